// SPDX-License-Identifier: Apache-2.0
// The whole way to a drawing:
//
//    Surfaces --weld--> mesh --close_seams--> --see--> facing of every triangle
//                                                 |
//                        find_features <----------+----> OccluderGrid
//                        find_crossings                      |
//                              |                             |
//                              +--> candidates --EdgeCutter--+--> parts, seen and hidden
//
// Threads cut 64 edges at a time, and their lists of parts are joined in the order of the edges.
#include "frontmost/lines.h"

#include <algorithm>
#include <atomic>
#include <string>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/pool.h"
#include "base/work_limit.h"
#include "lines/crossings/crossings.h"
#include "lines/hiding/hidden_parts.h"
#include "lines/lists.h"
#include "lines/mesh/feature_edges.h"

namespace frontmost {
namespace {

using namespace lines_detail;

constexpr std::size_t kEdgesPerPart = 64, kEdgesPerPoll = 16;
constexpr std::size_t kPartsPerTally = 1 << 16;
/// A drawing has at most kMostParts parts, and kMostPartsOfEdge more for each edge: five times what a city has.
constexpr std::size_t kMostParts = std::size_t(1) << 21, kMostPartsOfEdge = 4;
/// At most kMostBoxes boxes of triangles are compared with edges, and kMostBoxesOfEdge more for each edge. A comparison
/// takes 0.6 nanoseconds. The limit is sixty times what a city takes.
constexpr std::uint64_t kMostBoxes = std::uint64_t(1) << 35, kMostBoxesOfEdge = 1024;
/// Memory of all Buffers of a drawing together, with a reserve: the bunny takes 260 bytes per triangle.
constexpr std::size_t kBytesPerTriangle = 400;
constexpr double kCutFrom = 0.3;  // share of the progress at which cutting begins

/// All edges that will be drawn, before they are cut.
struct Candidates {
  [[nodiscard]] std::size_t count() const { return features.size() + crossings.size(); }

  [[nodiscard]] DrawnEdge drawn(std::size_t i) const {
    if (i < features.size()) {
      const FeatureEdge& f = features[i];
      return {mesh.positions[f.from], mesh.positions[f.to], f.kind, id_of(f.left), id_of(f.right)};
    }
    const Crossing& c = crossings[i - features.size()];
    return {c.from.place, c.to.place, EdgeKind::intersection, id_of(c.left), id_of(c.right)};
  }

  [[nodiscard]] SightedEdge sighted(std::size_t i) const {
    if (i < features.size()) {
      const FeatureEdge& f = features[i];
      const glm::dvec3 from = mesh.positions[f.from], to = mesh.positions[f.to];
      return {from, to, {f.from, f.from}, {f.to, f.to}, {f.left, f.right}, 0, f.outer};
    }
    const Crossing& c = crossings[i - features.size()];
    return {c.from.place, c.to.place, c.from.on, c.to.on, {c.left, c.right}, slack_of(c.from.place, c.to.place)};
  }

  [[nodiscard]] PrimitiveId id_of(std::uint32_t triangle) const {
    return triangle == no_index ? no_primitive : mesh.ids[triangle];
  }

  const WeldedMesh& mesh;
  const std::vector<FeatureEdge> features;
  const std::vector<Crossing> crossings;
};

/// Fills the edges and parts of `drawing`.
void cut_all(const Candidates& candidates, const EdgeOccluders& occlusion, const Execution& execution,
             Drawing& drawing) {
  const std::size_t count = candidates.count();
  reserve_large(drawing.edges, count, execution);
  std::vector<std::vector<DrawnPart>> lists((count + kEdgesPerPart - 1) / kEdgesPerPart);
  Pool<EdgeCutter> cutters;
  std::atomic<std::size_t> done{0}, parts{0};
  const std::size_t most_parts = kMostParts + kMostPartsOfEdge * count;
  WorkLimit work(execution, kMostBoxes + kMostBoxesOfEdge * count, "lines");
  const auto tell = [&](EdgeCutter& cutter) {
    work.add(cutter.take_work(), [] { return std::string("too many triangles lie over each other"); });
  };
  const auto cut = [&](std::vector<DrawnPart>& list, std::size_t begin, std::size_t end) {
    const auto cutter = cutters.borrow([&] { return std::make_unique<EdgeCutter>(occlusion); });
    std::size_t counted = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (i % kEdgesPerPoll == 0) tell(*cutter);
      cutter->cut(candidates.sighted(i), std::uint32_t(i), list);
      // A single edge may have as many parts as there are triangles.
      if (list.size() - counted < kPartsPerTally && i + 1 < end) continue;
      if ((parts += list.size() - counted) > most_parts)
        throw Error(ErrorCode::limit_exceeded, "lines", "more than " + std::to_string(most_parts) + " parts of edges");
      counted = list.size();
    }
    tell(*cutter);
    report_progress(execution, "lines", 1 - (1 - kCutFrom) * double(count - (done += end - begin)) / double(count));
  };
  // The edges are listed while other threads cut.
  parallel_for(execution, lists.size() + 1, 1, [&](std::size_t part, std::size_t) {
    if (part > 0) return cut(lists[part - 1], (part - 1) * kEdgesPerPart, std::min(count, part * kEdgesPerPart));
    for (std::size_t i = 0; i < count; ++i) {
      if (i % kPartsPerTally == 0) check_cancelled(execution);
      drawing.edges.push_back(candidates.drawn(i));
    }
  });
  drawing.parts = joined(lists, execution);
}

/// Removes the crossings of triangles that lie on opposite sides of a gap.
void erase_at_gaps(const WeldedMesh& mesh, const VertexPairs& continued, std::vector<Crossing>& crossings) {
  std::vector<bool> is_at_gap(mesh.positions.size(), false);
  for (const auto& [low, high] : continued) is_at_gap[low] = is_at_gap[high] = true;
  const auto touches = [&](std::uint32_t triangle) {
    const glm::uvec3& t = mesh.triangles[triangle];
    return is_at_gap[t.x] || is_at_gap[t.y] || is_at_gap[t.z];
  };
  std::erase_if(crossings, [&](const Crossing& crossing) {
    return touches(crossing.left) && touches(crossing.right) &&
           meet_at_gap(mesh, continued, crossing.left, crossing.right);
  });
}

/// Adds to the message of a limit the place where most triangles lie over each other.
Error with_place(const Error& error, const OccluderGrid& grid, const WeldedMesh& mesh, const Surfaces& surfaces) {
  const OccluderGrid::Crowd crowd = grid.largest_crowd();
  if (error.code() != ErrorCode::limit_exceeded || crowd.count == 0) return error;
  const PrimitiveId id = mesh.ids[crowd.triangle];
  return {error.code(), error.file(), error.place(),
          error.reason() + ": most of them, " + std::to_string(crowd.count) + ", in one place, among them face " +
              std::to_string(surfaces.source(id).triangle) + " of object " +
              std::to_string(surfaces.source(id).instance) + "; leave out faces that lie there many times"};
}

}  // namespace

struct LineDrawer::State {
  explicit State(const Surfaces& its_surfaces) : surfaces(its_surfaces) {}

  /// The properties of the mesh's triangles. The first view welds the mesh and closes its seams.
  [[nodiscard]] SeenMesh see_mesh(const Sight& sight, const Execution& execution) {
    if (!is_ready) {
      mesh = weld(surfaces, execution);
      SeenMesh seen = see(mesh, sight, execution);
      const bool had_seams = close_seams(mesh, seen.facing, execution);
      table = corner_table(mesh, execution);
      is_ready = true;
      if (!had_seams) return seen;
    }
    return see(mesh, sight, execution);
  }

  const Surfaces& surfaces;
  bool is_ready = false;
  WeldedMesh mesh;
  CornerTable table;
  std::optional<CrossedPairs> pairs;
};

LineDrawer::LineDrawer(const Surfaces& surfaces) : state_(std::make_unique<State>(surfaces)) {}
LineDrawer::~LineDrawer() = default;
LineDrawer::LineDrawer(LineDrawer&&) noexcept = default;
LineDrawer& LineDrawer::operator=(LineDrawer&&) noexcept = default;

Drawing LineDrawer::draw(const View& view, const LineOptions& options, const Execution& execution) {
  validate(view);
  if (options.crease_angle && !(*options.crease_angle >= 0 && *options.crease_angle <= 3.1415926535897932))
    throw Error(ErrorCode::bad_argument, "crease_angle", "must be from 0 to pi");
  const IeeeScope ieee;
  const Surfaces& surfaces = state_->surfaces;
  const WeldedMesh& mesh = state_->mesh;
  const Arena arena(kBytesPerTriangle * surfaces.primitive_count());
  report_progress(execution, "lines", 0);
  const Sight sight(view);
  SeenMesh seen = state_->see_mesh(sight, execution);
  Features features = find_features(seen, state_->table, surfaces, options, execution);
  // Coincident triangles hide no more than one of them, so only the first is kept.
  if (!options.counts_hidden)
    for (const std::uint32_t twin : features.twins) seen.facing[twin] = 0;
  report_progress(execution, "lines", 0.1);
  const OccluderGrid grid(seen, view, options.counts_hidden, execution);
  report_progress(execution, "lines", 0.2);
  Drawing drawing;
  drawing.view = view;
  try {
    std::vector<Crossing> crossings;
    if (options.intersections) {
      if (!state_->pairs) state_->pairs = find_crossed_pairs(mesh, features, execution);
      crossings = find_crossings(features, *state_->pairs, execution);
    }
    if (!features.continued.empty()) erase_at_gaps(mesh, features.continued, crossings);
    const Candidates candidates{mesh, std::move(features.edges), std::move(crossings)};
    report_progress(execution, "lines", kCutFrom);
    const ShadowKernels kernels = shadow_kernels(execution.isa);
    cut_all(candidates, {sight, view, grid, kernels, options.counts_hidden, options.outlines}, execution, drawing);
  } catch (const Error& error) {
    throw with_place(error, grid, mesh, surfaces);
  }
  return drawing;
}

Drawing draw_lines(const Surfaces& surfaces, const View& view, const LineOptions& options, const Execution& execution) {
  return LineDrawer(surfaces).draw(view, options, execution);
}

}  // namespace frontmost
