// Meshes of parts of a body, which share no nodes, as one mesh with the labels of the whole.
#pragma once

#include "curvetet/mesh.h"
#include "curvetet/report.h"
#include "geometry/parts.h"
#include "pipeline/settings.h"

namespace curvetet {

/// The whole's settings with the local sizes that concern the part.
Settings settings_of(const Part& part, const Settings& whole);

/// Entities of the whole without elements.
Mesh empty_mesh(const Model& whole, const Settings& settings);
/// Appends elements, and the entities' boundaries and boxes. A CAD vertex that several parts share keeps the first
/// one's node.
void append(Mesh& mesh, const Mesh& of_part, const Part& part);

/// Puts faces and solids of the report into the order of the mesh's entities.
void sort_entities(Report& report, const Mesh& mesh);

}  // namespace curvetet
