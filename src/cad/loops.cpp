// Wires are sets of oriented edges to us: their stored order is not trusted. Slits, and bridges between an outer loop
// and a hole, are taken out before the chains are traced; what remains falls apart into simple loops.
//
// Lifts: a chain is walked once, each use moved by whole periods so that it begins where the one before it ended. A
// face on a periodic surface whose loops do not close this way lacks its seam, which is a matter for healing.
#include "cad/loops.h"

#include <BRep_Tool.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cad/occt_geometry.h"
#include "geometry/analytic.h"

namespace curvetet {
namespace {

constexpr int kSamples = 16;

/// A use before it is lifted.
struct RawUse {
  EdgeUse use;
  Handle(Geom2d_Curve) curve;
  ParameterMap map;
  Vec2 begin, end, middle;  ///< in the direction of the loop
  CadVertexId from, to;
  bool point = false;  ///< an edge with a curve that is taken as a point
  Vec2 shift{};
};

class Tracer {
 public:
  Tracer(const TopoDS_Face& face, const LoopContext& context, ModelFace& out)
      : face_(TopoDS::Face(face.Oriented(TopAbs_FORWARD))), context_(context), out_(out) {
    period_ = {out.surface->period_u(), out.surface->period_v()};
  }

  int run() {
    for (TopoDS_Iterator wire(face_); wire.More(); wire.Next()) {
      if (wire.Value().ShapeType() != TopAbs_WIRE) continue;
      collect(wire.Value());
      measure();
      drop_points();
      take_slits();
      while (!uses_.empty()) trace_one();
    }
    align_loops();
    set_domain();
    return turned_;
  }

 private:
  void collect(const TopoDS_Shape& wire) {
    uses_.clear();
    for (TopoDS_Iterator it(wire); it.More(); it.Next()) {
      if (it.Value().ShapeType() != TopAbs_EDGE) continue;
      const TopoDS_Edge edge = TopoDS::Edge(it.Value());
      RawUse raw = make_use(edge);
      if (edge.Orientation() == TopAbs_INTERNAL || edge.Orientation() == TopAbs_EXTERNAL) {
        take_internal(raw);
      } else {
        uses_.push_back(std::move(raw));
      }
    }
  }

  RawUse make_use(const TopoDS_Edge& edge) {
    RawUse raw;
    raw.use.edge = context_.edge(edge);
    raw.use.reversed = edge.Orientation() == TopAbs_REVERSED;
    const ModelEdge& model_edge = context_.model->edges[raw.use.edge];
    raw.from = raw.use.reversed ? model_edge.end : model_edge.start;
    raw.to = raw.use.reversed ? model_edge.start : model_edge.end;
    Standard_Real first = 0, last = 0;
    raw.curve = BRep_Tool::CurveOnSurface(edge, face_, first, last);
    raw.point = model_edge.degenerate && (!BRep_Tool::Degenerated(edge) || first == last);
    if (raw.curve.IsNull()) return raw;
    const double length = model_edge.high - model_edge.low;
    if (std::abs(first - model_edge.low) + std::abs(last - model_edge.high) > 1e-12 * std::abs(length)) {
      raw.map.scale = (last - first) / length;
      raw.map.offset = first - raw.map.scale * model_edge.low;
    }
    raw.use.curve = evened(make_parameter_curve(raw.curve, raw.map), context_.model->edges[raw.use.edge].steps);
    const double middle = 0.5 * (model_edge.low + model_edge.high);
    raw.begin = raw.use.curve->value(raw.use.reversed ? model_edge.high : model_edge.low);
    raw.end = raw.use.curve->value(raw.use.reversed ? model_edge.low : model_edge.high);
    raw.middle = raw.use.curve->value(middle);
    return raw;
  }

  void take_internal(RawUse& raw) {
    raw.use.internal = true;
    raw.use.reversed = false;
    out_.internal_edges.push_back(raw.use);
  }

  /// Extent of the wire in (u,v), to which distances are compared.
  void measure() {
    Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    Vec2 high = -1 * low;
    for (const RawUse& raw : uses_) {
      for (const Vec2 p : {raw.begin, raw.middle, raw.end}) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
    }
    const auto positive = [](double x) { return std::isfinite(x) && x > 0 ? x : 1; };
    extent_ = {positive(high.x - low.x), positive(high.y - low.y)};
  }

  double relative_distance(Vec2 a, Vec2 b) const {
    return std::hypot((a.x - b.x) / extent_.x, (a.y - b.y) / extent_.y);
  }

  /// Edges that are taken as points are no poles: their neighbours meet without them. One that is a step in (u,v), or
  /// all that a wire has, stays.
  void drop_points() {
    const auto dropped = [&](const RawUse& raw) { return raw.point && relative_distance(raw.begin, raw.end) < 1e-2; };
    if (std::all_of(uses_.begin(), uses_.end(), dropped)) return;
    uses_.erase(std::remove_if(uses_.begin(), uses_.end(), dropped), uses_.end());
  }

  /// Finds the edges used twice: seams, whose two parameter curves lie apart, and slits, where they coincide.
  void take_slits() {
    std::vector<char> gone(uses_.size(), 0);
    for (std::size_t i = 0; i < uses_.size(); ++i) {
      for (std::size_t j = i + 1; j < uses_.size(); ++j) {
        RawUse& a = uses_[i];
        RawUse& b = uses_[j];
        if (gone[i] != 0 || gone[j] != 0 || a.use.edge != b.use.edge || a.use.reversed == b.use.reversed) continue;
        if (relative_distance(a.middle, b.middle) > 0.05) {
          a.use.seam = b.use.seam = true;
        } else if (!context_.model->edges[a.use.edge].degenerate) {
          gone[i] = gone[j] = 1;
          take_internal(a);
        }
      }
    }
    std::vector<RawUse> kept;
    for (std::size_t i = 0; i < uses_.size(); ++i) {
      if (gone[i] == 0) kept.push_back(std::move(uses_[i]));
    }
    uses_ = std::move(kept);
  }

  Vec2 whole_periods(Vec2 d) const {
    return {period_.x > 0 ? period_.x * std::nearbyint(d.x / period_.x) : 0,
            period_.y > 0 ? period_.y * std::nearbyint(d.y / period_.y) : 0};
  }

  /// How badly a use continues a chain that ends at `end`: sharing the vertex comes first, then the distance as stored,
  /// then the distance up to whole periods.
  double misfit(const RawUse& next, CadVertexId vertex, Vec2 end) const {
    const double stored = relative_distance(end, next.begin);
    const Vec2 d = end - next.begin;
    const double lifted = relative_distance(d, whole_periods(d));
    double score = stored < 1e-3 ? stored : 1e-3 + std::min(stored, lifted + 1e-3);
    if (next.from != vertex) score += 1e3;
    return score;
  }

  /// Takes one closed chain out of the uses, beginning with the first.
  void trace_one() {
    std::vector<RawUse> chain{std::move(uses_.front())};
    uses_.erase(uses_.begin());
    while (true) {
      const RawUse& last = chain.back();
      double best = std::numeric_limits<double>::infinity();
      std::size_t next = uses_.size();
      for (std::size_t i = 0; i < uses_.size(); ++i) {
        const double score = misfit(uses_[i], last.to, last.end);
        if (score < best) best = score, next = i;
      }
      // Closing wins a draw: chains that touch themselves fall apart into simple ones.
      if (next == uses_.size() || misfit(chain.front(), last.to, last.end) <= best) break;
      chain.push_back(std::move(uses_[next]));
      uses_.erase(uses_.begin() + static_cast<std::ptrdiff_t>(next));
    }
    lift(chain);
    out_.loops.push_back(finish(chain));
  }

  void lift(std::vector<RawUse>& chain) const {
    for (std::size_t i = 1; i < chain.size(); ++i) {
      const Vec2 d = chain[i - 1].end - chain[i].begin;
      // A degenerate use may run the other way round the pole: leave jumps of nearly half a period to the check.
      chain[i].shift = whole_periods(d);
      chain[i].begin = chain[i].begin + chain[i].shift;
      chain[i].end = chain[i].end + chain[i].shift;
    }
  }

  Loop finish(std::vector<RawUse>& chain) {
    Loop loop;
    for (std::size_t i = 0; i < chain.size(); ++i) {
      RawUse& raw = chain[i];
      const RawUse& next = chain[(i + 1) % chain.size()];
      if (!raw.curve.IsNull() && raw.shift != Vec2{}) {
        raw.map.shift = raw.shift;
        raw.use.curve = evened(make_parameter_curve(raw.curve, raw.map), context_.model->edges[raw.use.edge].steps);
      }
      loop.uses.push_back(raw.use);
      if (raw.use.curve == nullptr || next.use.curve == nullptr) continue;
      if (raw.to == next.from && collapses_between(raw.end, next.begin, raw.to)) {
        EdgeUse pole;
        pole.edge = context_.add_pole(raw.to);
        pole.curve = make_parameter_line(raw.end, next.begin - raw.end);
        loop.uses.push_back(pole);
      }
    }
    return loop;
  }

  /// A jump in (u,v) whose straight way stays at one point in space.
  bool collapses_between(Vec2 a, Vec2 b, CadVertexId vertex) const {
    if (relative_distance(a, b) < 1e-2) return false;
    const ModelVertex& at = context_.model->vertices[vertex];
    const double allowed = 10 * std::max(at.tolerance, out_.tolerance);
    for (int i = 0; i <= kSamples; ++i) {
      const Vec3 p = out_.surface->value(a + (static_cast<double>(i) / kSamples) * (b - a));
      if (!(distance(p, at.point) <= allowed)) return false;
    }
    return true;
  }

  std::vector<Vec2> polygon(const Loop& loop) const {
    std::vector<Vec2> points;
    for (const EdgeUse& use : loop.uses) {
      if (use.curve == nullptr) continue;
      const ModelEdge& edge = context_.model->edges[use.edge];
      for (int i = 0; i < kSamples; ++i) {
        const double s = static_cast<double>(use.reversed ? kSamples - i : i) / kSamples;
        points.push_back(use.curve->value(edge.low + s * (edge.high - edge.low)));
      }
    }
    return points;
  }

  static double signed_area(const std::vector<Vec2>& points) {
    double twice = 0;
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      twice += cross(points[i] - points[0], points[i + 1] - points[0]);
    }
    return twice / 2;
  }

  static bool inside(const std::vector<Vec2>& points, Vec2 p) {
    bool odd = false;
    for (std::size_t i = 0, j = points.size() - 1; i < points.size(); j = i++) {
      const Vec2 a = points[i], b = points[j];
      if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) odd = !odd;
    }
    return odd;
  }

  /// The loop of largest positive area first, the others moved by whole periods to lie inside of it.
  void align_loops() {
    if (out_.loops.size() < 2) return;
    std::size_t outer = 0;
    double largest = 0;
    for (std::size_t i = 0; i < out_.loops.size(); ++i) {
      const double area = signed_area(polygon(out_.loops[i]));
      if (area > largest) largest = area, outer = i;
    }
    std::rotate(out_.loops.begin(), out_.loops.begin() + static_cast<std::ptrdiff_t>(outer),
                out_.loops.begin() + static_cast<std::ptrdiff_t>(outer) + 1);
    if (largest == 0) return;
    const std::vector<Vec2> rim = polygon(out_.loops.front());
    for (std::size_t i = 1; i < out_.loops.size(); ++i) {
      const std::vector<Vec2> points = polygon(out_.loops[i]);
      if (points.empty()) continue;
      const Vec2 shift = shift_inside(rim, points);
      if (shift != Vec2{}) move(out_.loops[i], shift);
      // A hole that runs the wrong way round: some writers orient inner wires at random.
      if (signed_area(points) > 0 && count_inside(rim, points, shift) == points.size()) turn(out_.loops[i]);
    }
  }

  static std::size_t count_inside(const std::vector<Vec2>& rim, const std::vector<Vec2>& points, Vec2 shift) {
    return static_cast<std::size_t>(
        std::count_if(points.begin(), points.end(), [&](Vec2 p) { return inside(rim, p + shift); }));
  }

  void turn(Loop& loop) {
    std::reverse(loop.uses.begin(), loop.uses.end());
    for (EdgeUse& use : loop.uses) use.reversed = !use.reversed;
    ++turned_;
  }

  Vec2 shift_inside(const std::vector<Vec2>& rim, const std::vector<Vec2>& points) const {
    Vec2 best{};
    std::size_t most = 0;
    for (const int i : {0, 1, -1, 2, -2}) {
      for (const int j : {0, 1, -1, 2, -2}) {
        if ((i != 0 && period_.x == 0) || (j != 0 && period_.y == 0)) continue;
        const Vec2 shift{i * period_.x, j * period_.y};
        const std::size_t count = count_inside(rim, points, shift);
        if (count > most) most = count, best = shift;
      }
    }
    return best;
  }

  /// Shifts every use of a loop.
  void move(Loop& loop, Vec2 shift) const {
    for (EdgeUse& use : loop.uses) {
      if (use.curve != nullptr) use.curve = make_shifted(use.curve, shift);
    }
  }

  class Shifted final : public ParameterCurve {
   public:
    Shifted(std::shared_ptr<const ParameterCurve> curve, Vec2 shift) : curve_(std::move(curve)), shift_(shift) {}
    Vec2 value(double t) const override { return curve_->value(t) + shift_; }
    std::unique_ptr<ParameterCurve> clone() const override {
      return std::make_unique<Shifted>(std::shared_ptr<const ParameterCurve>(curve_->clone()), shift_);
    }

   private:
    std::shared_ptr<const ParameterCurve> curve_;
    Vec2 shift_;
  };

  static std::shared_ptr<const ParameterCurve> make_shifted(std::shared_ptr<const ParameterCurve> curve, Vec2 shift) {
    return std::make_shared<Shifted>(std::move(curve), shift);
  }

  void set_domain() {
    Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    Vec2 high = -1 * low;
    for (const Loop& loop : out_.loops) {
      for (const Vec2 p : polygon(loop)) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
    }
    if (!(low.x <= high.x)) low = high = {};
    out_.low = low;
    out_.high = high;
  }

  TopoDS_Face face_;
  const LoopContext& context_;
  ModelFace& out_;
  Vec2 period_, extent_;
  int turned_ = 0;
  std::vector<RawUse> uses_;
};

}  // namespace

int trace_loops(const TopoDS_Face& face, const LoopContext& context, ModelFace& out) {
  return Tracer(face, context, out).run();
}

}  // namespace curvetet
