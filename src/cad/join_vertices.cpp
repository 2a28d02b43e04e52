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

namespace curvetet {
namespace {

constexpr int kSamples = 16;
constexpr double kMeant = 40;  ///< length over tolerance of a curve that is there for its own sake

class Joiner {
 public:
  Joiner(const TopTools_IndexedMapOfShape& vertices, const TopTools_IndexedMapOfShape& edges, double largest)
      : vertices_(vertices), edges_(edges), largest_(largest) {}

  JoinedVertices run() {
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
    for (int e = 1; e <= edges_.Extent(); ++e) visit(e);
    return std::move(joined_);
  }

 private:
  const TopoDS_Vertex& vertex(int number) const { return TopoDS::Vertex(vertices_(number)); }
  gp_Pnt place(int number) const { return BRep_Tool::Pnt(vertex(number)); }

  void visit(int number) {
    const TopoDS_Edge& edge = TopoDS::Edge(edges_(number));
    TopoDS_Vertex start, end;
    TopExp::Vertices(edge, start, end);
    if (start.IsNull() || end.IsNull()) return;
    const int a = vertices_.FindIndex(start), b = vertices_.FindIndex(end);
    if (a == 0 || b == 0) return;
    Standard_Real low = 0, high = 0;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, low, high);
    const bool degenerate = BRep_Tool::Degenerated(edge) || curve.IsNull();
    if (!degenerate &&
        (is_meant(*curve, low, high, BRep_Tool::Tolerance(edge)) || !lies_at(*curve, low, high, start, end)))
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

  /// Makes one group of those of a and b, unless that would take a vertex farther than its own tolerance.
  bool join(int a, int b) {
    const int root_a = joined_.vertex[static_cast<std::size_t>(a)],
              root_b = joined_.vertex[static_cast<std::size_t>(b)];
    if (root_a == root_b) return true;
    std::vector<int> all = members_[static_cast<std::size_t>(root_a)];
    const std::vector<int>& others = members_[static_cast<std::size_t>(root_b)];
    all.insert(all.end(), others.begin(), others.end());
    std::sort(all.begin(), all.end());
    const int tightest = *std::min_element(all.begin(), all.end(), [&](int v, int w) {
      return BRep_Tool::Tolerance(vertex(v)) < BRep_Tool::Tolerance(vertex(w));
    });
    double tolerance = 0;
    for (const int v : all) {
      const double own = BRep_Tool::Tolerance(vertex(v)), away = place(v).Distance(place(tightest));
      if (!(away <= std::min(own, largest_))) return false;
      tolerance = std::max(tolerance, own + away);
    }
    for (const int v : all) joined_.vertex[static_cast<std::size_t>(v)] = tightest;
    joined_.tolerance[static_cast<std::size_t>(tightest)] = tolerance;
    members_[static_cast<std::size_t>(tightest)] = std::move(all);
    return true;
  }

  const TopTools_IndexedMapOfShape& vertices_;
  const TopTools_IndexedMapOfShape& edges_;
  double largest_;
  JoinedVertices joined_;
  std::vector<std::vector<int>> members_;  ///< of the group that a vertex stands for
};

}  // namespace

JoinedVertices join_vertices(const TopTools_IndexedMapOfShape& vertices, const TopTools_IndexedMapOfShape& edges,
                             double largest) {
  return Joiner(vertices, edges, largest).run();
}

}  // namespace curvetet
