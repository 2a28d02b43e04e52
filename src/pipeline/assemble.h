// From the mesher's structures to the plain mesh that users get: vertices compacted, lengths in the output's unit.
#pragma once

#include "conjoint/conjoint.h"
#include "curvetet/mesh.h"
#include "pipeline/settings.h"

namespace curvetet {

/// In Mesh::corner_nodes, of a CAD vertex that no mesh vertex lies at.
inline constexpr std::uint32_t kNoNode = 0xFFFFFFFF;

/// Tets with a region, the triangles of every T_Γ, the segments of every curve mesh. Points are in order along a
/// Hilbert curve, tets as the tetrahedralization has them, the rest by id; so the same bytes each time.
Mesh assemble(const Conjoint& conjoint, const Settings& settings);

/// The body's entities with their labels; faces still without their boundary, all without boxes.
void add_labels(Mesh& mesh, const Model& model);

/// FNV-1a over the bits of points, tets and triangles.
std::uint64_t mesh_hash(const Mesh& mesh);

}  // namespace curvetet
