// Solids that touch share what they touch in. Inside cad only.
#pragma once

#include "base/error.h"
#include "cad/body.h"
#include "curvetet/options.h"

namespace curvetet {

/// What fusing found.
enum class Fusing {
  apart,      ///< no two solids touch, or those that do share their faces already; the body is unchanged
  imprinted,  ///< the body is replaced: solids that touch share faces, edges and vertices
  failed,     ///< the kernel failed, or would change a solid; the body is unchanged but for a note
};

/// Imprints solids on each other where they touch and merges what coincides (OpenCASCADE's general fuse). Every solid
/// stays one solid with its volume. Labels follow by the fuse's history: the first part of an entity keeps its id, the
/// others get free ids and its name and colour; of entities that coincide the first lends its label. Notes tell which
/// faces were split and which coincide.
/// Solids that overlap are an error (overlapping_solids, with the pair, the volume and a place), or with
/// Overlaps::split cut into the cells they form: the part that two have in common becomes a solid of its own, named
/// after both; the volumes of a solid's cells add up to its own.
Result<Fusing> fuse_touching(CadBody& body, Overlaps overlaps, const std::string& source);

}  // namespace curvetet
