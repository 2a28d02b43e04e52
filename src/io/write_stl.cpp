// Binary STL of the labelled triangles, for a quick look; single precision, no labels. The header must not begin with
// "solid", by which readers tell the text form.
#include <cmath>
#include <cstdint>
#include <string>

#include "base/vec.h"
#include "io/writers.h"

namespace curvetet {

void write_stl(const Mesh& mesh, OutputFile& file) {
  std::string header = "curvetet boundary, unit " + mesh.unit;
  header.resize(80, ' ');
  file.put(header);
  file.raw(static_cast<std::uint32_t>(mesh.triangles.size()));
  const auto put = [&](Vec3 v) {
    for (int i = 0; i < 3; ++i) file.raw(static_cast<float>(v[i]));
  };
  const auto at = [&](std::uint32_t node) {
    return Vec3{mesh.points[node][0], mesh.points[node][1], mesh.points[node][2]};
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    put(normalized(cross(at(b) - at(a), at(c) - at(a))));
    put(at(a));
    put(at(b));
    put(at(c));
    file.raw(std::uint16_t{0});
  }
}

}  // namespace curvetet
