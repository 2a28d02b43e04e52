// Inside the room: the parts of check_against_model().
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "quality/checks.h"

namespace curvetet::checks {

/// The mesh in the model's terms. Lengths are working units.
struct MeshOnModel {
  const Mesh& mesh;
  const Model& model;
  const Topology& topology;
  double unit_scale = 1;
  double least_limit = 0;         ///< distance to the CAD that is forgiven in any case
  std::vector<Vec3> points;       ///< working coordinates
  std::vector<double> tolerance;  ///< by node: the largest of the CAD edges and vertices it is labelled with
  std::vector<FaceId> faces;      ///< by face entity of the mesh; invalid: not in the model
  std::vector<EdgeId> edges;
  std::vector<SolidId> solids;
  std::vector<CadVertexId> vertices;
  IndexedVector<FaceId, std::vector<std::uint32_t>> triangles;  ///< boundary triangles of each face

  double limit(double entity_tolerance, std::uint32_t node) const;
  double to_mesh_length(double working) const { return working / model.frame.scale * unit_scale; }
  std::string place_of(Vec3 working) const { return place(unit_scale * model.frame.to_cad(working)); }
};

/// Where a point is closest to a surface.
struct Foot {
  Vec2 uv;
  double distance = 0;
  bool inside_box = false;  ///< of the trimmed domain, up to periods and a margin
};

/// Projects points on one CAD face; for one thread.
class FaceProjector {
 public:
  explicit FaceProjector(const ModelFace& face);
  /// Closest of the feet found from the guesses, those inside the domain's box first. From a grid of samples if none of
  /// them is inside and within `near_enough`, and from a fine grid if that is finite and still not reached.
  std::optional<Foot> project(Vec3 point, std::span<const Vec2> guesses, double near_enough);
  /// Closest to the point within the domain's box, of what the guess and a grid of samples lead to.
  Vec2 closest(Vec3 point, Vec2 guess);
  Vec3 outward_normal(Vec2 uv) const;
  /// Whether a triangle with that outward normal looks away from the face where this is closest to its centroid, of
  /// which `foot` is the foot that `project` found.
  bool looks_away(Vec3 centroid, Vec3 normal, const Foot& foot);
  Vec3 value(Vec2 uv) const { return surface_->value(uv); }

 private:
  struct Grid {
    std::vector<Vec2> uv;
    std::vector<Vec3> value;
    void fill(const ModelFace& face, const Surface& surface, int samples);
    std::vector<Vec2> nearest(Vec3 point) const;
  };
  bool inside_box(Vec2 uv) const;
  /// From a place within the domain's box to one that is no farther from the point, without leaving the box.
  Vec2 descend(Vec3 point, Vec2 uv) const;
  void consider(Vec3 point, Vec2 guess, std::optional<Foot>& best) const;

  const ModelFace& face_;
  std::unique_ptr<Surface> surface_;
  Grid coarse_, fine_;
};

/// Triangles of every face against its surface. Adds to each solid the volume that may lie between facets and surfaces.
void check_faces(const MeshOnModel& m, Context& context, Findings& findings, std::vector<double>& solid_slack);
/// Every CAD edge a chain of mesh edges that the right number of triangles share.
void check_curves(const MeshOnModel& m, Context& context, Findings& findings);

}  // namespace curvetet::checks
