// Coarse meshes take milliseconds, so a failure is answered by meshing again with a smaller size where it happened,
// rather than by ever more desperate local measures. Halving at most six times bounds it. Halving over the whole face
// at once was rejected as the first answer: most failures are at one place.
#include "pipeline/body_mesher.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "boundary/cure_crossings.h"
#include "boundary/fill_holes.h"
#include "boundary/refine_surface.h"
#include "boundary/simplicial.h"
#include "boundary/surround.h"
#include "boundary/vertex_fans.h"

namespace curvetet {

namespace {

constexpr int kPatience = 3;        ///< rounds that ask for smaller sizes at single places
constexpr double kBendShare = 1.2;  ///< size over radius: five elements around

class BodyMesher {
 public:
  BodyMesher(const Model& model, SizeField& sizes, const Settings& settings, RecoveryMode mode, OuterLoop& loop,
             StageClock& clock, Context& context)
      : model_(model), sizes_(sizes), settings_(settings), mode_(mode), loop_(loop), clock_(clock), context_(context) {}

  Result<BodyMesherResult> run() {
    for (const std::vector<SizeSource>& asked : loop_.asked) sizes_.add(asked);
    BodyMesherResult result;
    result.restarts.resize(model_.faces.size());
    while (true) {
      result.rounds = loop_.round();
      result.mesh = std::make_unique<BodyMesh>();
      auto failures = attempt(*result.mesh);
      if (!failures.ok()) return failures.error();
      count_recovered(result.restarts, result.failures, failures.value());
      result.failures = std::move(failures.value());
      if (result.failures.empty() || is_last_round() || hopeless(result.failures)) return result;
      for (const RecoveryFailure& f : result.failures) log(f);
      const std::set<FaceId> faces = named(result.failures);
      for (FaceId f : faces) ++result.restarts[f].tried;
      std::vector<SizeSource> more = sources(result.failures);
      if (loop_.round() >= kPatience) add_bends(*result.mesh, faces, more);
      loop_.asked.push_back(std::move(more));
      sizes_.add(loop_.asked.back());
    }
  }

 private:
  using Failures = std::vector<RecoveryFailure>;

  bool is_last_round() const { return loop_.round() == kOuterRounds; }

  static bool hopeless(const Failures& failures) {
    return std::all_of(failures.begin(), failures.end(),
                       [](const RecoveryFailure& f) { return f.proved || f.size <= 0; });
  }

  static std::set<FaceId> named(const Failures& failures) {
    std::set<FaceId> faces;
    for (const RecoveryFailure& f : failures) faces.insert(f.faces.begin(), f.faces.end());
    return faces;
  }

  static void count_recovered(IndexedVector<FaceId, RungCounts>& restarts, const Failures& before,
                              const Failures& after) {
    const std::set<FaceId> left = named(after);
    for (FaceId f : named(before)) restarts[f].recovered += left.contains(f) ? 0 : 1;
  }

  void log(const RecoveryFailure& f) const {
    std::string faces;
    for (FaceId id : f.faces) faces += fmt::format(" {}", model_.faces[id].label.cad_id);
    context_.log(LogLevel::info, fmt::format("outer loop: {} (faces{}), size {:.4g} there", f.what, faces,
                                             model_.frame.length_to_cad(f.size) * settings_.unit_scale));
  }

  std::vector<SizeSource> sources(const Failures& failures) const {
    std::vector<SizeSource> more;
    for (const RecoveryFailure& f : failures) {
      if (f.size <= 0) continue;
      SizeSource s =
          source(f.where, std::min(f.size, 0.5 * sizes_.at(f.where)), f.faces.empty() ? FaceId() : f.faces.front());
      if (f.faces.size() > 1) s.other = f.faces[1];
      more.push_back(s);
    }
    return more;
  }

  /// Where rounds have not helped, each tells of other places of the same face: all its facets that are longer than
  /// twice the radius it is bent by there are at fault.
  void add_bends(const BodyMesh& body, const std::set<FaceId>& faces, std::vector<SizeSource>& more) const {
    for (const FaceId f : faces) {
      const FaceMesh& mesh = body.boundary.faces[f];
      for (const SurfaceTriangle& t : surface_triangles(mesh, f)) {
        const Bend bend = bend_below(mesh, t.triangle, *model_.faces[f].surface);
        if (!finite(bend.where) || longest_edge(body.vertices, t.vertices) <= 2 * bend.radius) continue;
        more.push_back(source(bend.where, kBendShare * bend.radius, f));
      }
    }
  }

  /// What is asked for, not below the floor.
  SizeSource source(Vec3 where, double size, FaceId face) const {
    SizeSource s;
    s.where = where;
    s.size = std::max(size, settings_.floor);
    s.reason = SizeReason::outer_loop;
    s.face = face;
    return s;
  }

  Result<Failures> attempt(BodyMesh& body) {
    clock_.start("curves and faces", 0.1, 0.25);
    auto front = mesh_boundary(model_, sizes_, body.vertices, BoundaryOptions{}, context_);
    if (!front.ok()) return front.error();
    body.boundary = std::move(front.value().mesh);
    if (!front.value().failures.empty()) return front_failures(front.value().failures);
    count_initial(body);
    body.conjoint = std::make_unique<Conjoint>(model_, body.vertices, body.boundary, [&](FaceId f) {
      return spatial_criterion(body.boundary.faces[f], body.vertices, model_.faces[f]);
    });

    if (mode_ == RecoveryMode::conjoint) {
      clock_.start("crossings", 0.25, 0.3);
      auto crossings = cure_crossings(*body.conjoint, {settings_.floor}, context_);
      if (!crossings.ok()) return crossings.error();
      body.crossings = crossings.value();
      if (!body.crossings.failures.empty()) return body.crossings.failures;
    }
    return tetrahedralize(body);
  }

  Status recover(BodyMesh& body) {
    if (mode_ == RecoveryMode::paper) {
      auto recovery = recover_faces_as_paper(*body.conjoint, {settings_.floor}, context_);
      if (!recovery.ok()) return recovery.error();
      body.recovery = std::move(recovery.value().recovery);
      body.paper = recovery.value().counts;
      return Done{};
    }
    FaceRecoveryOptions options;
    options.floor = settings_.floor;
    options.fallback = is_last_round();  // before that, a smaller size is the better cure
    auto recovery = recover_faces(*body.conjoint, options, context_);
    if (!recovery.ok()) return recovery.error();
    body.recovery = std::move(recovery.value());
    return Done{};
  }

  Result<Failures> tetrahedralize(BodyMesh& body) {
    clock_.start("tetrahedralization", 0.3, 0.35);
    body.tets = std::make_unique<Tetrahedralization>(body.vertices, context_.seed);
    std::vector<VertexId> vertices = used_vertices(body);
    add_surrounding(body.vertices, vertices);
    const Status built = body.tets->build(vertices, context_);
    if (!built.ok()) return built.error();
    body.conjoint->attach(body.tets.get());

    clock_.start("recovery", 0.35, 0.5);
    const Status recovered = recover(body);
    if (!recovered.ok()) return recovered.error();
    if (!body.recovery.failures.empty()) return body.recovery.failures;
    if (const Failures shared = shared_edges(body); !shared.empty()) return shared;
    if (const Failures broken = broken_fans(body); !broken.empty()) return broken;
    // Recovery takes facets that are there in place of missing ones; on a strip much narrower than its borders' chords
    // are high, these may look away from the surface they are nearest to.
    if (const auto folded = facets_turned_away(*body.conjoint); !folded.empty())
      return fold_failures(*body.conjoint, folded);

    clock_.start("classification", 0.5, 0.55);
    body.classified = classify(*body.conjoint);
    own_points(*body.conjoint);
    return body.classified.failures;
  }

  /// Recovery puts points where the surface meshes had none, and two sheets may share an edge then that they must not.
  Failures shared_edges(const BodyMesh& body) const {
    Failures failures;
    std::set<std::pair<VertexId, VertexId>> told;
    for (const Offence& offence : find_offences(model_, body.boundary)) {
      if (!told.insert(std::minmax(offence.a, offence.b)).second) continue;
      const Vec3 a = body.vertices.position(offence.a), b = body.vertices.position(offence.b);
      // An edge from a vertex around the face to itself has no length to go by.
      const double size = offence.a == offence.b ? 0.5 * sizes_.at(a) : 0.5 * distance(a, b);
      failures.push_back({{offence.face}, 0.5 * (a + b), size, describe(offence, model_)});
    }
    return failures;
  }

  /// Asked of the locked facets: that they are what the face meshes say is what is to be found out.
  Failures broken_fans(const BodyMesh& body) const {
    Failures failures;
    const auto locked = locked_facets(*body.tets, model_.faces.size());
    for (std::size_t f = 0; f < locked.size(); ++f)
      for (const FanFault& fault : find_fan_faults(body.boundary.faces[FaceId(f)], locked[FaceId(f)])) {
        const Vec3 p = body.vertices.position(fault.vertex);
        failures.push_back({{FaceId(f)}, p, 0.5 * sizes_.at(p), describe(fault)});
      }
    return failures;
  }

  static std::vector<VertexId> used_vertices(const BodyMesh& body) {
    std::vector<char> used(body.vertices.size(), 0);
    for (const FaceMesh& mesh : body.boundary.faces)
      for (std::size_t t = 0; t < mesh.triangle_slots(); ++t)
        if (mesh.triangle(TriangleId(t)).alive())
          for (VertexId v : mesh.vertices(TriangleId(t))) used[v.value()] = 1;
    std::vector<VertexId> list;
    for (std::size_t v = 0; v < used.size(); ++v)
      if (used[v]) list.push_back(VertexId(v));
    return list;
  }

  static void count_initial(BodyMesh& body) {
    for (const FaceMesh& mesh : body.boundary.faces) body.initial_points.push_back(vertices_of(mesh).size());
    body.initial_surface_points = used_vertices(body).size();
  }

  Failures front_failures(const std::vector<FaceFailure>& faces) const {
    Failures failures;
    for (const FaceFailure& f : faces)
      failures.push_back({{f.face}, f.where, 0.5 * sizes_.at(f.where), fmt::format("{}: {}", f.cause, f.detail)});
    return failures;
  }

  const Model& model_;
  SizeField& sizes_;
  const Settings& settings_;
  RecoveryMode mode_;
  OuterLoop& loop_;
  StageClock& clock_;
  Context& context_;
};

}  // namespace

std::vector<VertexId> vertices_of(const FaceMesh& mesh) {
  std::vector<VertexId> vertices;
  for (std::size_t n = 0; n < mesh.node_count(); ++n)
    if (mesh.triangle_at(NodeId(n)).valid()) vertices.push_back(mesh.node(NodeId(n)).vertex);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

Result<BodyMesherResult> mesh_body(const Model& model, SizeField& sizes, const Settings& settings,
                                   const Options& options, OuterLoop& loop, StageClock& clock, Context& context) {
  return BodyMesher(model, sizes, settings, options.recovery, loop, clock, context).run();
}

}  // namespace curvetet
