// The boundary stages under the outer loop: mesh curves and faces, cure crossings, tetrahedralize, recover, classify;
// where that fails, a smaller size at the place of the failure, and again (DESIGN: "the outer loop").
#pragma once

#include <memory>
#include <vector>

#include "boundary/boundary_mesh.h"
#include "boundary/classify.h"
#include "boundary/face_recovery.h"
#include "boundary/paper_recovery.h"
#include "conjoint/conjoint.h"
#include "curvetet/options.h"
#include "curvetet/report.h"
#include "pipeline/settings.h"
#include "pipeline/stage_clock.h"
#include "spatial/tetrahedralization.h"

namespace curvetet {

/// The meshes of a body, which refer to one another and are therefore kept in place.
struct BodyMesh {
  VertexStore vertices;
  BoundaryMesh boundary;
  std::unique_ptr<Conjoint> conjoint;
  std::unique_ptr<Tetrahedralization> tets;
  FaceRecoveryResult recovery;
  CrossingResult crossings;
  PaperCounts paper;  ///< of `--recovery paper`
  ClassifyResult classified;
  IndexedVector<FaceId, std::size_t> initial_points;  ///< vertices of each face mesh before recovery
  std::size_t initial_surface_points = 0;
};

/// Where the outer loop stands: for each round that failed, the sizes that it asked for.
struct OuterLoop {
  std::size_t part = 0;  ///< of the parts that are meshed apart, the one that it runs for
  std::vector<std::vector<SizeSource>> asked;
  int round() const { return static_cast<int>(asked.size()); }
};

struct BodyMesherResult {
  std::unique_ptr<BodyMesh> mesh;
  int rounds = 0;                              ///< of the outer loop that were needed beyond the first
  std::vector<RecoveryFailure> failures;       ///< empty when complete
  IndexedVector<FaceId, RungCounts> restarts;  ///< of the outer loop, for each face that a failure named
};

inline constexpr int kOuterRounds = 6;

/// The vertices that the triangles of a face mesh use, each once (a vertex on a seam is two nodes).
std::vector<VertexId> vertices_of(const FaceMesh& mesh);

/// Begins at the round where `loop` stands, and leaves it where the last attempt was made, whatever became of it.
Result<BodyMesherResult> mesh_body(const Model& model, SizeField& sizes, const Settings& settings,
                                   const Options& options, OuterLoop& loop, StageClock& clock, Context& context);

}  // namespace curvetet
