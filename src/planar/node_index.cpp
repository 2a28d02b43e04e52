// Linear probing over a power-of-two table at most half full; the nodes of one vertex are chained through next_.
#include "planar/node_index.h"

#include <algorithm>
#include <limits>

namespace curvetet {
namespace {

constexpr std::uint32_t kEmpty = std::numeric_limits<std::uint32_t>::max();

}  // namespace

void NodeIndex::clear() {
  head_.clear();
  next_.clear();
  vertex_.clear();
  used_ = 0;
}

std::size_t NodeIndex::slot(VertexId vertex) const {
  const std::size_t mask = head_.size() - 1;
  std::size_t s = (std::uint64_t{vertex.value()} * 0x9E3779B97F4A7C15ULL >> 32) & mask;
  while (head_[s] != kEmpty && vertex_[head_[s]] != vertex) s = (s + 1) & mask;
  return s;
}

void NodeIndex::grow() {
  const std::vector<std::uint32_t> old = std::move(head_);
  head_.assign(std::max<std::size_t>(16, 2 * old.size()), kEmpty);
  for (const std::uint32_t head : old) {
    if (head != kEmpty) head_[slot(vertex_[head])] = head;
  }
}

void NodeIndex::add(VertexId vertex, NodeId node) {
  if (2 * (used_ + 1) > head_.size()) grow();
  next_.resize(node.value() + 1, kEmpty);
  vertex_.resize(node.value() + 1);
  const std::size_t s = slot(vertex);
  if (head_[s] == kEmpty) ++used_;
  next_[node.value()] = head_[s];
  vertex_[node.value()] = vertex;
  head_[s] = node.value();
}

std::vector<NodeId> NodeIndex::find(VertexId vertex) const {
  std::vector<NodeId> out;
  if (head_.empty()) return out;
  for (std::uint32_t n = head_[slot(vertex)]; n != kEmpty; n = next_[n]) out.push_back(NodeId(n));
  std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace curvetet
