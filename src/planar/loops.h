// The input of a face mesh as a plane graph: nodes merged, segments listed, and what is wrong with them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/ids.h"
#include "planar/face_mesh.h"

namespace curvetet {

/// One segment of a chain, with the domain on its left (on both sides if two-sided).
struct LoopSegment {
  NodeId a, b;
  std::int32_t use = -1;
  std::size_t index = 0;  ///< in its chain
  std::size_t loop = 0;
  bool two_sided = false;
};

struct LoopGraph {
  IndexedVector<NodeId, FaceNode> nodes;  ///< one per vertex and chart point, by first appearance
  std::vector<LoopSegment> segments;  ///< loop by loop, without those of no length or that come and go at one vertex
  std::vector<NodeId> isolated;
  std::vector<LoopFault> faults;  ///< malformed chains, points beyond the chart, open loops, collapsed segments
};

LoopGraph assemble(const FaceInput& input);

/// Pairs of segments that cross, touch or overlap other than at a common end; nodes that share a point or lie on a
/// segment. Coincident segments of opposite direction, both one-sided, are legal: a slit. Each segment is named with at
/// most sixteen partners. Sorted by segment.
std::vector<LoopFault> find_crossings(const LoopGraph& graph);

/// What winding says of the regions left and right of each segment; `what` is "inverted" for every segment of a loop
/// that turns clockwise where no loop turns the other way, else "not nested" with the pair of nearest segments of two
/// loops. REQUIRED: no crossings, and `faulty` is as long as the segments.
std::vector<LoopFault> describe_nesting(const LoopGraph& graph, const std::vector<bool>& faulty);

}  // namespace curvetet
