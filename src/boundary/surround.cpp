#include "boundary/surround.h"

namespace curvetet {

std::vector<VertexId> add_surrounding(VertexStore& vertices) {
  std::vector<VertexId> corners;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0}) corners.push_back(vertices.add({x, y, z}, Owner{}, {}, Origin::surrounding));
  return corners;
}

}  // namespace curvetet
