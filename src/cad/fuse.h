// Solids that touch share what they touch in. Inside cad only.
#pragma once

#include "cad/body.h"

namespace curvetet {

/// What fusing found.
enum class Fusing {
  apart,      ///< no two solids touch, or those that do share their faces already; the body is unchanged
  imprinted,  ///< the body is replaced: solids that touch share faces, edges and vertices
  failed,     ///< the kernel failed, or solids overlap; the body is unchanged but for a note
};

/// Imprints solids on each other where they touch and merges what coincides (OpenCASCADE's general fuse). Every solid
/// stays one solid with its volume. Labels follow by the fuse's history: the first part of an entity keeps its id, the
/// others get free ids and its name and colour; of entities that coincide the first lends its label. Notes tell which
/// faces were split and which coincide.
Fusing fuse_touching(CadBody& body);

}  // namespace curvetet
