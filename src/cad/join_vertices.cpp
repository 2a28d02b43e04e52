// Edges shorter than their ends are exact come from modelling operations and from sewing. Meshed as they are they ask
// for elements of their own size, and the faces around them overlap by more than their length, so that facets fold.
// Growing groups over chains of such edges without a bound was rejected: a fine polyline with generous tolerances
// would vanish.
#include "cad/join_vertices.h"

#include <BRep_Tool.hxx>
#include <Geom_Curve.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <gp_Pnt.hxx>
#include <numeric>

#include "cad/body.h"

namespace curvetet {
namespace {

constexpr int kSamples = 16;
constexpr double kMeant = 40;  ///< length over tolerance of a curve that is there for its own sake
// Parts of the diagonal.
constexpr double kLargest = 1e-4;   ///< vertices farther apart are never joined, whatever their tolerances say
constexpr double kOnePlace = 1e-8;  ///< of two vertices that no edge connects; far below the hair of touching_edges.h

class Joiner {
 public:
  Joiner(const TopTools_IndexedMapOfShape& vertices, const TopTools_IndexedMapOfShape& edges, double diagonal)
      : vertices_(vertices), edges_(edges), diagonal_(diagonal), largest_(kLargest * diagonal) {}

  JoinedVertices run(const std::vector<char>& asked, const TopTools_IndexedMapOfShape& solids) {
    const auto count = static_cast<std::size_t>(vertices_.Extent()) + 1;
    joined_.vertex.resize(count);
    std::iota(joined_.vertex.begin(), joined_.vertex.end(), 0);
    joined_.tolerance.resize(count, 0);
    members_.resize(count);
    for (int v = 1; v <= vertices_.Extent(); ++v) {
      joined_.tolerance[static_cast<std::size_t>(v)] = BRep_Tool::Tolerance(vertex(v));
      members_[static_cast<std::size_t>(v)] = {v};
    }
    joined_.point.assign(static_cast<std::size_t>(edges_.Extent()) + 1, 0);
    join_asked(asked);
    for (int e = 1; e <= edges_.Extent(); ++e) visit(e);
    for (int s = 1; s <= solids.Extent(); ++s) join_in_place(solids(s));
    return std::move(joined_);
  }

 private:
  const TopoDS_Vertex& vertex(int number) const { return TopoDS::Vertex(vertices_(number)); }
  gp_Pnt place(int number) const { return BRep_Tool::Pnt(vertex(number)); }

  /// Numbers of the vertices at both ends, 0 where there is none.
  std::pair<int, int> ends_of(int edge) const {
    TopoDS_Vertex start, end;
    TopExp::Vertices(TopoDS::Edge(edges_(edge)), start, end);
    return {start.IsNull() ? 0 : vertices_.FindIndex(start), end.IsNull() ? 0 : vertices_.FindIndex(end)};
  }

  void join_asked(const std::vector<char>& asked) {
    if (asked.empty()) return;
    std::vector<int> uses(members_.size(), 0);
    for (int e = 1; e <= edges_.Extent(); ++e) {
      const auto [a, b] = ends_of(e);
      ++uses[static_cast<std::size_t>(a)];
      if (b != a) ++uses[static_cast<std::size_t>(b)];
    }
    for (int e = 1; e <= edges_.Extent(); ++e) {
      if (asked[static_cast<std::size_t>(e)] == 0) continue;
      const auto [a, b] = ends_of(e);
      if (a == 0 || b == 0) continue;
      joined_.point[static_cast<std::size_t>(e)] = 1;
      const std::vector<int> all = members_of(a, b);
      stand_for(all, *std::max_element(all.begin(), all.end(), [&](int v, int w) {
                  return uses[static_cast<std::size_t>(v)] < uses[static_cast<std::size_t>(w)];
                }));
    }
  }

  void visit(int number) {
    const TopoDS_Edge& edge = TopoDS::Edge(edges_(number));
    const auto [a, b] = ends_of(number);
    if (a == 0 || b == 0 || joined_.point[static_cast<std::size_t>(number)] != 0) return;
    Standard_Real low = 0, high = 0;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, low, high);
    const bool degenerate = BRep_Tool::Degenerated(edge) || curve.IsNull();
    if (!degenerate &&
        (is_meant(*curve, low, high, BRep_Tool::Tolerance(edge)) || !lies_at(*curve, low, high, vertex(a), vertex(b))))
      return;
    if (join(a, b) && !degenerate) joined_.point[static_cast<std::size_t>(number)] = 1;
  }

  /// A curve far longer than its own tolerance is a detail of the body, however generous its ends are.
  static bool is_meant(const Geom_Curve& curve, double low, double high, double tolerance) {
    double length = 0;
    gp_Pnt previous = curve.Value(low);
    for (int i = 1; i <= kSamples; ++i) {
      const gp_Pnt next = curve.Value(low + (high - low) * i / kSamples);
      length += previous.Distance(next);
      previous = next;
    }
    return length > kMeant * tolerance;
  }

  /// Whether a curve stays within the tolerance of one of its ends.
  bool lies_at(const Geom_Curve& curve, double low, double high, const TopoDS_Vertex& start,
               const TopoDS_Vertex& end) const {
    const bool first = BRep_Tool::Tolerance(start) >= BRep_Tool::Tolerance(end);
    const gp_Pnt centre = BRep_Tool::Pnt(first ? start : end);
    const double radius = std::min(BRep_Tool::Tolerance(first ? start : end), largest_);
    for (int i = 0; i <= kSamples; ++i) {
      if (!(curve.Value(low + (high - low) * i / kSamples).Distance(centre) <= radius)) return false;
    }
    return true;
  }

  /// Where a solid touches itself its edges pair up only if their ends are the same (see touching_edges.h). Candidates
  /// are near each other along a slanted line, across which no plane of a usual body lies.
  void join_in_place(const TopoDS_Shape& solid) {
    std::vector<std::pair<double, int>> along;
    const gp_XYZ slanted = gp_XYZ(0.36, 0.48, 0.8);
    const TopTools_IndexedMapOfShape own = sub_shapes(solid, TopAbs_VERTEX);
    along.reserve(static_cast<std::size_t>(own.Extent()));
    for (int v = 1; v <= own.Extent(); ++v) {
      const int number = vertices_.FindIndex(own(v));
      along.emplace_back(place(number).XYZ() * slanted, number);
    }
    std::sort(along.begin(), along.end());
    const double near = kOnePlace * diagonal_;
    for (std::size_t i = 0; i < along.size(); ++i)
      for (std::size_t k = i + 1; k < along.size() && along[k].first - along[i].first <= near; ++k)
        if (place(along[i].second).Distance(place(along[k].second)) <= near) join(along[i].second, along[k].second);
  }

  /// Makes one group of those of a and b, unless that would take a vertex farther than its own tolerance.
  bool join(int a, int b) {
    if (joined_.vertex[static_cast<std::size_t>(a)] == joined_.vertex[static_cast<std::size_t>(b)]) return true;
    const std::vector<int> all = members_of(a, b);
    const int tightest = *std::min_element(all.begin(), all.end(), [&](int v, int w) {
      return BRep_Tool::Tolerance(vertex(v)) < BRep_Tool::Tolerance(vertex(w));
    });
    for (const int v : all) {
      const double away = place(v).Distance(place(tightest));
      if (!(away <= std::min(BRep_Tool::Tolerance(vertex(v)), largest_))) return false;
    }
    stand_for(all, tightest);
    return true;
  }

  /// Of the groups of a and b together, ascending.
  std::vector<int> members_of(int a, int b) const {
    const int root_a = joined_.vertex[static_cast<std::size_t>(a)],
              root_b = joined_.vertex[static_cast<std::size_t>(b)];
    std::vector<int> all = members_[static_cast<std::size_t>(root_a)];
    if (root_a == root_b) return all;
    const std::vector<int>& others = members_[static_cast<std::size_t>(root_b)];
    all.insert(all.end(), others.begin(), others.end());
    std::sort(all.begin(), all.end());
    return all;
  }

  void stand_for(const std::vector<int>& all, int one) {
    double tolerance = 0;
    for (const int v : all) {
      tolerance = std::max(tolerance, BRep_Tool::Tolerance(vertex(v)) + place(v).Distance(place(one)));
      joined_.vertex[static_cast<std::size_t>(v)] = one;
    }
    joined_.tolerance[static_cast<std::size_t>(one)] = tolerance;
    members_[static_cast<std::size_t>(one)] = all;
  }

  const TopTools_IndexedMapOfShape& vertices_;
  const TopTools_IndexedMapOfShape& edges_;
  double diagonal_, largest_;
  JoinedVertices joined_;
  std::vector<std::vector<int>> members_;  ///< of the group that a vertex stands for
};

}  // namespace

JoinedVertices join_vertices(const TopTools_IndexedMapOfShape& vertices, const TopTools_IndexedMapOfShape& edges,
                             const TopTools_IndexedMapOfShape& solids, double diagonal,
                             const std::vector<char>& asked) {
  return Joiner(vertices, edges, diagonal).run(asked, solids);
}

}  // namespace curvetet
