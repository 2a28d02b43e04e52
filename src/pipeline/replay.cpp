#include "pipeline/replay.h"

#include "cad/kept_body.h"
#include "pipeline/pipeline.h"

namespace curvetet {

Result<MeshOutput> replay(const State& state, Context& context, Report* report_on_failure) {
  const Result<KeptBody> body = unpack_body(state.body);
  if (!body) return body.error();
  Source source;
  source.name = state.input;
  source.load = [&](const std::vector<std::uint32_t>& suspects, Context&) {
    return model_of(body.value(), state.input, suspects);
  };
  source.body = [&]() -> Result<std::string> { return state.body; };
  source.parts = [&](const std::vector<std::string>& parts, Context&) {
    return brep_of_parts(body.value(), parts, state.input);
  };
  source.loop = state.loop;
  return mesh_source(source, state.options, context, report_on_failure);
}

bool recurs(const State& state, const Error& failure) {
  if (failure.code != state.failure.code || failure.entities != state.failure.entities) return false;
  if (!failure.where || !state.failure.where) return failure.where.has_value() == state.failure.where.has_value();
  return distance(*failure.where, *state.failure.where) <= state.size;
}

}  // namespace curvetet
