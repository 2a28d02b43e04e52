// A hole is grown over missing edges until all edges of its border exist: only then is it clear what lies on which side
// of it.
#include "boundary/fill_holes.h"

#include <algorithm>
#include <map>
#include <set>

#include "boundary/surface_triangles.h"
#include "geometry/frame.h"
#include "spatial/refill.h"

namespace curvetet {

namespace {

/// Triangles of one hole: a larger one is not a matter of reconnecting what is there.
constexpr std::size_t kMostTriangles = 60;

/// Surface triangles by their edges.
class Sheets {
 public:
  explicit Sheets(std::vector<SurfaceTriangle> triangles) : triangles_(std::move(triangles)) {
    for (std::uint32_t i = 0; i < triangles_.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) at_edge_[key(i, k)].push_back(i);
  }
  std::uint64_t key(std::uint32_t i, std::size_t k) const {
    return edge_key(triangles_[i].vertices[k], triangles_[i].vertices[(k + 1) % 3]);
  }
  const std::vector<std::uint32_t>& at(std::uint64_t edge) const {
    const auto found = at_edge_.find(edge);
    return found == at_edge_.end() ? none_ : found->second;
  }
  const SurfaceTriangle& operator[](std::uint32_t i) const { return triangles_[i]; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(triangles_.size()); }

 private:
  std::vector<SurfaceTriangle> triangles_;
  std::map<std::uint64_t, std::vector<std::uint32_t>> at_edge_;
  std::vector<std::uint32_t> none_;
};

class HoleFiller {
 public:
  HoleFiller(Conjoint& conjoint, const Sheets& sheets) : tets_(*conjoint.tets()), sheets_(sheets) {
    options_.add_vertex = [&conjoint](Vec3 p) {
      return conjoint.vertices().add(snap(p), Owner::of(SolidId(0)), {}, Origin::steiner);
    };
  }

  bool present(std::uint32_t i) const {
    const auto& v = sheets_[i].vertices;
    return tets_.find_facet(v[0], v[1], v[2]).has_value();
  }

  /// Fills the hole that the triangles are in, first without points.
  FillResult fill(const std::vector<std::uint32_t>& seeds, bool with_points) {
    const std::set<std::uint32_t> hole = grown(seeds);
    if (hole.empty()) return {};
    std::vector<std::array<VertexId, 3>> wanted;
    std::size_t missing = 0;
    for (std::uint32_t i : hole) {
      wanted.push_back(sheets_[i].vertices);
      missing += present(i) ? 0U : 1U;
    }
    RefillOptions options;
    RefillResult done = refill(tets_, wanted, options);
    if (!done.done && with_points) done = refill(tets_, wanted, options_);
    return done.done ? FillResult{missing, done.points} : FillResult{};
  }

 private:
  /// Empty if the hole gets too large.
  std::set<std::uint32_t> grown(const std::vector<std::uint32_t>& seeds) const {
    std::set<std::uint32_t> hole(seeds.begin(), seeds.end());
    std::vector<std::uint32_t> queue(hole.begin(), hole.end());
    for (std::size_t q = 0; q < queue.size(); ++q) {
      if (hole.size() > kMostTriangles) return {};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& v = sheets_[queue[q]].vertices;
        if (tets_.find_edge(v[k], v[(k + 1) % 3])) continue;
        for (std::uint32_t n : sheets_.at(sheets_.key(queue[q], k)))
          if (hole.insert(n).second) queue.push_back(n);
      }
    }
    return hole;
  }

  Tetrahedralization& tets_;
  const Sheets& sheets_;
  RefillOptions options_;
};

/// Locks the facets of a face that are not locked yet, for as long as it lives.
class Protection {
 public:
  Protection(Tetrahedralization& tets, FaceId face, const Sheets& sheets) : tets_(tets) {
    for (std::uint32_t i = 0; i < sheets.size(); ++i) {
      const auto& v = sheets[i].vertices;
      const auto facet = tets.find_facet(v[0], v[1], v[2]);
      if (!facet || tets.complex().is_locked(*facet)) continue;
      tets.lock(*facet, face);
      locked_.push_back(v);
    }
  }
  ~Protection() {
    for (const auto& v : locked_)
      if (const auto facet = tets_.find_facet(v[0], v[1], v[2])) tets_.complex().unlock(*facet);
  }
  Protection(const Protection&) = delete;
  Protection& operator=(const Protection&) = delete;

 private:
  Tetrahedralization& tets_;
  std::vector<std::array<VertexId, 3>> locked_;
};

}  // namespace

FillResult fill_holes(Conjoint& conjoint, FaceId face, bool with_points) {
  const Sheets sheets(surface_triangles(conjoint.boundary().faces[face], face));
  const Protection protection(*conjoint.tets(), face, sheets);
  HoleFiller filler(conjoint, sheets);
  FillResult result;
  for (std::uint32_t i = 0; i < sheets.size(); ++i) {
    if (filler.present(i)) continue;
    const FillResult filled = filler.fill({i}, with_points);
    result.recovered += filled.recovered;
    result.points += filled.points;
  }
  return result;
}

FillResult fill_around_segment(Conjoint& conjoint, const Conjoint::Segment& segment, bool with_points) {
  const Sheets sheets(surface_triangles(conjoint.boundary()));
  return HoleFiller(conjoint, sheets).fill(sheets.at(edge_key(segment.a, segment.b)), with_points);
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
