// The labels are lines of tab-separated fields with backslash escapes; numbers are written in hexadecimal so that they
// come back as the same bytes. The last line is "end": a file without it is from a helper that died.
#include "cad/transfer.h"

#include <BinTools.hxx>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "cad/guard.h"

namespace curvetet {
namespace {

constexpr const char* kGreeting = "curvetet-cad 0.1.0";
constexpr const char *kNote = "note", *kWarning = "warning";  // kinds of lines

std::string labels_path(const std::string& out_path) { return out_path + ".labels"; }

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '\\':
        out += "\\\\";
        break;
      case '\t':
        out += "\\t";
        break;
      case '\n':
        out += "\\n";
        break;
      case '\r':
        out += "\\r";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string unescaped(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || i + 1 == text.size()) {
      out += text[i];
      continue;
    }
    const char c = text[++i];
    out += c == 't' ? '\t' : c == 'n' ? '\n' : c == 'r' ? '\r' : c;
  }
  return out;
}

double number(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

std::uint32_t read_id(const std::string& text) {
  return static_cast<std::uint32_t>(std::strtoul(text.c_str(), nullptr, 10));
}

class Fields {
 public:
  explicit Fields(const std::string& line) {
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, '\t');) fields_.push_back(unescaped(field));
  }
  std::string at(std::size_t i) const { return i < fields_.size() ? fields_[i] : ""; }
  std::size_t size() const { return fields_.size(); }

 private:
  std::vector<std::string> fields_;
};

void write_label(std::ostream& out, const char* type, const Label& label, const std::string& path) {
  out << type << '\t' << label.cad_id << '\t' << escaped(label.name) << '\t' << escaped(path);
  if (label.colour) {
    out << '\t' << exact_text(label.colour->red) << '\t' << exact_text(label.colour->green) << '\t'
        << exact_text(label.colour->blue);
  }
  out << '\n';
}

Label read_label(const Fields& fields) {
  Label label;
  label.cad_id = read_id(fields.at(1));
  label.name = fields.at(2);
  if (fields.size() >= 7) label.colour = Colour{number(fields.at(4)), number(fields.at(5)), number(fields.at(6))};
  return label;
}

void write_suppressed(std::ostream& out, const SuppressedDetail& detail) {
  out << "suppressed\t" << name(detail.kind) << '\t' << detail.label.cad_id << '\t' << escaped(detail.label.name)
      << '\t' << exact_text(detail.size) << '\t' << exact_text(detail.place.x) << '\t' << exact_text(detail.place.y)
      << '\t' << exact_text(detail.place.z) << '\n';
}

SuppressedDetail read_suppressed(const Fields& fields) {
  SuppressedDetail detail;
  detail.kind =
      fields.at(1) == name(SuppressedDetail::Kind::face) ? SuppressedDetail::Kind::face : SuppressedDetail::Kind::edge;
  detail.label.cad_id = read_id(fields.at(2));
  detail.label.name = fields.at(3);
  detail.size = number(fields.at(4));
  detail.place = {number(fields.at(5)), number(fields.at(6)), number(fields.at(7))};
  return detail;
}

void read_error(const Fields& fields, Error& error) {
  error.code = static_cast<ErrorCode>(std::strtol(fields.at(1).c_str(), nullptr, 10));
  error.message = fields.at(2);
  error.hint = fields.at(3);
  if (fields.size() >= 7) error.where = Vec3{number(fields.at(4)), number(fields.at(5)), number(fields.at(6))};
}

void write_labels(const CadBody& body, std::ostream& out) {
  out << "unit\t" << escaped(body.unit) << "\nfile unit\t" << escaped(body.file_unit) << '\n';
  for (const HealingNote& note : body.notes)
    out << (note.is_warning ? kWarning : kNote) << '\t' << escaped(note.entity) << '\t' << escaped(note.what) << '\n';
  for (const auto& [type, id] : body.last_ids) out << "last\t" << type_name(type) << '\t' << id << '\n';
  for (const SuppressedDetail& detail : body.suppressed) write_suppressed(out, detail);
  for (const TopAbs_ShapeEnum type : kLabelled) {
    const auto& labels = labels_of(body, type);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      write_label(out, type_name(type), labels[i], type == TopAbs_SOLID ? body.solid_paths[i] : "");
    }
  }
  for (const double area : body.measures.face_areas) out << "area\t" << exact_text(area) << '\n';
  for (const double volume : body.measures.shell_volumes) out << "volume\t" << exact_text(volume) << '\n';
  out << "end\n";
}

/// What the label file says.
struct Parsed {
  CadBody body;
  std::optional<Error> error;
  bool complete = false;
};

Parsed parse(std::istream& in) {
  Parsed parsed;
  std::string line;
  std::getline(in, line);
  while (!parsed.complete && std::getline(in, line)) {
    const Fields fields(line);
    const std::string kind = fields.at(0);
    if (kind == "end") parsed.complete = true;
    if (kind == "unit") parsed.body.unit = fields.at(1);
    if (kind == "file unit") parsed.body.file_unit = fields.at(1);
    if (kind == kNote || kind == kWarning) parsed.body.notes.push_back({fields.at(1), fields.at(2), kind == kWarning});
    if (kind == "suppressed") parsed.body.suppressed.push_back(read_suppressed(fields));
    if (kind == "area") parsed.body.measures.face_areas.push_back(number(fields.at(1)));
    if (kind == "volume") parsed.body.measures.shell_volumes.push_back(number(fields.at(1)));
    if (kind == "error") read_error(fields, parsed.error.emplace());
    if (kind == "entity" && parsed.error) parsed.error->entities.push_back(fields.at(1));
    for (const TopAbs_ShapeEnum type : kLabelled) {
      if (kind == "last" && fields.at(1) == type_name(type)) parsed.body.last_ids[type] = read_id(fields.at(2));
      if (kind == type_name(type)) labels_of(parsed.body, type).push_back(read_label(fields));
    }
    if (kind == "solid") parsed.body.solid_paths.push_back(fields.at(3));
  }
  return parsed;
}

Error broken() {
  return Error{ErrorCode::reader_crashed, "the helper that reads the CAD file ended before it was done"};
}

/// Does the shape have as many parts as there are labels?
bool labels_fit(const CadBody& body) {
  return !body.shape.IsNull() && std::all_of(kLabelled.begin(), kLabelled.end(), [&](TopAbs_ShapeEnum type) {
    return labels_of(body, type).size() == static_cast<std::size_t>(sub_shapes(body.shape, type).Extent());
  });
}

}  // namespace

std::string exact_text(double x) {
  std::ostringstream out;
  out << std::hexfloat << x;
  return out.str();
}

bool announce_transfer(const std::string& out_path) {
  std::ofstream out(labels_path(out_path));
  out << kGreeting << '\n';
  return out.flush().good();
}

bool write_transfer(const CadBody& body, const std::string& out_path) {
  if (!BinTools::Write(body.shape, out_path.c_str(), false, false, BinTools_FormatVersion_CURRENT)) return false;
  std::ofstream out(labels_path(out_path), std::ios::app);
  write_labels(body, out);
  return out.flush().good();
}

bool write_transfer(const Error& error, const std::string& out_path) {
  std::ofstream out(labels_path(out_path), std::ios::app);
  out << "error\t" << static_cast<int>(error.code) << '\t' << escaped(error.message) << '\t' << escaped(error.hint);
  if (error.where)
    out << '\t' << exact_text(error.where->x) << '\t' << exact_text(error.where->y) << '\t'
        << exact_text(error.where->z);
  out << '\n';
  for (const std::string& entity : error.entities) out << "entity\t" << escaped(entity) << '\n';
  out << "end\n";
  return out.flush().good();
}

bool transfer_announced(const std::string& out_path) {
  std::ifstream in(labels_path(out_path));
  std::string line;
  return std::getline(in, line) && line == kGreeting;
}

Result<CadBody> read_transfer(const std::string& out_path) {
  std::ifstream in(labels_path(out_path));
  Parsed parsed = parse(in);
  if (!parsed.complete) return broken();
  if (parsed.error) return *parsed.error;
  return guarded(ErrorCode::reader_crashed, "the helper's shape", [&]() -> Result<CadBody> {
    if (!BinTools::Read(parsed.body.shape, out_path.c_str()) || !labels_fit(parsed.body)) return broken();
    return std::move(parsed.body);
  });
}

Result<std::string> pack(const CadBody& body) {
  return guarded(ErrorCode::internal, "cannot keep the body", [&]() -> Result<std::string> {
    std::ostringstream out;
    out << kGreeting << '\n';
    write_labels(body, out);
    BinTools::Write(body.shape, out, false, false, BinTools_FormatVersion_CURRENT);
    return std::move(out).str();
  });
}

Result<CadBody> unpack(const std::string& bytes) {
  const QuietMessages quiet;
  const Error wrong{ErrorCode::file_unreadable, "what was kept of the body is damaged, or of another version"};
  return guarded(ErrorCode::file_unreadable, "what was kept of the body", [&]() -> Result<CadBody> {
    std::istringstream in(bytes);
    Parsed parsed = parse(in);
    if (bytes.rfind(kGreeting, 0) != 0 || !parsed.complete || parsed.error) return wrong;
    BinTools::Read(parsed.body.shape, in);
    if (!labels_fit(parsed.body)) return wrong;
    return std::move(parsed.body);
  });
}

}  // namespace curvetet
