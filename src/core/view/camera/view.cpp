// SPDX-License-Identifier: Apache-2.0
// The limits of a view: the patterns of its samples, and the ranges within which every method can draw it.
//
// Everything is checked here, so that methods have no error paths. The last check makes the transform of vertices and
// tests whether its floats are finite: a view may be valid in doubles, and still exceed the range of floats.
#include "frontmost/view.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "view/screen_transform.h"

namespace frontmost {
namespace {

// Places of samples in units of 1/16 pixel from the pixel's centre; x points right, y down.
constexpr std::array<glm::ivec2, 1> kOne{{{0, 0}}};
constexpr std::array<glm::ivec2, 2> kTwo{{{4, 4}, {-4, -4}}};
constexpr std::array<glm::ivec2, 4> kFour{{{-2, -6}, {6, -2}, {-6, 2}, {2, 6}}};
constexpr std::array<glm::ivec2, 8> kEight{{{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}}};
constexpr std::array<glm::ivec2, 16> kSixteen{{{1, 1},
                                               {-1, -3},
                                               {-3, 2},
                                               {4, -1},
                                               {-5, -2},
                                               {2, 5},
                                               {5, 3},
                                               {3, -5},
                                               {-2, 6},
                                               {0, -7},
                                               {-4, -6},
                                               {-6, 4},
                                               {-8, 0},
                                               {7, -4},
                                               {6, 7},
                                               {-7, -8}}};

template <std::size_t count>
constexpr std::array<glm::ivec2, count> in_fixed_point(const std::array<glm::ivec2, count>& sixteenths) {
  std::array<glm::ivec2, count> offsets{};
  for (std::size_t i = 0; i < count; ++i) offsets[i] = {128 + 16 * sixteenths[i].x, 128 + 16 * sixteenths[i].y};
  return offsets;
}

/// A value that is too large is a limit of the library, a value that is too small an error of the caller; messages name
/// both ends.
void check_range(double value, double low, double high, const char* what) {
  if (!(value >= low && value <= high))
    throw Error(value > high ? ErrorCode::limit_exceeded : ErrorCode::bad_argument, std::string(what),
                "must be " + std::to_string(int(low)) + " to " + std::to_string(int(high)));
}

template <std::size_t count>
bool all_finite(const std::array<float, count>& values) {
  return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

/// Vertices are transformed in floats, so the view's transform must be within their range.
void check_float_range(const View& view) {
  const ScreenTransform t(view);
  const auto refuse = [](const char* place, const char* reason) {
    throw Error(ErrorCode::limit_exceeded, place, reason);
  };
  if (!all_finite(t.eye)) refuse("pose", "the eye is farther from the origin than floats reach");
  if (!t.orthographic && !(t.near >= std::numeric_limits<float>::min())) refuse("near", "must be at least 1.2e-38");
  if (!(t.near < t.far)) refuse("far", "too close to near, or too far, to be told apart in floats");
  if (!all_finite<2>({t.far, t.inverse_range})) refuse("far", "must lie within the range of floats, and not at near");
  if (!all_finite(t.x_row) || !all_finite(t.y_row) || !all_finite<2>({t.x_offset, t.y_offset}))
    refuse("projection", "its sides are too close together, or too far from the axis, for floats");
}

}  // namespace

std::span<const glm::ivec2> sample_offsets(int samples) {
  static constexpr auto one = in_fixed_point(kOne);
  static constexpr auto two = in_fixed_point(kTwo);
  static constexpr auto four = in_fixed_point(kFour);
  static constexpr auto eight = in_fixed_point(kEight);
  static constexpr auto sixteen = in_fixed_point(kSixteen);
  switch (samples) {
    case 1: return one;
    case 2: return two;
    case 4: return four;
    case 8: return eight;
    case 16: return sixteen;
    default: throw Error(ErrorCode::bad_argument, "samples", "must be 1, 2, 4, 8 or 16");
  }
}

void validate(const View& view) {
  constexpr int kLargest = 16384;
  check_range(view.width, 1, kLargest, "width");
  check_range(view.height, 1, kLargest, "height");
  (void)sample_offsets(view.samples);
  // 2^28 ids and keys are 2 GiB: the size of the greatest picture at one sample.
  if (view.sample_count() > most_samples)
    throw Error(ErrorCode::limit_exceeded, "samples",
                "at most " + std::to_string(most_samples) + " in all pixels together");
  // These checks are made by constructing the projection again.
  const Projection& p = view.projection;
  if (p.orthographic) {
    (void)make_orthographic(p.left, p.right, p.bottom, p.top, p.clip);
  } else {
    // make_frustum() takes sides at the near plane. These sides, at distance 1, are passed unscaled: scaled by a wrong
    // near plane, they would be blamed for it.
    (void)make_frustum(p.left, p.right, p.bottom, p.top, p.clip);
  }
  (void)world_from_eye(view.world_from_eye, PoseConvention::opengl_camera_to_world);
  check_float_range(view);
}

}  // namespace frontmost
