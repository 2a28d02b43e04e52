// The end of the ladder for a stuck hole (the paper's section 3.5): t_3d as it is, facet by facet.
#pragma once

#include "boundary/face_recovery.h"

namespace curvetet {

/// Before: segments are kept, faces that are complete are locked. Makes facets of the missing triangles of a face by
/// flips, then by filling, with points in the volume where nothing else closes a hole. Only where these triangles cross
/// no other of the face and no locked facet, exactly; otherwise nothing is changed. The certificate and the points are
/// counted in `result`. True: every triangle of t_3d is a facet, which the caller locks. False: a failure says which
/// faces cross, or what is left. Terminates: each pass but the last recovers a facet.
bool fall_back(Conjoint& conjoint, FaceId face, FaceRecoveryResult& result, const Context& context);

}  // namespace curvetet
