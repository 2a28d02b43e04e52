// The one door to all formats: which format a name asks for, whole files in and out, and failures as typed errors.
#include "io/formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "io/output_file.h"
#include "io/readers.h"
#include "io/scanner.h"
#include "io/writers.h"

namespace curvetet {

static_assert(std::endian::native == std::endian::little, "binary formats are written in the machine's byte order");

namespace {

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

/// The whole of a regular file.
Result<std::string> contents_of(const std::string& path) {
  std::error_code problem;
  const auto status = std::filesystem::status(path, problem);
  if (!std::filesystem::exists(status)) return Error{ErrorCode::file_not_found, path + " does not exist"};
  if (!std::filesystem::is_regular_file(status)) return Error{ErrorCode::file_unreadable, path + " is not a file"};
  std::ifstream file(path, std::ios::binary);
  if (!file)
    return Error{ErrorCode::file_unreadable, fmt::format("{} cannot be opened: {}", path, std::strerror(errno))};
  const auto size = std::filesystem::file_size(path, problem);
  if (problem) return Error{ErrorCode::file_unreadable, fmt::format("{} cannot be read: {}", path, problem.message())};
  std::string text(size, '\0');
  file.read(text.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(file.gcount()) != size) {
    return Error{ErrorCode::file_unreadable, path + " cannot be read to its end"};
  }
  if (text.empty()) return Error{ErrorCode::empty_file, path + " is empty"};
  return text;
}

/// Indices of a mesh that do not fit its arrays are the caller's programming error.
void check_indices(const Mesh& mesh) {
  const auto all_below = [](const auto& values, std::size_t limit) {
    return std::all_of(values.begin(), values.end(), [limit](std::uint32_t value) { return value < limit; });
  };
  const auto elements_fit = [&](const auto& elements, const auto& entity_of, std::size_t entities) {
    if (elements.size() != entity_of.size() || !all_below(entity_of, entities)) return false;
    return std::all_of(elements.begin(), elements.end(),
                       [&](const auto& element) { return all_below(element, mesh.points.size()); });
  };
  const std::size_t n[] = {mesh.vertices.size(), mesh.edges.size(), mesh.faces.size(), mesh.solids.size()};
  CURVETET_CHECK(mesh.nodes.size() == mesh.points.size());
  CURVETET_CHECK(std::all_of(mesh.nodes.begin(), mesh.nodes.end(), [&](const NodeOnCad& node) {
    return node.dimension < 4 && node.entity < n[node.dimension];
  }));
  CURVETET_CHECK(elements_fit(mesh.tets, mesh.tet_solid, n[3]));
  CURVETET_CHECK(elements_fit(mesh.triangles, mesh.triangle_face, n[2]));
  CURVETET_CHECK(elements_fit(mesh.segments, mesh.segment_edge, n[1]));
  CURVETET_CHECK(mesh.corner_nodes.size() <= n[0]);
  CURVETET_CHECK(std::all_of(mesh.corner_nodes.begin(), mesh.corner_nodes.end(),
                             [&](std::uint32_t node) { return node == UINT32_MAX || node < mesh.points.size(); }));
}

}  // namespace

Result<MeshFormat> format_of(const std::string& path) {
  const std::string ending = ending_of(path);
  if (ending == ".msh") return MeshFormat::msh41_binary;
  if (ending == ".msh2") return MeshFormat::msh22;
  if (ending == ".vtu") return MeshFormat::vtu;
  if (ending == ".mesh") return MeshFormat::medit;
  if (ending == ".stl") return MeshFormat::stl;
  return Error{ErrorCode::bad_option,
               fmt::format("the ending of {} names no mesh format", path),
               {},
               {},
               "known endings: .msh .msh2 .vtu .mesh .stl"};
}

Result<MeshFormat> format_named(const std::string& name) {
  if (name == "msh") return MeshFormat::msh41_binary;
  if (name == "msh-ascii") return MeshFormat::msh41_ascii;
  if (name == "msh22") return MeshFormat::msh22;
  if (name == "vtu") return MeshFormat::vtu;
  if (name == "mesh") return MeshFormat::medit;
  if (name == "stl") return MeshFormat::stl;
  return Error{ErrorCode::bad_option,
               fmt::format("there is no mesh format '{}'", name),
               {},
               {},
               "known formats: msh msh-ascii msh22 vtu mesh stl"};
}

Status write_mesh(const Mesh& mesh, const std::string& path, const WriteOptions& options) {
  check_indices(mesh);
  OutputFile file(path);
  switch (options.format) {
    case MeshFormat::msh41_binary:
      write_msh41(mesh, {true, options.parametric_nodes}, file);
      break;
    case MeshFormat::msh41_ascii:
      write_msh41(mesh, {false, options.parametric_nodes}, file);
      break;
    case MeshFormat::msh22:
      write_msh22(mesh, file);
      break;
    case MeshFormat::vtu:
      write_vtu(mesh, file);
      break;
    case MeshFormat::medit:
      write_medit(mesh, file);
      break;
    case MeshFormat::stl:
      write_stl(mesh, file);
      break;
  }
  return file.commit();
}

Result<Mesh> read_mesh(const std::string& path) {
  const std::string ending = ending_of(path);
  const bool msh = ending == ".msh" || ending == ".msh2", vtu = ending == ".vtu", medit = ending == ".mesh";
  if (!msh && !vtu && !medit) {
    return Error{ErrorCode::unknown_format,
                 fmt::format("the ending of {} names no mesh format that can be read", path),
                 {},
                 {},
                 "known endings: .msh .msh2 .vtu .mesh"};
  }
  const Result<std::string> text = contents_of(path);
  if (!text) return text.error();
  try {
    return msh ? read_msh(text.value()) : vtu ? read_vtu(text.value()) : read_medit(text.value());
  } catch (const BadFile& bad) {
    return Error{bad.code, path + ": " + bad.message};
  }
}

Status write_file_atomically(const std::string& path, const std::string& content) {
  OutputFile file(path);
  file.put(content);
  return file.commit();
}

}  // namespace curvetet
