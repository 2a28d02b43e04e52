// OpenCASCADE can do this itself (read.stepcaf.subshapes.name), but crashes on products that hold something else than
// solids, so the entities are matched to their shapes here.
#include "cad/step_names.h"

#include <Interface_InterfaceModel.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepShape_Edge.hxx>
#include <StepShape_Face.hxx>
#include <StepShape_SolidModel.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <map>

namespace curvetet {
namespace {

TopoDS_Shape unlocated(const TopoDS_Shape& shape) { return shape.Located(TopLoc_Location()); }

/// A name that says something: writers fill in NONE, or the kind of the entity.
std::string useful_name(const Handle(StepRepr_RepresentationItem) & item) {
  const Handle(TCollection_HAsciiString) name = item->Name();
  if (name.IsNull()) return "";
  const std::string text = name->ToCString();
  const std::size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
  if (first == std::string::npos) return "";
  const std::string trimmed = text.substr(first, last - first + 1);
  return trimmed == "NONE" || trimmed == "none" ? "" : trimmed;
}

/// Names by shape without location; the first name of a shape counts.
class NamedShapes {
 public:
  explicit NamedShapes(const Handle(XSControl_WorkSession) & session) {
    const Handle(Interface_InterfaceModel) model = session->Model();
    const Handle(Transfer_TransientProcess) process = session->TransferReader()->TransientProcess();
    if (model.IsNull() || process.IsNull()) return;
    for (int i = 1; i <= model->NbEntities(); ++i) {
      const auto item = Handle(StepRepr_RepresentationItem)::DownCast(model->Value(i));
      if (item.IsNull()) continue;
      if (!item->IsKind(STANDARD_TYPE(StepShape_SolidModel)) && !item->IsKind(STANDARD_TYPE(StepShape_Face)) &&
          !item->IsKind(STANDARD_TYPE(StepShape_Edge))) {
        continue;
      }
      const std::string name = useful_name(item);
      if (name.empty()) continue;
      const TopoDS_Shape shape = TransferBRep::ShapeResult(process, item);
      if (shape.IsNull()) continue;
      const TopoDS_Shape key = unlocated(shape);
      if (index_.IsBound(key)) continue;
      index_.Bind(key, static_cast<int>(names_.size()));
      names_.push_back(name);
    }
  }

  std::string of(const TopoDS_Shape& shape) const {
    const TopoDS_Shape key = unlocated(shape);
    return index_.IsBound(key) ? names_[static_cast<std::size_t>(index_.Find(key))] : "";
  }
  bool empty() const { return names_.empty(); }

 private:
  TopTools_DataMapOfShapeInteger index_;
  std::vector<std::string> names_;
};

}  // namespace

void add_step_names(const Handle(XSControl_WorkSession) & session, CadBody& body) {
  const NamedShapes names(session);
  if (names.empty()) return;
  for (const TopAbs_ShapeEnum type : {TopAbs_SOLID, TopAbs_FACE, TopAbs_EDGE}) {
    const TopTools_IndexedMapOfShape parts = sub_shapes(body.shape, type);
    auto& labels = labels_of(body, type);
    for (int i = 1; i <= parts.Extent(); ++i) {
      Label& label = labels[static_cast<std::size_t>(i - 1)];
      const std::string name = names.of(parts(i));
      const bool only_solid =
          type == TopAbs_SOLID && !label.name.empty() && !body.shared_product[static_cast<std::size_t>(i - 1)];
      if (!name.empty() && !only_solid) label.name = name;
    }
  }
}

}  // namespace curvetet
