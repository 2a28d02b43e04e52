// Writers and readers of mesh files. A file appears whole or not at all: it is written beside its place and renamed.
#pragma once

#include <string>

#include "curvetet/error.h"
#include "curvetet/mesh.h"

namespace curvetet {

enum class MeshFormat { msh41_binary, msh41_ascii, msh22, vtu, medit, stl };

struct WriteOptions {
  MeshFormat format = MeshFormat::msh41_binary;
  /// MSH 4.1 only: the parameters of boundary nodes as MSH's parametric nodes. Off, they go to a section of our own,
  /// since meshio refuses files with parametric nodes; read_mesh finds them either way.
  bool parametric_nodes = false;
};

/// Format by the file's ending (.msh, .msh2, .vtu, .mesh, .stl); an error names the endings known.
Result<MeshFormat> format_of(const std::string& path);
/// Format by name: msh, msh-ascii, msh22, vtu, mesh, stl; an error names the names known.
Result<MeshFormat> format_named(const std::string& name);

/// Writes atomically. Entities keep their cad ids as tags, and every solid, face and edge has a physical group with the
/// CAD's name.
Status write_mesh(const Mesh& mesh, const std::string& path, const WriteOptions& options);
/// Reads .msh 4.1 and 2.2 (text and binary), .vtu (as we write it) and Medit .mesh. Untrusted input: typed errors,
/// never a crash. The unit is empty if the file does not say it, as files of other programs do not.
Result<Mesh> read_mesh(const std::string& path);

/// Writes text whole or not at all (report, pictures).
Status write_file_atomically(const std::string& path, const std::string& content);

}  // namespace curvetet
