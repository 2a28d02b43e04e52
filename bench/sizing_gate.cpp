// Size fields of CAD files: time, smallest size and why, and how many triangles the field implies.
//   sizing_gate FRACTION FILE...      size = diagonal / FRACTION; one line of JSON per file
// Environment: GRADING, MIN_SIZE (over the size); FACES=1: a line per face as well.
// Triangles implied: the integral over the trimmed faces of 1 / area of an equilateral triangle of the field's size.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "cad/load.h"
#include "geometry/trimmed_domain.h"
#include "sizing/size_field.h"

namespace {

using namespace curvetet;

/// Processor time, which a busy machine does not change as much as the time on the wall.
double seconds_since(std::clock_t start) { return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC; }

const char* name_of(SizeReason reason) {
  static constexpr const char* names[] = {"asked",       "curvature", "chord_height", "gap",
                                          "edge_length", "callback",  "outer_loop"};
  return names[static_cast<std::size_t>(reason)];
}

/// Triangles implied on one face, by the middle rule on a grid of its box.
double implied_triangles(const Model& model, FaceId id, const SizeField& field, double& area) {
  const ModelFace& face = model.faces[id];
  const TrimmedDomain domain(model, id);
  const auto surface = face.surface->clone();
  constexpr int kCells = 60;
  const Vec2 step = (1.0 / kCells) * (face.high - face.low);
  double sum = 0;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      const Vec2 uv = face.low + Vec2{(i + 0.5) * step.x, (j + 0.5) * step.y};
      if (!domain.inside(uv)) continue;
      const SurfaceFirst s = surface->first(uv);
      const double cell = norm(cross(s.du, s.dv)) * step.x * step.y;
      const double size = field.at_face(id, s.value);
      area += cell;
      sum += cell / (0.433 * size * size);
    }
  return sum;
}

void print_faces(const Model& model, const SizeField& field) {
  std::vector<SizeReduction> least(model.faces.size());
  for (const SizeReduction& reduction : field.reductions(model)) least[reduction.face.value()] = reduction;
  for (std::size_t i = 0; i < model.faces.size(); ++i) {
    double area = 0;
    const double triangles = implied_triangles(model, FaceId(i), field, area);
    const double size = field.largest();
    const double implied = area > 0 ? std::sqrt(area / (0.433 * triangles)) / size : 0;
    std::printf("  face %u %s area %.4g triangles %.0f mean size %.3g least %.3g %s gap %.3g other %u\n",
                model.faces[FaceId(i)].label.cad_id, name(model.faces[FaceId(i)].surface->kind()), area / (size * size),
                triangles, implied, least[i].size / size, name_of(least[i].reason), least[i].gap / size,
                least[i].other.valid() ? model.faces[least[i].other].label.cad_id : 0);
  }
}

double implied_triangles(const Model& model, const SizeField& field, double& area) {
  double sum = 0;
  area = 0;
  for (std::size_t i = 0; i < model.faces.size(); ++i) sum += implied_triangles(model, FaceId(i), field, area);
  return sum;
}

void run(const std::string& path, double fraction) {
  Context context;
  LoadOptions load;
  load.isolate = false;
  auto loaded = load_model(path, load, context);
  if (!loaded) {
    std::printf("{\"file\":\"%s\",\"error\":\"%s\"}\n", path.c_str(), name(loaded.error().code));
    return;
  }
  const Model& model = loaded.value();
  SizingOptions options;
  options.size = model.diagonal() / fraction;
  options.min_size = options.size / 1000;
  if (const char* grading = std::getenv("GRADING")) options.grading = std::atof(grading);
  if (const char* floor = std::getenv("MIN_SIZE")) options.min_size = options.size * std::atof(floor);
  options.gaps = false;
  auto start = std::clock();
  const auto bending = make_size_field(model, options, context);
  const double bending_time = seconds_since(start);
  options.gaps = true;
  start = std::clock();
  const auto field = make_size_field(model, options, context);
  const double time = seconds_since(start);
  if (!field || !bending) {
    std::printf("{\"file\":\"%s\",\"error\":\"sizing\"}\n", path.c_str());
    return;
  }
  double area = 0;
  const double without_gaps = implied_triangles(model, bending.value(), area);
  const double triangles = implied_triangles(model, field.value(), area);
  SizeReduction least;
  least.size = options.size;
  for (const SizeReduction& reduction : field.value().reductions(model))
    if (reduction.size < least.size) least = reduction;
  std::printf(
      "{\"file\":\"%s\",\"faces\":%zu,\"size\":%.6g,\"seconds\":%.4f,\"seconds_bending\":%.4f,\"sources\":%zu,"
      "\"area_ratio\":%.4g,\"uniform\":%.0f,\"bending\":%.0f,\"all\":%.0f,\"least\":%.3g,\"reason\":\"%s\","
      "\"face\":%d,\"other\":%d,\"gap\":%.3g}\n",
      path.c_str(), model.faces.size(), model.frame.length_to_cad(options.size), time, bending_time,
      field.value().sources().size(), area / (options.size * options.size),
      area / (0.433 * options.size * options.size), without_gaps, triangles, least.size / options.size,
      name_of(least.reason), least.face.valid() ? static_cast<int>(model.faces[least.face].label.cad_id) : 0,
      least.other.valid() ? static_cast<int>(model.faces[least.other].label.cad_id) : 0, least.gap / options.size);
  if (std::getenv("FACES")) print_faces(model, field.value());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: sizing_gate FRACTION FILE...\n");
    return 2;
  }
  for (int i = 2; i < argc; ++i) run(argv[i], std::atof(argv[1]));
  return 0;
}
