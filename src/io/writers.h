// The writers, one per format; each puts the whole mesh into a file that the caller commits.
#pragma once

#include "curvetet/mesh.h"
#include "io/output_file.h"

namespace curvetet {

struct Msh41Options {
  bool binary = true;
  bool parametric_nodes = false;
};
void write_msh41(const Mesh& mesh, const Msh41Options& options, OutputFile& file);
void write_msh22(const Mesh& mesh, OutputFile& file);
void write_vtu(const Mesh& mesh, OutputFile& file);
void write_medit(const Mesh& mesh, OutputFile& file);
void write_stl(const Mesh& mesh, OutputFile& file);

}  // namespace curvetet
