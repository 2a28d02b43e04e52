// A hole is grown over missing edges until all edges of its border exist: only then is it clear what lies on which side
// of it.
#include "boundary/fill_holes.h"

#include <algorithm>
#include <map>
#include <set>

#include "boundary/surface_triangles.h"
#include "boundary/temporary_locks.h"
#include "geometry/frame.h"
#include "spatial/refill.h"

namespace curvetet {

namespace {

/// Triangles of one hole: a larger one is not a matter of reconnecting what is there.
constexpr std::size_t kMostTriangles = 60;

/// Surface triangles of some faces by their edges.
class Sheets {
 public:
  explicit Sheets(const Conjoint& conjoint) : conjoint_(conjoint) {}

  void add(FaceId face) {
    if (!faces_.insert(face).second) return;
    for (const SurfaceTriangle& t : surface_triangles(conjoint_.boundary().faces[face], face)) {
      for (std::size_t k = 0; k < 3; ++k)
        at_edge_[edge_key(t.vertices[k], t.vertices[(k + 1) % 3])].push_back(static_cast<std::uint32_t>(all_.size()));
      all_.push_back(t);
    }
  }
  /// Those over an edge, with those of all faces of its curve if it is a segment.
  const std::vector<std::uint32_t>& at(VertexId a, VertexId b) {
    const EdgeId curve = conjoint_.segment_edge(a, b);
    if (curve.valid())
      for (FaceId f : conjoint_.model().edges[curve].faces) add(f);
    return at_edge_[edge_key(a, b)];
  }
  const std::vector<SurfaceTriangle>& all() const { return all_; }

 private:
  const Conjoint& conjoint_;
  std::set<FaceId> faces_;
  std::vector<SurfaceTriangle> all_;
  std::map<std::uint64_t, std::vector<std::uint32_t>> at_edge_;
};

class HoleFiller {
 public:
  HoleFiller(Conjoint& conjoint, Sheets& sheets, bool with_points) : tets_(*conjoint.tets()), sheets_(sheets) {
    if (!with_points) return;
    options_.add_vertex = [&conjoint](Vec3 p) {
      return conjoint.vertices().add(snap(p), Owner::of(SolidId(0)), {}, Origin::steiner);
    };
  }

  bool present(std::uint32_t i) const {
    const auto& v = sheets_.all()[i].vertices;
    return tets_.find_facet(v[0], v[1], v[2]).has_value();
  }

  /// Fills the hole that the triangles are in.
  FillResult fill(const std::vector<std::uint32_t>& seeds) {
    const std::set<std::uint32_t> hole = grown(seeds);
    if (hole.empty()) return {};
    std::vector<std::array<VertexId, 3>> wanted;
    std::size_t missing = 0;
    for (std::uint32_t i : hole) {
      wanted.push_back(sheets_.all()[i].vertices);
      missing += present(i) ? 0U : 1U;
    }
    const RefillResult done = refill(tets_, wanted, options_);
    return done.done ? FillResult{missing, done.points} : FillResult{};
  }

 private:
  /// Empty if the hole gets too large.
  std::set<std::uint32_t> grown(const std::vector<std::uint32_t>& seeds) {
    std::set<std::uint32_t> hole(seeds.begin(), seeds.end());
    std::vector<std::uint32_t> queue(hole.begin(), hole.end());
    for (std::size_t q = 0; q < queue.size(); ++q) {
      if (hole.size() > kMostTriangles) return {};
      const auto v = sheets_.all()[queue[q]].vertices;
      for (std::size_t k = 0; k < 3; ++k) {
        if (tets_.find_edge(v[k], v[(k + 1) % 3])) continue;
        for (std::uint32_t n : sheets_.at(v[k], v[(k + 1) % 3]))
          if (hole.insert(n).second) queue.push_back(n);
      }
    }
    return hole;
  }

  Tetrahedralization& tets_;
  Sheets& sheets_;
  RefillOptions options_;
};

}  // namespace

FillResult fill_holes(Conjoint& conjoint, FaceId face, bool with_points) {
  Sheets sheets(conjoint);
  sheets.add(face);
  TemporaryLocks locks(*conjoint.tets(), face);
  for (const SurfaceTriangle& t : sheets.all()) locks.add(t);
  HoleFiller filler(conjoint, sheets, with_points);
  FillResult result;
  for (std::uint32_t i = 0, n = static_cast<std::uint32_t>(sheets.all().size()); i < n; ++i) {
    if (filler.present(i)) continue;
    const FillResult filled = filler.fill({i});
    result.recovered += filled.recovered;
    result.points += filled.points;
  }
  return result;
}

FillResult fill_around_segment(Conjoint& conjoint, const Conjoint::Segment& segment) {
  Sheets sheets(conjoint);
  const std::vector<std::uint32_t> seeds = sheets.at(segment.a, segment.b);
  const FillResult without = HoleFiller(conjoint, sheets, false).fill(seeds);
  return without.recovered > 0 ? without : HoleFiller(conjoint, sheets, true).fill(seeds);
}

void own_points(Conjoint& conjoint) {
  VertexStore& vertices = conjoint.vertices();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const VertexId v(i);
    if (vertices.origin(v) != Origin::steiner || !conjoint.tets()->contains(v)) continue;
    const std::uint32_t region = conjoint.tets()->complex().region(conjoint.tets()->tet_of(v));
    if (region > 0) vertices.set_owner(v, Owner::of(SolidId(region - 1)));
  }
}

}  // namespace curvetet
