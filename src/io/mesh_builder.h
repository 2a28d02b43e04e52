// Gathers what a mesh file says, in the file's order and tags, and makes the Mesh of it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "curvetet/mesh.h"
#include "io/labels.h"

namespace curvetet {

/// Nodes and elements are put in the order of their tags. All functions throw BadFile on what cannot be a mesh.
class MeshBuilder {
 public:
  static constexpr std::uint8_t kUnknown = 255;  ///< dimension of a node that the file does not classify

  MeshBuilder() : entities_(mesh_) { mesh_.unit.clear(); }
  MeshBuilder(const MeshBuilder&) = delete;
  MeshBuilder& operator=(const MeshBuilder&) = delete;

  Mesh& mesh() { return mesh_; }
  EntityTable& entities() { return entities_; }

  /// A node on the entity with this cad id, or anywhere if the dimension is kUnknown.
  void add_node(std::uint64_t tag, const Point& point, std::uint8_t dimension, std::int64_t cad_id,
                std::array<double, 2> parameter);
  /// Parameters of a node on an edge or face; may come before or after the node.
  void set_parameter(std::uint64_t tag, std::array<double, 2> parameter);
  /// An element with dimension + 1 nodes.
  void add_element(int dimension, std::uint64_t tag, std::int64_t cad_id, std::span<const std::uint64_t> nodes);
  /// Puts everything in order; nodes that the file does not classify belong to the entity of lowest dimension whose
  /// elements use them. The builder is used up.
  Mesh finish();

 private:
  struct Elements {
    std::vector<std::uint64_t> tags, nodes;
    std::vector<std::uint32_t> entities;
  };
  void order_nodes();
  void apply_parameters();
  std::uint32_t node_of(std::uint64_t tag) const;
  template <std::size_t N>
  void take_elements(int dimension, std::vector<std::array<std::uint32_t, N>>& nodes,
                     std::vector<std::uint32_t>& entity_of);
  void take_corners();
  void classify_nodes();

  Mesh mesh_;
  EntityTable entities_;
  std::vector<std::uint64_t> node_tags_;
  std::vector<std::uint64_t> parameter_tags_;
  std::vector<std::array<double, 2>> parameters_;
  std::array<Elements, 4> elements_;
};

}  // namespace curvetet
