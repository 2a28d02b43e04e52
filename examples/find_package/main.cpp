// Meshes a CAD file, says what was made of each solid, and writes the mesh.
// usage: mesh_a_part PART.step PART.msh
#include <curvetet/curvetet.h>
#include <curvetet/formats.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: mesh_a_part PART.step PART.msh\n", stderr);
    return 2;
  }
  curvetet::Options options;
  options.curvature = 16;  // elements per full turn

  curvetet::Context context;  // progress, log, cancel
  context.on_progress = [](std::string_view stage, double fraction) {
    std::fprintf(stderr, "%3.0f %% %.*s\n", 100 * fraction, static_cast<int>(stage.size()), stage.data());
  };

  const curvetet::Result<curvetet::MeshOutput> made = curvetet::mesh({argv[1]}, options, context);
  if (!made) {
    std::fprintf(stderr, "%s\n%s\n", made.error().message.c_str(), made.error().hint.c_str());
    return curvetet::exit_code(made.error().code);
  }

  const curvetet::Report& report = made.value().report;
  for (const curvetet::SolidReport& solid : report.solids) {
    std::printf("%s: %zu tetrahedra, volume %g %s^3\n", solid.name.c_str(), solid.tets, solid.volume,
                report.unit.c_str());
  }
  if (!report.valid) return 5;
  const curvetet::Status written = curvetet::write_mesh(made.value().mesh, argv[2], {});
  if (!written) std::fprintf(stderr, "%s\n", written.error().message.c_str());
  return written ? 0 : curvetet::exit_code(written.error().code);
}
