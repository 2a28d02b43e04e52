// Loads CAD files and checks the models: a line per file with counts, time and faults. Names of files are read from
// standard input, one per line, relative to the folder given as first argument. With --isolate each is read in a helper
// process.
#include <chrono>
#include <cstdio>
#include <iostream>
#include <map>
#include <string>

#include "cad/load.h"
#include "geometry/check.h"

namespace {

void print_model(const std::string& file, const curvetet::Model& model, double seconds) {
  std::map<std::string, int> kinds;
  double worst = 0;
  for (const curvetet::ModelFault& fault : curvetet::check_model(model)) {
    ++kinds[curvetet::name(fault.kind)];
    worst = std::max(worst, fault.amount);
  }
  std::size_t degenerate = 0, internal = 0;
  for (const curvetet::ModelEdge& edge : model.edges) degenerate += edge.degenerate ? 1 : 0;
  for (const curvetet::ModelFace& face : model.faces) internal += face.internal_edges.size();
  double volume = 0, area = 0;
  for (const curvetet::ModelSolid& solid : model.solids) volume += solid.volume;
  for (const curvetet::ModelFace& face : model.faces) area += face.area;
  const double scale = model.frame.scale;
  std::printf(
      "%s\tmodel\t%.3f\tsolids=%zu faces=%zu edges=%zu vertices=%zu degenerate=%zu internal=%zu volume=%.9g "
      "area=%.9g diag=%.9g notes=%zu worst=%.3g\t",
      file.c_str(), seconds, model.solids.size(), model.faces.size(), model.edges.size(), model.vertices.size(),
      degenerate, internal, volume / (scale * scale * scale), area / (scale * scale), model.diagonal() / scale,
      model.healing.size(), worst);
  for (const auto& [kind, count] : kinds) std::printf("%s=%d ", kind.c_str(), count);
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "--cad-helper") return curvetet::run_cad_helper(argc, argv);
  const std::string folder = argc > 1 ? argv[1] : ".";
  curvetet::LoadOptions options;
  options.isolate = argc > 2 && std::string(argv[2]) == "--isolate";
  options.helper = "/proc/self/exe";
  for (std::string file; std::getline(std::cin, file);) {
    curvetet::Context context;
    const auto start = std::chrono::steady_clock::now();
    const auto model = curvetet::load_model(folder + "/" + file, options, context);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (model) {
      print_model(file, model.value(), seconds);
    } else {
      std::printf("%s\terror\t%.3f\t%s\t%s\n", file.c_str(), seconds, curvetet::name(model.error().code),
                  model.error().message.c_str());
    }
    std::fflush(stdout);
  }
  return 0;
}
