#include "geometry/model.h"

#include <algorithm>

namespace curvetet {
namespace {

std::string name_of(const Label& label, const char* prefix) {
  return label.name.empty() ? prefix + std::to_string(label.cad_id) : label.name;
}

}  // namespace

std::string Model::face_name(FaceId face) const { return name_of(faces[face].label, "face_"); }
std::string Model::edge_name(EdgeId edge) const { return name_of(edges[edge].label, "edge_"); }
std::string Model::solid_name(SolidId solid) const { return name_of(solids[solid].label, "solid_"); }

std::vector<FaceId> Model::faces_at(CadVertexId vertex) const {
  std::vector<FaceId> found;
  for (const ModelEdge& edge : edges) {
    if (edge.start == vertex || edge.end == vertex) found.insert(found.end(), edge.faces.begin(), edge.faces.end());
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto& inside = faces[FaceId(f)].internal_vertices;
    if (std::find(inside.begin(), inside.end(), vertex) != inside.end()) found.push_back(FaceId(f));
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace curvetet
