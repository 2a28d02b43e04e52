// t_ps: the triangulation of one CAD face in its parameter plane. Nodes are {vertex id, chart point}; a seam vertex has
// two nodes, a pole one node per end of its degenerate edge plus those along it. Triangles turn left in the chart,
// exactly.
//
// Edges that lie on a use of a CAD edge are constrained: they carry the use's number and the segment's place is found
// by its two nodes. Everything else may be flipped.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/error.h"
#include "base/ids.h"
#include "mesh/vertex_store.h"
#include "planar/chart.h"
#include "planar/node_index.h"
#include "planar/segment_grid.h"

namespace curvetet {

struct FaceNode {
  VertexId vertex;
  Vec2 q;  ///< chart point
};

/// neighbour[i] and use[i] belong to the edge opposite node[i], that is (node[i+1], node[i+2]).
struct FaceTriangle {
  std::array<NodeId, 3> node;
  std::array<TriangleId, 3> neighbour;          ///< invalid on the boundary of the domain
  std::array<std::int32_t, 3> use{-1, -1, -1};  ///< number of the edge use it lies on (FaceMesh input), or -1
  bool alive() const { return node[0].valid(); }
};

/// An edge of the triangulation: the one opposite local node `local` of `triangle`.
struct FaceEdge {
  TriangleId triangle;
  int local = 0;
};

enum class PlanarRefusal : std::uint8_t {
  none,
  outside,        ///< not in the domain
  on_constraint,  ///< on (or beyond) a constrained edge
  duplicate,      ///< at an existing node
  folded,         ///< a new triangle would not turn left, or its normal opposes the surface's
  invariant,      ///< the region between chord and arc holds another node or loop
};

/// One polygonal chain of the input: the nodes along one edge use in the order of its loop.
struct ChainInput {
  std::int32_t use = 0;            ///< number handed back in FaceTriangle::use
  std::vector<VertexId> vertices;  ///< first and last included
  std::vector<Vec2> q;             ///< chart points, as many; where two chains of a loop join, the first's end is taken
  bool two_sided = false;          ///< internal: triangles on both sides
};
struct LoopInput {
  std::vector<ChainInput>
      chains;         ///< closed, the domain to the left; a two-sided chain stands alone in its own LoopInput
  bool open = false;  ///< an open internal chain
};
struct FaceInput {
  std::vector<LoopInput> loops;
  std::vector<FaceNode> isolated;  ///< vertices that must become nodes
};

/// Loops that cross or are not nested: which chains' segments are at fault, so that the caller can split them.
struct LoopFault {
  std::int32_t use_a = -1, use_b = -1;
  std::size_t segment_a = 0, segment_b = 0;  ///< index of the segment's first vertex in its chain
  std::string what;
};

/// Of a full turn around a pole: an edge along one comes in chains without longer steps, or the triangles around it are
/// not told apart.
inline constexpr int kPoleSteps = 12;

class FaceMesh {
 public:
  Chart chart;

  /// Constrained Delaunay triangulation of the domain the loops bound (exact; interior found by winding). On faults
  /// nothing is built, the former mesh stays, and all of them are returned. Loops may touch at a common vertex; two
  /// segments over the same nodes in opposite directions are the two sides of a slit.
  /// REQUIRED: uses are not negative; chart points lie within (-1,1)^2, on the grid.
  std::vector<LoopFault> build(const FaceInput& input);

  const FaceNode& node(NodeId n) const { return nodes_[n]; }
  const FaceTriangle& triangle(TriangleId t) const { return triangles_[t]; }
  std::size_t node_count() const { return nodes_.size(); }
  std::size_t triangle_slots() const { return triangles_.size(); }
  std::size_t triangle_count() const;  ///< alive
  std::array<VertexId, 3> vertices(TriangleId t) const;
  /// Whether an edge of the boundary goes along a pole.
  bool has_pole() const { return !poles_.empty(); }
  /// Whether it goes around one by more than half a turn, by its edges along it: not at the corner of a patch.
  bool has_tip() const { return has_tip_; }
  /// The nodes that carry a vertex (one, or several for seams and poles).
  std::vector<NodeId> nodes_of(VertexId v) const;
  /// A triangle at a node; empty if the node is in none.
  TriangleId triangle_at(NodeId n) const;
  /// All triangles around a node, counter-clockwise from the boundary if there is one (pinched nodes: by id).
  void star(NodeId n, std::vector<TriangleId>& out) const;
  /// The edge, from the triangle that sees it as (a,b) if there is one, else from the other.
  std::optional<FaceEdge> find_edge(NodeId a, NodeId b) const;

  /// The triangle that contains q (walk from the hint, again from where a ray to the boundary sees
  /// q, then a scan); empty if outside.
  std::optional<TriangleId> locate(Vec2 q, TriangleId hint = TriangleId()) const;
  /// Where a walk from a triangle towards q ends: at the triangle that contains q, or before a constrained edge that q
  /// lies strictly beyond (the segment a refinement would split instead). Neither if the walk ran into its step bound.
  struct WalkEnd {
    std::optional<TriangleId> triangle;
    std::optional<FaceEdge> blocked;
  };
  WalkEnd walk(Vec2 q, TriangleId from) const;

  /// Decides whether the edge shared by two triangles (a,b,c) and (b,a,d) should be flipped to cd: the caller's
  /// Delaunay criterion (in space, or in the metric). Asked only where the flip is valid in the chart.
  using FlipWanted = std::function<bool(NodeId a, NodeId b, NodeId c, NodeId d)>;

  /// Would inserting at q be legal? `triangle` contains q. Nothing is changed.
  PlanarRefusal judge_insert(Vec2 q, TriangleId triangle) const;
  /// Inserts an interior node and restores the criterion, first by flips of the edges opposite it (each adds an edge at
  /// the node, so this ends for any criterion), then as `restore` does: what the chart forbade before may be legal now.
  /// `changed` becomes the triangles touched. An invalid id, and nothing changed, if judge_insert refuses.
  NodeId insert(VertexId vertex, Vec2 q, TriangleId triangle, const FlipWanted& wanted,
                std::vector<TriangleId>& changed);

  /// Splits the constrained edge at a node on its arc (which is usually not on the chord). `invariant` if the region
  /// between chord and the two new chords holds another node or edge, then nothing is changed. All exact, on either
  /// side of the chord; an edge with the domain on both sides (whose triangles may carry different uses) is split once,
  /// for both. `outside`: no constrained edge, or q beyond the chart.
  PlanarRefusal judge_split(FaceEdge edge, Vec2 q) const;
  /// As judged, then restores the criterion; `changed` becomes every triangle touched (alive ones). An invalid id, and
  /// nothing changed, if judge_split refuses.
  NodeId split(FaceEdge edge, VertexId vertex, Vec2 q, const FlipWanted& wanted, std::vector<TriangleId>& changed);

  /// Flips one unconstrained edge if the result turns left (exactly).
  bool flip(FaceEdge edge);
  /// Lawson's flips from the given triangles until none is wanted; at most 64 and 32 per edge given, for a criterion
  /// need not be transitive. `changed` becomes the triangles touched. An edge to a pole that is there more
  /// than once in the chart, with triangles over the pole between, is flipped as the one edge that it is in space.
  void restore(std::span<const TriangleId> from, const FlipWanted& wanted, std::vector<TriangleId>& changed);
  void restore(const FlipWanted& wanted, std::vector<TriangleId>& changed);  ///< from all triangles

  /// Moves a node without constrained edges, if all triangles around it turn left then. False, and nothing changed,
  /// otherwise. The criterion is not restored.
  bool move_node(NodeId n, Vec2 q);

  /// Removes a node without constrained edges and fills its star without flips, then restores the criterion if one is
  /// given. False, and nothing changed, for any other node. The node keeps its number but is in no triangle.
  bool remove_node(NodeId n, const FlipWanted& wanted, std::vector<TriangleId>& changed);
  bool remove_node(NodeId n);

  /// Gives the vertices other ids, as when those made for one face alone become the body's. REQUIRED: different
  /// vertices keep different ids.
  void rename(const std::function<VertexId(VertexId)>& new_id);

  /// As build, then inserts every former node that was on no constrained edge and lies strictly inside the new domain;
  /// the vertices of the others are listed in `dropped`. On faults the former mesh stays. Node numbers change.
  std::vector<LoopFault> rebuild(const FaceInput& input, std::vector<VertexId>& dropped);

  /// Validity: what is broken and where; empty when valid. Links reciprocal, all triangles turn left exactly,
  /// constraints present.
  std::vector<std::string> check() const;

  /// Replaces the connectivity by another set of triangles over the same nodes (T_Γ after recovery); false if it does
  /// not form a valid surface with the same constrained edges.
  bool replace(const std::vector<std::array<NodeId, 3>>& triangles);

 private:
  friend class FaceMeshBuilder;
  friend class FaceMeshChecker;
  enum class Stop : std::uint8_t { at_boundary, at_constraints };
  /// What splitting a constrained edge at q would do.
  struct SplitPlan {
    PlanarRefusal refusal = PlanarRefusal::none;
    enum class Side : std::uint8_t { on_chord, inside, outside } side = Side::on_chord;
    FaceEdge edge;      ///< the edge as seen from the triangle on q's side (any side if on the chord or outside)
    TriangleId holder;  ///< inside: a triangle that contains q
  };

  /// An edge that is to be asked for, if it is still that of these two nodes.
  struct AwaitingEdge {
    FaceEdge edge;
    NodeId a, b;
  };
  /// How often the boundary winds around a point, by the boundary edges that a ray from it meets.
  struct Ray {
    int winding = 0;
    std::optional<SegmentGrid::Entry> first;    ///< the nearest edge met
    std::optional<SegmentGrid::Entry> touched;  ///< an edge the point lies on
  };

  // face_mesh.cpp
  Vec2 point(NodeId n) const { return nodes_[n].q; }
  bool has_edge(FaceEdge e) const;
  WalkEnd walk(Vec2 q, TriangleId from, Stop stop, std::size_t steps) const;
  std::size_t longest_walk() const { return triangles_.size() + 8; }
  TriangleId nearby_triangle(Vec2 q) const;
  Ray cast(Vec2 q) const;
  std::optional<TriangleId> scan(Vec2 q) const;
  bool contains(TriangleId t, Vec2 q) const;
  FaceEdge mirror(FaceEdge e) const;
  FaceEdge across(FaceEdge e) const;  // as mirror; without a triangle at the boundary
  NodeId add_node(VertexId vertex, Vec2 q);
  TriangleId add_triangle(NodeId a, NodeId b, NodeId c);
  void remove_triangle(TriangleId t);
  void link(FaceEdge a, FaceEdge b);
  void relink(TriangleId neighbour, TriangleId from, TriangleId to);
  void find_pinched();
  void index_boundary();
  bool on_boundary(FaceEdge e) const { return !triangles_[e.triangle].neighbour[e.local].valid(); }
  bool is_constrained(FaceEdge e) const { return triangles_[e.triangle].use[e.local] != -1; }
  std::array<NodeId, 2> ends(FaceEdge e) const;

  // insert.cpp
  void place(NodeId n, TriangleId t, std::vector<TriangleId>& fan);
  void place_in_triangle(NodeId n, TriangleId t, std::vector<TriangleId>& fan);
  void place_on_edge(NodeId n, FaceEdge e, std::vector<TriangleId>& fan);
  void restore_around(std::vector<TriangleId>& changed, const FlipWanted& wanted);
  void await(FaceEdge e);
  void await_edges(TriangleId t);
  void restore_awaiting(const FlipWanted& wanted, std::vector<TriangleId>& changed);
  void flip_star(NodeId n, std::vector<TriangleId>& fan, const FlipWanted& wanted);
  bool can_flip(FaceEdge e) const;
  std::array<TriangleId, 2> flip_edge(FaceEdge e);

  // poles.cpp
  /// Triangles over a pole with one apex, and the nodes of the pole that they use, from right to left.
  struct PoleRun {
    std::vector<TriangleId> cavity;
    std::vector<NodeId> images;
  };
  std::optional<int> pole_apex(TriangleId t) const;
  FaceEdge pass_over_pole(TriangleId t, bool left, PoleRun& run) const;
  std::vector<TriangleId> join_to_pole(std::span<const NodeId> ring, PoleRun& run,
                                       std::vector<std::array<NodeId, 3>> fill);
  std::vector<TriangleId> leave_ring(TriangleId over, const FlipWanted& wanted);
  std::vector<TriangleId> join_ring(FaceEdge below_pole, const FlipWanted& wanted);
  bool touches_pole(FaceEdge edge) const;
  std::vector<TriangleId> flip_at_pole(FaceEdge edge, const FlipWanted& wanted);

  // cavity.cpp
  void recover_edge(NodeId a, NodeId b, std::vector<TriangleId>& made);
  void fill_polygon(std::span<const NodeId> polygon, std::vector<std::array<NodeId, 3>>& out) const;
  void replace_cavity(std::vector<TriangleId>& cavity, std::span<const std::array<NodeId, 3>> fill,
                      std::vector<TriangleId>& made);

  // split.cpp
  SplitPlan plan_split(FaceEdge edge, Vec2 q) const;
  SplitPlan plan_inside(FaceEdge edge, Vec2 q) const;
  SplitPlan plan_outside(FaceEdge edge, Vec2 q) const;
  void split_inside(FaceEdge edge, NodeId n, TriangleId holder, std::vector<TriangleId>& made);
  void split_outside(FaceEdge edge, NodeId n, std::vector<TriangleId>& made);

  IndexedVector<NodeId, FaceNode> nodes_;
  IndexedVector<TriangleId, FaceTriangle> triangles_;
  IndexedVector<NodeId, TriangleId> node_triangle_;
  std::vector<TriangleId> free_;
  NodeIndex index_;
  SegmentGrid boundary_;         // the edges of one triangle, by their nodes as that triangle sees them
  std::vector<NodeId> pinched_;  // nodes where the domain touches itself: more than one fan; sorted
  std::vector<VertexId> poles_;  // at both ends of a boundary edge; few
  bool has_tip_ = false;
  std::size_t constrained_ = 0;  // sides of triangles on constrained edges
  std::vector<TriangleId> scratch_;
  std::vector<AwaitingEdge> awaiting_;
};

}  // namespace curvetet
