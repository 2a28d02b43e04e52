#include "pipeline/state.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "base/fnv.h"
#include "io/output_file.h"

namespace curvetet {

namespace {

static_assert(std::endian::native == std::endian::little, "the file holds numbers as they are in memory");

using Json = nlohmann::ordered_json;

constexpr std::string_view kMagic = "curvetet replay\n";
constexpr std::uint32_t kLayout = 1;

struct Header {
  std::uint32_t layout = kLayout;
  std::uint64_t json = 0, body = 0, hash = 0;
};
constexpr std::size_t kHeaderBytes = kMagic.size() + sizeof(std::uint32_t) + 3 * sizeof(std::uint64_t);

std::uint64_t hash_of(std::string_view bytes) {
  Fnv1a hash;
  hash.add(bytes);
  return hash.value();
}

Json json_of(Vec3 p) { return {p.x, p.y, p.z}; }

Vec3 vec_of(const Json& j) { return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()}; }

Json json_of(const std::optional<double>& x) { return x ? Json(*x) : Json(); }

std::optional<double> optional_of(const Json& j) { return j.is_null() ? std::nullopt : std::optional(j.get<double>()); }

Json json_of(const LocalSize& l) { return {static_cast<int>(l.kind), l.which, l.size}; }

/// An enumerator by its number, which must not exceed that of the last one.
template <class Enum>
Enum enum_of(const Json& j, Enum last) {
  const int value = j.get<int>();
  if (value < 0 || value > static_cast<int>(last)) throw std::out_of_range("no such choice");
  return static_cast<Enum>(value);
}

Json json_of(const Options& o) {
  Json j;
  j["size"] = json_of(o.size);
  j["size_divisor"] = o.size_divisor;
  j["min_size"] = json_of(o.min_size);
  j["curvature"] = o.curvature;
  j["chord_height"] = json_of(o.chord_height);
  j["grading"] = o.grading;
  j["gaps"] = o.gaps;
  j["local_sizes"] = Json::array();
  for (const LocalSize& l : o.local_sizes) j["local_sizes"].push_back(json_of(l));
  j["unit"] = o.unit;
  j["conformal"] = static_cast<int>(o.conformal);
  j["overlaps"] = static_cast<int>(o.overlaps);
  j["min_feature"] = o.min_feature;
  j["recovery"] = static_cast<int>(o.recovery);
  j["refine_interior"] = o.refine_interior;
  j["improve"] = o.improve;
  j["radius_edge"] = o.radius_edge;
  j["seed"] = o.seed;
  return j;
}

Options options_of(const Json& j) {
  Options o;
  o.size = optional_of(j.at("size"));
  o.size_divisor = j.at("size_divisor").get<double>();
  o.min_size = optional_of(j.at("min_size"));
  o.curvature = j.at("curvature").get<double>();
  o.chord_height = optional_of(j.at("chord_height"));
  o.grading = j.at("grading").get<double>();
  o.gaps = j.at("gaps").get<bool>();
  for (const Json& l : j.at("local_sizes"))
    o.local_sizes.push_back(
        {enum_of(l.at(0), LocalSize::Kind::solid), l.at(1).get<std::string>(), l.at(2).get<double>()});
  o.unit = j.at("unit").get<std::string>();
  o.conformal = enum_of(j.at("conformal"), Conformal::strict);
  o.overlaps = enum_of(j.at("overlaps"), Overlaps::split);
  o.min_feature = j.at("min_feature").get<double>();
  o.recovery = enum_of(j.at("recovery"), RecoveryMode::paper);
  o.refine_interior = j.at("refine_interior").get<bool>();
  o.improve = j.at("improve").get<bool>();
  o.radius_edge = j.at("radius_edge").get<double>();
  o.seed = j.at("seed").get<std::uint64_t>();
  return o;
}

Json json_of(const SizeSource& s) {
  const auto index = [](FaceId f) { return f.valid() ? Json(f.value()) : Json(); };
  return {json_of(s.where), s.size, index(s.face), index(s.other)};
}

SizeSource source_of(const Json& j) {
  const auto face = [](const Json& f) { return f.is_null() ? FaceId() : FaceId(f.get<std::uint32_t>()); };
  SizeSource s;
  s.where = vec_of(j.at(0));
  s.size = j.at(1).get<double>();
  s.reason = SizeReason::outer_loop;
  s.face = face(j.at(2));
  s.other = face(j.at(3));
  return s;
}

Json json_of(const OuterLoop& loop) {
  Json rounds = Json::array();
  for (const std::vector<SizeSource>& asked : loop.asked) {
    Json round = Json::array();
    for (const SizeSource& s : asked) round.push_back(json_of(s));
    rounds.push_back(std::move(round));
  }
  return rounds;
}

OuterLoop loop_of(const Json& rounds) {
  OuterLoop loop;
  if (rounds.size() > kOuterRounds) throw std::out_of_range("too many rounds");
  for (const Json& round : rounds) {
    std::vector<SizeSource>& asked = loop.asked.emplace_back();
    for (const Json& s : round) asked.push_back(source_of(s));
  }
  return loop;
}

Json json_of(const Error& e) {
  return {{"code", static_cast<int>(e.code)},
          {"message", e.message},
          {"entities", e.entities},
          {"where", e.where ? json_of(*e.where) : Json()},
          {"hint", e.hint}};
}

Error error_of(const Json& j) {
  Error e;
  e.code = static_cast<ErrorCode>(j.at("code").get<int>());
  e.message = j.at("message").get<std::string>();
  e.entities = j.at("entities").get<std::vector<std::string>>();
  if (!j.at("where").is_null()) e.where = vec_of(j.at("where"));
  e.hint = j.at("hint").get<std::string>();
  return e;
}

std::string json_text(const State& state) {
  Json j;
  j["version"] = state.version;
  j["input"] = state.input;
  j["options"] = json_of(state.options);
  j["part"] = state.loop.part;
  j["rounds"] = json_of(state.loop);
  j["failure"] = json_of(state.failure);
  j["size"] = state.size;
  return j.dump(-1, ' ', false, Json::error_handler_t::replace);
}

State state_of(const Json& j) {
  State state;
  state.version = j.at("version").get<std::string>();
  state.input = j.at("input").get<std::string>();
  state.options = options_of(j.at("options"));
  state.loop = loop_of(j.at("rounds"));
  state.loop.part = j.at("part").get<std::size_t>();
  state.failure = error_of(j.at("failure"));
  state.size = j.at("size").get<double>();
  return state;
}

Error unreadable(const std::string& path, const std::string& why, ErrorCode code = ErrorCode::file_unreadable) {
  return {code, path + " " + why, {}, {}, "give the replay.bin of a dossier, as it was written"};
}

template <class T>
T take(std::string_view& bytes) {
  T value{};
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
  return value;
}

Result<std::string> bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return unreadable(path, "cannot be opened", ErrorCode::file_not_found);
  std::ostringstream out;
  out << in.rdbuf();
  return std::move(out).str();
}

}  // namespace

Status write_state(const State& state, const std::string& path) {
  const std::string json = json_text(state);
  OutputFile file(path);
  file.put(kMagic);
  file.raw(kLayout);
  file.raw(std::uint64_t{json.size()});
  file.raw(std::uint64_t{state.body.size()});
  file.raw(hash_of(json + state.body));
  file.put(json);
  file.put(state.body);
  return file.commit();
}

Result<State> read_state(const std::string& path) {
  const Result<std::string> bytes = bytes_of(path);
  if (!bytes) return bytes.error();
  std::string_view rest = bytes.value();
  if (rest.size() < kHeaderBytes || rest.substr(0, kMagic.size()) != kMagic)
    return unreadable(path, "is not the state of a run");
  rest.remove_prefix(kMagic.size());
  Header header;
  header.layout = take<std::uint32_t>(rest);
  if (header.layout != kLayout)
    return unreadable(path, fmt::format("is of layout {}, not {}", header.layout, kLayout), ErrorCode::unknown_format);
  header.json = take<std::uint64_t>(rest);
  header.body = take<std::uint64_t>(rest);
  header.hash = take<std::uint64_t>(rest);
  if (header.json > rest.size() || header.body != rest.size() - header.json || header.hash != hash_of(rest))
    return unreadable(path, "is damaged or cut short");
  try {
    State state = state_of(Json::parse(rest.substr(0, header.json)));
    state.body = rest.substr(header.json);
    return state;
  } catch (const std::exception& error) {
    return unreadable(path, std::string("does not hold what it should: ") + error.what());
  }
}

}  // namespace curvetet
