// The size field of a body: sample, measure bending, then gaps, then short edges; every stage sees the field of the
// ones before.

#include <cmath>
#include <string>

#include "sizing/gaps.h"
#include "sizing/sampling.h"
#include "sizing/size_field.h"
#include "sizing/strips.h"

namespace curvetet {

namespace {

using sizing::EdgeSamples;
using sizing::FaceSamples;

constexpr double kShortestEdgeSize = 0.3;  ///< sizes from short edges, as a part of the size around them

Error bad_option(const std::string& message) { return {ErrorCode::bad_option, message}; }

std::optional<Error> check(const SizingOptions& options) {
  if (!(options.size > 0) || !std::isfinite(options.size)) return bad_option("the size must be positive");
  if (!(options.grading > 0)) return bad_option("the grading must be positive");
  if (!(options.min_size >= 0)) return bad_option("the smallest size must not be negative");
  if (!(options.curvature >= 0)) return bad_option("the number of elements per turn must not be negative");
  if (!(options.chord_height >= 0)) return bad_option("the chord height must not be negative");
  for (const auto* asked : {&options.face_size, &options.edge_size, &options.solid_size})
    for (const auto& entry : *asked)
      if (!(entry.second > 0)) return bad_option("a size asked for an entity must be positive");
  return std::nullopt;
}

class FieldMaker {
 public:
  FieldMaker(const Model& model, const SizingOptions& options, Context& context)
      : model_(model), options_(options), context_(context) {}

  Result<SizeField> run() {
    if (auto error = check(options_)) return *error;
    SizeField field({}, options_);
    field.spread_limits(model_);
    sample(field);
    if (context_.should_stop()) return context_.stop_error("sizing");
    std::vector<SizeSource> sources = bending_sources();
    add_asked_sources(field, sources);
    field.add(sources);
    if (options_.gaps)
      field.add(sizing::gap_sources({model_, options_, field, domains_, face_samples_, edge_samples_}, context_));
    if (context_.should_stop()) return context_.stop_error("sizing");
    field.add(sizing::strip_sources({model_, options_, field, edge_samples_}, context_));
    if (context_.should_stop()) return context_.stop_error("sizing");
    field.add(short_edge_sources(field));
    return field;
  }

 private:
  void sample(const SizeField& field) {
    const std::size_t faces = model_.faces.size(), edges = model_.edges.size();
    domains_.resize(faces);
    face_samples_.resize(faces);
    edge_samples_.resize(edges);
    parallel_for(context_, faces + edges, [&](std::size_t i) {
      if (context_.should_stop()) return;
      if (i >= faces) {
        edge_samples_[i - faces] =
            sizing::sample_edge(model_, EdgeId(i - faces), options_, field.edge_limit(EdgeId(i - faces)));
        return;
      }
      domains_[i] = std::make_unique<TrimmedDomain>(model_, FaceId(i));
      face_samples_[i] = sizing::sample_face(model_, FaceId(i), *domains_[i], options_, field.face_limit(FaceId(i)));
    });
  }

  std::vector<SizeSource> bending_sources() const {
    std::vector<SizeSource> sources;
    for (const FaceSamples& samples : face_samples_)
      sources.insert(sources.end(), samples.sources.begin(), samples.sources.end());
    for (const EdgeSamples& samples : edge_samples_)
      sources.insert(sources.end(), samples.sources.begin(), samples.sources.end());
    return sources;
  }

  /// Sources on the entities that a size was asked for, so that the size grows from there.
  void add_asked_sources(const SizeField& field, std::vector<SizeSource>& sources) const {
    const auto add = [&](Vec3 p, double asked, FaceId face) {
      if (asked < options_.size) sources.push_back({p, asked, SizeReason::asked, face, FaceId(), 0});
    };
    for (std::size_t i = 0; i < face_samples_.size(); ++i)
      for (const sizing::Patch& patch : face_samples_[i].patches)
        if (domains_[i]->inside(patch.middle())) add(patch.point, field.face_limit(FaceId(i)), FaceId(i));
    for (std::size_t i = 0; i < edge_samples_.size(); ++i)
      for (const sizing::EdgeSample& sample : edge_samples_[i].samples)
        add(sample.point, field.edge_limit(EdgeId(i)), FaceId());
  }

  std::vector<SizeSource> short_edge_sources(const SizeField& field) const {
    std::vector<SizeSource> sources;
    for (std::size_t i = 0; i < edge_samples_.size(); ++i) {
      const ModelEdge& edge = model_.edges[EdgeId(i)];
      const EdgeSamples& samples = edge_samples_[i];
      if (samples.samples.empty()) continue;
      for (const CadVertexId end : {edge.start, edge.end}) {
        if (!end.valid()) continue;
        const Vec3 p = model_.vertices[end].point;
        const double around = field.at(p);
        if (samples.length >= around) continue;
        const double size = std::max(samples.length, kShortestEdgeSize * around);
        const FaceId face = edge.faces.empty() ? FaceId() : edge.faces.front();
        sources.push_back({p, size, SizeReason::edge_length, face, FaceId(), 0});
      }
    }
    return sources;
  }

  const Model& model_;
  const SizingOptions& options_;
  Context& context_;
  std::vector<std::unique_ptr<TrimmedDomain>> domains_;
  std::vector<FaceSamples> face_samples_;
  std::vector<EdgeSamples> edge_samples_;
};

}  // namespace

Result<SizeField> make_size_field(const Model& model, const SizingOptions& options, Context& context) {
  return FieldMaker(model, options, context).run();
}

}  // namespace curvetet
