// The boundary stages on a model, as the pipeline runs them, with every intermediate result at hand.
#pragma once

#include <memory>

#include "boundary/boundary_mesh.h"
#include "boundary/classify.h"
#include "boundary/face_recovery.h"
#include "boundary/paper_recovery.h"
#include "conjoint/conjoint.h"
#include "sizing/size_field.h"
#include "spatial/tetrahedralization.h"

namespace curvetet::test {

struct BoundaryRun {
  VertexStore vertices;
  BoundaryMesh boundary;
  SizeField sizes;
  std::unique_ptr<Conjoint> conjoint;
  std::unique_ptr<Tetrahedralization> tets;
  CrossingResult crossings;
  FaceRecoveryResult recovery;
  PaperCounts paper;
  ClassifyResult classified;
};

enum class Until { faces, crossings, tets, recovery, classification };

struct BoundaryRunOptions {
  double size = 1;  ///< in the CAD's unit
  double curvature = 12;
  bool gaps = true;
  bool as_paper = false;
  bool smooth = true;                 ///< off: face meshes of which the Delaunay tetrahedralization lacks more
  FaceRecoveryOptions recovery = {};  ///< but for the floor
  int threads = 1;
  Until until = Until::classification;
};

/// Runs the stages; a gtest failure is recorded where a stage returns an error.
std::unique_ptr<BoundaryRun> run_boundary(const Model& model, const BoundaryRunOptions& options);

/// Requirements I-VI of the paper's section 3 on every locked face set, and the conformity of the whole: what is
/// broken.
std::vector<std::string> check_recovered(const Model& model, const BoundaryRun& run);

}  // namespace curvetet::test
