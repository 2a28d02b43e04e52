// That no place is in two tets, from the boundary alone.
//
// Walk through space off all edges. Through a facet of two tets on opposite sides, one tet is left and one entered; so
// the number of tets around a place changes only at facets of one tet, by one if no two of these lie in one place, and
// far away it is zero. It is one everywhere in the tets if it is zero before each such facet. Around an edge of exactly
// two of them, the places before the one are joined with those before the other; so one facet decides for all that it
// reaches across such edges: for its sheet. It is decided on a line through the facet: along it the number must change
// between zero and one.
//
// Signs and orders are exact: shadows by turns, heights on the line as fractions. A line that passes through an edge
// decides nothing, and another is taken.
//
// Rejected: looking in each tet for vertices that are not its own, which takes a third of all checks; it remains where
// this proof fails, to say where.
#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "quality/checks.h"
#include "quality/exact.h"

namespace curvetet::checks {
namespace {

using Fraction = boost::multiprecision::cpp_rational;

/// Where lines pass through a facet, as weights of its corners.
constexpr std::array<std::array<double, 3>, 6> kWeights{
    {{0.34, 0.33, 0.33}, {0.5, 0.3, 0.2}, {0.2, 0.5, 0.3}, {0.3, 0.2, 0.5}, {0.15, 0.27, 0.58}, {0.58, 0.15, 0.27}}};

/// All points with the same two other coordinates as `through`.
struct Line {
  int axis = 0;
  Vec3 through;
};

struct Crossing {
  Fraction height;
  int change = 0;  ///< of the number of tets, upwards
  std::uint32_t facet = 0;
};

class CoveringCheck {
 public:
  CoveringCheck(const Mesh& mesh, const Topology& topology, const BoxTree& tree)
      : mesh_(mesh), boundary_(topology.boundary), sheet_(topology.outer_sheet), tree_(tree) {}

  bool run() {
    settled_.assign(boundary_.size(), 0);
    for (const std::uint32_t f : largest_of_sheets()) {
      if (settled_[sheet_[f]] != 0) continue;
      if (!is_simple_on_a_line_through(f)) return false;
    }
    return true;
  }

 private:
  /// A facet with tets on one side only.
  static bool is_outer(const BoundaryFacet& f) { return f.above == kOutside || f.below == kOutside; }

  std::array<Vec3, 3> corners(std::uint32_t f) const {
    const auto& v = boundary_[f].vertices;
    return {vec(mesh_.points[v[0]]), vec(mesh_.points[v[1]]), vec(mesh_.points[v[2]])};
  }

  std::vector<std::uint32_t> largest_of_sheets() {
    std::vector<std::uint32_t> largest(boundary_.size(), kOutside);
    std::vector<double> area(boundary_.size(), -1);
    for (std::uint32_t f = 0; f < boundary_.size(); ++f) {
      if (!is_outer(boundary_[f])) continue;
      const std::uint32_t sheet = sheet_[f];
      const auto p = corners(f);
      const double squared = norm2(cross(p[1] - p[0], p[2] - p[0]));
      if (squared <= area[sheet]) continue;
      area[sheet] = squared;
      largest[sheet] = f;
    }
    std::erase(largest, kOutside);
    return largest;
  }

  bool is_simple_on_a_line_through(std::uint32_t f) {
    const auto p = corners(f);
    const int axis = exact::shadow_axis(p[0], p[1], p[2]);
    for (const auto& w : kWeights) {
      const std::optional<bool> simple = is_simple_along({axis, w[0] * p[0] + w[1] * p[1] + w[2] * p[2]}, f);
      if (simple) return *simple;
    }
    return false;
  }

  /// Whether no more than one tet is at any place of the line. Nothing if the line passes through an edge, or by
  /// rounding beside the facet.
  std::optional<bool> is_simple_along(const Line& line, std::uint32_t f) {
    std::vector<Crossing> crossings;
    bool has_facet = false;
    for (const std::uint32_t g : facets_near(line)) {
      const std::optional<int> turn = passes(line, g);
      if (!turn) return std::nullopt;
      if (*turn == 0) continue;
      const int above = boundary_[g].above != kOutside ? 1 : 0, below = boundary_[g].below != kOutside ? 1 : 0;
      crossings.push_back({height_on(line, g), *turn * (above - below), g});
      has_facet = has_facet || g == f;
    }
    if (!has_facet) return std::nullopt;
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.height < b.height; });
    int covered = 0;
    for (const Crossing& c : crossings) {
      covered += c.change;
      if (covered < 0 || covered > 1) return false;
    }
    for (const Crossing& c : crossings) settled_[sheet_[c.facet]] = 1;
    return true;
  }

  std::vector<std::uint32_t> facets_near(const Line& line) const {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    Box3 box{line.through, line.through};
    box.low[line.axis] = -kFar;
    box.high[line.axis] = kFar;
    std::vector<std::uint32_t> near;
    tree_.overlaps(box, near);
    std::erase_if(near, [this](std::uint32_t g) { return !is_outer(boundary_[g]); });
    return near;
  }

  /// How the facet's shadow turns if the line passes through its inside, 0 if it does not meet it, nothing if it meets
  /// its rim.
  std::optional<int> passes(const Line& line, std::uint32_t g) const {
    const auto p = corners(g);
    const int a = exact::turn(p[0], p[1], line.through, line.axis),
              b = exact::turn(p[1], p[2], line.through, line.axis),
              c = exact::turn(p[2], p[0], line.through, line.axis);
    if (std::min({a, b, c}) < 0 && std::max({a, b, c}) > 0) return 0;
    if (a == 0 || b == 0 || c == 0) return std::nullopt;
    return a;
  }

  /// Where the line meets the facet's plane.
  Fraction height_on(const Line& line, std::uint32_t g) const {
    const auto p = corners(g);
    const int w = line.axis, u = (w + 1) % 3, v = (w + 2) % 3;
    const auto along = [&](std::size_t i, int axis) { return Fraction(p[i][axis]) - Fraction(p[0][axis]); };
    const Fraction qu = along(1, u), qv = along(1, v), qw = along(1, w), ru = along(2, u), rv = along(2, v),
                   rw = along(2, w);
    const Fraction x = Fraction(line.through[u]) - Fraction(p[0][u]), y = Fraction(line.through[v]) - Fraction(p[0][v]);
    const Fraction area = qu * rv - qv * ru;
    return Fraction(p[0][w]) + (qw * (x * rv - y * ru) + rw * (qu * y - qv * x)) / area;
  }

  const Mesh& mesh_;
  const std::vector<BoundaryFacet>& boundary_;
  const std::vector<std::uint32_t>& sheet_;
  const BoxTree& tree_;
  std::vector<std::uint8_t> settled_;  ///< by sheet
};

}  // namespace

bool is_covered_once(const Mesh& mesh, const Topology& topology, const BoxTree& tree) {
  return CoveringCheck(mesh, topology, tree).run();
}

}  // namespace curvetet::checks
