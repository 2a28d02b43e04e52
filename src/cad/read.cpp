// STEP and IGES go through OpenCASCADE's document (XCAF), which keeps names, colours and the assembly's tree. The tree
// is walked with the product of its locations, so that every instance of a part has its own entities, as
// TopExp::MapShapes numbers them on the compound of all instances.
#include "cad/read.h"

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESModel.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>

#include "cad/guard.h"
#include "cad/scan.h"
#include "cad/step_names.h"

namespace curvetet {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// The first and the last few thousand bytes of a file.
struct Ends {
  std::string head, tail;
};

Ends read_ends(const std::string& path) {
  constexpr std::streamoff kBytes = 4096;
  std::ifstream in(path, std::ios::binary);
  in.seekg(0, std::ios::end);
  const std::streamoff size = in.tellg();
  const auto part = [&](std::streamoff from) {
    std::string text(static_cast<std::size_t>(std::min(kBytes, size - from)), '\0');
    in.seekg(from);
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    return text;
  };
  return {part(0), part(std::max<std::streamoff>(0, size - kBytes))};
}

bool looks_like_iges(const std::string& head) {
  // Fixed lines of 80 columns, the section's letter in column 73.
  const std::size_t line = head.find_first_of("\r\n");
  if (line == std::string::npos || line < 80) return false;
  return head[72] == 'S' && std::all_of(head.begin() + 73, head.begin() + 80,
                                        [](unsigned char c) { return std::isdigit(c) != 0 || c == ' '; });
}

/// Unit of a STEP or IGES file in short, as options write it.
std::string short_unit(std::string name) {
  name = lower(name);
  if (name == "millimetre" || name == "millimeter" || name == "mm") return "mm";
  if (name == "centimetre" || name == "centimeter" || name == "cm") return "cm";
  if (name == "metre" || name == "meter" || name == "m") return "m";
  if (name == "inch" || name == "in") return "inch";
  return name;
}

Label& label_at(std::vector<Label>& labels, int index) { return labels[static_cast<std::size_t>(index - 1)]; }

/// Walks the document's tree and writes names and colours to the labels of the body.
class Document {
 public:
  explicit Document(const Handle(TDocStd_Document) & document)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        colours_(XCAFDoc_DocumentTool::ColorTool(document->Main())) {}

  CadBody make_body() {
    TDF_LabelSequence roots;
    shapes_->GetFreeShapes(roots);
    body_.shape = compound_of(roots);
    if (body_.shape.IsNull()) return std::move(body_);
    label_all(body_);
    solid_map_ = sub_shapes(body_.shape, TopAbs_SOLID);
    face_map_ = sub_shapes(body_.shape, TopAbs_FACE);
    edge_map_ = sub_shapes(body_.shape, TopAbs_EDGE);
    for (int i = 1; i <= roots.Length(); ++i) visit(roots(i), TopLoc_Location(), "", "", std::nullopt);
    return std::move(body_);
  }

 private:
  static TopoDS_Shape compound_of(const TDF_LabelSequence& roots) {
    if (roots.Length() == 1) return XCAFDoc_ShapeTool::GetShape(roots(1));
    TopoDS_Compound compound;
    BRep_Builder builder;
    builder.MakeCompound(compound);
    bool any = false;
    for (int i = 1; i <= roots.Length(); ++i) {
      const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(roots(i));
      if (shape.IsNull()) continue;
      builder.Add(compound, shape);
      any = true;
    }
    return any ? TopoDS_Shape(compound) : TopoDS_Shape();
  }

  static std::string name_of(const TDF_Label& label) {
    Handle(TDataStd_Name) attribute;
    if (!label.FindAttribute(TDataStd_Name::GetID(), attribute)) return "";
    const TCollection_ExtendedString& wide = attribute->Get();
    std::string text(static_cast<std::size_t>(wide.LengthOfCString()) + 1, '\0');
    Standard_PCharacter start = text.data();
    text.resize(static_cast<std::size_t>(wide.ToUTF8CString(start)));
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
    return text == "NONE" ? "" : text;
  }

  std::optional<Colour> colour_of(const TDF_Label& label) const {
    Quantity_Color colour;
    for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen}) {
      if (!colours_->GetColor(label, type, colour)) continue;
      Standard_Real red = 0, green = 0, blue = 0;
      colour.Values(red, green, blue, Quantity_TOC_sRGB);
      return Colour{red, green, blue};
    }
    return std::nullopt;
  }

  void visit(const TDF_Label& label, const TopLoc_Location& location, const std::string& path,
             const std::string& instance_name, const std::optional<Colour>& inherited) {
    const auto own = colour_of(label);
    const auto colour = inherited ? inherited : own;
    const std::string product = name_of(label);
    if (XCAFDoc_ShapeTool::IsAssembly(label)) {
      const std::string name = product.empty() ? instance_name : product;
      const std::string inner = path.empty() ? name : path + "/" + name;
      TDF_LabelSequence components;
      XCAFDoc_ShapeTool::GetComponents(label, components);
      for (int i = 1; i <= components.Length(); ++i) {
        TDF_Label part;
        if (!XCAFDoc_ShapeTool::GetReferredShape(components(i), part)) continue;
        const auto instance_colour = colour_of(components(i));
        visit(part, location * XCAFDoc_ShapeTool::GetLocation(components(i)), inner, name_of(components(i)),
              instance_colour ? instance_colour : inherited);
      }
      return;
    }
    label_part(label, location, path, product.empty() ? instance_name : product, colour);
  }

  /// A part without components: its solids get its name and colour, its labelled sub-shapes their own.
  void label_part(const TDF_Label& label, const TopLoc_Location& location, const std::string& path,
                  const std::string& name, const std::optional<Colour>& colour) {
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label).Moved(location);
    const TopTools_IndexedMapOfShape solids = sub_shapes(shape, TopAbs_SOLID);
    for (int i = 1; i <= solids.Extent(); ++i) {
      const int found = solid_map_.FindIndex(solids(i));
      if (found == 0) continue;
      Label& solid = label_at(body_.solids, found);
      solid.name = solids.Extent() == 1 || name.empty() ? name : name + "_" + std::to_string(i);
      solid.colour = colour;
      body_.shared_product[static_cast<std::size_t>(found - 1)] = solids.Extent() > 1 ? 1 : 0;
      body_.solid_paths[static_cast<std::size_t>(found - 1)] = path;
    }
    if (colour && solids.Extent() == 0) {
      const TopTools_IndexedMapOfShape faces = sub_shapes(shape, TopAbs_FACE);
      for (int i = 1; i <= faces.Extent(); ++i) {
        const int found = face_map_.FindIndex(faces(i));
        if (found != 0) label_at(body_.faces, found).colour = colour;
      }
    }
    TDF_LabelSequence parts;
    XCAFDoc_ShapeTool::GetSubShapes(label, parts);
    for (int i = 1; i <= parts.Length(); ++i) label_sub_shape(parts(i), location);
  }

  void label_sub_shape(const TDF_Label& label, const TopLoc_Location& location) {
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label).Moved(location);
    if (shape.IsNull()) return;
    Label* found = nullptr;
    const auto look = [&](const TopTools_IndexedMapOfShape& map, std::vector<Label>& labels) {
      const int index = map.FindIndex(shape);
      if (index != 0) found = &label_at(labels, index);
    };
    if (shape.ShapeType() == TopAbs_SOLID) look(solid_map_, body_.solids);
    if (shape.ShapeType() == TopAbs_FACE) look(face_map_, body_.faces);
    if (shape.ShapeType() == TopAbs_EDGE) look(edge_map_, body_.edges);
    if (found == nullptr) return;
    const std::string name = name_of(label);
    if (!name.empty()) found->name = name;
    if (const auto colour = colour_of(label)) found->colour = colour;
  }

  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colours_;
  CadBody body_;
  TopTools_IndexedMapOfShape solid_map_, face_map_, edge_map_;
};

/// The document's automatic names ("SOLID") are a process-wide setting; it is put back at the end of the reading.
class NoAutomaticNames {
 public:
  NoAutomaticNames() : before_(XCAFDoc_ShapeTool::AutoNaming()) { XCAFDoc_ShapeTool::SetAutoNaming(false); }
  ~NoAutomaticNames() { XCAFDoc_ShapeTool::SetAutoNaming(before_); }
  NoAutomaticNames(const NoAutomaticNames&) = delete;
  NoAutomaticNames& operator=(const NoAutomaticNames&) = delete;

 private:
  bool before_;
};

Error failed(const std::string& path, const std::string& why) {
  return Error{ErrorCode::reader_failed,
               "cannot read " + path + ": " + why,
               {},
               {},
               "open the file in the CAD system that wrote it and export it again"};
}

void note_unit(CadBody& body, const std::string& unit) {
  body.file_unit = unit;
  if (!unit.empty() && unit != "mm") body.notes.push_back({"file", "lengths converted from " + unit + " to mm"});
}

Result<CadBody> read_step(const std::string& path, const std::string& unit) {
  if (auto bad = scan_step(path)) return *bad;
  const NoAutomaticNames no_names;
  STEPCAFControl_Reader reader;
  reader.SetLayerMode(false);
  reader.SetPropsMode(false);
  reader.SetGDTMode(false);
  reader.SetMatMode(false);
  reader.SetViewMode(false);
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) return failed(path, "it is not a complete STEP file");
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.ChangeReader().FileUnits(lengths, angles, solid_angles);
  Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
  if (!reader.Transfer(document)) return failed(path, "no shape in it could be translated");
  CadBody body = Document(document).make_body();
  if (body.shape.IsNull()) return failed(path, "it holds no shape");
  add_step_names(reader.Reader().WS(), body);
  if (lengths.Length() > 0) {
    note_unit(body, short_unit(lengths(1).ToCString()));
  } else if (!unit.empty()) {
    body.unit = unit;  // the reader leaves lengths without a unit as they are
  }
  return body;
}

Result<CadBody> read_iges(const std::string& path) {
  const NoAutomaticNames no_names;
  IGESCAFControl_Reader reader;
  reader.SetLayerMode(false);
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) return failed(path, "it is not a complete IGES file");
  Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
  if (!reader.Transfer(document)) return failed(path, "no shape in it could be translated");
  CadBody body = Document(document).make_body();
  if (body.shape.IsNull()) return failed(path, "it holds no shape");
  const auto unit = reader.IGESModel()->GlobalSection().UnitName();
  if (!unit.IsNull()) note_unit(body, short_unit(unit->ToCString()));
  return body;
}

Result<CadBody> read_brep(const std::string& path, const std::string& unit, bool binary) {
  CadBody body;
  BRep_Builder builder;
  const bool read =
      binary ? BinTools::Read(body.shape, path.c_str()) : BRepTools::Read(body.shape, path.c_str(), builder);
  if (!read || body.shape.IsNull()) return failed(path, "it is not a complete BREP file");
  label_all(body);
  body.unit = unit.empty() ? "mm" : unit;
  return body;
}

}  // namespace

Result<CadFormat> detect_format(const std::string& path) {
  std::error_code code;
  const auto status = std::filesystem::status(path, code);
  if (!std::filesystem::exists(status)) return Error{ErrorCode::file_not_found, "no such file: " + path};
  if (std::filesystem::is_directory(status)) return Error{ErrorCode::file_unreadable, path + " is a directory"};
  if (!std::filesystem::is_regular_file(status) || !std::ifstream(path).good()) {
    return Error{ErrorCode::file_unreadable, "cannot open " + path};
  }
  if (std::filesystem::file_size(path, code) == 0) return Error{ErrorCode::empty_file, path + " is empty"};
  const Ends ends = read_ends(path);
  if (ends.head.find("ISO-10303-21") != std::string::npos) {
    if (ends.tail.find("END-ISO-10303-21") == std::string::npos) return failed(path, "the end of the file is missing");
    return CadFormat::step;
  }
  if (ends.head.find("Open CASCADE Topology") != std::string::npos) return CadFormat::binary_brep;
  if (ends.head.find("CASCADE Topology") != std::string::npos) {
    if (!brep_is_complete(ends.tail)) return failed(path, "the end of the file is missing");
    return CadFormat::brep;
  }
  if (looks_like_iges(ends.head)) return CadFormat::iges;
  const std::string ending = lower(std::filesystem::path(path).extension().string());
  if (ending == ".step" || ending == ".stp") return failed(path, "it does not start as a STEP file does");
  if (ending == ".iges" || ending == ".igs") return CadFormat::iges;
  if (ending == ".brep" || ending == ".brp") return failed(path, "it does not start as a BREP file does");
  return Error{ErrorCode::unknown_format, path + " is neither STEP nor IGES nor BREP", {}, {}, "convert it to STEP"};
}

Result<CadBody> read_body(const std::string& path, const std::string& input_unit) {
  const Result<CadFormat> format = detect_format(path);
  if (!format) return format.error();
  const QuietMessages quiet;
  return guarded(ErrorCode::reader_failed, "cannot read " + path, [&]() -> Result<CadBody> {
    switch (format.value()) {
      case CadFormat::step:
        return read_step(path, input_unit);
      case CadFormat::iges:
        return read_iges(path);
      case CadFormat::brep:
        return read_brep(path, input_unit, false);
      case CadFormat::binary_brep:
        return read_brep(path, input_unit, true);
    }
    return failed(path, "its format is not known");
  });
}

}  // namespace curvetet
