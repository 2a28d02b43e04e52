// First the star of one of the cell's vertices, of those that see all of it the one whose worst tet is best. Most small
// cells have one. Then a search: a tet is put on the side that the fewest vertices see, on one of them after the other,
// so that it crosses no side; the sides it leaves are filled in the same way (the idea of small polyhedron
// reconnection; Liu, Chen and Sun, 2006, without their aim at the best quality). At last both with a point in the
// middle, or as near to it as the cell's planes allow.
#include "spatial/fill_cell.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "predicates/predicates.h"
#include "spatial/flips_exchange.h"
#include "spatial/triangles_cross.h"

namespace curvetet {

namespace {

using Tets = std::vector<TetComplex::Vertices>;

/// Tets put on trial in one search.
constexpr int kTrials = 4000;
/// Sides from which a search is not tried: it would not end within its trials.
constexpr std::size_t kMostSides = 48;
/// Steps towards the kernel of a cell; it is found in a few tens where there is one worth having.
constexpr int kKernelSteps = 400;
/// Height of a new point before a side over the square root of twice its area, from and to.
constexpr double kHighest = 0.25, kLowest = 1e-4;
/// New points in one cell.
constexpr std::size_t kMostPoints = 4;
/// Least distance of a new point to the planes of its cell over the cell's size.
constexpr double kKernelDepth = 1e-3;

bool has(const CellSide& t, VertexId v) { return t[0] == v || t[1] == v || t[2] == v; }
CellSide sorted(CellSide t) {
  std::sort(t.begin(), t.end());
  return t;
}

class Cell {
  struct Search {
    std::map<CellSide, CellSide> open;  ///< by sorted vertices
    Tets tets;
    std::vector<VertexId> corners;
    int trials;
  };

 public:
  Cell(const VertexStore& vertices, const std::vector<CellSide>& sides) : store_(vertices), sides_(sides) {
    for (const CellSide& s : sides) corners_.insert(corners_.end(), s.begin(), s.end());
    std::sort(corners_.begin(), corners_.end());
    corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
  }

  std::optional<Tets> star() const {
    VertexId best;
    double best_worst = 0;
    for (VertexId v : corners_) {
      const double worst = worst_of_star(v);
      if (worst > best_worst) {
        best_worst = worst;
        best = v;
      }
    }
    if (!best.valid()) return std::nullopt;
    return star_of(best);
  }

  std::optional<Tets> star(VertexId v) const {
    if (worst_of_star(v) <= 0) return std::nullopt;
    return star_of(v);
  }

  /// A search, with more vertices if there are any.
  std::optional<Tets> search(const std::vector<VertexId>& more = {}) {
    if (sides_.size() > kMostSides) return std::nullopt;
    dead_ends_.clear();
    Search search = start();
    search.corners.insert(search.corners.end(), more.begin(), more.end());
    if (search.open.size() != sides_.size() || !solve(search)) return std::nullopt;
    return search.tets;
  }

  /// A point before the side that is stuck most often and has no such point yet, so near to it that their tet fits.
  VertexId point_before_stuck(const std::function<VertexId(Vec3)>& add_vertex) {
    const Search empty = start();
    for (const CellSide& s : stuck()) {
      if (std::find(served_.begin(), served_.end(), s) != served_.end()) continue;
      served_.push_back(s);
      const Vec3 normal = cross(at(s[1]) - at(s[0]), at(s[2]) - at(s[0]));
      const Vec3 middle = (1.0 / 3) * (at(s[0]) + at(s[1]) + at(s[2]));
      for (double height = kHighest; height >= kLowest; height *= 0.25) {
        const VertexId v = add_vertex(middle + (height / std::sqrt(norm(normal))) * normal);
        if (side_of(s, v) > 0 && fits(empty, s, v)) return v;
      }
    }
    return {};
  }

  /// All sides, first those that were dead ends of the last search most often.
  std::vector<CellSide> stuck() const {
    std::vector<CellSide> order = sides_;
    const auto count = [&](const CellSide& s) {
      const auto found = dead_ends_.find(s);
      return found == dead_ends_.end() ? 0 : found->second;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](const CellSide& a, const CellSide& b) { return count(a) > count(b); });
    return order;
  }

  /// From the middle over and over off the plane that the point is least within of, first with a wide margin. Within
  /// all of them, or nearest to that.
  Vec3 middle() const {
    Vec3 middle{};
    for (VertexId v : corners_) middle = middle + (1.0 / static_cast<double>(corners_.size())) * at(v);
    double size = 0;
    for (VertexId v : corners_) size = std::max(size, distance(at(v), middle));
    std::vector<Plane> planes;
    for (const CellSide& t : sides_)
      planes.push_back({normalized(cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]))), at(t[0])});
    Vec3 best = middle;
    double deepest = -std::numeric_limits<double>::infinity();
    for (double margin = 0.2 * size; margin > kKernelDepth * size; margin *= 0.5) {
      Vec3 x = middle;
      for (int step = 0; step < kKernelSteps; ++step) {
        const auto depth = [&](const Plane& p) { return dot(p.normal, x - p.point); };
        const auto least = std::min_element(planes.begin(), planes.end(),
                                            [&](const Plane& p, const Plane& q) { return depth(p) < depth(q); });
        if (depth(*least) >= 0.5 * margin) return x;
        if (depth(*least) > deepest) {
          deepest = depth(*least);
          best = x;
        }
        x = x + (margin - depth(*least)) * least->normal;
      }
    }
    return best;
  }

 private:
  Search start() const {
    Search search{{}, {}, corners_, kTrials};
    for (const CellSide& s : sides_) search.open.emplace(sorted(s), s);
    return search;
  }

  struct Plane {
    Vec3 normal, point;
  };
  Vec3 at(VertexId v) const { return store_.position(v); }
  int side_of(const CellSide& t, VertexId v) const { return orient3d(at(t[0]), at(t[1]), at(t[2]), at(v)); }

  double quality(const CellSide& t, VertexId v) const {
    return flips::volume_over_length(at(t[0]), at(t[1]), at(t[2]), at(v));
  }

  /// Not positive if one of the tets is not.
  double worst_of_star(VertexId v) const {
    double worst = std::numeric_limits<double>::infinity();
    for (const CellSide& t : sides_) {
      if (has(t, v)) continue;
      if (side_of(t, v) <= 0) return 0;
      worst = std::min(worst, quality(t, v));
    }
    return std::max(worst, std::numeric_limits<double>::min());
  }

  Tets star_of(VertexId v) const {
    Tets tets;
    for (const CellSide& t : sides_)
      if (!has(t, v)) tets.push_back({t[0], t[1], t[2], v});
    return tets;
  }

  bool solve(Search& search) {
    if (search.open.empty()) return true;
    const CellSide side = most_constrained(search);
    std::vector<std::pair<double, VertexId>> apexes;
    for (VertexId v : search.corners)
      if (!has(side, v) && side_of(side, v) > 0) apexes.emplace_back(-quality(side, v), v);
    std::sort(apexes.begin(), apexes.end());
    bool fitted = false;
    for (const auto& [order, v] : apexes) {
      if (--search.trials < 0) return false;
      if (!fits(search, side, v)) continue;
      const std::map<CellSide, CellSide> before = search.open;
      put(search, side, v);
      if (solve(search)) return true;
      search.open = before;
      search.tets.pop_back();
      fitted = true;
    }
    if (!fitted && std::find(sides_.begin(), sides_.end(), side) != sides_.end()) ++dead_ends_[side];
    return false;
  }

  /// The side with the fewest vertices before it.
  CellSide most_constrained(const Search& search) const {
    CellSide best{};
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    for (const auto& entry : search.open) {
      const CellSide& side = entry.second;
      const auto seen =
          static_cast<std::size_t>(std::count_if(search.corners.begin(), search.corners.end(),
                                                 [&](VertexId v) { return !has(side, v) && side_of(side, v) > 0; }));
      if (seen >= fewest) continue;
      fewest = seen;
      best = side;
    }
    return best;
  }

  /// The facets of the tet over a side, as sides of what is left beyond them.
  static std::array<CellSide, 3> beyond(const CellSide& s, VertexId v) {
    return {CellSide{s[0], s[1], v}, CellSide{s[1], s[2], v}, CellSide{s[2], s[0], v}};
  }

  static bool same_turn(const CellSide& a, const CellSide& b) {
    const auto at = std::find(b.begin(), b.end(), a[0]) - b.begin();
    return b[static_cast<std::size_t>((at + 1) % 3)] == a[1];
  }

  /// Whether the tet lies in what is left to fill.
  bool fits(const Search& search, const CellSide& side, VertexId v) const {
    for (VertexId w : search.corners)
      if (w != v && !has(side, w) && inside(side, v, w)) return false;
    for (const CellSide& facet : beyond(side, v)) {
      const auto found = search.open.find(sorted(facet));
      if (found != search.open.end()) {
        if (same_turn(facet, found->second)) return false;  // the side's cell is on the other side
        continue;
      }
      for (const auto& [key, other] : search.open)
        if (triangles_cross(store_, facet, other)) return false;
    }
    return true;
  }

  bool inside(const CellSide& side, VertexId v, VertexId w) const {
    if (side_of(side, w) < 0) return false;
    const auto facets = beyond(side, v);
    return std::all_of(facets.begin(), facets.end(), [&](const CellSide& f) { return side_of(f, w) <= 0; });
  }

  static void put(Search& search, const CellSide& side, VertexId v) {
    search.open.erase(sorted(side));
    for (const CellSide& facet : beyond(side, v)) {
      const auto [at, made] = search.open.emplace(sorted(facet), facet);
      if (!made) search.open.erase(at);
    }
    search.tets.push_back({side[0], side[1], side[2], v});
  }

  const VertexStore& store_;
  const std::vector<CellSide>& sides_;
  std::vector<VertexId> corners_;
  std::map<CellSide, int> dead_ends_;  ///< of the last search
  std::vector<CellSide> served_;       ///< sides with a new point before them
};

/// How many of the points the tets have.
std::size_t used(const std::vector<VertexId>& points, const Tets& tets) {
  return static_cast<std::size_t>(std::count_if(points.begin(), points.end(), [&](VertexId v) {
    return std::any_of(tets.begin(), tets.end(),
                       [v](const auto& t) { return std::find(t.begin(), t.end(), v) != t.end(); });
  }));
}

}  // namespace

CellFill fill_cell(const VertexStore& vertices, const std::vector<CellSide>& sides,
                   const std::function<VertexId(Vec3)>& add_vertex) {
  Cell cell(vertices, sides);
  if (auto tets = cell.star()) return {std::move(*tets), 0, {}};
  if (auto tets = cell.search()) return {std::move(*tets), 0, {}};
  if (!add_vertex || sides.size() > kMostSides) return {{}, 0, cell.stuck()};
  std::vector<VertexId> points{add_vertex(cell.middle())};
  if (auto tets = cell.star(points.front())) return {std::move(*tets), 1, {}};
  while (true) {
    if (auto tets = cell.search(points)) return {*tets, used(points, *tets), {}};
    const VertexId more = points.size() < kMostPoints ? cell.point_before_stuck(add_vertex) : VertexId();
    if (!more.valid()) return {{}, 0, cell.stuck()};
    points.push_back(more);
  }
}

}  // namespace curvetet
