#include "geometry/describe.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <vector>

namespace curvetet {
namespace {

constexpr std::size_t kKinds = static_cast<std::size_t>(SurfaceKind::other) + 1;

/// What both forms of the description say.
struct Summary {
  Vec3 low, high;                           ///< in the model's unit
  std::array<std::size_t, kKinds> kinds{};  ///< faces by kind of surface
  double area_factor = 1, volume_factor = 1;
};

SurfaceKind kind_of(const ModelFace& face) {
  return face.surface == nullptr ? SurfaceKind::other : face.surface->kind();
}

Summary summarize(const Model& model) {
  Summary summary;
  summary.low = model.frame.to_cad(model.box.low);
  summary.high = model.frame.to_cad(model.box.high);
  for (const ModelFace& face : model.faces) ++summary.kinds[static_cast<std::size_t>(kind_of(face))];
  const double unit = model.frame.length_to_cad(1);
  summary.area_factor = unit * unit;
  summary.volume_factor = unit * unit * unit;
  return summary;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string colour_json(const std::optional<Colour>& colour) {
  return colour ? fmt::format("[{:.6g}, {:.6g}, {:.6g}]", colour->red, colour->green, colour->blue) : "null";
}

std::string solid_json(const Model& model, SolidId solid) {
  return solid.valid() ? std::to_string(model.solids[solid].label.cad_id) : "null";
}

std::string kind_of(const ModelEdge& edge) {
  if (edge.degenerate) return "pole";
  return edge.curve == nullptr ? "other" : name(edge.curve->kind());
}

std::string face_ids(const Model& model, const std::vector<FaceId>& faces) {
  std::string ids;
  for (const FaceId face : faces) ids += (ids.empty() ? "" : ", ") + std::to_string(model.faces[face].label.cad_id);
  return ids;
}

/// Items one per line between the brackets of a list.
std::string list_json(const std::vector<std::string>& items) {
  if (items.empty()) return "[]";
  std::string out = "[\n";
  for (std::size_t i = 0; i < items.size(); ++i) out += "    " + items[i] + (i + 1 < items.size() ? ",\n" : "\n");
  return out + "  ]";
}

std::vector<std::string> edges_json(const Model& model) {
  std::vector<std::string> edges;
  for (std::size_t i = 0; i < model.edges.size(); ++i) {
    const ModelEdge& edge = model.edges[EdgeId(i)];
    edges.push_back(fmt::format(R"({{"id": {}, "kind": "{}", "name": {}, "colour": {}, "faces": [{}]}})",
                                edge.label.cad_id, kind_of(edge), quoted(model.edge_name(EdgeId(i))),
                                colour_json(edge.label.colour), face_ids(model, edge.faces)));
  }
  return edges;
}

std::vector<std::string> suppressed_json(const Model& model) {
  std::vector<std::string> details;
  for (const SuppressedDetail& detail : model.suppressed) {
    const Vec3& p = detail.place;
    details.push_back(
        fmt::format(R"({{"kind": "{}", "id": {}, "name": {}, "size": {:.12g}, "where": [{:.12g}, {:.12g}, {:.12g}]}})",
                    name(detail.kind), detail.label.cad_id, quoted(detail.label.name), detail.size, p.x, p.y, p.z));
  }
  return details;
}

std::string to_json(const Model& model, const Summary& summary) {
  std::vector<std::string> solids, faces, notes;
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const ModelSolid& solid = model.solids[SolidId(i)];
    solids.push_back(fmt::format(
        R"({{"id": {}, "name": {}, "path": {}, "colour": {}, "volume": {:.12g}, "faces": [{}]}})", solid.label.cad_id,
        quoted(model.solid_name(SolidId(i))), quoted(solid.path), colour_json(solid.label.colour),
        solid.volume * summary.volume_factor, face_ids(model, solid.faces)));
  }
  for (std::size_t i = 0; i < model.faces.size(); ++i) {
    const ModelFace& face = model.faces[FaceId(i)];
    faces.push_back(fmt::format(
        R"({{"id": {}, "kind": "{}", "name": {}, "colour": {}, "area": {:.12g}, "back": {}, "front": {}}})",
        face.label.cad_id, name(kind_of(face)), quoted(model.face_name(FaceId(i))), colour_json(face.label.colour),
        face.area * summary.area_factor, solid_json(model, face.back), solid_json(model, face.front)));
  }
  for (const HealingNote& note : model.healing) {
    notes.push_back(fmt::format(R"({{"entity": {}, "what": {}}})", quoted(note.entity), quoted(note.what)));
  }
  std::string kinds;
  for (std::size_t k = 0; k < kKinds; ++k) {
    if (summary.kinds[k] == 0) continue;
    kinds +=
        fmt::format(R"({}"{}": {})", kinds.empty() ? "" : ", ", name(static_cast<SurfaceKind>(k)), summary.kinds[k]);
  }
  const Vec3 &a = summary.low, &b = summary.high;
  return fmt::format(
      "{{\n  \"schema\": 1,\n  \"unit\": {},\n  \"file_unit\": {},\n  \"box\": [{:.12g}, {:.12g}, {:.12g}, {:.12g}, "
      "{:.12g}, {:.12g}],\n"
      "  \"counts\": {{\"solids\": {}, \"faces\": {}, \"edges\": {}, \"vertices\": {}}},\n  \"surfaces\": {{{}}},\n"
      "  \"solids\": {},\n  \"faces\": {},\n  \"edges\": {},\n  \"healing\": {},\n  \"suppressed\": {}\n}}\n",
      quoted(model.unit), model.file_unit.empty() ? "null" : quoted(model.file_unit), a.x, a.y, a.z, b.x, b.y, b.z,
      model.solids.size(), model.faces.size(), model.edges.size(), model.vertices.size(), kinds, list_json(solids),
      list_json(faces), list_json(edges_json(model)), list_json(notes), list_json(suppressed_json(model)));
}

std::string to_words(const Model& model, const Summary& summary) {
  std::string out;
  const auto add = [&](const std::string& line) { out += line + "\n"; };
  const Vec3 &a = summary.low, &b = summary.high;
  add(fmt::format(
      "{} solids, {} faces, {} edges, {} vertices; lengths in {}{}", model.solids.size(), model.faces.size(),
      model.edges.size(), model.vertices.size(), model.unit,
      model.file_unit.empty() || model.file_unit == model.unit ? "" : ", in the file in " + model.file_unit));
  add(fmt::format("box ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}), diagonal {:.6g}", a.x, a.y, a.z, b.x, b.y,
                  b.z, distance(a, b)));
  std::string kinds;
  for (std::size_t k = 0; k < kKinds; ++k) {
    if (summary.kinds[k] == 0) continue;
    kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", summary.kinds[k], name(static_cast<SurfaceKind>(k)));
  }
  add("surfaces: " + kinds);
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const ModelSolid& solid = model.solids[SolidId(i)];
    add(fmt::format("solid {}  {}  volume {:.6g}  {} faces{}", solid.label.cad_id, model.solid_name(SolidId(i)),
                    solid.volume * summary.volume_factor, solid.faces.size(),
                    solid.path.empty() ? "" : "  in " + solid.path));
  }
  for (std::size_t i = 0; i < model.faces.size(); ++i) {
    const ModelFace& face = model.faces[FaceId(i)];
    add(fmt::format("face {}  {}  {}  area {:.6g}", face.label.cad_id, name(kind_of(face)), model.face_name(FaceId(i)),
                    face.area * summary.area_factor));
  }
  for (std::size_t i = 0; i < model.edges.size(); ++i) {
    const ModelEdge& edge = model.edges[EdgeId(i)];
    add(fmt::format("edge {}  {}  {}  on faces {}", edge.label.cad_id, kind_of(edge), model.edge_name(EdgeId(i)),
                    face_ids(model, edge.faces)));
  }
  for (const SuppressedDetail& detail : model.suppressed) {
    const Vec3& p = detail.place;
    add(fmt::format("suppressed: {} {}{}, {} {:.3g} at ({:.6g}, {:.6g}, {:.6g})", name(detail.kind),
                    detail.label.cad_id, detail.label.name.empty() ? "" : "  " + detail.label.name,
                    detail.kind == SuppressedDetail::Kind::edge ? "length" : "width", detail.size, p.x, p.y, p.z));
  }
  for (const HealingNote& note : model.healing)
    add((note.is_warning ? "warning: " : "note: ") + note.entity + ": " + note.what);
  return out;
}

}  // namespace

Result<std::string> describe_model(const Model& model, bool json) {
  const Summary summary = summarize(model);
  return json ? to_json(model, summary) : to_words(model, summary);
}

}  // namespace curvetet
