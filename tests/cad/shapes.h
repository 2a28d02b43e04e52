// Shapes made with OpenCASCADE, and a folder to write them to.
#pragma once

#include <TopoDS_Shape.hxx>
#include <filesystem>
#include <string>

#include "geometry/model.h"

namespace curvetet::test {

/// A folder that is removed with its contents.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// A block with rounded edges, a through bore, a countersunk blind bore and a boss.
TopoDS_Shape make_bracket();
/// A box and a cylinder in it that share their faces: two solids.
TopoDS_Shape make_box_with_core();

/// Fails the test for every fault of the model.
void expect_sound(const Model& model, const std::string& what);
/// Volume of all solids in the model's unit.
double total_volume(const Model& model);
double total_area(const Model& model);

}  // namespace curvetet::test
