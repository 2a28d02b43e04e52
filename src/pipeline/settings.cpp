#include "pipeline/settings.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/units.h"

namespace curvetet {

namespace {

Error bad(const std::string& message, const std::string& hint = {}) {
  return {ErrorCode::bad_option, message, {}, {}, hint};
}

bool positive(double x) { return std::isfinite(x) && x > 0; }

// Below this share of the diagonal a size asks for more elements than any machine holds.
constexpr double kSmallestShare = 1e-5;
constexpr double kFloorShare = 1.0 / 256;
constexpr double kFreeFormFloorShare = 1.0 / 50;

template <class Key, class Entities, class NameOf>
bool assign_local(const LocalSize& local, double size, const Entities& entities, std::map<std::uint32_t, double>& into,
                  const NameOf& name_of) {
  bool found = false;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    const Label& label = entities[Key(i)].label;
    if (std::to_string(label.cad_id) != local.which && label.name != local.which && name_of(Key(i)) != local.which)
      continue;
    into[static_cast<std::uint32_t>(i)] = size;
    found = true;
  }
  return found;
}

bool resolve_local(const LocalSize& local, double size, const Model& model, SizingOptions& sizing) {
  switch (local.kind) {
    case LocalSize::Kind::face:
      return assign_local<FaceId>(local, size, model.faces, sizing.face_size,
                                  [&](FaceId f) { return model.face_name(f); });
    case LocalSize::Kind::edge:
      return assign_local<EdgeId>(local, size, model.edges, sizing.edge_size,
                                  [&](EdgeId e) { return model.edge_name(e); });
    case LocalSize::Kind::solid:
      return assign_local<SolidId>(local, size, model.solids, sizing.solid_size,
                                   [&](SolidId s) { return model.solid_name(s); });
  }
  return false;
}

}  // namespace

Status check_options(const Options& o) {
  if (o.size && !positive(*o.size)) return bad(fmt::format("size must be a positive length, not {}", *o.size));
  if (!(std::isfinite(o.size_divisor) && o.size_divisor >= 1))
    return bad(fmt::format("the diagonal cannot be divided by {}: at least 1", o.size_divisor));
  if (o.min_size && !positive(*o.min_size))
    return bad(fmt::format("min-size must be a positive length, not {}", *o.min_size));
  if (o.size && o.min_size && *o.min_size > *o.size) return bad("min-size is larger than size");
  if (o.chord_height && !positive(*o.chord_height))
    return bad(fmt::format("chord-height must be a positive length, not {}", *o.chord_height));
  if (!(std::isfinite(o.curvature) && o.curvature >= 0 && o.curvature <= 10000))
    return bad(fmt::format("curvature must be from 0 (off) to 10000 elements per turn, not {}", o.curvature));
  if (!(positive(o.grading) && o.grading <= 10))
    return bad(fmt::format("grading must be above 0 and at most 10, not {}", o.grading));
  if (!(std::isfinite(o.radius_edge) && o.radius_edge >= 1))
    return bad(fmt::format("radius-edge must be at least 1, not {}", o.radius_edge));
  if (!(std::isfinite(o.min_feature) && o.min_feature >= 0))
    return bad(fmt::format("min-feature must be a length, or 0 for off, not {}", o.min_feature));
  if (o.time_limit && !positive(*o.time_limit))
    return bad(fmt::format("time-limit must be positive seconds, not {}", *o.time_limit));
  if (o.threads < 0 || o.threads > 4096)
    return bad(fmt::format("threads must be from 0 (all cores) to 4096, not {}", o.threads));
  for (const std::string& unit : {o.unit, o.input_unit})
    if (!unit.empty() && !millimetres(unit))
      return bad(fmt::format("unknown unit '{}'", unit), "one of um, mm, cm, m, inch, ft");
  if (o.conformal == Conformal::off && o.overlaps == Overlaps::split)
    return bad("overlaps are split by joining solids, which conformal=off forbids", "leave out one of the two");
  for (const LocalSize& l : o.local_sizes)
    if (!positive(l.size))
      return bad(fmt::format("the size of '{}' must be a positive length, not {}", l.which, l.size));
  return Done{};
}

Result<Settings> resolve(const Options& options, const Model& model) {
  Settings s;
  s.unit = options.unit.empty() ? model.unit : options.unit;
  s.unit_scale = millimetres(model.unit).value_or(1) / millimetres(s.unit).value_or(1);
  const auto working = [&](double length) { return model.frame.length_to_working(length / s.unit_scale); };
  const double diagonal = model.diagonal();
  s.size = options.size ? working(*options.size) : diagonal / options.size_divisor;
  if (s.size < kSmallestShare * diagonal)
    return bad(fmt::format("the size is below {} of the body's diagonal", kSmallestShare), "ask for a larger size");
  s.size = std::min(s.size, diagonal);
  s.sizing.size = s.size;
  s.sizing.min_size = options.min_size ? std::min(working(*options.min_size), s.size) : 1e-3 * s.size;
  s.sizing.free_form_floor = options.min_size ? s.sizing.min_size : kFreeFormFloorShare * s.size;
  s.sizing.curvature = options.curvature;
  s.sizing.chord_height = options.chord_height ? working(*options.chord_height) : 0;
  s.sizing.grading = options.grading;
  s.sizing.gaps = options.gaps;
  s.floor = kFloorShare * s.size;
  for (const LocalSize& local : options.local_sizes)
    if (!resolve_local(local, working(local.size), model, s.sizing))
      return bad(fmt::format("no entity '{}' for a local size", local.which), "see `curvetet info` for ids and names");
  if (options.size_callback)
    s.sizing.callback = [callback = options.size_callback, frame = model.frame, scale = s.unit_scale](Vec3 p) {
      const Vec3 q = scale * frame.to_cad(p);
      return frame.length_to_working(callback({q.x, q.y, q.z}) / scale);
    };
  return s;
}

std::string options_json(const Options& o, const Settings& s, const Model& model) {
  const auto out = [&](double working) { return model.frame.length_to_cad(working) * s.unit_scale; };
  nlohmann::ordered_json j;
  j["size"] = out(s.sizing.size);
  j["size_is_default"] = !o.size.has_value() && o.size_divisor == Options().size_divisor;
  j["min_size"] = out(s.sizing.min_size);
  j["free_form_floor"] = out(s.sizing.free_form_floor);
  j["curvature"] = o.curvature;
  j["chord_height"] = o.chord_height ? nlohmann::ordered_json(*o.chord_height) : nlohmann::ordered_json();
  j["grading"] = o.grading;
  j["gaps"] = o.gaps;
  j["conformal"] = o.conformal == Conformal::off ? "off" : o.conformal == Conformal::strict ? "strict" : "auto";
  j["overlaps"] = o.overlaps == Overlaps::split ? "split" : "refuse";
  j["min_feature"] = o.min_feature;
  j["recovery"] = o.recovery == RecoveryMode::paper ? "paper" : "conjoint";
  j["refine_interior"] = o.refine_interior;
  j["improve"] = o.improve;
  j["radius_edge"] = o.radius_edge;
  j["seed"] = o.seed;
  j["local_sizes"] = nlohmann::ordered_json::array();
  const auto kind = [](LocalSize::Kind k) {
    return k == LocalSize::Kind::face ? "face" : k == LocalSize::Kind::edge ? "edge" : "solid";
  };
  for (const LocalSize& l : o.local_sizes)
    j["local_sizes"].push_back({{"kind", kind(l.kind)}, {"which", l.which}, {"size", l.size}});
  return j.dump();
}

}  // namespace curvetet
