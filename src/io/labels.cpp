// Gmsh merges groups of equal name and cuts names at 127 bytes, so group names are cleaned and made unique here; the
// exact names travel in the label lines. Those are JSON because names may hold anything; '$' is escaped because it
// starts a section in Gmsh's files.
#include "io/labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace curvetet {

namespace {

constexpr std::size_t kLongestName = 127;

using Json = nlohmann::ordered_json;

/// Length of the UTF-8 character at `at`, or 0 if there is none (overlong forms count as none only where they are
/// short).
std::size_t character_length(const std::string& text, std::size_t at) {
  const auto byte = static_cast<unsigned char>(text[at]);
  const std::size_t length = byte < 0x80   ? 1
                             : byte < 0xC2 ? 0
                             : byte < 0xE0 ? 2
                             : byte < 0xF0 ? 3
                             : byte < 0xF5 ? 4
                                           : 0;
  if (at + length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((static_cast<unsigned char>(text[at + i]) & 0xC0U) != 0x80U) return 0;
  }
  return length;
}

/// UTF-8 without quotes, backslashes and control characters (readers trip over them), cut between characters.
std::string clean_name(const std::string& name, std::size_t longest) {
  std::string clean;
  for (std::size_t i = 0; i < name.size();) {
    const std::size_t length = character_length(name, i);
    if (clean.size() + std::max<std::size_t>(length, 1) > longest) break;
    const auto byte = static_cast<unsigned char>(name[i]);
    if (length == 0) {
      clean.push_back('?');
    } else if (length > 1) {
      clean.append(name, i, length);
    } else {
      clean.push_back(byte == '"' ? '\'' : byte == '\\' ? '/' : (byte < 32 || byte == 127) ? ' ' : name[i]);
    }
    i += std::max<std::size_t>(length, 1);
  }
  return clean.find_first_not_of(' ') == std::string::npos ? std::string() : clean;
}

std::string unique_name(const std::string& name, std::uint32_t cad_id, const std::set<std::string>& taken) {
  std::string suffix = fmt::format("_{}", cad_id);
  for (int n = 2;; ++n) {
    std::string candidate = clean_name(name, kLongestName - suffix.size()) + suffix;
    if (!taken.contains(candidate)) return candidate;
    suffix = fmt::format("_{}_{}", cad_id, n);
  }
}

Json numbers(const auto& values) {
  Json list = Json::array();
  for (const auto value : values) list.push_back(value);
  return list;
}

template <std::size_t N>
bool read_numbers(const Json& json, std::array<double, N>& values) {
  if (!json.is_array() || json.size() != N) return false;
  for (std::size_t i = 0; i < N; ++i) {
    if (!json[i].is_number()) return false;
    values[i] = json[i].template get<double>();
    if (!std::isfinite(values[i])) return false;
  }
  return true;
}

bool read_boundary(const Json& json, std::vector<std::int32_t>& boundary) {
  if (!json.is_array()) return false;
  boundary.clear();
  for (const Json& id : json) {
    if (!id.is_number_integer()) return false;
    boundary.push_back(static_cast<std::int32_t>(id.get<std::int64_t>()));
  }
  return true;
}

bool read_entity(const Json& json, Entity& entity) {
  if (json.contains("name")) {
    if (!json["name"].is_string()) return false;
    entity.name = json["name"].get<std::string>();
  }
  if (json.contains("colour")) {
    entity.colour.emplace();
    if (!read_numbers(json["colour"], *entity.colour)) return false;
  }
  if (json.contains("box") && !read_numbers(json["box"], entity.box)) return false;
  return !json.contains("boundary") || read_boundary(json["boundary"], entity.boundary);
}

bool finite_box(const Entity& entity) {
  for (const double value : entity.box) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

std::string dump(const Json& json) {
  const std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);
  std::string line;
  for (const char c : text) {
    if (c == '$') {
      line += "\\u0024";
    } else {
      line.push_back(c);
    }
  }
  return line;
}

}  // namespace

std::string default_name(int dimension, std::uint32_t cad_id) {
  constexpr const char* kNames[] = {"vertex", "edge", "face", "solid"};
  return fmt::format("{}_{}", kNames[dimension], cad_id);
}

const std::vector<Entity>& entities_of(const Mesh& mesh, int dimension) {
  return dimension == 0 ? mesh.vertices : dimension == 1 ? mesh.edges : dimension == 2 ? mesh.faces : mesh.solids;
}

std::vector<Entity>& entities_of(Mesh& mesh, int dimension) {
  return dimension == 0 ? mesh.vertices : dimension == 1 ? mesh.edges : dimension == 2 ? mesh.faces : mesh.solids;
}

PhysicalGroups physical_groups(const std::vector<Entity>& entities, int dimension) {
  PhysicalGroups result;
  result.tag_of_entity.assign(entities.size(), 0);
  std::map<std::string, std::uint32_t> tag_of_name;  // by the CAD's own name
  std::set<std::string> taken;
  const auto add = [&](std::size_t i, const std::string& name) {
    const std::string clean = clean_name(name, kLongestName);
    const bool is_free = !clean.empty() && !taken.contains(clean);
    const std::string own = default_name(dimension, entities[i].cad_id);
    result.groups.push_back(
        {entities[i].cad_id, is_free ? clean : unique_name(clean.empty() ? own : clean, entities[i].cad_id, taken)});
    taken.insert(result.groups.back().name);
    result.tag_of_entity[i] = entities[i].cad_id;
  };
  // The CAD's names first: a name made up for another entity has to give way to them.
  std::vector<std::size_t> unnamed;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    const Entity& entity = entities[i];
    if (entity.name.empty() || entity.name == default_name(dimension, entity.cad_id)) {
      unnamed.push_back(i);
    } else if (const auto known = tag_of_name.find(entity.name); known != tag_of_name.end()) {
      result.tag_of_entity[i] = known->second;
    } else {
      tag_of_name[entity.name] = entity.cad_id;
      add(i, entity.name);
    }
  }
  for (const std::size_t i : unnamed) add(i, default_name(dimension, entities[i].cad_id));
  std::sort(result.groups.begin(), result.groups.end(),
            [](const PhysicalGroup& a, const PhysicalGroup& b) { return a.tag < b.tag; });
  return result;
}

std::vector<std::string> label_lines(const Mesh& mesh, bool with_geometry) {
  std::vector<std::string> lines;
  lines.push_back(dump(Json{{"schema", 1}, {"unit", mesh.unit}}));
  for (int dimension = 0; dimension < 4; ++dimension) {
    for (const Entity& entity : entities_of(mesh, dimension)) {
      Json json{{"dimension", dimension}, {"id", entity.cad_id}, {"name", entity.name}};
      if (entity.colour) json["colour"] = numbers(*entity.colour);
      if (with_geometry && finite_box(entity)) json["box"] = numbers(entity.box);
      if (with_geometry && !entity.boundary.empty()) json["boundary"] = numbers(entity.boundary);
      lines.push_back(dump(json));
    }
  }
  return lines;
}

std::uint32_t EntityTable::find_or_add(int dimension, std::uint32_t cad_id) {
  std::vector<Entity>& entities = entities_of(mesh_, dimension);
  const auto [place, added] =
      index_[static_cast<std::size_t>(dimension)].try_emplace(cad_id, static_cast<std::uint32_t>(entities.size()));
  if (added) {
    entities.emplace_back();
    entities.back().cad_id = cad_id;
  }
  return place->second;
}

bool EntityTable::apply_label_line(std::string_view line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return false;
  if (json.contains("unit")) {
    if (!json["unit"].is_string()) return false;
    mesh_.unit = json["unit"].get<std::string>();
    return true;
  }
  if (!json.contains("dimension") || !json["dimension"].is_number_unsigned()) return false;
  if (!json.contains("id") || !json["id"].is_number_unsigned()) return false;
  const auto dimension = json["dimension"].get<std::uint64_t>();
  const auto id = json["id"].get<std::uint64_t>();
  if (dimension > 3 || id > 0x7FFFFFFFU) return false;
  const std::uint32_t index = find_or_add(static_cast<int>(dimension), static_cast<std::uint32_t>(id));
  return read_entity(json, entities_of(mesh_, static_cast<int>(dimension))[index]);
}

void EntityTable::name_the_unnamed() {
  for (int dimension = 0; dimension < 4; ++dimension) {
    for (Entity& entity : entities_of(mesh_, dimension)) {
      if (entity.name.empty()) entity.name = default_name(dimension, entity.cad_id);
    }
  }
}

}  // namespace curvetet
