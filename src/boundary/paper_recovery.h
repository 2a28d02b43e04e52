// Recovery by the paper to the letter (`--recovery paper`): first stage by equatorial spheres with its cancel rule
// (section 3.1), then the faces one by one, each locked before the next (3.2), with the remeshing cases 1-4 (3.4) and
// the termination rules (3.5).
//
// Before: as recover_faces, edges recovered without flips. After (complete): as recover_faces.
#pragma once

#include "boundary/face_recovery.h"

namespace curvetet {

struct PaperCounts {
  std::size_t stage_one_points = 0, stage_one_allowed = 0;
  std::size_t case1 = 0, case2 = 0, case3a = 0, case3b = 0, case4 = 0;
};

struct PaperRecoveryResult {
  FaceRecoveryResult recovery;
  PaperCounts counts;
};

Result<PaperRecoveryResult> recover_faces_as_paper(Conjoint& conjoint, const FaceRecoveryOptions& options,
                                                   Context& context);

/// Section 3.1 alone: until the equatorial sphere of every triangle of t_3d holds only adjacent or allowed vertices.
/// Terminates by the cancel rule and the floor.
Status paper_stage_one(Conjoint& conjoint, double floor, PaperCounts& counts, Context& context);

}  // namespace curvetet
