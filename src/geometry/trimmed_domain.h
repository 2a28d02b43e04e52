// The trimmed domain of a face in (u,v), as polygons: is a parameter inside, does a cell meet it, how far is it
// outside.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/model.h"

namespace curvetet {

/// Loops as polygons, close enough for sampling (chords within a fraction of a percent of the domain's box), not for
/// topology. A face without loops is its whole box. Immutable once made, so that threads may share it.
class TrimmedDomain {
 public:
  TrimmedDomain(const Model& model, FaceId face);
  Vec2 low() const { return low_; }
  Vec2 high() const { return high_; }
  /// Even-odd rule; slits cancel out.
  bool inside(Vec2 uv) const;
  /// False only if the cell lies wholly outside.
  bool meets(Vec2 cell_low, Vec2 cell_high) const;
  /// The parameter moved by whole periods to where the domain is.
  Vec2 lifted(Vec2 uv) const;
  /// Is the boundary within `reach` of the parameter, with u and v scaled to lengths?
  bool is_near_boundary(Vec2 uv, Vec2 scale, double reach) const;

 private:
  struct Segment {
    Vec2 a, b;
  };
  void add_use(const EdgeUse& use, const ModelEdge& edge);
  void sort_into_rows();
  std::size_t row_of(double v) const;

  Vec2 low_, high_;
  double period_u_ = 0, period_v_ = 0;
  std::vector<Segment> segments_;
  std::vector<std::vector<std::uint32_t>> rows_;  ///< segments that meet each strip of v
};

}  // namespace curvetet
