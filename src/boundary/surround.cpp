#include "boundary/surround.h"

namespace curvetet {

void add_surrounding(VertexStore& store, std::vector<VertexId>& vertices) {
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0}) vertices.push_back(store.add({x, y, z}, Owner{}, {}, Origin::surrounding));
}

}  // namespace curvetet
