// A body in parts that are meshed apart: solids that share faces stay together.
#pragma once

#include <vector>

#include "geometry/model.h"

namespace curvetet {

/// Solids of each part, ascending; parts by their first solid. O(faces).
std::vector<std::vector<SolidId>> parts_of(const Model& model);

/// Some of the solids as a body of their own. Frame, box and units are those of the whole, so lengths and places mean
/// the same in both.
struct Part {
  Model model;
  // Of the whole, by the part's own ids; ascending.
  IndexedVector<SolidId, SolidId> solids;
  IndexedVector<FaceId, FaceId> faces;
  IndexedVector<EdgeId, EdgeId> edges;
  IndexedVector<CadVertexId, CadVertexId> vertices;
};

/// Beside the part's faces there is nothing, even where the whole has another solid.
Part make_part(const Model& whole, const std::vector<SolidId>& solids);

}  // namespace curvetet
