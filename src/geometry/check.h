// Is a Model what the mesher may rely on? Checks what every loader must deliver.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/model.h"

namespace curvetet {

struct ModelFault {
  enum class Kind {
    reference,       ///< an id out of range, an empty range, a missing curve
    vertex_off,      ///< a vertex further from the end of its edge than the tolerances explain
    curve_off,       ///< an edge's curve further from the surface along its parameter curve than the tolerances explain
    loop_open,       ///< consecutive uses of a loop do not join in (u,v)
    inside_out,      ///< the loops of a face bound a negative or zero area in (u,v)
    solid_open,      ///< an edge of a solid's boundary is not used evenly by its faces
    not_finite,      ///< a coordinate that is not a finite number
    crosses_itself,  ///< a face on both sides of its axis, or twice at one place of its surface
  };
  Kind kind = Kind::reference;
  std::string entity;         ///< "face 12"
  std::string what;           ///< one sentence
  double amount = 0;          ///< distance in working units, where there is one
  std::optional<Vec3> where;  ///< in working coordinates, where there is one place
};

const char* name(ModelFault::Kind kind);

struct CheckOptions {
  int samples = 9;        ///< per edge use, ends included
  double slack = 10;      ///< distances may exceed the tolerances of the entities by this factor
  double floor = 1e-6;    ///< and by this part of the body's diagonal in any case
  double largest = 1e-2;  ///< part of the diagonal beyond which no tolerance explains a distance
};

/// All faults, in the order of solids, faces, edges, vertices; empty when the model is sound.
std::vector<ModelFault> check_model(const Model& model, const CheckOptions& options = {});

}  // namespace curvetet
