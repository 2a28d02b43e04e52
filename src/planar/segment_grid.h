// Segments of the plane by cell of a uniform grid: finds those near a box. A filter only; the tests behind it are
// exact.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace curvetet {

class SegmentGrid {
 public:
  /// What the caller knows a segment by.
  struct Entry {
    std::uint32_t a = 0, b = 0;
    friend auto operator<=>(const Entry&, const Entry&) = default;
  };

  /// An empty grid over the box, for about as many segments. Segments and queries beyond the box fall into its outer
  /// cells.
  void reset(Vec2 low, Vec2 high, std::size_t segments);
  void add(Entry entry, Vec2 p, Vec2 q);
  /// Exactly as it was added.
  void remove(Entry entry, Vec2 p, Vec2 q);
  /// Calls visit(entry) for a superset of the segments that meet the closed box; entries may repeat.
  template <class Visit>
  void near(Vec2 low, Vec2 high, Visit&& visit) const {
    if (cells_.empty()) return;
    const int x1 = column(high.x), y1 = row(high.y);
    for (int y = row(low.y); y <= y1; ++y) {
      for (int x = column(low.x); x <= x1; ++x) {
        for (const Entry& entry : cell(x, y)) visit(entry);
      }
    }
  }
  const std::vector<std::vector<Entry>>& cells() const { return cells_; }
  std::size_t size() const { return size_; }
  std::size_t capacity() const { return 4 * cells_.size(); }  ///< beyond this many segments a new grid pays

 private:
  int clamp(double x) const;
  int column(double x) const { return clamp((x - low_.x) * per_length_.x); }
  int row(double y) const { return clamp((y - low_.y) * per_length_.y); }
  const std::vector<Entry>& cell(int x, int y) const { return cells_[static_cast<std::size_t>(y) * side_ + x]; }
  template <class Visit>
  void rasterize(Vec2 p, Vec2 q, Visit&& visit);

  Vec2 low_{}, per_length_{1, 1};
  std::size_t side_ = 0, size_ = 0;
  std::vector<std::vector<Entry>> cells_;
};

}  // namespace curvetet
