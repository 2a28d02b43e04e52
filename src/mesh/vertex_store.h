// All vertices of a mesh: position, owner, parameter, origin. Append-only while meshing.
#pragma once

#include <cstdint>
#include <vector>

#include "base/ids.h"
#include "base/vec.h"

namespace curvetet {

enum class OwnerKind : std::uint8_t { vertex, edge, face, interior };

/// The CAD entity of lowest dimension a vertex lies on.
struct Owner {
  OwnerKind kind = OwnerKind::interior;
  std::uint32_t index = 0;  ///< of the CadVertexId, EdgeId, FaceId or (interior) SolidId
  static Owner of(CadVertexId v) { return {OwnerKind::vertex, v.value()}; }
  static Owner of(EdgeId e) { return {OwnerKind::edge, e.value()}; }
  static Owner of(FaceId f) { return {OwnerKind::face, f.value()}; }
  static Owner of(SolidId s) { return {OwnerKind::interior, s.value()}; }
  friend bool operator==(const Owner&, const Owner&) = default;
};

/// The stage that made a vertex.
enum class Origin : std::uint8_t {
  curve_mesh,
  face_mesh,
  edge_recovery,
  stage_one,
  stage_two,
  ladder,
  steiner,
  interior,
  surrounding  ///< a corner of the cube around the body, in no solid
};

/// Positions are working coordinates on the grid (geometry/frame.h). Ids are never reused; `reorder` alone changes
/// them.
class VertexStore {
 public:
  /// In half a cache line: cavities are grown by positions alone.
  struct alignas(32) Site {
    Vec3 position;
    Owner owner;
  };
  static_assert(sizeof(Vec3) + sizeof(Owner) == 32, "insphere_four reads four doubles of it");

  VertexId add(Vec3 position, Owner owner, Vec2 parameter, Origin origin) {
    sites_.push_back({position, owner});
    parameters_.push_back(parameter);
    origins_.push_back(origin);
    return VertexId(sites_.size() - 1);
  }
  std::size_t size() const { return sites_.size(); }
  Vec3 position(VertexId v) const { return sites_[v.value()].position; }
  Owner owner(VertexId v) const { return sites_[v.value()].owner; }
  /// (u,v) for a vertex on a face, (t,0) for one on an edge, zero otherwise.
  Vec2 parameter(VertexId v) const { return parameters_[v.value()]; }
  Origin origin(VertexId v) const { return origins_[v.value()]; }
  /// For smoothing; the new position must be on the grid.
  void move(VertexId v, Vec3 position) { sites_[v.value()].position = position; }
  void set_owner(VertexId v, Owner owner) { sites_[v.value()].owner = owner; }
  const Site* sites() const { return sites_.data(); }
  /// Renumbers the last vertices: order[k], from `first` on, becomes vertex first + k.
  void reorder(VertexId first, const std::vector<VertexId>& order) {
    const auto permute = [&](auto& all) {
      auto taken = all;
      for (std::size_t k = 0; k < order.size(); ++k) all[first.value() + k] = taken[order[k].value()];
    };
    permute(sites_);
    permute(parameters_);
    permute(origins_);
  }

 private:
  std::vector<Site> sites_;
  std::vector<Vec2> parameters_;
  std::vector<Origin> origins_;
};

}  // namespace curvetet
