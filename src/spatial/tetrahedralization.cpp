// Queries, constraints and the commit. A vertex knows one of its tets; everything around it is found by turning or
// flooding from there, so there is no further table to keep right when flips change the complex.
#include "spatial/tetrahedralization.h"

#include <algorithm>
#include <functional>
#include <numeric>

#include "base/gather.h"
#include "base/hilbert.h"
#include "base/parallel_sort.h"

namespace curvetet {

namespace {

std::uint64_t segment_key(VertexId a, VertexId b) {
  return static_cast<std::uint64_t>(std::min(a, b).value()) << 32 | std::max(a, b).value();
}

}  // namespace

const char* name(Refusal refusal) {
  switch (refusal) {
    case Refusal::none:
      return "none";
    case Refusal::duplicate:
      return "duplicate";
    case Refusal::on_locked_facet:
      return "on_locked_facet";
    case Refusal::on_kept_segment:
      return "on_kept_segment";
    case Refusal::locked_cavity:
      return "locked_cavity";
    case Refusal::outside:
      return "outside";
    case Refusal::too_close:
      return "too_close";
    case Refusal::encroaches:
      return "encroaches";
  }
  return "none";
}

Tetrahedralization::Tetrahedralization(const VertexStore& vertices, std::uint64_t seed)
    : vertices_(&vertices), seed_(seed) {}

void Tetrahedralization::cover_vertices() {
  if (vertex_tet_.size() < vertices_->size()) vertex_tet_.resize(vertices_->size());
}

TetId Tetrahedralization::locate(Vec3 p, TetId hint) const {
  const auto usable = [&](TetId t) { return t.value() < complex_.slots() && complex_.is_alive(t); };
  TetId start = usable(hint) ? hint : usable(last_) ? last_ : TetId();
  for (std::size_t slot = 0; !start.valid() && slot < complex_.slots(); ++slot) {
    if (complex_.is_alive(TetId(slot))) start = TetId(slot);
  }
  if (!start.valid()) return TetId();
  // A stream of its own for every call: a location does not depend on those before it.
  kernel::Stream stream(seed_);
  last_ = kernel::walk(complex_, sites(), p, start, stream);
  return last_;
}

TetId Tetrahedralization::commit(const Cavity& cavity) {
  CURVETET_CHECK(cavity.ok() && !cavity.tets.empty());
  cover_vertices();
  for (const TetId t : cavity.tets) CURVETET_CHECK(complex_.is_alive(t));
  star_builder_.replace(complex_, cavity.vertex, cavity.tets, cavity.boundary, star_);
  for (const TetId t : star_) touch(t);
  last_ = star_.back();
  return last_;
}

void Tetrahedralization::note_walls(Insertion& insertion) const {
  kernel::collect_walls(complex_, insertion.cavity.boundary, insertion.walls);
}

void Tetrahedralization::reserve(Insertion& insertion, VertexId vertex) {
  insertion.cavity.vertex = vertex;
  insertion.slots = insertion.cavity.tets;
  while (insertion.slots.size() < insertion.walls.size()) insertion.slots.push_back(complex_.add({}));
}

void Tetrahedralization::commit(Insertion& insertion, kernel::StarBuilder& builder) {
  builder.fill(complex_, insertion.cavity.vertex, insertion.walls, insertion.slots, insertion.cavity.numbers,
               insertion.cavity.numbered);
}

void Tetrahedralization::settle(Insertion& insertion) {
  for (std::size_t k = insertion.walls.size(); k < insertion.slots.size(); ++k) complex_.remove(insertion.slots[k]);
  insertion.slots.resize(insertion.walls.size());
  last_ = insertion.slots.back();
}

void Tetrahedralization::link_vertices() {
  cover_vertices();
  for (std::size_t t = 0; t < complex_.slots(); ++t)
    if (complex_.is_alive(TetId(t))) touch(TetId(t));
}

void Tetrahedralization::sort_in_space(VertexStore& vertices, VertexId first, const Context& context) {
  CURVETET_CHECK(&vertices == vertices_);
  std::vector<std::pair<std::uint64_t, VertexId>> along(vertices.size());
  in_blocks(context, along.size(), kLargeBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) along[v] = {hilbert_index(vertices.position(VertexId(v))), VertexId(v)};
  });
  parallel_sort(context, along, std::less<>());

  std::vector<VertexId> order;
  IndexedVector<VertexId, VertexId> number;
  IndexedVector<VertexId, std::uint32_t> rank;  // by new number
  number.resize(vertices.size());
  rank.resize(vertices.size());
  for (std::size_t k = 0; k < along.size(); ++k) {
    const VertexId v = along[k].second;
    number[v] = v < first ? v : VertexId(first.value() + order.size());
    rank[number[v]] = static_cast<std::uint32_t>(k);
    if (!(v < first)) order.push_back(v);
  }
  vertices.reorder(first, order);
  sort_tets(number, rank, context);
}

/// By the vertex of each that is first along the curve.
void Tetrahedralization::sort_tets(const IndexedVector<VertexId, VertexId>& number,
                                   const IndexedVector<VertexId, std::uint32_t>& rank, const Context& context) {
  constexpr std::uint32_t kNowhere = UINT32_MAX;  // of free slots
  std::vector<std::uint32_t> place(complex_.slots(), kNowhere);
  in_blocks(context, place.size(), kLargeBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (!complex_.is_alive(TetId(t))) continue;
      for (VertexId& v : complex_.tets()[t].vertices) {
        if (v == kInfinite) continue;
        v = number[v];
        place[t] = std::min(place[t], rank[v]);
      }
    }
  });
  std::vector<std::size_t> next(rank.size() + 1, 0);
  for (std::size_t t = 0; t < place.size(); ++t)
    if (place[t] != kNowhere) ++next[place[t] + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<TetId> order(complex_.alive());
  for (std::size_t t = 0; t < place.size(); ++t)
    if (place[t] != kNowhere) order[next[place[t]]++] = TetId(t);
  complex_.reorder(order, context);
  link_vertices();
  star_.clear();
  last_ = TetId();
}

Refusal Tetrahedralization::insert(VertexId vertex, TetId hint) {
  const Cavity cavity = find_cavity(vertex, hint);
  if (cavity.ok()) commit(cavity);
  return cavity.refusal;
}

template <class Until>
void Tetrahedralization::flood_star(VertexId v, kernel::SmallMarks& marks, std::vector<TetId>& out,
                                    const Until& until) const {
  out.clear();
  if (!contains(v)) return;
  marks.start();
  out.push_back(vertex_tet_[v]);
  marks.set(out[0].value(), kernel::kInside);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const TetId t = out[k];
    if (until(t)) {
      std::swap(out[0], out[k]);
      return;
    }
    const int own = complex_.local(t, v);
    for (int i = 0; i < 4; ++i) {
      const TetId next = complex_.neighbour(t, i);
      if (i == own || marks.state(next.value()) != 0) continue;
      marks.set(next.value(), kernel::kInside);
      out.push_back(next);
    }
  }
}

void Tetrahedralization::star(VertexId v, kernel::SmallMarks& marks, std::vector<TetId>& out) const {
  flood_star(v, marks, out, [](TetId) { return false; });
}

std::optional<TetEdge> Tetrahedralization::find_edge(VertexId a, VertexId b) const {
  if (!contains(a) || !contains(b) || a == b) return std::nullopt;
  int j = -1;
  flood_star(a, scratch_.marks, around_, [&](TetId t) { return (j = complex_.local(t, b)) >= 0; });
  if (j < 0) return std::nullopt;
  return TetEdge{around_[0], complex_.local(around_[0], a), j};
}

std::optional<TetFacet> Tetrahedralization::find_facet(VertexId a, VertexId b, VertexId c) const {
  if (!contains(a) || !contains(b) || !contains(c) || a == b || b == c || c == a) return std::nullopt;
  int j = -1, k = -1;
  flood_star(a, scratch_.marks, around_, [&](TetId t) {
    j = complex_.local(t, b);
    k = complex_.local(t, c);
    return j >= 0 && k >= 0;
  });
  if (j < 0 || k < 0) return std::nullopt;
  return TetFacet{around_[0], 6 - complex_.local(around_[0], a) - j - k};
}

void Tetrahedralization::ring(TetEdge edge, std::vector<TetId>& out) const {
  out.clear();
  const VertexId a = complex_.vertex(edge.tet, edge.i);
  const VertexId b = complex_.vertex(edge.tet, edge.j);
  // In kFacet[i] the other three follow i in even order.
  const std::array<int, 3>& others = kFacet[static_cast<std::size_t>(edge.i)];
  const std::size_t at = others[0] == edge.j ? 0 : others[1] == edge.j ? 1 : 2;
  // (others..., i) is even, and moving i to the front past three is odd: k is the one before j.
  VertexId away = complex_.vertex(edge.tet, others[(at + 2) % 3]);
  TetId t = edge.tet;
  do {
    out.push_back(t);
    VertexId kept;
    for (const VertexId v : complex_.vertices(t)) {
      if (v != a && v != b && v != away) kept = v;
    }
    t = complex_.neighbour(t, complex_.local(t, away));
    away = kept;
  } while (t != edge.tet);
}

void Tetrahedralization::keep_segment(VertexId a, VertexId b) {
  cover_vertices();
  if (!kept_.insert(segment_key(a, b)).second) return;
  const std::size_t most = std::max(a, b).value() + std::size_t{1};
  if (kept_degree_.size() < most) kept_degree_.resize(most);
  ++kept_degree_[a];
  ++kept_degree_[b];
}

void Tetrahedralization::release_segment(VertexId a, VertexId b) {
  if (kept_.erase(segment_key(a, b)) == 0) return;
  --kept_degree_[a];
  --kept_degree_[b];
}

bool Tetrahedralization::is_kept(VertexId a, VertexId b) const {
  return !kept_.empty() && kept_.contains(segment_key(a, b));
}

std::vector<std::array<VertexId, 2>> Tetrahedralization::kept_segments() const {
  std::vector<std::uint64_t> keys(kept_.begin(), kept_.end());
  std::sort(keys.begin(), keys.end());
  std::vector<std::array<VertexId, 2>> segments;
  segments.reserve(keys.size());
  for (const std::uint64_t key : keys) {
    segments.push_back({VertexId(static_cast<std::uint32_t>(key >> 32)), VertexId(static_cast<std::uint32_t>(key))});
  }
  return segments;
}

std::size_t Tetrahedralization::bytes() const {
  const std::size_t kept_node = sizeof(std::uint64_t) + sizeof(void*);
  return complex_.bytes() + vertex_tet_.raw().capacity() * sizeof(TetId) +
         kept_degree_.raw().capacity() * sizeof(std::uint32_t) + kept_.size() * kept_node +
         kept_.bucket_count() * sizeof(void*) + star_.capacity() * sizeof(TetId) + scratch_.bytes() +
         star_builder_.bytes();
}

void Tetrahedralization::touch(TetId t) {
  if (vertex_tet_.size() < vertices_->size()) cover_vertices();
  for (const VertexId v : complex_.vertices(t)) {
    if (v != kInfinite) vertex_tet_[v] = t;
  }
}

}  // namespace curvetet
