// The best triangulation of an edge's ring, by dynamic programming (Klincsek 1980): what edge removal would put there.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "predicates/predicates.h"
#include "spatial/flips_exchange.h"

namespace curvetet::flips {

/// Triangles over positions in the ring, with what they cost and the least quality of the tets on them.
struct RingPlan {
  int cost = 0;
  double quality = std::numeric_limits<double>::infinity();
  Inline<std::array<std::uint8_t, 3>, kMaxRing> triangles;
};

/// The exchange that a plan stands for: each triangle makes a tet with q above and a tet with p below.
inline Exchange exchange_of(const Ring& ring, const RingPlan& plan) {
  Exchange exchange;
  for (TetId t : ring.tets) exchange.old_tets.push_back(t);
  for (const auto& [i, j, k] : plan.triangles) {
    const VertexId a = ring.vertices[i], b = ring.vertices[j], c = ring.vertices[k];
    exchange.new_tets.push_back({a, b, c, ring.q});
    exchange.new_tets.push_back({a, c, b, ring.p});
  }
  return exchange;
}

/// Finds the plan of least cost, among those the one of largest least quality; a plan is legal if all its tets are
/// exactly positive and of quality above `measure.floor()`. With an ear, the vertex at that position is cut off by one
/// triangle, so that it gets no new edge. A Measure has
///   double floor(); double tet(Vec3, Vec3, Vec3, Vec3): quality of a positive tet;
///   int facet(VertexId, VertexId, VertexId); int edge(VertexId, VertexId): cost of what would be new.
template <class Measure>
class RingPlanner {
 public:
  RingPlanner(const Tetrahedralization& mesh, const Ring& ring, const Measure& measure)
      : ring_(ring), measure_(measure), n_(static_cast<int>(ring.vertices.size())) {
    p_ = mesh.position(ring.p);
    q_ = mesh.position(ring.q);
    for (int i = 0; i < n_; ++i) points_[at(i)] = mesh.position(ring.vertices[at(i)]);
  }

  std::optional<RingPlan> plan(std::optional<int> ear = std::nullopt) {
    shift_ = ear ? *ear + 1 : 0;  // an ear becomes the last position
    const int last = ear ? n_ - 2 : n_ - 1;
    for (int length = 2; length <= last; ++length) {
      for (int i = 0; i + length <= last; ++i) solve(i, i + length, i == 0 && length == n_ - 1);
    }
    RingPlan result;
    if (last >= 2) {
      const Cell& whole = cell(0, last);
      if (!whole.legal) return std::nullopt;
      add_triangles(0, last, result);
      result.cost = whole.cost;
      result.quality = whole.quality;
    }
    if (ear) {
      const Cell tip = triangle(0, last, n_ - 1);
      if (!tip.legal) return std::nullopt;
      result.cost += tip.cost;
      result.quality = std::min(result.quality, tip.quality);
      result.triangles.push_back({real(0), real(last), real(n_ - 1)});
    }
    return result;
  }

 private:
  struct Cell {
    bool legal = false;
    int cost = 0;
    double quality = 0;
    int apex = -1;
  };
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  std::uint8_t real(int i) const { return static_cast<std::uint8_t>((i + shift_) % n_); }
  Cell& cell(int i, int j) { return cells_[at(i)][at(j)]; }
  VertexId vertex(int i) const { return ring_.vertices[real(i)]; }
  Vec3 point(int i) const { return points_[real(i)]; }

  Cell triangle(int i, int k, int j) const {
    const Vec3 a = point(i), b = point(k), c = point(j);
    if (orient3d(a, b, c, q_) <= 0 || orient3d(a, c, b, p_) <= 0) return {};
    const double above = measure_.tet(a, b, c, q_);
    if (!(above > measure_.floor())) return {};
    const double below = measure_.tet(a, c, b, p_);
    if (!(below > measure_.floor())) return {};
    return {true, measure_.facet(vertex(i), vertex(k), vertex(j)), std::min(above, below), k};
  }

  int chord_cost(int i, int j) const {
    return measure_.edge(vertex(i), vertex(j)) + measure_.facet(vertex(i), vertex(j), ring_.p) +
           measure_.facet(vertex(i), vertex(j), ring_.q);
  }

  void solve(int i, int j, bool whole) {
    Cell best;
    for (int k = i + 1; k < j; ++k) {
      const bool left = k > i + 1, right = k < j - 1;
      if ((left && !cell(i, k).legal) || (right && !cell(k, j).legal)) continue;
      Cell c = triangle(i, k, j);
      if (!c.legal) continue;
      if (left) add(c, cell(i, k));
      if (right) add(c, cell(k, j));
      if (!best.legal || c.cost < best.cost || (c.cost == best.cost && c.quality > best.quality)) best = c;
    }
    if (best.legal && !whole) best.cost += chord_cost(i, j);
    cell(i, j) = best;
  }

  static void add(Cell& c, const Cell& part) {
    c.cost += part.cost;
    c.quality = std::min(c.quality, part.quality);
  }

  void add_triangles(int i, int j, RingPlan& plan) {
    if (j < i + 2) return;
    const int k = cell(i, j).apex;
    plan.triangles.push_back({real(i), real(k), real(j)});
    add_triangles(i, k, plan);
    add_triangles(k, j, plan);
  }

  const Ring& ring_;
  const Measure& measure_;
  int n_, shift_ = 0;
  Vec3 p_, q_;
  std::array<Vec3, kMaxRing> points_;
  std::array<std::array<Cell, kMaxRing>, kMaxRing> cells_;
};

}  // namespace curvetet::flips
