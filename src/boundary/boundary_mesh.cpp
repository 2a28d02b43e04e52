// The two first stages in order: curves, face meshes on them, points inside the faces, and the cure of what is not
// simplicial. Faces are refined in parallel with ids of their own for new vertices; these join the store face by face,
// so that ids do not depend on the number of threads.

#include "boundary/boundary_mesh.h"

#include <algorithm>

#include "boundary/curve_mesh.h"
#include "boundary/face_mesh_builder.h"
#include "boundary/face_refinement.h"
#include "boundary/simplicial.h"

namespace curvetet {

namespace {

/// Faces in the order of falling area, so that the largest do not come last to an idle machine.
std::vector<std::size_t> by_area(const Model& model) {
  std::vector<std::size_t> order(model.faces.size());
  for (std::size_t f = 0; f < order.size(); ++f) order[f] = f;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return model.faces[FaceId(a)].area > model.faces[FaceId(b)].area;
  });
  return order;
}

Status refine_faces(const Model& model, const SizeField& sizes, VertexStore& vertices, BoundaryMesh& mesh,
                    const BoundaryOptions& options, Context& context) {
  const std::vector<std::size_t> order = by_area(model);
  std::vector<std::vector<AddedVertex>> added(order.size());
  parallel_for(context, order.size(), [&](std::size_t i) {
    const FaceId face(order[i]);
    if (context.should_stop() || mesh.faces[face].triangle_count() == 0) return;
    const std::unique_ptr<Surface> surface = model.faces[face].surface->clone();
    added[face.value()] = refine_face(mesh.faces[face], face, *surface, sizes, vertices, options.smooth_faces, context);
  });
  if (context.should_stop()) return context.stop_error("face meshes");
  std::vector<VertexId> first;
  for (std::size_t f = 0; f < added.size(); ++f) {
    first.emplace_back(vertices.size());
    for (const AddedVertex& v : added[f]) vertices.add(v.position, Owner::of(FaceId(f)), v.uv, Origin::face_mesh);
  }
  parallel_for(context, order.size(), [&](std::size_t i) {
    const std::size_t f = order[i];
    if (added[f].empty()) return;
    mesh.faces[FaceId(f)].rename([&](VertexId v) {
      return v.value() < kLocalVertices ? v : VertexId(v.value() - kLocalVertices + first[f].value());
    });
  });
  return Done{};
}

}  // namespace

Result<BoundaryResult> mesh_boundary(const Model& model, const SizeField& sizes, VertexStore& vertices,
                                     const BoundaryOptions& options, Context& context) {
  BoundaryResult result;
  BoundaryMesh& mesh = result.mesh;
  if (const Status status = mesh_curves(model, sizes, vertices, mesh, context); !status) return status.error();
  if (const Status status = build_face_meshes(model, options, vertices, mesh, result.failures, context); !status) {
    return status.error();
  }
  if (const Status status = refine_faces(model, sizes, vertices, mesh, options, context); !status) {
    return status.error();
  }
  Conjoint conjoint(model, vertices, mesh,
                    [&](FaceId face) { return spatial_criterion(mesh.faces[face], vertices, model.faces[face]); });
  for (const Offence& offence : make_simplicial(conjoint, context)) {
    result.failures.push_back({offence.face, "not simplicial", describe(offence, model), vertices.position(offence.a)});
  }
  if (context.should_stop()) return context.stop_error("face meshes");
  return result;
}

}  // namespace curvetet
