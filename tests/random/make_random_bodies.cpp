// Draws CAD bodies at random: COUNT sound ones from SEED on, the same for the same seeds, half of them as STEP and half
// as BREP, with bodies.txt and manifest.jsonl, as scripts/corpus.py takes them.
//
//   make_random_bodies FOLDER COUNT [SEED [KIND]]
#include <sys/wait.h>
#include <unistd.h>

#include <BRepBndLib.hxx>
#include <BRepTools.hxx>
#include <Bnd_Box.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <Standard_Failure.hxx>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>

#include "random/shapes.h"

namespace {

using namespace curvetet::test;

constexpr unsigned kSecondsForABody = 20;

struct Body {
  TopoDS_Shape shape;
  std::string name;
};

/// Of the kind of that name, or of any.
std::optional<Body> draw_body(std::uint32_t seed, const std::string& wanted) {
  Draw draw(seed);
  const ShapeKind& kind = body_kinds()[draw.below(body_kinds().size())];
  if (!wanted.empty() && kind.name != wanted) return std::nullopt;
  try {
    const TopoDS_Shape shape = kind.draw(draw);
    if (!is_sound(shape)) return std::nullopt;
    return Body{shape, kind.name + "_" + std::to_string(seed) + (draw.coin() ? ".step" : ".brep")};
  } catch (const Standard_Failure&) {
    return std::nullopt;
  }
}

/// Not every sound shape is one when it is read again.
bool write(const Body& body, const std::filesystem::path& folder) {
  const std::string path = (folder / body.name).string();
  if (!path.ends_with(".step")) return BRepTools::Write(body.shape, path.c_str());
  STEPControl_Writer writer;
  STEPControl_Reader reader;
  return writer.Transfer(body.shape, STEPControl_AsIs) == IFSelect_RetDone &&
         writer.Write(path.c_str()) == IFSelect_RetDone && reader.ReadFile(path.c_str()) == IFSelect_RetDone &&
         reader.TransferRoots() > 0 && is_sound(reader.OneShape());
}

double diagonal_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::AddOptimal(shape, box, true, false);
  return std::sqrt(box.SquareExtent());
}

/// In a process of its own, for OpenCASCADE crashes or hangs over some of them. Empty: this seed gives no sound body.
std::string make_body(std::uint32_t seed, const std::string& kind, const std::filesystem::path& folder) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  const pid_t child = fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child == 0) {
    alarm(kSecondsForABody);
    const std::optional<Body> body = draw_body(seed, kind);
    if (!body) _exit(1);
    if (!write(*body, folder)) {
      std::filesystem::remove(folder / body->name);
      _exit(1);
    }
    dprintf(ends[1], "{\"path\": \"%s\", \"diag\": %.9g}", body->name.c_str(), diagonal_of(body->shape));
    _exit(0);
  }
  close(ends[1]);
  std::string line(1000, '\0');
  const ssize_t length = read(ends[0], line.data(), line.size());
  line.resize(static_cast<std::size_t>(std::max<ssize_t>(length, 0)));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  return status == 0 ? line : "";
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3 || count > 5) {
    std::fprintf(stderr, "usage: %s FOLDER COUNT [SEED [KIND]]\n", arguments[0]);
    return 2;
  }
  const std::string kind = count > 4 ? arguments[4] : "";
  const auto is_kind = [&](const ShapeKind& k) { return kind.empty() || k.name == kind; };
  if (std::none_of(body_kinds().begin(), body_kinds().end(), is_kind)) {
    std::fprintf(stderr, "no kind of body: %s\n", kind.c_str());
    return 2;
  }
  const std::filesystem::path folder(arguments[1]);
  std::filesystem::create_directories(folder);
  Message::DefaultMessenger()->ChangePrinters().Clear();
  std::ofstream list(folder / "bodies.txt"), manifest(folder / "manifest.jsonl");
  auto seed = static_cast<std::uint32_t>(count > 3 ? std::atoi(arguments[3]) : 1);
  for (int left = std::atoi(arguments[2]); left > 0; ++seed) {
    const std::string line = make_body(seed, kind, folder);
    if (line.empty()) continue;
    const std::size_t name = line.find(": \"") + 3;
    list << line.substr(name, line.find('"', name) - name) << std::endl;
    manifest << line << std::endl;
    --left;
  }
  return list && manifest ? 0 : 1;
}
