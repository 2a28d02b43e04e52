// Names of CAD entities in mesh files: physical groups for formats that have them, and label lines that carry what a
// format has no place for.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "curvetet/mesh.h"

namespace curvetet {

/// "vertex_3", "edge_7", "face_12" or "solid_1".
std::string default_name(int dimension, std::uint32_t cad_id);

/// The entities of one dimension, 0 to 3.
const std::vector<Entity>& entities_of(const Mesh& mesh, int dimension);
std::vector<Entity>& entities_of(Mesh& mesh, int dimension);

struct PhysicalGroup {
  std::uint32_t tag = 0;  ///< cad id of the group's first entity
  std::string name;       ///< at most 127 bytes, without quotes and control characters
};

struct PhysicalGroups {
  std::vector<PhysicalGroup> groups;  ///< by ascending tag
  std::vector<std::uint32_t> tag_of_entity;
};

/// One group per entity, vertices included (meshio refuses files in which only some entities have one); entities to
/// which the CAD gave the same name share theirs, all other names are unique.
PhysicalGroups physical_groups(const std::vector<Entity>& entities, int dimension);

/// One JSON object per line, ASCII only and without '$': first the unit, then every entity with its name and colour,
/// and with its box and boundary if asked for.
std::vector<std::string> label_lines(const Mesh& mesh, bool with_geometry);

/// The entities of a mesh that is being read, by dimension and cad id.
class EntityTable {
 public:
  explicit EntityTable(Mesh& mesh) : mesh_(mesh) {}
  /// Index of the entity; appended, without a name, if the mesh does not have it yet.
  std::uint32_t find_or_add(int dimension, std::uint32_t cad_id);
  /// Applies one label line; false if it is not one.
  bool apply_label_line(std::string_view line);
  /// Gives every entity without a name its default name.
  void name_the_unnamed();

 private:
  Mesh& mesh_;
  std::array<std::map<std::uint32_t, std::uint32_t>, 4> index_;
};

}  // namespace curvetet
