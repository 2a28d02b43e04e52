// How wide faces are. Inside cad only.
#pragma once

#include <cstdint>
#include <vector>

#include "cad/body.h"

namespace curvetet {

struct NarrowFace {
  std::uint32_t cad_id = 0;
  double width = 0, area = 0;
  Vec3 place;            ///< the middle of its area
  bool compact = false;  ///< its whole extent is below the length, not its width alone
};

/// What to list of a face of the body, known by its id, that is taken out of it.
SuppressedDetail detail_of(const CadBody& body, const NarrowFace& face);

/// The faces of solids that are narrower than `length`, in sets that hang together by edges; in the order of the shape.
/// The width of a face is that of a rectangle with its area and outline, or the second largest side of its box, turned
/// to fit, whichever is less: a ring is as narrow as it is wide, a bore as its diameter.
std::vector<std::vector<NarrowFace>> narrow_faces(const CadBody& body, double length);

}  // namespace curvetet
