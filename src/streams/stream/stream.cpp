// SPDX-License-Identifier: Apache-2.0
// The passes over a stream. Pieces are drawn one by one and merged. The nearest triangle is a minimum, so the result
// does not depend on the size or order of pieces, nor on the rank that read them.
#include <algorithm>
#include <filesystem>
#include <mutex>

#include "base/parallel.h"
#include "frontmost/pictures.h"
#include "frontmost/streams.h"
#include "frontmost/zbuffer.h"
#include "shade/geometry/geometry.h"
#include "stream/neighbours.h"
#include "stream/outline.h"
#include "stream/sight.h"

namespace frontmost {

using namespace streaming;

namespace {

Turns turns_of(const StreamOptions& options) {
  if (!options.ranks) return {};
  return {options.ranks->number(), options.ranks->count(), options.readers};
}

/// The size of pieces, small enough that every rank gets some of each shared file.
std::uint32_t shared_piece_size(const std::vector<std::string>& paths, const StreamOptions& options) {
  if (!options.ranks) return options.triangles_at_once;
  constexpr std::uint64_t bytes_per_triangle = 50, pieces_each = 4, least = 1u << 12;
  const Turns turns = turns_of(options);
  std::uint64_t bytes = 0;
  std::error_code ignored;
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (turns.reader_of(i) < 0) bytes += std::filesystem::file_size(paths[i], ignored);
  const std::uint64_t even = bytes / (bytes_per_triangle * pieces_each * std::uint64_t(turns.count));
  return bytes == 0 ? options.triangles_at_once
                    : std::uint32_t(std::min<std::uint64_t>(std::max(even, least), options.triangles_at_once));
}

/// Vertices of the kept triangles that are large enough on the screen for their smooth normals to be used.
std::vector<glm::vec3> large_corners(const KeptPieces& kept, const std::vector<Visible>& visible,
                                     const Execution& execution) {
  const std::vector<PrimitiveId> ids = ids_of(kept);
  const IdMap places(ids);
  std::vector<shading::BitSet> large;
  for (const Visible& one : visible) {
    const PrimitiveId* const seen = one.primitives.data();
    std::vector<PrimitiveId> first(seen, seen + one.view.pixel_count());
    places.apply(first, execution);
    large.push_back(shading::large_primitives(ids.size(), first, one.view.width, execution));
  }
  std::vector<glm::vec3> corners;
  std::size_t id = 0;
  for (const auto& [number, piece] : kept)
    for (std::uint32_t t = 0; t < piece.triangles.size(); ++t, ++id)
      if (piece.mesh.normals.empty() &&
          std::any_of(large.begin(), large.end(), [&](auto& set) { return set.contains(id); }))
        for (int k = 0; k < 3; ++k) corners.push_back(piece.mesh.positions[3 * t + std::uint32_t(k)]);
  return corners;
}

}  // namespace

struct Stream::State {
  State(const std::vector<std::string>& paths, const StreamOptions& given, const Execution& execution)
      : options(given), models(paths, given.load, turns_of(given), execution) {
    constexpr std::uint32_t most_at_once = 1u << 24;
    if (given.triangles_at_once < 1 || given.triangles_at_once > most_at_once)
      throw Error(ErrorCode::bad_argument, "triangles_at_once", "must be 1 to 16777216");
    options.triangles_at_once = shared_piece_size(paths, given);
  }

  /// Exchanges facts with the other ranks after the first pass. `found` holds the bounds that this rank has found, and
  /// gets those of all ranks. \returns the map from this pass's ids to ids of the whole model.
  IdShift share_facts(Box& found) {
    const std::vector<PrimitiveId> from = models.first_ids();
    const std::vector<std::uint64_t> counts = models.triangle_counts();
    const PassFacts all = share(*options.ranks, {counts, models.take_warnings(), found});
    models.set_triangle_counts(all.triangle_counts);
    models.add_warnings(all.warnings);
    found = all.bounds;
    triangle_count = 0;
    for (const std::uint64_t count : all.triangle_counts) *triangle_count += count;
    return {from, counts, models.first_ids()};
  }

  /// Calls work(worker, piece, place, execution of the worker) for every piece. `samples` is the number of samples that
  /// a worker draws a piece into, over all views.
  template <class Work>
  void pass(std::size_t samples, const Execution& execution, const Work& work) {
    if (passes++ > 0) {
      if (!models.can_rewind())
        throw Error(ErrorCode::unsupported,
                    "standard input and pipes can be read only once, and this takes another pass");
      models.rewind();
    }
    // The memory for pieces limits the number of workers, which share the threads.
    constexpr std::size_t memory = std::size_t(512) << 20, bytes_per_triangle = 220, bytes_per_sample = 8;
    const std::size_t each = options.triangles_at_once * bytes_per_triangle + samples * bytes_per_sample;
    const int workers = std::min(thread_count(execution), int(std::max<std::size_t>(memory / each, 1)));
    // Workers report no progress of their own: the loop over pieces does.
    Watch quiet;
    if (execution.watch) quiet.cancelled = execution.watch->cancelled;
    const Execution of_worker{std::max(1, thread_count(execution) / workers), execution.isa, &quiet};
    for_each_piece(
        models, {options.triangles_at_once, workers}, execution,
        [&](int worker, StreamPiece& piece, const PiecePlace& place) { work(worker, piece, place, of_worker); });
  }

  /// The first pass of look(): finds what is visible on any rank, and keeps copies of the triangles read here.
  KeptPieces find_visible(const std::vector<View>& views, const StreamNeeds& needs, Excerpt& excerpt,
                          const Execution& execution) {
    SightGatherer sight(views, {.triangles = true, .bounds = !bounds, .unseen = needs.unseen});
    std::vector<Drawer> drawers(std::size_t(thread_count(execution)));
    pass(sight.sample_count(), execution,
         [&](int worker, StreamPiece& piece, const PiecePlace& place, const Execution& each) {
           drawers[std::size_t(worker)].draw(piece, place, models.scene(), sight, each);
         });
    Box found = bounds.value_or(sight.bounds());
    if (options.ranks) sight.share(*options.ranks, share_facts(found), execution);
    sight.forget_hidden();
    bounds = found;
    excerpt.visible = sight.take_visible();
    return sight.take_kept();
  }

  /// The second pass of look(): finds what the light sees, and the neighbours of visible triangles.
  KeptPieces find_needs(KeptPieces kept, const StreamNeeds& needs, Excerpt& excerpt, const Execution& execution) {
    std::vector<View> light;
    if (needs.key_light)
      if (const auto view = key_light_view(excerpt.visible.front(), *bounds, needs.light, execution))
        light.push_back(*view);
    std::optional<NeighbourFinder> neighbours;
    if (needs.smooth_normals) {
      std::vector<glm::vec3> corners = large_corners(kept, excerpt.visible, execution);
      if (options.ranks) corners = share(*options.ranks, corners);
      if (!corners.empty()) neighbours.emplace(std::move(kept), corners);
    }
    if (light.empty() && !neighbours) return kept;
    SightGatherer sight(light, {});
    std::vector<Drawer> drawers(std::size_t(thread_count(execution)));
    pass(sight.sample_count(), execution,
         [&](int worker, StreamPiece& piece, const PiecePlace& place, const Execution& each) {
           if (neighbours) neighbours->find(piece.mesh, place);
           if (!light.empty()) drawers[std::size_t(worker)].draw(piece, place, models.scene(), sight, each);
         });
    if (options.ranks && !light.empty()) sight.share(*options.ranks, {{}, {}, {}}, execution);
    if (!light.empty()) excerpt.seen_by_light = std::move(sight.take_visible().front());
    return neighbours ? neighbours->take() : std::move(kept);
  }

  StreamOptions options;
  Models models;
  int passes = 0;
  std::optional<Box> bounds;                    ///< set by the first pass that finds them
  std::optional<std::uint64_t> triangle_count;  ///< triangles of all ranks, once the ranks have exchanged facts
};

Stream::Stream(const std::vector<std::string>& paths, const StreamOptions& options, const Execution& execution)
    : state_(std::make_unique<State>(paths, options, execution)) {}
Stream::~Stream() = default;
Stream::Stream(Stream&&) noexcept = default;
Stream& Stream::operator=(Stream&&) noexcept = default;

const Scene& Stream::scene() const { return state_->models.scene(); }
bool Stream::can_repeat() const { return state_->models.can_rewind(); }
int Stream::passes() const { return state_->passes; }
std::uint64_t Stream::triangle_count() const {
  return state_->triangle_count.value_or(state_->models.triangle_count());
}
Box Stream::bounds() const { return state_->bounds.value_or(Box{}); }

Scene Stream::outline(const View& direction, double margin, const Execution& execution) {
  std::vector<OutlineFinder> finders(std::size_t(thread_count(execution)), OutlineFinder(direction, margin));
  state_->pass(0, execution, [&](int worker, StreamPiece& piece, const PiecePlace&, const Execution&) {
    finders[std::size_t(worker)].include(piece.mesh);
  });
  OutlineFinder finder(direction, margin);
  for (const OutlineFinder& other : finders) finder.include(other.points());
  if (Ranks* const ranks = state_->options.ranks) finder.include(share(*ranks, finder.points()));
  Box bounds = finder.bounds();
  if (state_->options.ranks) (void)state_->share_facts(bounds);
  state_->bounds = bounds;
  Scene scene = finder.scene();
  scene.name = state_->models.scene().name;
  scene.up = state_->models.scene().up;
  scene.origin = state_->models.scene().origin;
  return scene;
}

Excerpt Stream::look(const std::vector<View>& views, const StreamNeeds& needs, const Execution& execution) {
  if (views.empty()) throw Error(ErrorCode::bad_argument, "stream", "no views");
  Excerpt excerpt;
  KeptPieces kept = state_->find_visible(views, needs, excerpt, execution);
  kept = state_->find_needs(std::move(kept), needs, excerpt, execution);
  if (Ranks* const ranks = state_->options.ranks) {
    kept = gather(*ranks, std::move(kept));
    if (ranks->number() != 0) return {};
  }
  excerpt.stream_ids = ids_of(kept);
  const IdMap places(excerpt.stream_ids);
  for (Visible& visible : excerpt.visible)
    places.apply({visible.primitives.data(), visible.primitives.size()}, execution);
  excerpt.parts_ = std::make_unique<const Excerpt::Parts>(scene_of(state_->models.scene(), std::move(kept)), execution);
  return excerpt;
}

}  // namespace frontmost
