// Which nodes carry a vertex: a flat open-addressing table, looked up and never iterated.
#pragma once

#include <cstdint>
#include <vector>

#include "base/ids.h"

namespace curvetet {

/// Nodes are added in the order of their ids, each once; several may carry one vertex (seams, poles).
class NodeIndex {
 public:
  void clear();
  void add(VertexId vertex, NodeId node);
  /// The nodes of a vertex by rising id.
  std::vector<NodeId> find(VertexId vertex) const;

 private:
  std::size_t slot(VertexId vertex) const;  ///< of the vertex's entry, or the free one where it belongs
  void grow();

  std::vector<std::uint32_t> head_;  // last node of the slot's vertex, or kEmpty
  std::vector<std::uint32_t> next_;  // per node: the former head
  std::vector<VertexId> vertex_;     // per node
  std::size_t used_ = 0;
};

}  // namespace curvetet
