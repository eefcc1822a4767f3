// SPDX-License-Identifier: Apache-2.0
// The exactly nearest triangle at every sample: bounds in doubles decide nearly everywhere, expansions the rest.
//
// The z-buffer's coverage is exact already, by integers and the top-left rule. Its tiles and coverage are therefore
// reused (zbuffer/place); only depths, which it rounds to keys, are computed anew.
#include <algorithm>
#include <array>
#include <optional>

#include "base/work_limit.h"
#include "frontmost/precision.h"
#include "report/exact_depth.h"
#include "view/screen_cutout.h"
#include "zbuffer/place/submission.h"
#include "zbuffer/triangle_records.h"

namespace frontmost {
namespace {

using namespace zbuffer_detail;

/// A triangle at a sample is one step of work if doubles decide. The constants are the steps of entering a triangle
/// into a tile, of comparing two planes exactly, and of comparing two depths; a tile reports its steps in portions of
/// kStepsAtOnce.
constexpr std::uint64_t kStepsOfTriangle = 16, kStepsOfPlanes = 16, kStepsOfDepths = 64, kStepsAtOnce = 1 << 14;
/// Limits of the steps: in all, and more for each sample and triangle.
constexpr std::uint64_t kMostSteps = std::uint64_t(1) << 29, kMostStepsOfSample = 128, kMostStepsOfTriangle = 1024;

/// Cached facts about a pair of triangles. In models with coplanar faces, thousands of samples need them.
struct Rival {
  PrimitiveId beside = no_primitive, id = no_primitive;
  bool shares_plane = false, has_one_depth = false;  // has_one_depth: both triangles lie at one depth
  std::optional<BoundedPlane> plane;
};

/// The planes being filled, and the bounds of the nearest depth so far, by sample.
struct NearestBounds {
  const Surfaces& surfaces;
  const SampleRays rays;
  const ScreenRays screen_rays;
  std::span<const glm::ivec2> samples;
  ExactVisible& answer;
  Buffer<DepthBounds> bounds;
};

class TileContest {
 public:
  TileContest(NearestBounds& field, const PixelRect& tile, WorkLimit& work) : field_(field), tile_(tile), work_(work) {}

  void enter(const TriangleRecord& r) {
    const View& view = field_.answer.view;
    const PixelRect rect = common_part(pixel_rect(r, view.width, view.height), tile_);
    if (rect.is_empty()) return;
    steps_ += kStepsOfTriangle;
    const BoundedPlane plane(field_.surfaces.corners(r.id), field_.rays);
    const Cutouts* const cutouts = placed_scene(field_.surfaces).cutouts.get();
    std::optional<ScreenCutout> cutout;
    if (cutouts && cutouts->has(r.id)) cutout.emplace((*cutouts)[r.id], field_.screen_rays);
    for (std::size_t s = 0; s < field_.samples.size(); ++s) {
      const glm::ivec2 offset = field_.samples[s];
      visit_covered(r, rect, offset, [&](int x, int y) {
        if (cutout && cutout->is_hole(x * kSubPixels + offset.x, y * kSubPixels + offset.y)) return;
        fragment(x, y, s, r.id, plane);
      });
    }
    if (steps_ > kStepsAtOnce) tell();
  }
  /// Reports the steps since the last call. \throws Error limit_exceeded, cancelled.
  void tell() {
    work_.add(std::exchange(steps_, 0), [&] {
      return "too many of " + std::to_string(field_.surfaces.primitive_count()) +
             " triangles lie over each other in the picture";
    });
  }

 private:
  void fragment(int x, int y, std::size_t sample, PrimitiveId id, const BoundedPlane& plane) {
    ++steps_;
    ExactVisible& answer = field_.answer;
    const SampleRay ray = field_.rays.at(x, y, field_.samples[sample]);
    const DepthBounds bounds = plane.at(ray);
    const std::size_t i =
        (sample * std::size_t(answer.view.height) + std::size_t(y)) * std::size_t(answer.view.width) + std::size_t(x);
    DepthBounds& best = field_.bounds[i];
    const bool first = answer.primitives[i] == no_primitive;
    if (!first && bounds.low > best.high) return;
    const int order =
        first || bounds.high < best.low ? -1 : compare_exactly(id, answer.primitives[i], plane, bounds, best, ray);
    if (order > 0) return;
    if (order == 0) {
      answer.tied[i] = 1;
      return;  // ids ascend, so the first one stays
    }
    answer.primitives[i] = id;
    answer.tied[i] = 0;
    best = bounds;
  }

  /// Compares the depths of `a` and `b` at a ray, where their bounds are `bounds` and `others`.
  [[nodiscard]] int compare_exactly(PrimitiveId a, PrimitiveId b, const BoundedPlane& plane, const DepthBounds& bounds,
                                    const DepthBounds& others, const SampleRay& ray) {
    const Rival& rival = rival_of(a, b);
    if (rival.shares_plane &&
        (rival.has_one_depth || (plane.is_within_corners(bounds) && rival.plane->is_within_corners(others))))
      return 0;
    steps_ += kStepsOfDepths;
    return compare(ExactDepth(field_.surfaces.corners(a), field_.rays, ray),
                   ExactDepth(field_.surfaces.corners(b), field_.rays, ray));
  }

  /// The cached facts about `b` relative to `a`.
  [[nodiscard]] const Rival& rival_of(PrimitiveId a, PrimitiveId b) {
    Rival& rival = rivals_[b % rivals_.size()];
    if (rival.beside == a && rival.id == b) return rival;
    steps_ += kStepsOfPlanes;
    const auto own = field_.surfaces.corners(a), other = field_.surfaces.corners(b);
    rival.beside = a;
    rival.id = b;
    rival.shares_plane = share_a_plane(own, other);
    rival.has_one_depth = rival.shares_plane && has_one_depth(own, field_.rays) && has_one_depth(other, field_.rays);
    if (rival.shares_plane) rival.plane.emplace(other, field_.rays);
    return rival;
  }

  NearestBounds& field_;
  PixelRect tile_;
  WorkLimit& work_;
  std::uint64_t steps_ = 0;       ///< not yet reported
  std::array<Rival, 16> rivals_;  // by the last bits of their ids
};

}  // namespace

ExactVisible find_exact_visible(const Surfaces& surfaces, const View& view, const Execution& execution) {
  validate(view);
  const IeeeScope ieee;
  const std::size_t count = view.sample_count();
  ExactVisible answer{view, Buffer<PrimitiveId>(count, no_primitive), Buffer<std::uint8_t>(count, 0)};
  NearestBounds field{surfaces, SampleRays(view),          ScreenRays(view), sample_offsets(view.samples),
                      answer,   Buffer<DepthBounds>(count)};
  WorkLimit work(execution, kMostSteps + kMostStepsOfSample * count + kMostStepsOfTriangle * surfaces.primitive_count(),
                 "exact depths");
  submit(surfaces, view, {0, surfaces.primitive_count()}, execution, [&](const Tile& tile, const OrderedBatch& batch) {
    TileContest contest(field, tile.rect(), work);
    batch.visit_tile(
        tile,
        [&](std::span<const TileRun> runs) {
          for (const TileRun& run : runs)
            for (std::size_t i = 0; i < run.count; ++i) contest.enter(batch.small().record(run.first + i));
        },
        [&](const SingleTriangle& single) { contest.enter(single.record); });
    contest.tell();
  });
  return answer;
}

}  // namespace frontmost
