// Any bytes as a mesh file: reading gives a mesh or an error, and a mesh that is read can be checked and written. The
// first byte chooses the ending, the rest is the file.
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "io/formats.h"
#include "quality/validate.h"

namespace {

/// A file that is gone when the target ends.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& ending) : path_("/dev/shm/fuzz_" + std::to_string(getpid()) + ending) {}
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }
  void fill(const std::uint8_t* data, std::size_t size) const {
    std::FILE* file = std::fopen(path_.c_str(), "wb");
    if (file == nullptr) std::abort();
    if (size > 0 && std::fwrite(data, 1, size, file) != size) std::abort();
    std::fclose(file);
  }

 private:
  std::string path_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace curvetet;
  if (size == 0) return 0;
  static constexpr std::array<const char*, 3> endings{".msh", ".vtu", ".mesh"};
  const ScratchFile file(endings[data[0] % endings.size()]);
  file.fill(data + 1, size - 1);
  const Result<Mesh> mesh = read_mesh(file.path());
  if (!mesh.ok()) return 0;
  Context context;
  context.threads = 1;
  if (!validate(mesh.value(), nullptr, 1, context).valid()) return 0;
  // What is valid survives being written and read again.
  if (!write_mesh(mesh.value(), file.path(), {MeshFormat::msh41_binary}).ok()) std::abort();
  const Result<Mesh> again = read_mesh(file.path());
  if (!again.ok() || again.value().points != mesh.value().points || again.value().tets != mesh.value().tets) {
    std::abort();
  }
  return 0;
}
