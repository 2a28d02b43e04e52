// A picture of a mesh: boundary triangles shaded flat and coloured by CAD face, mesh edges drawn; with a cut, whole
// tets.
#pragma once

#include <optional>
#include <string>

#include "base/error.h"
#include "curvetet/mesh.h"

namespace curvetet {

/// Takes away every tet whose centroid lies on the viewer's side of the plane across `axis` at this fraction of the
/// box.
struct PictureCut {
  int axis = 0;
  double fraction = 0.5;
};

struct PictureOptions {
  int width = 1200, height = 900;  ///< pixels
  std::optional<PictureCut> cut;
};

/// Draws the mesh, seen from the right, the front and above (z up, y to the back), and writes a PNG file whole or not
/// at all. A mesh without tets shows its triangles, uncut.
Status write_picture(const Mesh& mesh, const std::string& path, const PictureOptions& options);

}  // namespace curvetet
