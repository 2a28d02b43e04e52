// The size field: the largest edge length wanted at each point, the minimum of user sizes, curvature, chord height and
// gaps, graded. All lengths in working coordinates.
//
// After: size > 0 everywhere; |h(x) - h(y)| <= grading * |x - y| away from a user's callback. min_size is a floor of
// derived sizes (curvature, chord height, gap, edge length); sizes that were asked for, and those of the outer loop,
// may be smaller.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "base/context.h"
#include "base/error.h"
#include "geometry/model.h"

namespace curvetet {

struct SizingOptions {
  double size = 0;             ///< largest edge length wanted; > 0
  double min_size = 0;         ///< floor of curvature- and gap-driven sizes
  double curvature = 12;       ///< elements per full turn; 0: off
  double free_form_floor = 0;  ///< floor of what the curvature of others than analytic surfaces and conics asks for
  double chord_height = 0;     ///< largest distance of a chord to its arc; 0: off
  double grading = 0.5;        ///< growth of size over distance
  bool gaps = true;            ///< chord height at most a quarter of the local gap
  std::map<std::uint32_t, double> face_size;  ///< by index of FaceId
  std::map<std::uint32_t, double> edge_size;
  std::map<std::uint32_t, double> solid_size;
  std::function<double(Vec3)> callback;  ///< may be called from several threads
};

enum class SizeReason : std::uint8_t {
  asked,
  curvature,
  chord_height,
  gap,
  narrow_face,
  edge_length,
  callback,
  outer_loop
};

/// A point where the size is smaller than asked, and why.
struct SizeSource {
  Vec3 where;
  double size = 0;
  SizeReason reason = SizeReason::asked;
  FaceId face;   ///< whose sample it is, if any
  FaceId other;  ///< gap: the face on the far side
  double gap = 0;
};

/// Per face: the smallest size and its reason, for the report.
struct SizeReduction {
  FaceId face, other;
  SizeReason reason = SizeReason::asked;
  double size = 0, gap = 0;
  Vec3 where;
};

class SizeField {
 public:
  SizeField() = default;
  SizeField(const std::vector<SizeSource>& sources, const SizingOptions& options);
  /// Size at a point; thread-safe (as far as the callback is). O(log n) on average.
  double at(Vec3 p) const;
  /// As at(), further bounded by the sizes asked for the entity.
  double at_face(FaceId face, Vec3 p) const;
  double at_edge(EdgeId edge, Vec3 p) const;
  double at_solid(SolidId solid, Vec3 p) const;
  /// The least size asked for the entity, or for one that it bounds; infinite if none was.
  double face_limit(FaceId face) const;
  double edge_limit(EdgeId edge) const;
  /// Lets the sizes asked for a solid bound its faces, and those of a face bound its edges.
  void spread_limits(const Model& model);
  double largest() const { return options_.size; }
  /// The least size of all sources and of all entities that a size was asked for; a callback may go below it.
  double smallest() const;
  const SizingOptions& options() const { return options_; }
  /// Adds sources (the outer loop's) and rebuilds.
  void add(const std::vector<SizeSource>& more);
  /// The smallest own source of each face that has one below the largest size; ascending by face. Each source keeps the
  /// gap that caused it, so that a size held up by min_size can be told: gap > 0 and size == min_size.
  std::vector<SizeReduction> reductions(const Model& model) const;
  const std::vector<SizeSource>& sources() const { return sources_; }

 private:
  struct Tree;
  SizingOptions options_;
  std::map<std::uint32_t, double> face_limit_, edge_limit_;  ///< asked sizes, spread to the entities below
  std::vector<SizeSource> sources_;
  std::shared_ptr<const Tree> tree_;
};

/// Samples the boundary (curves and faces), measures curvature and gaps (shrinking balls against every sheet that is
/// not the sample's own neighbourhood, the same face included), and makes the field.
Result<SizeField> make_size_field(const Model& model, const SizingOptions& options, Context& context);

}  // namespace curvetet
