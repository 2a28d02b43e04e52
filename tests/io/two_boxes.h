// Two unit boxes that share a face, meshed regularly and labelled in full: a small mesh with every kind of entity.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "curvetet/mesh.h"

namespace curvetet::test {

/// Place of a coordinate relative to the planes at 0, 1, ... (times n): 2k on plane k, 2k + 1 between planes k and k
/// + 1.
inline int stratum(int twice, int n) { return twice % (2 * n) == 0 ? twice / n : 2 * (twice / (2 * n)) + 1; }

class TwoBoxes {
 public:
  explicit TwoBoxes(int n) : n_(n) {
    add_entities();
    add_points();
    for (int x = 0; x < 2 * n_; ++x) {
      for (int y = 0; y < n_; ++y) {
        for (int z = 0; z < n_; ++z) add_cube({x, y, z});
      }
    }
    for (const auto& [edge, strata] : edges_) add_segment(edge, strata);
    for (const auto& [face, strata] : faces_) add_triangle(face, strata);
  }
  Mesh mesh;

 private:
  using Triple = std::array<int, 3>;
  static int dimension(const Triple& strata) { return strata[0] % 2 + strata[1] % 2 + strata[2] % 2; }

  void add_entities() {
    std::array<std::vector<Entity>*, 4> lists{&mesh.vertices, &mesh.edges, &mesh.faces, &mesh.solids};
    for (int x = 0; x < 5; ++x) {
      for (int y = 0; y < 3; ++y) {
        for (int z = 0; z < 3; ++z) {
          const Triple strata{x, y, z};
          const auto d = static_cast<std::size_t>(dimension(strata));
          index_[strata] = static_cast<std::uint32_t>(lists[d]->size());
          constexpr const char* kNames[] = {"vertex_", "edge_", "face_", "solid_"};
          Entity entity;
          entity.cad_id = static_cast<std::uint32_t>(lists[d]->size() + 1);
          entity.name = kNames[d] + std::to_string(entity.cad_id);
          for (std::size_t i = 0; i < 3; ++i) {
            entity.box[i] = strata[i] / 2;
            entity.box[i + 3] = (strata[i] + 1) / 2;
          }
          lists[d]->push_back(entity);
        }
      }
    }
    for (const auto& [strata, index] : index_) {
      const auto d = static_cast<std::size_t>(dimension(strata));
      if (d == 0) continue;
      int sign = -1;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int step : {-1, 1}) {
          if (strata[axis] % 2 == 0) continue;
          Triple lower = strata;
          lower[axis] += step;
          (*lists[d])[index].boundary.push_back(sign * static_cast<std::int32_t>(index_[lower] + 1));
          sign = -sign;
        }
      }
    }
    mesh.corner_nodes.assign(mesh.vertices.size(), UINT32_MAX);
  }

  std::uint32_t node(const Triple& p) const {
    return static_cast<std::uint32_t>((p[0] * (n_ + 1) + p[1]) * (n_ + 1) + p[2]);
  }

  Triple strata_of(const Triple& twice) const {
    return {stratum(twice[0], n_), stratum(twice[1], n_), stratum(twice[2], n_)};
  }

  void add_points() {
    for (int x = 0; x <= 2 * n_; ++x) {
      for (int y = 0; y <= n_; ++y) {
        for (int z = 0; z <= n_; ++z) {
          const Triple strata = strata_of({2 * x, 2 * y, 2 * z});
          const int d = dimension(strata);
          NodeOnCad on{static_cast<std::uint8_t>(d), index_[strata], {}};
          if (d == 1) on.parameter = {(x + y + z) / 3.0, 0};
          if (d == 2) on.parameter = {x / 3.0 - 1, y * 1e-9 + z / 7.0};
          if (d == 0) mesh.corner_nodes[on.entity] = static_cast<std::uint32_t>(mesh.points.size());
          mesh.points.push_back({double(x) / n_, double(y) / n_, double(z) / n_});
          mesh.nodes.push_back(on);
        }
      }
    }
  }

  /// Six tets around the diagonal.
  void add_cube(const Triple& low) {
    Triple axes{0, 1, 2};
    do {
      std::array<Triple, 4> corner{low, low, low, low};
      for (std::size_t i = 1; i < 4; ++i) {
        corner[i] = corner[i - 1];
        ++corner[i][static_cast<std::size_t>(axes[i - 1])];
      }
      const bool even = (axes[1] - axes[0] + 3) % 3 == 1;
      if (!even) std::swap(corner[2], corner[3]);
      mesh.tets.push_back({node(corner[0]), node(corner[1]), node(corner[2]), node(corner[3])});
      mesh.tet_solid.push_back(low[0] < n_ ? 0 : 1);
      collect(corner);
    } while (std::next_permutation(axes.begin(), axes.end()));
  }

  /// The faces and edges of a tet that lie on faces and edges of the boxes.
  void collect(const std::array<Triple, 4>& corner) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        Triple sum{};
        for (std::size_t a = 0; a < 3; ++a) sum[a] = corner[i][a] + corner[j][a];
        if (dimension(strata_of(sum)) == 1) {
          edges_[{std::min(node(corner[i]), node(corner[j])), std::max(node(corner[i]), node(corner[j]))}] =
              strata_of(sum);
        }
      }
      constexpr std::size_t kFace[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
      Triple strata{};
      int d = 0;
      std::array<std::uint32_t, 3> face{};
      for (std::size_t a = 0; a < 3; ++a) {
        const int c[3] = {corner[kFace[i][0]][a], corner[kFace[i][1]][a], corner[kFace[i][2]][a]};
        const bool flat = c[0] == c[1] && c[1] == c[2];
        strata[a] = flat ? stratum(2 * c[0], n_) : stratum(2 * std::min({c[0], c[1], c[2]}) + 1, n_);
        d += strata[a] % 2;
        face[a] = node(corner[kFace[i][a]]);
      }
      std::array<std::uint32_t, 3> key = face;
      std::sort(key.begin(), key.end());
      if (d == 2 && seen_.insert(key).second) faces_[face] = strata;
    }
  }

  void add_segment(const std::array<std::uint32_t, 2>& edge, const Triple& strata) {
    mesh.segments.push_back(edge);
    mesh.segment_edge.push_back(index_[strata]);
  }
  void add_triangle(const std::array<std::uint32_t, 3>& face, const Triple& strata) {
    mesh.triangles.push_back(face);
    mesh.triangle_face.push_back(index_[strata]);
  }

  int n_;
  std::map<Triple, std::uint32_t> index_;
  std::map<std::array<std::uint32_t, 2>, Triple> edges_;
  std::map<std::array<std::uint32_t, 3>, Triple> faces_;
  std::set<std::array<std::uint32_t, 3>> seen_;
};

}  // namespace curvetet::test
