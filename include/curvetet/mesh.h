// The mesh that curvetet makes: plain arrays, labelled with the CAD's ids and names.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace curvetet {

using Point = std::array<double, 3>;

/// One CAD entity that mesh elements belong to.
struct Entity {
  std::uint32_t cad_id = 0;                     ///< 1..n as in the input shape; unique per dimension
  std::string name;                             ///< the CAD's, or solid_1, face_12, edge_7
  std::optional<std::array<double, 3>> colour;  ///< red, green, blue in [0,1]
  std::vector<std::int32_t> boundary;  ///< cad ids of the bounding entities one dimension lower; negative: reversed
  std::array<double, 6> box{};         ///< min x,y,z, max x,y,z in the output's unit
};

/// Where a node lies on the CAD.
struct NodeOnCad {
  std::uint8_t dimension = 3;         ///< 0 vertex, 1 edge, 2 face, 3 interior
  std::uint32_t entity = 0;           ///< index into the entities of that dimension
  std::array<double, 2> parameter{};  ///< (t,-) on an edge, (u,v) on a face
};

/// A tetrahedral mesh with its boundary. Element vertices are indices into `points`; entity fields are indices into the
/// entity list of that dimension (not cad ids).
struct Mesh {
  std::string unit = "mm";
  std::vector<Point> points;
  std::vector<NodeOnCad> nodes;                    ///< as many as points
  std::vector<std::array<std::uint32_t, 4>> tets;  ///< positive: det[b-a, c-a, d-a] > 0
  std::vector<std::uint32_t> tet_solid;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< seen counter-clockwise from outside of the CAD face
  std::vector<std::uint32_t> triangle_face;
  std::vector<std::array<std::uint32_t, 2>> segments;
  std::vector<std::uint32_t> segment_edge;
  std::vector<std::uint32_t> corner_nodes;  ///< node of each CAD vertex, by vertex entity; UINT32_MAX if none
  std::vector<Entity> solids, faces, edges, vertices;
};

}  // namespace curvetet
