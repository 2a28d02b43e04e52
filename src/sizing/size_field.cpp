// The size field as a lower envelope of cones: h(p) = min_i (size_i + grading * |p - p_i|), bounded by the largest
// size.
//
// Each cone has slope `grading`, so the envelope is graded by construction and no smoothing pass over a background mesh
// is needed. The minimum is found by branch and bound in a kd-tree whose nodes store their box and their least size: a
// subtree whose least size, grown over the distance to its box, is not below the best value so far holds no better
// cone. Sources that lie on or above the cone of another are dropped before the tree for queries is built; "is implied
// by" is transitive (triangle inequality), so all can be tested against the full set at once, and those that were there
// before against the new ones alone.
//
// Rejected: a background octree with gradation by propagation (its resolution shows in the field, and it must be
// rebuilt when the outer loop adds a source).

#include "sizing/size_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace curvetet {

namespace {

constexpr std::uint32_t kLeafSize = 8;

struct Cone {
  Vec3 where;
  double size = 0;
};

bool before(const Cone& a, const Cone& b) {
  return std::tie(a.size, a.where.x, a.where.y, a.where.z) < std::tie(b.size, b.where.x, b.where.y, b.where.z);
}

double squared_distance_to_box(Vec3 p, const Box3& box) {
  const double x = std::max({box.low.x - p.x, 0.0, p.x - box.high.x});
  const double y = std::max({box.low.y - p.y, 0.0, p.y - box.high.y});
  const double z = std::max({box.low.z - p.z, 0.0, p.z - box.high.z});
  return x * x + y * y + z * z;
}

int longest_axis(const Box3& box) {
  const Vec3 extent = box.high - box.low;
  if (extent.x >= extent.y && extent.x >= extent.z) return 0;
  return extent.y >= extent.z ? 1 : 2;
}

bool is_derived(SizeReason reason) {
  return reason == SizeReason::curvature || reason == SizeReason::chord_height || reason == SizeReason::gap ||
         reason == SizeReason::edge_length;
}

double limit_of(const std::map<std::uint32_t, double>& sizes, std::uint32_t index) {
  const auto found = sizes.find(index);
  return found == sizes.end() ? std::numeric_limits<double>::infinity() : found->second;
}

void lower_limit(std::map<std::uint32_t, double>& sizes, std::uint32_t index, double size) {
  const auto [entry, inserted] = sizes.emplace(index, size);
  if (!inserted) entry->second = std::min(entry->second, size);
}

}  // namespace

struct SizeField::Tree {
  struct Node {
    Box3 box;
    double least = 0;
    std::uint32_t begin = 0, end = 0;
    std::uint32_t right = 0;  ///< the left child follows its parent; 0: a leaf
  };

  std::vector<Node> nodes;
  std::vector<Cone> cones;

  explicit Tree(std::vector<Cone> all) : cones(std::move(all)) {
    if (cones.empty()) return;
    nodes.reserve(2 * cones.size() / kLeafSize + 2);
    build(0, static_cast<std::uint32_t>(cones.size()));
  }

  std::uint32_t build(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes.size());
    Node node;
    node.begin = begin;
    node.end = end;
    node.least = cones[begin].size;
    for (std::uint32_t i = begin; i < end; ++i) {
      node.box.extend(cones[i].where);
      node.least = std::min(node.least, cones[i].size);
    }
    nodes.push_back(node);
    if (end - begin <= kLeafSize) return index;
    const int axis = longest_axis(node.box);
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(cones.begin() + begin, cones.begin() + middle, cones.begin() + end,
                     [axis](const Cone& a, const Cone& b) {
                       return a.where[axis] != b.where[axis] ? a.where[axis] < b.where[axis] : before(a, b);
                     });
    build(begin, middle);
    const std::uint32_t right = build(middle, end);
    nodes[index].right = right;
    return index;
  }

  /// The least of `best` and all cones at p. Compares squares: grading * distance < best - size.
  double lowest(Vec3 p, double grading, double best) const {
    if (nodes.empty()) return best;
    const double grading2 = grading * grading;
    const auto may_hold_less = [&](double size, double distance2) {
      const double room = best - size;
      return room > 0 && grading2 * distance2 < room * room;
    };
    struct Visit {
      std::uint32_t node;
      double distance2;
    };
    const auto visit_of = [&](std::uint32_t node) { return Visit{node, squared_distance_to_box(p, nodes[node].box)}; };
    std::array<Visit, 64> stack;  // depth is at most 33: the tree is balanced
    std::size_t top = 0;
    stack[top++] = visit_of(0);
    while (top > 0) {
      const Visit visit = stack[--top];
      const Node& node = nodes[visit.node];
      if (!may_hold_less(node.least, visit.distance2)) continue;
      if (node.right == 0) {
        for (std::uint32_t i = node.begin; i < node.end; ++i) {
          const double distance2 = norm2(p - cones[i].where);
          if (may_hold_less(cones[i].size, distance2)) best = cones[i].size + grading * std::sqrt(distance2);
        }
        continue;
      }
      Visit near = visit_of(visit.node + 1), far = visit_of(node.right);
      if (far.distance2 < near.distance2) std::swap(near, far);
      stack[top++] = far;
      stack[top++] = near;
    }
    return best;
  }
};

namespace {

std::vector<Cone> distinct(std::vector<Cone> cones) {
  std::sort(cones.begin(), cones.end(), before);
  const auto same = [](const Cone& a, const Cone& b) { return a.size == b.size && a.where == b.where; };
  cones.erase(std::unique(cones.begin(), cones.end(), same), cones.end());
  return cones;
}

}  // namespace

SizeField::SizeField(const std::vector<SizeSource>& sources, const SizingOptions& options) : options_(options) {
  face_limit_ = options_.face_size;
  edge_limit_ = options_.edge_size;
  add(sources);
}

void SizeField::add(const std::vector<SizeSource>& more) {
  std::vector<Cone> cones;
  for (SizeSource source : more) {
    if (is_derived(source.reason)) source.size = std::max(source.size, options_.min_size);
    if (!(source.size > 0) || !finite(source.where)) continue;
    sources_.push_back(source);
    if (source.size < options_.size) cones.push_back({source.where, source.size});
  }
  if (!tree_) tree_ = std::make_shared<const Tree>(std::vector<Cone>());
  const Tree fresh(distinct(std::move(cones)));
  const auto is_implied = [this](const Tree& by, const Cone& cone) {
    return by.lowest(cone.where, options_.grading, cone.size) < cone.size;
  };
  std::vector<Cone> kept;
  for (const Cone& cone : fresh.cones)
    if (!is_implied(fresh, cone) && !is_implied(*tree_, cone)) kept.push_back(cone);
  if (kept.empty()) return;
  for (const Cone& cone : tree_->cones)
    if (!is_implied(fresh, cone)) kept.push_back(cone);
  tree_ = std::make_shared<const Tree>(distinct(std::move(kept)));
}

void SizeField::spread_limits(const Model& model) {
  for (const auto& [index, size] : options_.solid_size) {
    if (index >= model.solids.size()) continue;
    for (const FaceId face : model.solids[SolidId(index)].faces) lower_limit(face_limit_, face.value(), size);
  }
  for (std::size_t i = 0; i < model.edges.size(); ++i)
    for (const FaceId face : model.edges[EdgeId(i)].faces) {
      const double size = limit_of(face_limit_, face.value());
      if (std::isfinite(size)) lower_limit(edge_limit_, static_cast<std::uint32_t>(i), size);
    }
}

double SizeField::at(Vec3 p) const {
  double size = options_.size;
  if (tree_) size = tree_->lowest(p, options_.grading, size);
  if (options_.callback) {
    const double asked = options_.callback(p);
    if (asked > 0) size = std::min(size, asked);
  }
  return size;
}

double SizeField::face_limit(FaceId face) const { return limit_of(face_limit_, face.value()); }
double SizeField::edge_limit(EdgeId edge) const { return limit_of(edge_limit_, edge.value()); }

double SizeField::at_face(FaceId face, Vec3 p) const { return std::min(at(p), face_limit(face)); }
double SizeField::at_edge(EdgeId edge, Vec3 p) const { return std::min(at(p), edge_limit(edge)); }
double SizeField::at_solid(SolidId solid, Vec3 p) const {
  return std::min(at(p), limit_of(options_.solid_size, solid.value()));
}

double SizeField::smallest() const {
  double size = options_.size;
  if (tree_ && !tree_->nodes.empty()) size = std::min(size, tree_->nodes.front().least);
  for (const auto* asked : {&options_.face_size, &options_.edge_size, &options_.solid_size})
    for (const auto& entry : *asked) size = std::min(size, entry.second);
  return size;
}

std::vector<SizeReduction> SizeField::reductions(const Model& model) const {
  std::vector<SizeReduction> least(model.faces.size());
  for (const SizeSource& source : sources_) {
    if (!source.face.valid() || source.face.value() >= least.size() || source.size >= options_.size) continue;
    SizeReduction& reduction = least[source.face.value()];
    if (reduction.face.valid() && reduction.size <= source.size) continue;
    reduction = {source.face, source.other, source.reason, source.size, source.gap, source.where};
  }
  std::erase_if(least, [](const SizeReduction& reduction) { return !reduction.face.valid(); });
  return least;
}

}  // namespace curvetet
