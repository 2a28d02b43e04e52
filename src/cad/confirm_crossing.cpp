// The whole body was rejected as argument: the analyzer compares all faces with all, which takes minutes where a mesh
// takes seconds, and finds what does not matter here.
#include "cad/confirm_crossing.h"

#include <BOPAlgo_ArgumentAnalyzer.hxx>
#include <BOPAlgo_CheckResult.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>

#include "cad/guard.h"

namespace curvetet {

namespace {

/// A copy of the faces with what they share; the analyzer may change tolerances.
TopoDS_Shape copy_of_faces(const CadBody& body, const std::vector<std::uint32_t>& faces) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  const TopTools_IndexedMapOfShape map = sub_shapes(body.shape, TopAbs_FACE);
  for (int i = 1; i <= map.Extent(); ++i) {
    const std::uint32_t id = body.faces[static_cast<std::size_t>(i - 1)].cad_id;
    if (std::find(faces.begin(), faces.end(), id) != faces.end()) builder.Add(compound, map(i));
  }
  return BRepBuilderAPI_Copy(compound).Shape();
}

bool interfere(const TopoDS_Shape& faces) {
  BOPAlgo_ArgumentAnalyzer analyzer;
  analyzer.SetShape1(faces);
  analyzer.ArgumentTypeMode() = false;
  analyzer.SelfInterMode() = true;
  analyzer.Perform();
  const BOPAlgo_ListOfCheckResult& results = analyzer.GetCheckResult();
  return std::any_of(results.begin(), results.end(), [](const BOPAlgo_CheckResult& result) {
    return result.GetCheckStatus() == BOPAlgo_SelfIntersect;
  });
}

}  // namespace

std::optional<Error> confirm_crossing(const CadBody& body, const std::vector<std::uint32_t>& faces,
                                      const std::string& source) {
  const QuietMessages quiet;
  Error error{ErrorCode::self_intersection, "the CAD kernel finds that faces of " + source + " cross"};
  for (const std::uint32_t id : faces) error.entities.push_back("face " + std::to_string(id));
  const Result<bool> found = guarded(ErrorCode::internal, "cannot analyze the faces",
                                     [&]() -> Result<bool> { return interfere(copy_of_faces(body, faces)); });
  return found && found.value() ? std::optional(error) : std::nullopt;
}

}  // namespace curvetet
