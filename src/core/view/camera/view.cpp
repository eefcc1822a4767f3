// SPDX-License-Identifier: Apache-2.0
// Poses, projections, and the limits of a view.
//
//        y                            z (forward)
//        |                           /
//        |     x                    o------ x
//        o------                    |
//       /                           |
//      z (backward)                 y
//
//    OpenGL, and this library       OpenCV
//
// One formula serves every depth convention: in perspective the normalised depth is (a z_eye + b) / -z_eye, in parallel
// projection -a z_eye + b, with a and b such that near and far map to the convention's two ends. (S. Gortler.
// Foundations of 3D Computer Graphics. 2012, chapters 10 and 11.)
//
// validate() checks everything, so that methods have no error paths. Its last check makes the transform of vertices and
// tests whether its floats are finite: a view may be valid in doubles, and still exceed the range of floats.
#include "frontmost/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "view/screen_transform.h"

namespace frontmost {
namespace {

// y and z change sign between OpenGL's camera axes (y up, z back) and OpenCV's (y down, z forward).
const glm::dmat4 kFlipYZ(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
// Eye space from a robot's axes: x is ahead (-z of the eye), y left (-x), z up (y).
const glm::dmat4 kEyeFromRobot(0, 0, -1, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1);

/// Inverts a rigid pose. The transpose inverts a rotation exactly; a general inverse would round once more.
glm::dmat4 inverse_rigid(const glm::dmat4& pose) {
  const glm::dmat3 rotation = glm::transpose(glm::dmat3(pose));
  glm::dmat4 inverse(rotation);
  inverse[3] = glm::dvec4(-(rotation * glm::dvec3(pose[3])), 1.0);
  return inverse;
}

void check_rigid(const glm::dmat4& pose) {
  constexpr double kTolerance = 1e-4;  // poses come from text files with few digits
  const glm::dmat3 r(pose);
  const glm::dmat3 product = glm::transpose(r) * r;
  bool good = is_finite(glm::dvec3(pose[3])) && std::abs(glm::determinant(r) - 1) < kTolerance;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) good = good && std::abs(product[i][j] - (i == j ? 1 : 0)) < kTolerance;
    good = good && std::abs(pose[i][3]) < kTolerance;
  }
  if (!(good && std::abs(pose[3][3] - 1) < kTolerance))
    throw Error(ErrorCode::singular_camera, "pose", "must be a rotation and a translation, last row 0 0 0 1");
}

bool is_world_to_camera(PoseConvention convention) {
  return convention == PoseConvention::opengl_world_to_camera || convention == PoseConvention::opencv_world_to_camera ||
         convention == PoseConvention::robot_world_to_camera;
}

bool is_opencv(PoseConvention convention) {
  return convention == PoseConvention::opencv_camera_to_world || convention == PoseConvention::opencv_world_to_camera;
}

bool is_robot(PoseConvention convention) {
  return convention == PoseConvention::robot_camera_to_world || convention == PoseConvention::robot_world_to_camera;
}

}  // namespace

glm::dmat4 look_at(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up) {
  const glm::dvec3 direction = target - eye;
  const double distance = glm::length(direction);
  if (!is_finite(eye) || !is_finite(target) || !std::isfinite(distance) || !(distance > 0))
    throw Error(ErrorCode::singular_camera, "camera", "eye and target must be finite and apart");
  const glm::dvec3 back = -direction / distance;
  const double up_length = glm::length(up);
  const glm::dvec3 wanted = is_finite(up) && up_length > 0 ? up / up_length : glm::dvec3(0, 1, 0);
  glm::dvec3 right = glm::cross(wanted, back);
  // The roll is undefined along "up", so the axis farthest from the viewing direction replaces "up". The limit is the
  // sine of the angle between "up" and the viewing direction: below it the roll would consist of rounding errors.
  if (glm::length(right) < 1e-9) {
    const glm::dvec3 other = std::abs(back.z) < 0.9 ? glm::dvec3(0, 0, back.y > 0 ? -1 : 1) : glm::dvec3(0, 1, 0);
    right = glm::cross(other, back);
  }
  right = glm::normalize(right);
  const glm::dvec3 true_up = glm::cross(back, right);
  return {glm::dvec4(right, 0), glm::dvec4(true_up, 0), glm::dvec4(back, 0), glm::dvec4(eye, 1)};
}

glm::dmat4 world_from_eye(const glm::dmat4& pose, PoseConvention convention) {
  // A scale in a pose would silently change the meaning of distances; a mirror would reverse every face.
  check_rigid(pose);
  const glm::dmat4 world_from_camera = is_world_to_camera(convention) ? inverse_rigid(pose) : pose;
  if (is_robot(convention)) return world_from_camera * glm::transpose(kEyeFromRobot);
  return is_opencv(convention) ? world_from_camera * kFlipYZ : world_from_camera;
}

glm::dmat4 pose_of(const glm::dmat4& world_from_eye, PoseConvention convention) {
  const glm::dmat4 world_from_camera = is_robot(convention)    ? world_from_eye * kEyeFromRobot
                                       : is_opencv(convention) ? world_from_eye * kFlipYZ
                                                               : world_from_eye;
  return is_world_to_camera(convention) ? inverse_rigid(world_from_camera) : world_from_camera;
}

View View::placed(const glm::dmat4& pose, PoseConvention convention) const {
  View view = *this;
  view.world_from_eye = frontmost::world_from_eye(pose, convention);
  return view;
}

View View::looking(const glm::dvec3& from, const glm::dvec3& target, const glm::dvec3& up) const {
  View view = *this;
  view.world_from_eye = look_at(from, target, up);
  return view;
}

View View::about(const glm::dvec3& origin) const {
  View view = *this;
  view.world_from_eye[3] -= glm::dvec4(origin, 0);
  return view;
}

namespace {

void check_finite(double value, const char* what) {
  if (!std::isfinite(value)) throw Error(ErrorCode::bad_argument, std::string(what), "must be a finite number");
}

void check_clip(const ClipDistances& clip, bool orthographic) {
  check_finite(clip.near, "near");
  if (std::isnan(clip.far)) throw Error(ErrorCode::bad_argument, "far", "must be a number");
  if (!orthographic && !(clip.near > 0))
    throw Error(ErrorCode::bad_argument, "near", "must be greater than 0 in perspective");
  if (orthographic) check_finite(clip.far, "far");
  if (!(clip.far > clip.near)) throw Error(ErrorCode::bad_argument, "far", "must be greater than near");
}

void check_sides(double left, double right, double bottom, double top) {
  check_finite(left, "left");
  check_finite(right, "right");
  check_finite(bottom, "bottom");
  check_finite(top, "top");
  if (!(left < right)) throw Error(ErrorCode::bad_argument, "right", "must be greater than left");
  if (!(bottom < top)) throw Error(ErrorCode::bad_argument, "top", "must be greater than bottom");
}

void check_size(int width, int height) {
  if (width < 1 || height < 1)
    throw Error(ErrorCode::bad_argument, "resolution", "width and height must be at least 1");
}

/// The offset that makes image coordinates count from the top left corner.
double pixel_shift(PixelRule rule) { return rule == PixelRule::centre_at_integer ? 0.5 : 0.0; }

/// Coefficients of the depth row (see the head of the file).
struct DepthRow {
  double a, b;
};

DepthRow depth_row(const Projection& projection, const DepthConvention& depth) {
  const double n = projection.clip.near, f = projection.clip.far;
  if (projection.orthographic) {
    const double a = (depth.at_far - depth.at_near) / (f - n);
    return {a, depth.at_near - a * n};
  }
  // The limit of the last line: n / (f - n) goes to 0, f / (f - n) to 1.
  if (std::isinf(f)) return {-depth.at_far, (depth.at_near - depth.at_far) * n};
  return {(depth.at_near * n - depth.at_far * f) / (f - n), (depth.at_near - depth.at_far) * n * f / (f - n)};
}

}  // namespace

Projection make_projection(double min_fov, double aspect, const ClipDistances& clip) {
  constexpr double kPi = 3.14159265358979323846;
  check_finite(min_fov, "field of view");
  check_finite(aspect, "aspect");
  if (!(min_fov > 0 && min_fov < kPi))
    throw Error(ErrorCode::bad_argument, "field of view", "must be between 0 and 180 degrees");
  if (!(aspect > 0)) throw Error(ErrorCode::bad_argument, "aspect", "must be greater than 0");
  check_clip(clip, false);
  const double side = std::tan(min_fov / 2);
  const double x = aspect > 1 ? side * aspect : side, y = aspect > 1 ? side : side / aspect;
  return {false, -x, x, -y, y, clip};
}

Projection make_frustum(double left, double right, double bottom, double top, const ClipDistances& clip) {
  check_sides(left, right, bottom, top);
  check_clip(clip, false);
  const double n = clip.near;
  return {false, left / n, right / n, bottom / n, top / n, clip};
}

Projection make_orthographic(double left, double right, double bottom, double top, const ClipDistances& clip) {
  check_sides(left, right, bottom, top);
  check_clip(clip, true);
  return {true, left, right, bottom, top, clip};
}

Projection make_projection(const Intrinsics& k, int width, int height, const ClipDistances& clip) {
  for (const double value : {k.fx, k.fy, k.cx, k.cy}) check_finite(value, "intrinsics");
  if (!(k.fx > 0 && k.fy > 0))
    throw Error(ErrorCode::bad_argument, "intrinsics", "focal lengths must be greater than 0");
  check_size(width, height);
  check_clip(clip, false);
  const double cx = k.cx + pixel_shift(k.rule), cy = k.cy + pixel_shift(k.rule);
  return {false, -cx / k.fx, (width - cx) / k.fx, (cy - height) / k.fy, cy / k.fy, clip};
}

Intrinsics intrinsics_of(const Projection& projection, int width, int height, PixelRule rule) {
  if (projection.orthographic) throw Error(ErrorCode::bad_argument, "intrinsics", "a parallel projection has none");
  const double fx = width / (projection.right - projection.left), fy = height / (projection.top - projection.bottom);
  return {fx, fy, -projection.left * fx - pixel_shift(rule), projection.top * fy - pixel_shift(rule), rule};
}

View make_view(const Intrinsics& intrinsics, int width, int height) {
  View view;
  view.width = width;
  view.height = height;
  view.projection = make_projection(intrinsics, width, height, {});
  return view;
}

View make_view(double min_fov, int width, int height) {
  check_size(width, height);
  View view;
  view.width = width;
  view.height = height;
  view.projection = make_projection(min_fov, double(width) / height, {});
  return view;
}

View View::between(double near, double far) const {
  View view = *this;
  view.projection.clip = {near, far};
  return view;
}

View View::enclosing(const Box& bounds) const {
  const ClipDistances clip = fit_clip(bounds, world_from_eye, projection.orthographic);
  return between(clip.near, clip.far);
}

glm::dmat4 clip_from_eye(const Projection& projection, const DepthConvention& depth) {
  const double w = projection.right - projection.left, h = projection.top - projection.bottom;
  const double x = (projection.right + projection.left) / w, y = (projection.top + projection.bottom) / h;
  const DepthRow row = depth_row(projection, depth);
  if (projection.orthographic) return {2 / w, 0, 0, 0, 0, 2 / h, 0, 0, 0, 0, -row.a, 0, -x, -y, row.b, 1};
  return {2 / w, 0, 0, 0, 0, 2 / h, 0, 0, x, y, row.a, -1, 0, 0, row.b, 0};
}

double distance_of_depth(const Projection& projection, const DepthConvention& depth, double ndc_depth) {
  const DepthRow row = depth_row(projection, depth);
  if (projection.orthographic) return (ndc_depth - row.b) / row.a;
  const double denominator = ndc_depth + row.a;
  // The distance is infinite: the depth is that of an infinite far plane, or one beyond a finite far plane.
  if (denominator == 0) return std::numeric_limits<double>::infinity();
  return row.b / denominator;
}

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

/// A value that is too large exceeds a limit of the library, and one that is too small is an error of the caller.
/// Messages name both ends of the range.
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
  if (!(t.near < t.far)) refuse("far", "too close to near, or too large, for floats");
  if (!all_finite<2>({t.far, t.inverse_range}))
    refuse("far", "must be within the range of floats, and differ from near");
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
    // make_frustum() takes sides at the near plane. These sides, at distance 1, are passed unscaled: if they were
    // scaled by a wrong near plane, the error would name the sides.
    (void)make_frustum(p.left, p.right, p.bottom, p.top, p.clip);
  }
  (void)world_from_eye(view.world_from_eye, PoseConvention::opengl_camera_to_world);
  check_float_range(view);
}

}  // namespace frontmost
