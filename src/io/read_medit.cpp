// Medit's .mesh in text, ours and that of other programs (MMG, Gmsh). References become cad ids. Keywords whose content
// a Mesh has no place for are skipped only if they hold no elements of space.
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "io/mesh_builder.h"
#include "io/readers.h"
#include "io/scanner.h"

namespace curvetet {

namespace {

/// Numbers per line of the keywords that are skipped.
int numbers_to_skip(std::string_view keyword) {
  struct Skipped {
    std::string_view keyword;
    int numbers;
  };
  constexpr Skipped kSkipped[] = {{"Ridges", 1},
                                  {"RequiredVertices", 1},
                                  {"RequiredEdges", 1},
                                  {"RequiredTriangles", 1},
                                  {"RequiredTetrahedra", 1},
                                  {"Normals", 3},
                                  {"Tangents", 3},
                                  {"NormalAtVertices", 2},
                                  {"TangentAtVertices", 2}};
  for (const Skipped& skipped : kSkipped) {
    if (skipped.keyword == keyword) return skipped.numbers;
  }
  return 0;
}

class MeditReader {
 public:
  explicit MeditReader(std::string_view file) : in_(file) {}
  Mesh read();

 private:
  std::string_view keyword();
  void read_vertices();
  void read_elements(int dimension);
  void read_corners();
  void add_corners();

  Scanner in_;
  MeshBuilder builder_;
  std::vector<std::int64_t> vertex_references_;
  std::vector<std::uint64_t> corners_;
};

/// The next keyword; comments before it are skipped, or applied if they are labels of ours. Empty at the end.
std::string_view MeditReader::keyword() {
  for (in_.skip_blanks(); in_.rest().starts_with('#'); in_.skip_blanks()) {
    const std::string_view comment = in_.line(), own = "#curvetet ";
    if (comment.starts_with(own) && !builder_.entities().apply_label_line(comment.substr(own.size()))) {
      in_.fail("a #curvetet comment is not a label");
    }
  }
  return in_.at_end() ? std::string_view() : in_.word();
}

void MeditReader::read_vertices() {
  for (auto n = in_.number<std::uint64_t>(); n > 0; --n) {
    Point point{};
    for (double& coordinate : point) coordinate = in_.number<double>();
    vertex_references_.push_back(in_.number<std::int64_t>());
    builder_.add_node(vertex_references_.size(), point, MeshBuilder::kUnknown, 0, {});
  }
}

void MeditReader::read_elements(int dimension) {
  const std::size_t corners = static_cast<std::size_t>(dimension) + 1;
  std::array<std::uint64_t, 4> nodes{};
  const auto n = in_.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < n; ++i) {
    for (std::size_t c = 0; c < corners; ++c) nodes[c] = in_.number<std::uint64_t>();
    builder_.add_element(dimension, i, in_.number<std::int64_t>(), std::span(nodes).first(corners));
  }
}

void MeditReader::read_corners() {
  for (auto n = in_.number<std::uint64_t>(); n > 0; --n) corners_.push_back(in_.number<std::uint64_t>());
}

/// The reference of a corner is its vertex; where references do not tell the corners apart, they are numbered.
void MeditReader::add_corners() {
  std::set<std::int64_t> references;
  for (const std::uint64_t node : corners_) {
    if (node < 1 || node > vertex_references_.size()) throw BadFile{"a corner is no vertex of the mesh"};
    if (vertex_references_[node - 1] > 0) references.insert(vertex_references_[node - 1]);
  }
  const bool distinct = references.size() == corners_.size();
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const std::int64_t vertex = distinct ? vertex_references_[corners_[i] - 1] : static_cast<std::int64_t>(i) + 1;
    builder_.add_element(0, i, vertex, std::span(&corners_[i], 1));
  }
}

Mesh MeditReader::read() {
  for (std::string_view word = keyword(); !word.empty() && word != "End"; word = keyword()) {
    if (word == "MeshVersionFormatted") {
      in_.number<int>();
    } else if (word == "Dimension") {
      if (in_.number<int>() != 3) in_.fail("only meshes of dimension 3 are read");
    } else if (word == "Vertices") {
      read_vertices();
    } else if (word == "Edges") {
      read_elements(1);
    } else if (word == "Triangles") {
      read_elements(2);
    } else if (word == "Tetrahedra") {
      read_elements(3);
    } else if (word == "Corners") {
      read_corners();
    } else if (const int numbers = numbers_to_skip(word); numbers > 0) {
      for (auto n = in_.number<std::uint64_t>(); n > 0; --n) {
        for (int i = 0; i < numbers; ++i) in_.number<double>();
      }
    } else {
      in_.fail("the keyword '" + Scanner::shown(word) + "' is not read");
    }
  }
  add_corners();
  return builder_.finish();
}

}  // namespace

Mesh read_medit(std::string_view file) { return MeditReader(file).read(); }

}  // namespace curvetet
