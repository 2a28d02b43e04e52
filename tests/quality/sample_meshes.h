// Good meshes of the analytic bodies, made by formula, for the validator to accept and for mutations to spoil.
#pragma once

#include "curvetet/mesh.h"
#include "geometry/model.h"

namespace curvetet::test {

/// Boxes side by side along x, each divided into n^3 cells of six tets; fits make_boxes().
Mesh mesh_boxes(const Model& model, const std::vector<double>& lengths, double y, double z, int n);
/// Fans of wedges around the axis; fits make_cylinder().
Mesh mesh_cylinder(const Model& model, double radius, double height, int sectors);
/// Octahedra refined `levels` times and thrown on spheres of these radii, ascending, with tets between; the innermost
/// ball is filled from its centre if `filled`. Layer k gets solid `solid[k]`. Fits make_ball(), make_shell() and
/// make_nested_balls().
Mesh mesh_balls(const Model& model, const std::vector<double>& radii, bool filled,
                const std::vector<std::uint32_t>& solid, int levels);

}  // namespace curvetet::test
