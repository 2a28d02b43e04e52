#include "commands.h"
#include "terminal.h"

namespace curvetet::cli {

int run_picture(const PictureCommand& command) {
  const Result<Mesh> mesh = read_mesh(command.mesh);
  if (!mesh) return show_error(mesh.error());
  const Status drawn = write_picture(mesh.value(), command.output, command.options);
  return drawn ? 0 : show_error(drawn.error());
}

}  // namespace curvetet::cli
