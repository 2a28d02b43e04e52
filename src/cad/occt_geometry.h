// OpenCASCADE's curves and surfaces as ours, in working coordinates. What is analytic becomes our own formulas with the
// same parametrisation; the rest keeps an OpenCASCADE evaluator, one per clone.
#pragma once

#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <gp_XYZ.hxx>
#include <memory>

#include "geometry/frame.h"
#include "geometry/surface.h"

namespace curvetet {

Vec3 to_vec(const gp_XYZ& p);

/// A closed surface that OpenCASCADE does not call periodic (a B-spline whose ends meet) is made periodic.
std::unique_ptr<Surface> make_surface(const Handle(Geom_Surface) & surface, const Frame& frame);

std::unique_ptr<Curve> make_curve(const Handle(Geom_Curve) & curve, const Frame& frame);

/// Where the parameter curve of an edge use runs: t of the edge is mapped to `scale * t + offset` of the curve, and the
/// result is moved by `shift` (multiples of the surface's periods).
struct ParameterMap {
  double scale = 1, offset = 0;
  Vec2 shift{};
};
std::unique_ptr<ParameterCurve> make_parameter_curve(const Handle(Geom2d_Curve) & curve, const ParameterMap& map);

}  // namespace curvetet
