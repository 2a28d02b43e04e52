// Prisms are cut into three tets by the numbers of their vertices (the diagonal of each quadrangle starts at its
// smallest), so that neighbours agree. Labels come from distances to the model's surfaces and curves, which is what
// they mean.
#include "sample_meshes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "quality/measures.h"

namespace curvetet::test {
namespace {

using Index = std::uint32_t;
constexpr double kOn = 1e-9;

Vec3 at(const Mesh& mesh, Index v) { return {mesh.points[v][0], mesh.points[v][1], mesh.points[v][2]}; }

void add_tet(Mesh& mesh, std::array<Index, 4> t, Index solid) {
  if (tet_volume(at(mesh, t[0]), at(mesh, t[1]), at(mesh, t[2]), at(mesh, t[3])) < 0) std::swap(t[0], t[1]);
  mesh.tets.push_back(t);
  mesh.tet_solid.push_back(solid);
}

/// Prism with triangles (v0 v1 v2) and (v3 v4 v5), v3 above v0.
void add_prism(Mesh& mesh, std::array<Index, 6> v, Index solid) {
  const auto smallest = static_cast<int>(std::min_element(v.begin(), v.end()) - v.begin());
  if (smallest >= 3) {
    std::swap(v[0], v[3]);
    std::swap(v[1], v[4]);
    std::swap(v[2], v[5]);
  }
  std::rotate(v.begin(), v.begin() + smallest % 3, v.begin() + 3);
  std::rotate(v.begin() + 3, v.begin() + 3 + smallest % 3, v.end());
  add_tet(mesh, {v[0], v[3], v[4], v[5]}, solid);
  if (std::min(v[1], v[5]) < std::min(v[2], v[4])) {
    add_tet(mesh, {v[0], v[1], v[2], v[5]}, solid);
    add_tet(mesh, {v[0], v[1], v[5], v[4]}, solid);
  } else {
    add_tet(mesh, {v[0], v[1], v[2], v[4]}, solid);
    add_tet(mesh, {v[0], v[4], v[2], v[5]}, solid);
  }
}

Index add_point(Mesh& mesh, Vec3 p) {
  mesh.points.push_back({p.x, p.y, p.z});
  return static_cast<Index>(mesh.points.size() - 1);
}

bool on_surface(const Model& model, const ModelFace& face, Vec3 p) {
  const Vec3 q = model.frame.to_working(p);
  const auto close = [&](double s, double t) {
    const Vec2 guess{face.low.x + s * (face.high.x - face.low.x), face.low.y + t * (face.high.y - face.low.y)};
    const auto uv = face.surface->project(q, guess);
    return uv && distance(face.surface->value(*uv), q) < kOn;
  };
  for (const double s : {0.1, 0.35, 0.6, 0.85}) {
    for (const double t : {0.2, 0.5, 0.8}) {
      if (close(s, t)) return true;
    }
  }
  return false;
}

bool on_curve(const Model& model, const ModelEdge& edge, Vec3 p) {
  const Vec3 q = model.frame.to_working(p);
  for (int i = 0; i <= 16; ++i) {
    const double guess = edge.low + (edge.high - edge.low) * i / 16;
    if (distance(edge.curve->value(edge.curve->project(q, guess, edge.low, edge.high)), q) < kOn) return true;
  }
  return false;
}

template <class Range>
std::vector<Entity> entities(const Range& range) {
  std::vector<Entity> result;
  for (const auto& entity : range) result.push_back({entity.label.cad_id, entity.label.name, {}, {}, {}});
  return result;
}

/// Facets between different solids (number of solids for the outside), with those on either side of ascending vertices.
std::map<std::array<Index, 3>, std::array<Index, 2>> boundary_of(const Mesh& mesh) {
  const auto outside = static_cast<Index>(mesh.solids.size());
  std::map<std::array<Index, 3>, std::array<Index, 2>> facets;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<Index, 3> f{mesh.tets[t][(i + 1) % 4], mesh.tets[t][(i + 2) % 4], mesh.tets[t][(i + 3) % 4]};
      std::sort(f.begin(), f.end());
      const bool above = tet_volume(at(mesh, f[0]), at(mesh, f[1]), at(mesh, f[2]), at(mesh, mesh.tets[t][i])) > 0;
      facets.emplace(f, std::array{outside, outside}).first->second[above ? 0 : 1] = mesh.tet_solid[t];
    }
  }
  std::erase_if(facets, [](const auto& facet) { return facet.second[0] == facet.second[1]; });
  return facets;
}

void label_triangles(Mesh& mesh, const Model& model) {
  std::map<Index, std::set<std::size_t>> faces_of;  // by vertex
  const auto facets = boundary_of(mesh);
  for (const auto& [vertices, sides] : facets) {
    for (const Index v : vertices) {
      if (faces_of.contains(v)) continue;
      auto& faces = faces_of[v];
      for (std::size_t f = 0; f < model.faces.size(); ++f) {
        if (on_surface(model, model.faces[FaceId(f)], at(mesh, v))) faces.insert(f);
      }
    }
  }
  const auto solid = [&](SolidId s) { return s.valid() ? s.value() : static_cast<Index>(mesh.solids.size()); };
  for (const auto& [v, sides] : facets) {
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
      if (!faces_of[v[0]].contains(f) || !faces_of[v[1]].contains(f) || !faces_of[v[2]].contains(f)) continue;
      const ModelFace& face = model.faces[FaceId(f)];
      const bool even = sides == std::array{solid(face.front), solid(face.back)};
      const bool odd = sides == std::array{solid(face.back), solid(face.front)};
      if (!even && !odd) continue;  // of other solids in the same plane
      mesh.triangles.push_back(even ? v : std::array{v[0], v[2], v[1]});
      mesh.triangle_face.push_back(static_cast<Index>(f));
      break;
    }
  }
}

void label_segments(Mesh& mesh, const Model& model) {
  std::map<std::array<Index, 2>, std::set<Index>> faces_at;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = mesh.triangles[t][i], b = mesh.triangles[t][(i + 1) % 3];
      faces_at[{std::min(a, b), std::max(a, b)}].insert(mesh.triangle_face[t]);
    }
  }
  for (const auto& [s, faces] : faces_at) {
    if (faces.size() < 2) continue;
    for (std::size_t e = 0; e < model.edges.size(); ++e) {
      const ModelEdge& edge = model.edges[EdgeId(e)];
      if (edge.degenerate || !on_curve(model, edge, at(mesh, s[0])) || !on_curve(model, edge, at(mesh, s[1]))) continue;
      mesh.segments.push_back(s);
      mesh.segment_edge.push_back(static_cast<Index>(e));
    }
  }
  for (const ModelVertex& vertex : model.vertices) {
    Index corner = UINT32_MAX;
    for (Index v = 0; v < mesh.points.size(); ++v) {
      if (distance(model.frame.to_working(at(mesh, v)), vertex.point) < kOn) corner = v;
    }
    mesh.corner_nodes.push_back(corner);
  }
}

Mesh begin(const Model& model) {
  Mesh mesh;
  mesh.solids = entities(model.solids);
  mesh.faces = entities(model.faces);
  mesh.edges = entities(model.edges);
  mesh.vertices = entities(model.vertices);
  return mesh;
}

Mesh finish(Mesh mesh, const Model& model) {
  mesh.nodes.resize(mesh.points.size());
  label_triangles(mesh, model);
  label_segments(mesh, model);
  return mesh;
}

struct Sphere {
  std::vector<Vec3> directions;
  std::vector<std::array<Index, 3>> triangles;
};

Sphere octasphere(int levels) {
  Sphere s{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
           {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::array<Index, 2>, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto [found, fresh] =
          middles.emplace(std::array{std::min(a, b), std::max(a, b)}, static_cast<Index>(s.directions.size()));
      if (fresh) s.directions.push_back(normalized(s.directions[a] + s.directions[b]));
      return found->second;
    };
    std::vector<std::array<Index, 3>> finer;
    for (const auto& [a, b, c] : s.triangles) {
      const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    s.triangles = std::move(finer);
  }
  return s;
}

}  // namespace

Mesh mesh_boxes(const Model& model, const std::vector<double>& lengths, double y, double z, int n) {
  Mesh mesh = begin(model);
  const int nx = n * static_cast<int>(lengths.size());
  const auto index = [&](int i, int j, int k) { return static_cast<Index>((k * (n + 1) + j) * (nx + 1) + i); };
  for (int k = 0; k <= n; ++k) {
    for (int j = 0; j <= n; ++j) {
      double x = 0;
      for (int i = 0; i <= nx; ++i) {
        add_point(mesh, {x, y * j / n, z * k / n});
        if (i < nx) x += lengths[static_cast<std::size_t>(i / n)] / n;
      }
    }
  }
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < nx; ++i) {
        const auto solid = static_cast<Index>(i / n);
        add_prism(mesh,
                  {index(i, j, k), index(i + 1, j, k), index(i + 1, j + 1, k), index(i, j, k + 1),
                   index(i + 1, j, k + 1), index(i + 1, j + 1, k + 1)},
                  solid);
        add_prism(mesh,
                  {index(i, j, k), index(i + 1, j + 1, k), index(i, j + 1, k), index(i, j, k + 1),
                   index(i + 1, j + 1, k + 1), index(i, j + 1, k + 1)},
                  solid);
      }
    }
  }
  return finish(std::move(mesh), model);
}

Mesh mesh_cylinder(const Model& model, double radius, double height, int sectors) {
  Mesh mesh = begin(model);
  for (const double z : {0.0, height}) {
    add_point(mesh, {0, 0, z});
    for (int i = 0; i < sectors; ++i) {
      const double angle = 2 * M_PI * i / sectors;
      add_point(mesh, {radius * std::cos(angle), radius * std::sin(angle), z});
    }
  }
  const auto up = static_cast<Index>(sectors + 1);
  for (int i = 0; i < sectors; ++i) {
    const auto a = static_cast<Index>(1 + i), b = static_cast<Index>(1 + (i + 1) % sectors);
    add_prism(mesh, {0, a, b, up, up + a, up + b}, 0);
  }
  return finish(std::move(mesh), model);
}

Mesh mesh_balls(const Model& model, const std::vector<double>& radii, bool filled,
                const std::vector<std::uint32_t>& solid, int levels) {
  Mesh mesh = begin(model);
  const Sphere sphere = octasphere(levels);
  const auto n = static_cast<Index>(sphere.directions.size());
  for (const double radius : radii) {
    for (const Vec3 direction : sphere.directions) add_point(mesh, radius * direction);
  }
  const Index centre = filled ? add_point(mesh, {}) : 0;
  for (const auto& [a, b, c] : sphere.triangles) {
    if (filled) add_tet(mesh, {centre, a, b, c}, solid[0]);
    for (Index layer = 0; layer + 1 < radii.size(); ++layer) {
      const Index i = layer * n, o = i + n;
      add_prism(mesh, {i + a, i + b, i + c, o + a, o + b, o + c}, solid[layer + (filled ? 1 : 0)]);
    }
  }
  return finish(std::move(mesh), model);
}

}  // namespace curvetet::test
