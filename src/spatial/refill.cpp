// The tets that the wanted triangles cross form a region. Its boundary, the wanted triangles and the locked facets
// inside of it are sheets that cut it into cells. Each side of a sheet belongs to one cell: from side to side one gets
// over an edge by turning into the cell until the next sheet, in an exact order around the edge. So slits, sheets that
// meet three at an edge and cells that touch need no special case.
//
// Rejected: points on the wanted triangles, taken off them afterwards (George, Borouchaki and Saltel, "Ultimate
// robustness in meshing an arbitrary polyhedron", 2003). It never fails, but it leaves several points for each tet that
// is crossed, and the few holes that come here are small.
#include "spatial/refill.h"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "base/disjoint_sets.h"
#include "predicates/predicates.h"
#include "spatial/fill_cell.h"
#include "spatial/flips_exchange.h"

namespace curvetet {

namespace {

using Triple = std::array<VertexId, 3>;
using Pair = std::array<VertexId, 2>;

Triple sorted(Triple t) {
  std::sort(t.begin(), t.end());
  return t;
}
Pair sorted(VertexId a, VertexId b) { return a < b ? Pair{a, b} : Pair{b, a}; }
bool has(const Triple& t, VertexId v) { return t[0] == v || t[1] == v || t[2] == v; }

/// Tets taken in beyond those that are crossed, where a cell cannot be filled.
constexpr int kMostGrowths = 12;

/// Which tets the wanted triangles cross. May take in a tet that is only touched.
class CrossedTets {
 public:
  CrossedTets(const Tetrahedralization& mesh, std::span<const Triple> triangles) : mesh_(mesh), triangles_(triangles) {
    for (const Triple& t : triangles)
      for (std::size_t k = 0; k < 3; ++k)
        if (!mesh.find_edge(t[k], t[(k + 1) % 3])) missing_edges_.insert(sorted(t[k], t[(k + 1) % 3]));
  }

  /// Sorted; stops once there are more than `most`.
  std::vector<TetId> run(std::size_t most) {
    std::vector<TetId> queue, crossed, star;
    std::set<TetId> seen;
    const auto visit = [&](TetId t) {
      if (!mesh_.complex().is_ghost(t) && seen.insert(t).second) queue.push_back(t);
    };
    for (const Triple& w : triangles_) {
      for (VertexId v : w) {
        mesh_.star(v, star);
        for (TetId t : star) visit(t);
      }
    }
    for (std::size_t i = 0; i < queue.size() && crossed.size() <= most; ++i) {
      if (!is_crossed(queue[i])) continue;
      crossed.push_back(queue[i]);
      for (TetId n : mesh_.complex().neighbours(crossed.back())) visit(n);
    }
    std::sort(crossed.begin(), crossed.end());
    return crossed;
  }

 private:
  Vec3 at(VertexId v) const { return mesh_.position(v); }

  bool is_crossed(TetId t) const {
    const TetComplex& complex = mesh_.complex();
    for (const auto& [i, j] : kEdge)
      if (edge_crosses(complex.vertex(t, i), complex.vertex(t, j))) return true;
    for (int i = 0; i < 4; ++i)
      if (facet_is_crossed(complex.facet_vertices({t, i}))) return true;
    return false;
  }

  bool edge_crosses(VertexId u, VertexId v) const {
    for (const Triple& w : triangles_) {
      if (has(w, u) || has(w, v)) continue;
      if (segment_triangle(at(u), at(v), at(w[0]), at(w[1]), at(w[2])) == SegmentTriangle::crosses) return true;
    }
    for (const auto& [a, b] : missing_edges_) {
      if (u == a || u == b || v == a || v == b) continue;
      if (segments_cross(at(u), at(v), at(a), at(b))) return true;
    }
    return false;
  }

  bool facet_is_crossed(const Triple& f) const {
    for (const auto& [a, b] : missing_edges_) {
      if (has(f, a) || has(f, b)) continue;
      if (segment_triangle(at(a), at(b), at(f[0]), at(f[1]), at(f[2])) == SegmentTriangle::crosses) return true;
    }
    return false;
  }

  const Tetrahedralization& mesh_;
  std::span<const Triple> triangles_;
  std::set<Pair> missing_edges_;
};

class Refill {
 public:
  Refill(Tetrahedralization& mesh, std::span<const Triple> triangles, const RefillOptions& options)
      : mesh_(mesh), complex_(mesh.complex()), triangles_(triangles), options_(options) {}

  RefillResult run() {
    region_ = CrossedTets(mesh_, triangles_).run(options_.most_tets);
    RefillResult result;
    for (int growth = 0; growth <= kMostGrowths; ++growth) {
      if (region_.empty() || region_.size() > options_.most_tets || !one_region()) return {};
      collect_sheets();
      if (loses_something() || !form_cells()) return {};
      const std::vector<CellSide> stuck = fill(result.points);
      if (stuck.empty()) break;
      const bool grown = growth < kMostGrowths &&
                         std::any_of(stuck.begin(), stuck.end(), [&](const CellSide& side) { return grow(side); });
      if (!grown) return {};
    }
    flips::commit_many(mesh_, region_, new_tets_);
    result.done = true;
    return result;
  }

 private:
  Vec3 at(VertexId v) const { return mesh_.position(v); }
  bool in_region(TetId t) const { return std::binary_search(region_.begin(), region_.end(), t); }

  bool one_region() const {
    return std::all_of(region_.begin(), region_.end(),
                       [&](TetId t) { return complex_.region(t) == complex_.region(region_.front()); });
  }

  /// Takes in the tet beyond a side that no tet fits on; false where that is not allowed.
  bool grow(const CellSide& side) {
    const auto found = outside_.find(sorted(side));
    if (found == outside_.end() || found->second.locked) return false;
    const TetId t = found->second.tet;
    if (complex_.is_ghost(t)) return false;
    region_.insert(std::lower_bound(region_.begin(), region_.end(), t), t);
    return true;
  }

  void collect_sheets() {
    sides_.clear();
    outside_.clear();
    cells_.clear();
    std::set<Triple> inner;
    for (const Triple& w : triangles_) inner.insert(sorted(w));
    for (TetId t : region_) {
      for (int i = 0; i < 4; ++i) {
        const TetFacet f{t, i};
        const Triple v = complex_.facet_vertices(f);
        if (in_region(complex_.neighbour(t, i))) {
          if (complex_.is_locked(f)) inner.insert(sorted(v));
          continue;
        }
        outside_[sorted(v)] = {complex_.neighbour(t, i), complex_.is_locked(f)};
        sides_.push_back(v);
      }
    }
    for (const Triple& w : inner) {
      if (outside_.contains(w)) continue;
      sides_.push_back(w);
      sides_.push_back({w[1], w[0], w[2]});
    }
  }

  /// A vertex or a kept segment that is on no sheet would vanish with the region.
  bool loses_something() const {
    std::set<VertexId> vertices;
    std::set<Pair> edges;
    for (const CellSide& s : sides_) {
      for (std::size_t k = 0; k < 3; ++k) {
        vertices.insert(s[k]);
        edges.insert(sorted(s[k], s[(k + 1) % 3]));
      }
    }
    for (TetId t : region_) {
      for (VertexId v : complex_.vertices(t))
        if (!vertices.contains(v)) return true;
      for (const auto& [i, j] : kEdge) {
        const VertexId a = complex_.vertex(t, i), b = complex_.vertex(t, j);
        if (mesh_.is_kept(a, b) && !edges.contains(sorted(a, b))) return true;
      }
    }
    return false;
  }

  /// Sides that see each other over an edge are of one cell. False where sheets overlap.
  bool form_cells() {
    std::map<Pair, std::vector<std::uint32_t>> around;
    for (std::uint32_t s = 0; s < sides_.size(); ++s)
      for (std::size_t k = 0; k < 3; ++k) around[sorted(sides_[s][k], sides_[s][(k + 1) % 3])].push_back(s);
    DisjointSets sets(sides_.size());
    for (const auto& [edge, sides] : around) {
      for (std::uint32_t s : sides) {
        const auto next = next_side(s, edge, sides);
        if (!next) return false;
        sets.join(s, *next);
      }
    }
    std::map<std::uint32_t, std::vector<std::uint32_t>> by_root;
    for (std::uint32_t s = 0; s < sides_.size(); ++s) by_root[sets.root(s)].push_back(s);
    for (auto& [r, cell] : by_root) cells_.push_back(std::move(cell));
    return std::all_of(cells_.begin(), cells_.end(), [&](const auto& cell) { return is_surface(cell); });
  }

  VertexId apex(std::uint32_t s, const Pair& edge) const {
    for (VertexId v : sides_[s])
      if (v != edge[0] && v != edge[1]) return v;
    return {};
  }

  /// The side that one comes upon first when one turns around the edge from side s into its cell.
  std::optional<std::uint32_t> next_side(std::uint32_t s, const Pair& edge,
                                         const std::vector<std::uint32_t>& sides) const {
    const Triple& t = sides_[s];
    const VertexId c = apex(s, edge);
    VertexId a = edge[0], b = edge[1];
    for (std::size_t k = 0; k < 3; ++k)
      if (t[k] == b && t[(k + 1) % 3] == a) std::swap(a, b);
    std::optional<VertexId> first;
    for (std::uint32_t other : sides) {
      const VertexId x = apex(other, edge);
      if (x == c || x == first) continue;
      if (half_turn(a, b, c, x) == 0) return std::nullopt;
      if (!first || before(a, b, c, x, *first)) first = x;
    }
    const VertexId end = first.value_or(c);
    for (std::uint32_t other : sides)
      if (apex(other, edge) == end && faces(sides_[other], b, a)) return other;
    return std::nullopt;
  }

  static bool faces(const Triple& t, VertexId from, VertexId to) {
    for (std::size_t k = 0; k < 3; ++k)
      if (t[k] == from && t[(k + 1) % 3] == to) return true;
    return false;
  }

  /// Of the angle around ab from c to x: 1 below half a turn, 2 half a turn, 3 above, 0 none at all.
  int half_turn(VertexId a, VertexId b, VertexId c, VertexId x) const {
    const int side = orient3d(at(a), at(b), at(c), at(x));
    if (side != 0) return side > 0 ? 1 : 3;
    for (int axis = 0; axis < 3; ++axis) {
      const int s = orient2d_dropped(at(a), at(b), at(c), axis) * orient2d_dropped(at(a), at(b), at(x), axis);
      if (s != 0) return s < 0 ? 2 : 0;
    }
    return 0;
  }

  bool before(VertexId a, VertexId b, VertexId c, VertexId x, VertexId y) const {
    const int hx = half_turn(a, b, c, x), hy = half_turn(a, b, c, y);
    return hx != hy ? hx < hy : orient3d(at(a), at(b), at(x), at(y)) > 0;
  }

  /// Each edge in two sides: what a star needs to be glued.
  bool is_surface(const std::vector<std::uint32_t>& cell) const {
    std::map<Pair, int> count;
    for (std::uint32_t s : cell)
      for (std::size_t k = 0; k < 3; ++k) ++count[sorted(sides_[s][k], sides_[s][(k + 1) % 3])];
    return std::all_of(count.begin(), count.end(), [](const auto& entry) { return entry.second == 2; });
  }

  /// Nothing once all cells are filled; else the sides of one that could not be, the worst first.
  std::vector<CellSide> fill(std::size_t& points) {
    new_tets_.clear();
    points = 0;
    for (const std::vector<std::uint32_t>& cell : cells_) {
      std::vector<CellSide> sides;
      sides.reserve(cell.size());
      for (std::uint32_t s : cell) sides.push_back(sides_[s]);
      CellFill filled = fill_cell(mesh_.vertices(), sides, options_.add_vertex);
      if (filled.tets.empty()) return std::move(filled.stuck);
      points += filled.points;
      new_tets_.insert(new_tets_.end(), filled.tets.begin(), filled.tets.end());
    }
    return {};
  }

  struct Outside {
    TetId tet;
    bool locked = false;
  };

  Tetrahedralization& mesh_;
  TetComplex& complex_;
  std::span<const Triple> triangles_;
  const RefillOptions& options_;
  std::vector<TetId> region_;
  std::vector<CellSide> sides_;
  std::map<Triple, Outside> outside_;  ///< beyond the region's boundary
  std::vector<std::vector<std::uint32_t>> cells_;
  std::vector<TetComplex::Vertices> new_tets_;
};

}  // namespace

RefillResult refill(Tetrahedralization& mesh, std::span<const std::array<VertexId, 3>> triangles,
                    const RefillOptions& options) {
  return Refill(mesh, triangles, options).run();
}

}  // namespace curvetet
