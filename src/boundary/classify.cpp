// Components are flooded first, then each is given the solid that its locked facets name; a component whose facets
// disagree is a contradiction and names the two faces. The side of a facet follows from the orientation of its triangle
// in t_ps and of its face, never from a coarse facet's own normal.
#include "boundary/classify.h"

#include <fmt/format.h>

#include <map>

#include "boundary/surface_triangles.h"

namespace curvetet {

namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;

class Classification {
 public:
  explicit Classification(Conjoint& conjoint)
      : conjoint_(conjoint), complex_(conjoint.tets()->complex()), component_(complex_.slots(), kNone) {
    result_.tets.resize(conjoint.model().solids.size(), 0);
    result_.volumes.resize(conjoint.model().solids.size(), 0);
  }

  ClassifyResult run() {
    flood();
    for (const SurfaceTriangle& t : surface_triangles(conjoint_.boundary())) label_sides(t);
    assign();
    return std::move(result_);
  }

 private:
  struct Claim {
    SolidId solid;
    FaceId face;
    bool made = false;
  };

  void flood() {
    std::uint32_t count = 0;
    std::vector<TetId> stack;
    for (std::size_t s = 0; s < complex_.slots(); ++s) {
      if (!complex_.is_alive(TetId(s)) || component_[s] != kNone) continue;
      component_[s] = count;
      stack.assign(1, TetId(s));
      while (!stack.empty()) {
        const TetId t = stack.back();
        stack.pop_back();
        for (int i = 0; i < 4; ++i) {
          const TetId n = complex_.neighbour(t, i);
          if (component_[n.value()] != kNone || complex_.is_locked({t, i})) continue;
          component_[n.value()] = count;
          stack.push_back(n);
        }
      }
      ++count;
    }
    claims_.resize(count);
  }

  void label_sides(const SurfaceTriangle& t) {
    const auto facet = conjoint_.tets()->find_facet(t.vertices[0], t.vertices[1], t.vertices[2]);
    CURVETET_CHECK(facet.has_value());
    for (const TetFacet& f : {*facet, complex_.mirror(*facet)}) {
      // The tet lies where orient3d(facet, apex) > 0: on the side of du x dv if the facet runs as the triangle does.
      const auto v = complex_.facet_vertices(f);
      const bool along = (v[0] == t.vertices[0] && v[1] == t.vertices[1]) ||
                         (v[1] == t.vertices[0] && v[2] == t.vertices[1]) ||
                         (v[2] == t.vertices[0] && v[0] == t.vertices[1]);
      const ModelFace& face = conjoint_.model().faces[t.face];
      claim(f, along != face.reversed ? face.front : face.back, t);
    }
  }

  void claim(const TetFacet& f, SolidId solid, const SurfaceTriangle& t) {
    Claim& c = claims_[component_[f.tet.value()]];
    if (!c.made) {
      c = {solid, t.face, true};
    } else if (c.solid != solid && !contradicted_) {
      contradicted_ = true;
      RecoveryFailure failure;
      failure.faces = {c.face, t.face};
      double longest = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 p = conjoint_.vertices().position(t.vertices[k]);
        failure.where = failure.where + (1.0 / 3) * p;
        longest = std::max(longest, distance(p, conjoint_.vertices().position(t.vertices[(k + 1) % 3])));
      }
      failure.size = 0.5 * longest;
      failure.what = "the two sides of the boundary are not told apart: the flood fill meets a contradiction";
      result_.failures.push_back(failure);
    }
  }

  void assign() {
    for (std::size_t s = 0; s < complex_.slots(); ++s) {
      const TetId t(s);
      if (!complex_.is_alive(t)) continue;
      const Claim& c = claims_[component_[s]];
      const bool inside = c.made && c.solid.valid() && !complex_.is_ghost(t);
      complex_.set_region(t, inside ? c.solid.value() + 1 : 0);
      if (!inside) continue;
      ++result_.tets[c.solid];
      const auto& v = complex_.vertices(t);
      const Vec3 a = conjoint_.vertices().position(v[0]);
      result_.volumes[c.solid] +=
          dot(cross(conjoint_.vertices().position(v[1]) - a, conjoint_.vertices().position(v[2]) - a),
              conjoint_.vertices().position(v[3]) - a) /
          6;
    }
    for (std::size_t s = 0; s < result_.tets.size(); ++s)
      if (result_.tets[SolidId(s)] == 0)
        result_.failures.push_back(
            {conjoint_.model().solids[SolidId(s)].faces,
             {},
             0,
             fmt::format("solid {} got no tets", conjoint_.model().solids[SolidId(s)].label.cad_id)});
  }

  Conjoint& conjoint_;
  TetComplex& complex_;
  std::vector<std::uint32_t> component_;
  std::vector<Claim> claims_;
  bool contradicted_ = false;
  ClassifyResult result_;
};

}  // namespace

ClassifyResult classify(Conjoint& conjoint) { return Classification(conjoint).run(); }

}  // namespace curvetet
