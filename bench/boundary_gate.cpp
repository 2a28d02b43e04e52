// Curve meshes and face meshes of one CAD file at several sizes: a JSON line for each size, with what failed and why.
//   boundary_gate FILE [DIVISOR...]     size = diagonal of the body / divisor; default 5 10 20 50
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "boundary/boundary_check.h"
#include "boundary/boundary_mesh.h"
#include "cad/load.h"
#include "sizing/size_field.h"

namespace {

using namespace curvetet;
using Json = nlohmann::ordered_json;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Area of the loops in the chart, from many samples of the parameter curves.
double exact_chart_area(const Model& model, const ModelFace& face, const Chart& chart) {
  constexpr int kSamples = 200;
  double area = 0;
  for (const Loop& loop : face.loops) {
    for (const EdgeUse& use : loop.uses) {
      const ModelEdge& edge = model.edges[use.edge];
      const auto at = [&](int i) {
        const double share = static_cast<double>(use.reversed ? kSamples - i : i) / kSamples;
        return chart.to_chart(use.curve->value(edge.low + share * (edge.high - edge.low)));
      };
      Vec2 previous = at(0);
      for (int i = 1; i <= kSamples; ++i) {
        const Vec2 next = at(i);
        area += cross(previous, next) / 2;
        previous = next;
      }
    }
  }
  return area;
}

double chart_area(const FaceMesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) {
    const FaceTriangle& triangle = mesh.triangle(TriangleId(t));
    if (!triangle.alive()) continue;
    const Vec2 a = mesh.node(triangle.node[0]).q;
    area += cross(mesh.node(triangle.node[1]).q - a, mesh.node(triangle.node[2]).q - a) / 2;
  }
  return area;
}

/// Largest relative error of a face's area in its chart.
std::pair<double, std::uint32_t> worst_area(const Model& model, const BoundaryMesh& mesh) {
  std::pair<double, std::uint32_t> worst{0, 0};
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    const FaceMesh& face = mesh.faces[FaceId(f)];
    if (face.triangle_count() == 0) continue;
    const double exact = exact_chart_area(model, model.faces[FaceId(f)], face.chart);
    const double error = exact > 0 ? std::abs(chart_area(face) / exact - 1) : 1;
    worst = std::max(worst, std::pair(error, model.faces[FaceId(f)].label.cad_id));
  }
  return worst;
}

void run(const Model& model, double divisor, Json& line) {
  Context context;
  const auto start = std::chrono::steady_clock::now();
  SizingOptions sizing;
  sizing.size = model.diagonal() / divisor;
  sizing.min_size = sizing.size / 1000;
  const Result<SizeField> sizes = make_size_field(model, sizing, context);
  line["sizing_seconds"] = seconds_since(start);
  if (!sizes) {
    line["error"] = sizes.error().message;
    return;
  }
  const auto front = std::chrono::steady_clock::now();
  VertexStore vertices;
  const Result<BoundaryResult> result = mesh_boundary(model, sizes.value(), vertices, {}, context);
  line["seconds"] = seconds_since(front);
  if (!result) {
    line["error"] = result.error().message;
    return;
  }
  const BoundaryMesh& mesh = result.value().mesh;
  std::size_t triangles = 0;
  for (const FaceMesh& face : mesh.faces) triangles += face.triangle_count();
  line["triangles"] = triangles;
  line["vertices"] = vertices.size();
  Json causes = Json::object(), details = Json::array();
  for (const FaceFailure& failure : result.value().failures) {
    causes[failure.cause] = causes.value(failure.cause, 0) + 1;
    if (details.size() < 4) {
      details.push_back("face " + std::to_string(model.faces[failure.face].label.cad_id) + ": " + failure.detail);
    }
  }
  const std::vector<std::string> faults = check_boundary(model, mesh, vertices);
  for (std::size_t i = 0; i < faults.size() && i < 4; ++i) details.push_back(faults[i]);
  const auto [area_error, area_face] = worst_area(model, mesh);
  line["area_error"] = area_error;
  line["area_face"] = area_face;
  line["causes"] = causes;
  line["faults"] = faults.size();
  line["details"] = details;
  line["pass"] = result.value().failures.empty() && faults.empty() && area_error < 0.7;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  std::vector<double> divisors;
  for (int i = 2; i < argc; ++i) divisors.push_back(std::atof(argv[i]));
  if (divisors.empty()) divisors = {5, 10, 20, 50};
  Context context;
  LoadOptions load;
  load.joining.overlaps = Overlaps::split;  // what is tested here are surface meshes, whosever they are
  load.isolate = false;
  const auto start = std::chrono::steady_clock::now();
  const Result<Model> model = load_model(argv[1], load, context);
  const double load_seconds = seconds_since(start);
  for (const double divisor : divisors) {
    Json line;
    line["body"] = argv[1];
    line["divisor"] = divisor;
    line["load_seconds"] = load_seconds;
    if (model) {
      line["faces"] = model.value().faces.size();
      try {
        run(model.value(), divisor, line);
      } catch (const std::exception& e) {
        line["error"] = std::string("internal: ") + e.what();
      }
    } else {
      line["error"] = "load: " + model.error().message;
    }
    if (!line.contains("pass")) line["pass"] = false;
    std::printf("%s\n", line.dump().c_str());
    std::fflush(stdout);
  }
  return 0;
}
