// Tags may be sparse and in any order, so they are looked up by binary search in the sorted tags; for dense tags, the
// usual case, the rank is the tag itself.
#include "io/mesh_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "io/scanner.h"

namespace curvetet {

namespace {

constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();

std::uint32_t checked_cad_id(std::int64_t cad_id) {
  if (cad_id < 0 || cad_id > std::numeric_limits<std::int32_t>::max()) {
    throw BadFile{fmt::format("an entity has the impossible id {}", cad_id)};
  }
  return static_cast<std::uint32_t>(cad_id);
}

/// Positions in ascending order of tags; equal tags keep their order.
std::vector<std::uint32_t> order_of(const std::vector<std::uint64_t>& tags) {
  std::vector<std::uint32_t> order(tags.size());
  std::iota(order.begin(), order.end(), 0U);
  if (!std::is_sorted(tags.begin(), tags.end())) {
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return tags[a] < tags[b]; });
  }
  return order;
}

}  // namespace

void MeshBuilder::add_node(std::uint64_t tag, const Point& point, std::uint8_t dimension, std::int64_t cad_id,
                           std::array<double, 2> parameter) {
  for (const double coordinate : point) {
    if (!std::isfinite(coordinate)) throw BadFile{fmt::format("node {} is not finite", tag), ErrorCode::not_finite};
  }
  if (node_tags_.size() >= kMost) throw BadFile{"more nodes than can be numbered"};
  node_tags_.push_back(tag);
  mesh_.points.push_back(point);
  const std::uint32_t entity = dimension == kUnknown ? 0 : entities_.find_or_add(dimension, checked_cad_id(cad_id));
  mesh_.nodes.push_back({dimension, entity, parameter});
}

void MeshBuilder::set_parameter(std::uint64_t tag, std::array<double, 2> parameter) {
  parameter_tags_.push_back(tag);
  parameters_.push_back(parameter);
}

void MeshBuilder::add_element(int dimension, std::uint64_t tag, std::int64_t cad_id,
                              std::span<const std::uint64_t> nodes) {
  Elements& elements = elements_[static_cast<std::size_t>(dimension)];
  if (elements.tags.size() >= kMost) throw BadFile{"more elements than can be numbered"};
  elements.tags.push_back(tag);
  elements.entities.push_back(entities_.find_or_add(dimension, checked_cad_id(cad_id)));
  elements.nodes.insert(elements.nodes.end(), nodes.begin(), nodes.end());
}

void MeshBuilder::order_nodes() {
  const std::vector<std::uint32_t> order = order_of(node_tags_);
  std::vector<std::uint64_t> tags(order.size());
  std::vector<Point> points(order.size());
  std::vector<NodeOnCad> nodes(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    tags[i] = node_tags_[order[i]];
    points[i] = mesh_.points[order[i]];
    nodes[i] = mesh_.nodes[order[i]];
    if (i > 0 && tags[i] == tags[i - 1]) throw BadFile{fmt::format("there are two nodes with the tag {}", tags[i])};
  }
  node_tags_ = std::move(tags);
  mesh_.points = std::move(points);
  mesh_.nodes = std::move(nodes);
}

std::uint32_t MeshBuilder::node_of(std::uint64_t tag) const {
  if (!node_tags_.empty()) {
    const std::uint64_t offset = tag - node_tags_.front();
    if (offset < node_tags_.size() && node_tags_[offset] == tag) return static_cast<std::uint32_t>(offset);
  }
  const auto found = std::lower_bound(node_tags_.begin(), node_tags_.end(), tag);
  if (found == node_tags_.end() || *found != tag) throw BadFile{fmt::format("there is no node with the tag {}", tag)};
  return static_cast<std::uint32_t>(found - node_tags_.begin());
}

void MeshBuilder::apply_parameters() {
  for (std::size_t i = 0; i < parameter_tags_.size(); ++i) {
    mesh_.nodes[node_of(parameter_tags_[i])].parameter = parameters_[i];
  }
}

template <std::size_t N>
void MeshBuilder::take_elements(int dimension, std::vector<std::array<std::uint32_t, N>>& nodes,
                                std::vector<std::uint32_t>& entity_of) {
  const Elements& elements = elements_[static_cast<std::size_t>(dimension)];
  nodes.reserve(elements.tags.size());
  entity_of.reserve(elements.tags.size());
  for (const std::uint32_t i : order_of(elements.tags)) {
    std::array<std::uint32_t, N> element{};
    for (std::size_t c = 0; c < N; ++c) element[c] = node_of(elements.nodes[i * N + c]);
    nodes.push_back(element);
    entity_of.push_back(elements.entities[i]);
  }
}

void MeshBuilder::take_corners() {
  mesh_.corner_nodes.assign(mesh_.vertices.size(), UINT32_MAX);
  const Elements& corners = elements_[0];
  for (std::size_t i = 0; i < corners.tags.size(); ++i) {
    std::uint32_t& corner = mesh_.corner_nodes[corners.entities[i]];
    const std::uint32_t node = node_of(corners.nodes[i]);
    if (corner != UINT32_MAX && corner != node) {
      throw BadFile{fmt::format("vertex {} has two nodes", mesh_.vertices[corners.entities[i]].cad_id)};
    }
    corner = node;
  }
}

void MeshBuilder::classify_nodes() {
  const auto classify = [&](std::uint8_t dimension, std::uint32_t node, std::uint32_t entity) {
    if (mesh_.nodes[node].dimension == kUnknown) {
      mesh_.nodes[node].dimension = dimension;
      mesh_.nodes[node].entity = entity;
    }
  };
  const auto classify_all = [&](std::uint8_t dimension, const auto& elements, const auto& entity_of) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      for (const std::uint32_t node : elements[i]) classify(dimension, node, entity_of[i]);
    }
  };
  for (std::size_t v = 0; v < mesh_.corner_nodes.size(); ++v) {
    if (mesh_.corner_nodes[v] != UINT32_MAX) classify(0, mesh_.corner_nodes[v], static_cast<std::uint32_t>(v));
  }
  classify_all(1, mesh_.segments, mesh_.segment_edge);
  classify_all(2, mesh_.triangles, mesh_.triangle_face);
  classify_all(3, mesh_.tets, mesh_.tet_solid);
  for (std::size_t i = 0; i < mesh_.nodes.size(); ++i) {
    // A node that no element uses: somewhere in the first solid, so that it is still there to be complained about.
    if (mesh_.nodes[i].dimension == kUnknown) {
      if (mesh_.solids.empty()) entities_.find_or_add(3, 1);
      classify(3, static_cast<std::uint32_t>(i), 0);
    }
  }
}

Mesh MeshBuilder::finish() {
  order_nodes();
  apply_parameters();
  take_corners();
  take_elements(1, mesh_.segments, mesh_.segment_edge);
  take_elements(2, mesh_.triangles, mesh_.triangle_face);
  take_elements(3, mesh_.tets, mesh_.tet_solid);
  classify_nodes();
  entities_.name_the_unnamed();
  return std::move(mesh_);
}

}  // namespace curvetet
