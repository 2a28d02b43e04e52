#include "cad/kept_body.h"

#include <BRepTools.hxx>
#include <sstream>

#include "cad/confirm_crossing.h"
#include "cad/convert.h"
#include "cad/guard.h"
#include "cad/isolate.h"
#include "cad/parts_of_body.h"
#include "cad/read.h"
#include "cad/transfer.h"

namespace curvetet {

namespace {

Result<std::string> brep_of(const TopoDS_Shape& shape) {
  return guarded(ErrorCode::internal, "cannot write the parts", [&]() -> Result<std::string> {
    std::ostringstream out;
    BRepTools::Write(shape, out);
    return std::move(out).str();
  });
}

}  // namespace

Result<std::string> pack_body(const KeptBody& body) { return pack(*body); }

Result<KeptBody> unpack_body(const std::string& bytes) {
  Result<CadBody> body = unpack(bytes);
  if (!body) return body.error();
  return KeptBody(std::make_shared<const CadBody>(std::move(body.value())));
}

Result<Model> model_of(const KeptBody& body, const std::string& source, const std::vector<std::uint32_t>& suspects) {
  if (!suspects.empty()) {
    if (const auto crossing = confirm_crossing(*body, suspects, source)) return *crossing;
  }
  CadBody copy = *body;
  return convert_body(copy, source);
}

Result<std::string> brep_of_parts(const KeptBody& body, const std::vector<std::string>& parts,
                                  const std::string& source) {
  const Result<CadBody> some = parts_of_body(*body, parts, source);
  if (!some) return some.error();
  return brep_of(some.value().shape);
}

Result<std::string> brep_of_parts(const std::string& path, const LoadOptions& options,
                                  const std::vector<std::string>& parts, Context& context) {
  if (const Result<CadFormat> format = detect_format(path); !format) return format.error();
  const auto helper = options.isolate ? find_helper(options) : std::nullopt;
  if (helper) {
    const Result<CadBody> some = read_isolated(path, *helper, options, parts, context);
    if (!some) return some.error();
    return brep_of(some.value().shape);
  }
  const Result<CadBody> body = read_body(path, options.input_unit);
  if (!body) return body.error();
  return brep_of_parts(std::make_shared<const CadBody>(body.value()), parts, path);
}

}  // namespace curvetet
