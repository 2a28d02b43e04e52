// A segment is listed in the cells it passes, row by row. The clipped ends of a row are widened by far more than the
// rounding of their computation, so two segments with a common point share a cell: cell indices are monotone in the
// coordinates.
#include "planar/segment_grid.h"

#include <algorithm>
#include <cmath>

namespace curvetet {
namespace {

constexpr double kWiden = 1e-9;  // in cells of a chart of size one: rounding is below 1e-12
constexpr double kLargestSide = 256;

}  // namespace

int SegmentGrid::clamp(double x) const {
  return static_cast<int>(std::clamp(std::floor(x), 0.0, static_cast<double>(side_ - 1)));
}

void SegmentGrid::reset(Vec2 low, Vec2 high, std::size_t segments) {
  side_ = static_cast<std::size_t>(std::clamp(std::sqrt(static_cast<double>(segments)), 1.0, kLargestSide));
  low_ = low;
  const auto per_length = [this](double extent) { return extent > 0 ? static_cast<double>(side_) / extent : 0; };
  per_length_ = {per_length(high.x - low.x), per_length(high.y - low.y)};
  cells_.assign(side_ * side_, {});
  size_ = 0;
}

template <class Visit>
void SegmentGrid::rasterize(Vec2 p, Vec2 q, Visit&& visit) {
  if (p.y > q.y || (p.y == q.y && p.x > q.x)) std::swap(p, q);
  const auto grid_x = [this](double x) { return (x - low_.x) * per_length_.x; };
  const auto grid_y = [this](double y) { return (y - low_.y) * per_length_.y; };
  const Vec2 a{grid_x(p.x), grid_y(p.y)}, b{grid_x(q.x), grid_y(q.y)};
  const double left = std::min(a.x, b.x), right = std::max(a.x, b.x);
  const int first = row(p.y), last = row(q.y);
  for (int y = first; y <= last; ++y) {
    double x0 = left, x1 = right;
    if (b.y - a.y > kWiden) {  // clip to the row; the outer rows have no end
      const double slope = (b.x - a.x) / (b.y - a.y);
      const double y0 = y == first ? a.y : std::max(a.y, y - kWiden);
      const double y1 = y == last ? b.y : std::min(b.y, y + 1 + kWiden);
      const double e0 = a.x + slope * (y0 - a.y), e1 = a.x + slope * (y1 - a.y);
      x0 = std::clamp(std::min(e0, e1) - kWiden, left, right);
      x1 = std::clamp(std::max(e0, e1) + kWiden, left, right);
    }
    for (int x = clamp(x0); x <= clamp(x1); ++x) visit(cells_[static_cast<std::size_t>(y) * side_ + x]);
  }
}

void SegmentGrid::add(Entry entry, Vec2 p, Vec2 q) {
  rasterize(p, q, [entry](std::vector<Entry>& cell) { cell.push_back(entry); });
  ++size_;
}

void SegmentGrid::remove(Entry entry, Vec2 p, Vec2 q) {
  rasterize(p, q, [entry](std::vector<Entry>& cell) {
    const auto found = std::find(cell.begin(), cell.end(), entry);
    if (found == cell.end()) return;
    *found = cell.back();
    cell.pop_back();
  });
  --size_;
}

}  // namespace curvetet
