// Visible are the facets that belong to exactly one of the tets kept; a facet that is also a labelled triangle has the
// colour of its CAD face, any other was laid open by the cut. The view is orthographic, so that lengths can be
// compared.
#include "io/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"
#include "io/drawing.h"
#include "io/formats.h"

namespace curvetet {

namespace {

constexpr std::int64_t kCutOpen = -1;

/// A facet to draw: its nodes, and its CAD face or kCutOpen.
struct Facet {
  std::array<std::uint32_t, 3> nodes{};
  std::int64_t face = kCutOpen;
};

/// From CAD coordinates to the picture's.
struct View {
  Vec3 right, up, towards_viewer;
  Vec3 centre;
  double scale = 1;
  Vec2 middle;
  Vec3 on_picture(const Vec3& p) const {
    const Vec3 d = p - centre;
    return {middle.x + scale * dot(d, right), middle.y - scale * dot(d, up), -scale * dot(d, towards_viewer)};
  }
};

Vec3 at(const Mesh& mesh, std::uint32_t node) {
  const Point& p = mesh.points[node];
  return {p[0], p[1], p[2]};
}

std::array<std::uint32_t, 3> sorted(std::array<std::uint32_t, 3> nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

View view_of(const Mesh& mesh, const PictureOptions& options) {
  View view;
  view.towards_viewer = normalized({0.85, -1.4, 0.95});
  view.right = normalized(cross({0, 0, 1}, view.towards_viewer));
  view.up = cross(view.towards_viewer, view.right);
  Box3 box;
  for (std::uint32_t i = 0; i < mesh.points.size(); ++i) box.extend(at(mesh, i));
  view.centre = 0.5 * box.low + 0.5 * box.high;
  Vec2 low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};
  for (std::uint32_t i = 0; i < mesh.points.size(); ++i) {
    const Vec3 p = view.on_picture(at(mesh, i));
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  constexpr double kFilled = 0.9;  // of the picture, the rest is margin
  view.scale = kFilled * std::min(options.width / std::max(high.x - low.x, 1e-300),
                                  options.height / std::max(high.y - low.y, 1e-300));
  view.middle = {options.width / 2.0 - view.scale * (low.x + high.x) / 2,
                 options.height / 2.0 - view.scale * (low.y + high.y) / 2};
  return view;
}

/// Which tets the cut leaves.
std::vector<bool> kept_tets(const Mesh& mesh, const View& view, const std::optional<PictureCut>& cut) {
  std::vector<bool> kept(mesh.tets.size(), true);
  if (!cut) return kept;
  Box3 box;
  for (std::uint32_t i = 0; i < mesh.points.size(); ++i) box.extend(at(mesh, i));
  const double side = view.towards_viewer[cut->axis] < 0 ? -1 : 1;
  const double plane = (1 - cut->fraction) * box.low[cut->axis] + cut->fraction * box.high[cut->axis];
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    double centroid = 0;
    for (const std::uint32_t node : mesh.tets[t]) centroid += at(mesh, node)[cut->axis] / 4;
    kept[t] = side * (centroid - plane) < 0;
  }
  return kept;
}

/// The facets of exactly one kept tet, with the face of the labelled triangle that they are, if any.
std::vector<Facet> visible_facets(const Mesh& mesh, const std::vector<bool>& kept) {
  std::vector<Facet> labelled;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    labelled.push_back({sorted(mesh.triangles[i]), mesh.faces[mesh.triangle_face[i]].cad_id});
  }
  if (mesh.tets.empty()) return labelled;
  const auto by_nodes = [](const Facet& a, const Facet& b) { return a.nodes < b.nodes; };
  std::sort(labelled.begin(), labelled.end(), by_nodes);
  std::vector<Facet> all, single;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!kept[t]) continue;
    const auto& [a, b, c, d] = mesh.tets[t];
    for (const auto& nodes : {sorted({b, c, d}), sorted({a, c, d}), sorted({a, b, d}), sorted({a, b, c})}) {
      all.push_back({nodes, kCutOpen});
    }
  }
  std::sort(all.begin(), all.end(), by_nodes);
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i + 1;
    while (end < all.size() && all[end].nodes == all[i].nodes) ++end;
    if (end == i + 1) {
      const auto label = std::lower_bound(labelled.begin(), labelled.end(), all[i], by_nodes);
      if (label != labelled.end() && label->nodes == all[i].nodes) all[i].face = label->face;
      single.push_back(all[i]);
    }
    i = end;
  }
  return single;
}

Rgb from_hue(double hue, double saturation, double value) {
  Rgb rgb{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double place = std::fmod(hue + (i == 0 ? 1.0 : i == 1 ? 2.0 / 3 : 1.0 / 3), 1.0);
    const double ramp = std::clamp(std::abs(6 * place - 3) - 1, 0.0, 1.0);
    rgb[i] = static_cast<float>(value * (1 - saturation * (1 - ramp)));
  }
  return rgb;
}

/// Neighbouring ids get hues far apart: steps of the golden ratio, in the circle of hues without the yellow of the cut.
Rgb colour_of(std::int64_t face) {
  if (face == kCutOpen) return {1.0F, 0.84F, 0.3F};
  const double turns = 0.55 + 0.6180339887498949 * static_cast<double>(face);
  return from_hue(0.2 + 0.87 * (turns - std::floor(turns)), 0.36, 0.97);
}

Rgb shaded(const Rgb& colour, double light) {
  Rgb result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = static_cast<float>(light) * colour[i];
  return result;
}

class Painter {
 public:
  Painter(const Mesh& mesh, const PictureOptions& options)
      : mesh_(mesh), view_(view_of(mesh, options)), canvas_(options.width, options.height, samples(options)) {
    for (const auto& [a, b] : mesh.segments) segments_.push_back({std::min(a, b), std::max(a, b)});
    std::sort(segments_.begin(), segments_.end());
  }

  bool paint(const std::optional<PictureCut>& cut) {
    const std::vector<Facet> facets = visible_facets(mesh_, kept_tets(mesh_, view_, cut));
    for (const Facet& facet : facets) paint(facet);
    return !facets.empty();
  }
  std::vector<std::uint8_t> pixels() const { return canvas_.pixels(); }

 private:
  static int samples(const PictureOptions& options) {
    const double pixels = double(options.width) * options.height;
    return pixels <= 4e6 ? 3 : pixels <= 16e6 ? 2 : 1;
  }

  /// A light at the viewer's left shoulder over an even base; facets are seen from both sides.
  double light_on(const Facet& facet) const {
    const Vec3 a = at(mesh_, facet.nodes[0]), b = at(mesh_, facet.nodes[1]), c = at(mesh_, facet.nodes[2]);
    Vec3 normal = normalized(cross(b - a, c - a));
    if (dot(normal, view_.towards_viewer) < 0) normal = -normal;
    const Vec3 lamp = normalized(view_.towards_viewer + 0.75 * view_.up - 0.45 * view_.right);
    return 0.58 + 0.28 * std::max(0.0, dot(normal, lamp)) + 0.16 * std::max(0.0, dot(normal, view_.towards_viewer));
  }

  bool on_cad_edge(std::uint32_t a, std::uint32_t b) const {
    return std::binary_search(segments_.begin(), segments_.end(),
                              std::array<std::uint32_t, 2>{std::min(a, b), std::max(a, b)});
  }

  void paint(const Facet& facet) {
    DrawnTriangle triangle;
    double longest = 1e-12;
    for (std::size_t i = 0; i < 3; ++i) triangle.corner[i] = view_.on_picture(at(mesh_, facet.nodes[i]));
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 d = triangle.corner[(i + 1) % 3] - triangle.corner[i];
      longest = std::max(longest, std::hypot(d.x, d.y));
    }
    triangle.fill = shaded(colour_of(facet.face), light_on(facet));
    triangle.line = shaded(triangle.fill, 0.35);
    // Where elements are hardly larger than pixels, lines would leave nothing else to be seen.
    const Vec3 u = triangle.corner[1] - triangle.corner[0], v = triangle.corner[2] - triangle.corner[0];
    const double height = std::abs(u.x * v.y - u.y * v.x) / longest;
    const double thin = std::clamp((height - 1.5) / 7, 0.0, 1.0) * 0.5;
    for (std::size_t i = 0; i < 3; ++i) {
      const bool thick = on_cad_edge(facet.nodes[(i + 1) % 3], facet.nodes[(i + 2) % 3]);
      triangle.half_width[i] = thick ? std::max(thin, 0.4) * 2.6 : thin;
    }
    canvas_.draw(triangle);
  }

  const Mesh& mesh_;
  View view_;
  Canvas canvas_;
  std::vector<std::array<std::uint32_t, 2>> segments_;
};

}  // namespace

Status write_picture(const Mesh& mesh, const std::string& path, const PictureOptions& options) {
  CURVETET_CHECK(options.width > 0 && options.height > 0);
  double largest = 0;
  for (const Point& point : mesh.points) {
    for (const double coordinate : point) largest = std::max(largest, std::abs(coordinate));
  }
  if (!(largest < 1e150)) return Error{ErrorCode::not_finite, "the mesh is too large to be drawn"};
  Painter painter(mesh, options);
  if (!painter.paint(options.cut)) {
    return Error{
        ErrorCode::no_faces, "there is nothing to draw", {}, {}, "cut elsewhere, or look whether the mesh is empty"};
  }
  return write_png(path, painter.pixels(), options.width, options.height);
}

}  // namespace curvetet
