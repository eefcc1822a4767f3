// SPDX-License-Identifier: Apache-2.0
// The exactly nearest triangle at every sample: bounds in doubles decide nearly everywhere, expansions the rest.
//
// The z-buffer's coverage is exact already, by integers and the top-left rule. Its tiles and coverage are therefore
// reused (zbuffer/place); only depths, which it rounds to keys, are computed anew. With n the normal and a a corner, a
// ray o + d v meets the plane at d = n.(a - o) / n.v.
#include "report/exact_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/work_limit.h"
#include "frontmost/precision.h"
#include "view/screen_cutout.h"
#include "view/screen_transform.h"
#include "zbuffer/place/submission.h"
#include "zbuffer/triangle_records.h"

namespace frontmost {

SampleRays::SampleRays(const View& view)
    : orthographic_(view.projection.orthographic),
      eye_(view.eye()),
      forward_(view.forward()),
      right_(view.right()),
      up_(view.up()),
      left_(view.projection.left),
      top_(view.projection.top),
      step_x_((view.projection.right - view.projection.left) / view.width),
      step_y_((view.projection.top - view.projection.bottom) / view.height) {
  const ScreenTransform t(view);
  near_ = double(t.near);
  far_ = double(t.far);
  const double guard = double(kGuardBand) / kSubPixels;
  widest_ =
      glm::length(glm::dvec3((guard + 0.5 * view.width) * step_x_ + std::abs(left_ + 0.5 * view.width * step_x_),
                             (guard + 0.5 * view.height) * step_y_ + std::abs(top_ - 0.5 * view.height * step_y_), 1));
}

SampleRay SampleRays::at(int x, int y, const glm::ivec2& offset) const {
  const double along = left_ + (x + offset.x / 256.0) * step_x_, upwards = top_ - (y + offset.y / 256.0) * step_y_;
  const glm::dvec3 aside = along * right_ + upwards * up_;
  if (orthographic_) return {eye_ + aside, forward_};
  return {eye_, forward_ + aside};
}

BoundedPlane::BoundedPlane(const std::array<glm::vec3, 3>& corners, const SampleRays& rays) : corner_(corners[0]) {
  const glm::dvec3 ab = glm::dvec3(corners[1]) - corner_, ac = glm::dvec3(corners[2]) - corner_;
  normal_ = BoundedNormal(ab, ac);
  double low = std::numeric_limits<double>::infinity(), high = -low, error = 0;
  for (const glm::vec3& corner : corners) {
    const Bounded depth = bounded_dot(rays.forward(), glm::dvec3(0), glm::dvec3(corner) - rays.eye());
    low = std::min(low, depth.value);
    high = std::max(high, depth.value);
    error = std::max(error, depth.error);
  }
  const auto within = [&](double depth) { return std::min(std::max(depth, rays.near()), rays.far()); };
  limits_low_ = {within(low - error), within(low + error)};
  limits_high_ = {within(high - error), within(high + error)};
}

DepthBounds BoundedPlane::at(const SampleRay& ray) const {
  const Bounded above = bounded_dot(normal_.value, normal_.error, corner_ - ray.origin);
  const Bounded below = bounded_dot(normal_.value, normal_.error, ray.direction);
  // If the plane is seen nearly edge-on, or contains the eye, only the corners' range is known. The test is written so
  // that NaN passes it.
  if (!(std::abs(below.value) > 4 * below.error)) return {limits_low_.low, limits_high_.high};
  const double depth = above.value / below.value;
  const double error = (above.error + std::abs(depth) * below.error) / (std::abs(below.value) - below.error) +
                       kRounding * std::abs(depth);
  return {std::min(std::max(depth - error, limits_low_.low), limits_high_.low),
          std::min(std::max(depth + error, limits_low_.high), limits_high_.high)};
}

bool lie_in_one_plane(const std::array<glm::vec3, 3>& a, const std::array<glm::vec3, 3>& b) {
  const glm::dvec3 origin(a[0]);
  const Leg ab{glm::dvec3(a[1]), origin}, ac{glm::dvec3(a[2]), origin};
  return std::all_of(b.begin(), b.end(), [&](const glm::vec3& corner) {
    return sign_of_determinant(ab, ac, {glm::dvec3(corner), origin}) == 0;
  });
}

Fraction exact_depth(const std::array<glm::vec3, 3>& corners, const SampleRays& rays, const SampleRay& ray) {
  const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
  const ExactVector normal = cross(difference(b, a), difference(c, a));
  Fraction depth{dot(normal, difference(a, ray.origin)), dot(normal, exact(ray.direction))};
  if (depth.denominator.sign() < 0) depth = {-depth.numerator, -depth.denominator};
  // Edge-on: the ray lies in the plane or misses it. The depth of the nearest corner is used.
  if (depth.denominator.sign() == 0) depth = {Expansion(-std::numeric_limits<float>::max()), Expansion(1)};
  // Limits the depth to the corners' range, by the same rule as the bounds above; otherwise exact depths and bounds
  // would disagree about slivers.
  Expansion nearest, farthest;
  for (std::size_t i = 0; i < 3; ++i) {
    const Expansion at = dot(exact(rays.forward()), difference(glm::dvec3(corners[i]), rays.eye()));
    if (i == 0 || (at - nearest).sign() < 0) nearest = at;
    if (i == 0 || (at - farthest).sign() > 0) farthest = at;
  }
  // Limits the depth from below (side 1) or from above (side -1).
  const auto limit = [&](const Expansion& bound, int side) {
    if ((bound * depth.denominator - depth.numerator).sign() == side) depth = {bound, Expansion(1)};
  };
  limit(nearest, 1);
  limit(farthest, -1);
  limit(Expansion(rays.near()), 1);
  limit(Expansion(rays.far()), -1);
  return depth;
}

namespace {

using namespace zbuffer_detail;

/// Whether two triangles lie in exactly one common plane. False if doubles leave open whether each triangle has an
/// area.
bool share_a_plane(const std::array<glm::vec3, 3>& a, const std::array<glm::vec3, 3>& b) {
  const auto has_area = [](const std::array<glm::vec3, 3>& corners) {
    const glm::dvec3 from(corners[0]);
    const BoundedNormal normal(glm::dvec3(corners[1]) - from, glm::dvec3(corners[2]) - from);
    const glm::dvec3 sure = glm::abs(normal.value) - normal.error;
    return sure.x > 0 || sure.y > 0 || sure.z > 0;
  };
  return has_area(a) && has_area(b) && lie_in_one_plane(a, b);
}

/// Whether all corners have exactly the same depth. Every point of the triangle then has that depth.
bool has_one_depth(const std::array<glm::vec3, 3>& corners, const SampleRays& rays) {
  const auto is_level = [&](const glm::vec3& corner) {
    const Bounded step = bounded_dot(rays.forward(), glm::dvec3(0), glm::dvec3(corner) - glm::dvec3(corners[0]));
    if (std::abs(step.value) > 2 * step.error) return false;
    return dot(exact(rays.forward()), difference(glm::dvec3(corner), glm::dvec3(corners[0]))).sign() == 0;
  };
  return is_level(corners[1]) && is_level(corners[2]);
}

/// A triangle at a sample is one step of work if doubles decide. Entering a triangle into a tile, comparing two planes
/// exactly, and comparing two depths exactly take the following numbers of steps. A tile reports its steps in portions
/// of kStepsAtOnce.
constexpr std::uint64_t kStepsOfTriangle = 16, kStepsOfPlanes = 16, kStepsOfDepths = 64, kStepsAtOnce = 1 << 14;
/// The limit of the steps is a constant, plus a number for each sample and one for each triangle.
constexpr std::uint64_t kMostSteps = std::uint64_t(1) << 29, kMostStepsOfSample = 128, kMostStepsOfTriangle = 1024;

/// Cached facts about a pair of triangles. In models with coplanar faces, thousands of samples need them.
struct Rival {
  PrimitiveId beside = no_primitive, id = no_primitive;
  bool shares_plane = false, has_one_depth = false;  // has_one_depth: both triangles lie at one depth
  std::optional<BoundedPlane> plane;
};

/// The answer that is being filled, and by sample the bounds of the nearest depth so far.
struct NearestBounds {
  const Surfaces& surfaces;
  const SampleRays rays;
  const ScreenRays screen_rays;
  std::span<const glm::ivec2> samples;
  ExactVisible& answer;
  Buffer<DepthBounds> bounds;
};

class NearestInTile {
 public:
  NearestInTile(NearestBounds& field, const PixelRect& tile, WorkLimit& work)
      : field_(field), tile_(tile), work_(work) {}

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
    return exact_depth(field_.surfaces.corners(a), field_.rays, ray)
        .compare(exact_depth(field_.surfaces.corners(b), field_.rays, ray));
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
  std::array<Rival, 16> rivals_;  // indexed by the last bits of the ids
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
    NearestInTile nearest(field, tile.rect(), work);
    batch.visit_tile(
        tile,
        [&](std::span<const TileRun> runs) {
          for (const TileRun& run : runs)
            for (std::size_t i = 0; i < run.count; ++i) nearest.enter(batch.small().record(run.first + i));
        },
        [&](const SingleTriangle& single) { nearest.enter(single.record); });
    nearest.tell();
  });
  return answer;
}

}  // namespace frontmost
