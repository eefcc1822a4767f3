// SPDX-License-Identifier: Apache-2.0
// Views that show a whole model, or the part of it that holds most of its interest.
//
//           eye             A plane across the picture, seen from above: each side of the frustum is a line. If the
//          / | \            left and the right line are moved until they touch the model, they meet where the eye
//         /  |  \           must stand to see it exactly.
//        / . * . \    (the points are the model)
//       *  . . .  *
//
// The upper and the lower side give another place. The eye takes the place that is farther back, and is then moved
// across until the model is in the middle of the looser direction, too.
//
// The subject of a picture is found by how far objects reach from the middle. Objects behind the first gap are left
// out, if little interest lies beyond it:
//
//   . .:. .   . . . . gap . . . .
//   |subject|                    | ground |   | sky |
//   0       r                    at least 8 r     reach ->
//
// Interest is the fourth root of the number of triangles: many plain objects outweigh one fine mesh, and one fine mesh
// outweighs a few plain objects. If interest were the number itself, a sphere around a village would be the subject.
//
// An object with more than half of the interest holds the weighted median on each axis. So the middle lies among the
// objects that matter, however far away the others are, and the distance from the middle separates both groups. The
// size of all objects together, or their mean, would mostly depend on how far away the lost objects are.
#include <algorithm>
#include <array>
#include <cmath>

#include "frontmost/view.h"
#include "view/camera/extremes.h"

namespace frontmost {
namespace {

constexpr double gap = 8;
constexpr double least_share = 0.6;

double interest_of(const Scene& scene, std::size_t instance) {
  return std::sqrt(std::sqrt(double(scene.meshes[scene.instances[instance].mesh].triangles.size())));
}

/// A place on an axis, and its weight.
struct Weighted {
  double place, weight;
};

/// The weighted median: the least place up to which at least half of the weight lies. Halves that cannot contain it are
/// dropped, so it takes O(places).
double median(std::vector<Weighted> places) {
  double half = 0, below = 0;
  for (const Weighted& one : places) half += one.weight / 2;
  auto begin = places.begin(), end = places.end();
  while (end - begin > 1) {
    const auto middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, [](const Weighted& a, const Weighted& b) { return a.place < b.place; });
    double weight = 0;
    for (auto one = begin; one != middle; ++one) weight += one->weight;
    if (below + weight >= half) {
      end = middle;
    } else {
      below += weight;
      begin = middle;
    }
  }
  return begin->place;
}

/// The middle of the objects; a sample stands for very many objects.
glm::dvec3 middle_of(const Surfaces& surfaces) {
  constexpr std::size_t enough = 4096;
  const Scene& scene = surfaces.scene();
  const std::size_t step = scene.instances.size() / enough + 1;
  std::vector<Weighted> places[3];
  for (std::size_t i = 0; i < scene.instances.size(); i += step) {
    const Box& box = surfaces.bounds(std::uint32_t(i));
    if (box.is_empty()) continue;
    const glm::dvec3 twice = glm::dvec3(box.low) + glm::dvec3(box.high);
    for (int axis = 0; axis < 3; ++axis) places[axis].push_back({twice[axis] / 2, interest_of(scene, i)});
  }
  if (places[0].empty()) return glm::dvec3(0);
  return {median(std::move(places[0])), median(std::move(places[1])), median(std::move(places[2]))};
}

double reach_of(const Box& box, const glm::dvec3& middle) {
  return glm::length(glm::max(glm::abs(glm::dvec3(box.low) - middle), glm::abs(glm::dvec3(box.high) - middle)));
}

/// The objects whose reach lies between two consecutive powers of two.
struct Octave {
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0, interest = 0;
};

/// Octaves for all distances that floats can have, in order. A gap always lies between two octaves, so objects need not
/// be sorted.
class Octaves {
 public:
  void include(double reach, double interest) {
    Octave& octave = octaves_[std::size_t(reach > 0 ? std::clamp(std::ilogb(reach), lowest + 1, highest) - lowest : 0)];
    octave.nearest = std::min(octave.nearest, reach);
    octave.farthest = std::max(octave.farthest, reach);
    octave.interest += interest;
    whole_ += interest;
  }
  /// How far the subject reaches; infinite if the subject is everything.
  [[nodiscard]] double reach_of_subject() const {
    double within = 0, reach = 0;
    for (const Octave& octave : octaves_) {
      if (octave.interest == 0) continue;
      if (reach > 0 && octave.nearest >= gap * reach && within >= least_share * whole_) return reach;
      within += octave.interest;
      reach = octave.farthest;
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  static constexpr int lowest = -152, highest = 152;
  std::array<Octave, std::size_t(highest - lowest + 1)> octaves_;
  double whole_ = 0;
};

}  // namespace

Subject find_subject(const Surfaces& surfaces) {
  Subject subject{surfaces.bounds(), {}};
  const Scene& scene = surfaces.scene();
  const auto count = std::uint32_t(scene.instances.size());
  if (count < 2) return subject;
  const glm::dvec3 middle = middle_of(surfaces);
  Octaves octaves;
  for (std::uint32_t i = 0; i < count; ++i)
    if (const Box& box = surfaces.bounds(i); !box.is_empty())
      octaves.include(reach_of(box, middle), interest_of(scene, i));
  const double reach = octaves.reach_of_subject();
  if (reach == std::numeric_limits<double>::infinity()) return subject;
  subject.bounds = {};
  for (std::uint32_t i = 0; i < count; ++i) {
    const Box& box = surfaces.bounds(i);
    if (box.is_empty()) continue;
    if (reach_of(box, middle) <= reach)
      subject.bounds.include(box);
    else
      subject.left_out.push_back(i);
  }
  return subject;
}

namespace {

/// The model's own axes. `up` is as the format defines it; NamedView::front looks at the side `front`.
struct ModelAxes {
  glm::dvec3 right, up, front;  ///< right-handed; front points from the model to the viewer
};

ModelAxes model_axes(Axis up_axis) {
  const glm::dvec3 up = direction(up_axis);
  // Front of a y-up model is +z (glTF), of a z-up model -y (CAD), of an x-up model +z.
  const bool along_z = up_axis == Axis::z || up_axis == Axis::minus_z;
  const glm::dvec3 front = along_z ? glm::dvec3(0, -1, 0) : glm::dvec3(0, 0, 1);
  return {glm::cross(up, front), up, front};
}

struct Gaze {
  glm::dvec3 towards_viewer, up;
};

Gaze gaze(NamedView view, const ModelAxes& axes) {
  switch (view) {
    case NamedView::front: return {axes.front, axes.up};
    case NamedView::back: return {-axes.front, axes.up};
    case NamedView::left: return {-axes.right, axes.up};
    case NamedView::right: return {axes.right, axes.up};
    case NamedView::top: return {axes.up, -axes.front};
    case NamedView::bottom: return {-axes.up, axes.front};
    case NamedView::iso: return {axes.right + axes.up + axes.front, axes.up};
    case NamedView::three_quarter: return {0.55 * axes.right + 0.42 * axes.up + axes.front, axes.up};
  }
  return {axes.front, axes.up};
}

std::array<glm::dvec3, 8> corners_of(const Box& box) {
  std::array<glm::dvec3, 8> corners;
  for (int k = 0; k < 8; ++k)
    corners[std::size_t(k)] = {k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y,
                               k & 4 ? box.high.z : box.low.z};
  return corners;
}

/// The box that is framed if a scene has nothing to show.
Box unit_box() { return {glm::vec3(-0.5f), glm::vec3(0.5f)}; }

/// A frustum moved so that it just holds all included points. With p = (x, y, towards) along its axes, a point is left
/// of the right side if x <= spread * (eye_towards - towards) + eye_x. So each side requires one sum of the eye's
/// coordinates to be at least the greatest such sum of the points. Two opposite sides give the eye's place across and
/// how far back it must stand; only the latter, if a target in the middle of the picture gives the place across.
class Fit {
 public:
  Fit(const FilledFrustum& frustum, const std::optional<glm::dvec3>& target)
      : frustum_(frustum), x_{frustum.spread.x}, y_{frustum.spread.y} {
    if (!target) return;
    const glm::dvec3 at = along_axes(*target);
    x_.centre = at.x;
    y_.centre = at.y;
    nearest_ = at.z;
  }

  void include(const glm::dvec3& p) {
    const glm::dvec3 at = along_axes(p);
    x_.include(at.x, at.z);
    y_.include(at.y, at.z);
    nearest_ = std::max(nearest_, at.z);
  }
  /// The place of a perspective eye, at least `closest` before the nearest point.
  [[nodiscard]] glm::dvec3 eye(double closest) const {
    return in_world(x_.across(), y_.across(), std::max({x_.back(), y_.back(), nearest_ + closest}));
  }
  /// The place of the eye of a parallel projection, `before` the middle of `box` and the target.
  [[nodiscard]] glm::dvec3 parallel_eye(const Box& box, double before) const {
    const double middle = along_axes(0.5 * (glm::dvec3(box.low) + glm::dvec3(box.high))).z;
    return in_world(x_.middle(), y_.middle(), (x_.centre ? std::max(middle, nearest_) : middle) + before);
  }
  /// Distance from the middle of the picture to the farthest points.
  [[nodiscard]] glm::dvec2 half_extent() const { return {x_.half_extent(), y_.half_extent()}; }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  struct Direction {
    double spread;
    std::optional<double> centre = std::nullopt;   // centre of the picture, if there is a target
    double plus = -kInfinity, minus = -kInfinity;  // greatest values of +-x / spread + towards
    double low = kInfinity, high = -kInfinity;

    void include(double x, double towards) {
      plus = std::max(plus, x / spread + towards);
      minus = std::max(minus, -x / spread + towards);
      low = std::min(low, x);
      high = std::max(high, x);
    }
    [[nodiscard]] double across() const { return centre.value_or(spread * (plus - minus) / 2); }
    [[nodiscard]] double back() const {
      return centre ? std::max(plus - *centre / spread, minus + *centre / spread) : (plus + minus) / 2;
    }
    [[nodiscard]] double middle() const { return centre.value_or((low + high) / 2); }
    [[nodiscard]] double half_extent() const {
      return centre ? std::max(high - *centre, *centre - low) : (high - low) / 2;
    }
  };

  [[nodiscard]] glm::dvec3 along_axes(const glm::dvec3& p) const {
    const glm::dmat4& axes = frustum_.axes;
    return {glm::dot(p, glm::dvec3(axes[0])), glm::dot(p, glm::dvec3(axes[1])), glm::dot(p, glm::dvec3(axes[2]))};
  }
  /// The inverse of along_axes(): from sheared axes to the world.
  [[nodiscard]] glm::dvec3 in_world(double x, double y, double towards) const {
    const glm::dvec3 back(frustum_.axes[2]);
    const glm::dvec2& middle = frustum_.middle;
    const glm::dvec3 right = glm::dvec3(frustum_.axes[0]) - middle.x * back,
                     up = glm::dvec3(frustum_.axes[1]) - middle.y * back;
    return (x - middle.x * towards) * right + (y - middle.y * towards) * up + towards * back;
  }

  FilledFrustum frustum_;
  Direction x_, y_;
  double nearest_ = -kInfinity;
};

/// The extremes of a model in the picture of an eye, as slopes from the picture's middle, and their distances.
class Spread {
 public:
  Spread(const glm::dvec3& eye, const glm::dvec3& across, const glm::dvec3& back)
      : eye_(eye), across_(across), back_(back) {}

  void include(const glm::dvec3& p) {
    const glm::dvec3 d = p - eye_;
    const double distance = -glm::dot(d, back_), slope = glm::dot(d, across_) / distance;
    if (slope < low_.slope) low_ = {slope, distance};
    if (slope > high_.slope) high_ = {slope, distance};
  }
  /// How far the eye must move for the two extremes to lie equally far from the picture's middle.
  [[nodiscard]] double to_centre() const {
    // After a move by m, a point at distance w has slope s - m / w: the result is the m for which the new slopes add up
    // to 0.
    return (low_.slope + high_.slope) / (1 / low_.distance + 1 / high_.distance);
  }

 private:
  struct Extreme {
    double slope, distance;
  };
  glm::dvec3 eye_, across_, back_;
  Extreme low_{std::numeric_limits<double>::infinity(), 1}, high_{-std::numeric_limits<double>::infinity(), 1};
};

/// Moves the eye across until the model is in the middle of the picture. Only the looser direction moves, as the tight
/// one is in the middle already.
void centre(glm::dmat4& pose, const FilledFrustum& frustum, const std::vector<glm::vec3>& points) {
  constexpr int kSteps = 3;  // each step leaves a small error, because the distances of the extremes change
  for (int step = 0; step < kSteps; ++step)
    for (int axis = 0; axis < 2; ++axis) {
      Spread spread(glm::dvec3(pose[3]), glm::dvec3(frustum.axes[axis]), glm::dvec3(frustum.axes[2]));
      for (const glm::vec3& p : points) spread.include(glm::dvec3(p));
      pose[3] += pose[axis] * spread.to_centre();
    }
}

std::vector<glm::vec3> extremes_of(const Surfaces& surfaces, const Subject& subject, const FilledFrustum& frustum) {
  Extremes extremes(frustum);
  const ClusterSet* const clusters = made_cluster_set(surfaces);
  if (clusters && subject.left_out.empty())
    extremes.include(*clusters);
  else
    extremes.include(placed_scene(surfaces), subject.left_out);
  return extremes.points();
}

Subject subject_for(const Surfaces& surfaces, FramedObjects objects) {
  Subject subject = objects == FramedObjects::all ? Subject{surfaces.bounds(), {}} : find_subject(surfaces);
  if (subject.bounds.is_empty()) subject.bounds = unit_box();
  return subject;
}

/// Clip planes around everything. But left-out objects must not push the near plane into the subject. In parallel
/// projection, left-out objects behind the eye must not hide the subject.
ClipDistances clip_around(const Surfaces& surfaces, const Subject& subject, const glm::dmat4& pose, bool orthographic) {
  ClipDistances clip = fit_clip(surfaces.bounds(), pose, orthographic);
  if (subject.left_out.empty()) return clip;
  if (orthographic) return {std::max(clip.near, 0.0), clip.far};
  clip.near = std::min(clip.near, fit_clip(subject.bounds, pose, false).near);
  return clip;
}

void check(int width, int height, const FrameOptions& options) {
  if (width < 1 || height < 1)
    throw Error(ErrorCode::bad_argument, "resolution", "width and height must be at least 1");
  if (!(options.margin >= 0 && options.margin < 0.5))
    throw Error(ErrorCode::bad_argument, "margin", "must be 0 to 0.5");
  if (options.orthographic && options.intrinsics)
    throw Error(ErrorCode::bad_argument, "intrinsics", "a parallel projection has none");
  for (int axis = 0; options.target && axis < 3; ++axis)
    if (!std::isfinite((*options.target)[axis]))
      throw Error(ErrorCode::bad_argument, "target", "must be finite numbers");
}

}  // namespace

ClipDistances fit_clip(const Box& bounds, const glm::dmat4& world_from_eye, bool orthographic) {
  const Box box = bounds.is_empty() ? unit_box() : bounds;
  const glm::dvec3 eye(world_from_eye[3]), forward(-glm::dvec3(world_from_eye[2]));
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest, size = 0;
  for (const glm::dvec3& corner : corners_of(box)) {
    const double distance = glm::dot(corner - eye, forward);
    nearest = std::min(nearest, distance);
    farthest = std::max(farthest, distance);
    size = std::max(size, glm::length(corner - eye));
  }
  // A flat box seen face on has no depth, so the margin is then a part of its distance.
  const double spare = std::max({0.01 * (farthest - nearest), 1e-6 * size, 1e-30});
  ClipDistances clip{nearest - spare, farthest + spare};
  if (orthographic) return clip;
  if (!(clip.far > 0)) clip.far = std::max(size, 1e-30);  // all behind the eye: any valid planes will do
  // An eye within the model would give a near plane at 0, and keys (near / distance) that are all 0. A range of four
  // digits costs floats no precision, because keys near 0 are as finely spaced relative to their size.
  clip.near = std::max(clip.near, 1e-4 * clip.far);
  if (!(clip.near < clip.far)) clip.near = 0.5 * clip.far;
  return clip;
}

View frame(const Surfaces& surfaces, int width, int height, const FrameOptions& options) {
  check(width, height, options);
  const Subject subject = subject_for(surfaces, options.objects);
  const Box& box = subject.bounds;
  const Gaze look = gaze(options.direction, model_axes(surfaces.scene().up));
  const glm::dvec3 forward = options.forward.value_or(-look.towards_viewer);
  glm::dmat4 pose = look_at(-glm::normalize(forward), glm::dvec3(0), options.up.value_or(look.up));

  const double aspect = double(width) / height;
  Projection projection = options.intrinsics ? make_projection(*options.intrinsics, width, height, {})
                                             : make_projection(options.min_fov, aspect, {});
  const FilledFrustum frustum(pose, projection, options.margin);
  const std::vector<glm::vec3> points = extremes_of(surfaces, subject, frustum);
  Fit fit(frustum, options.target);
  for (const glm::vec3& p : points) fit.include(glm::dvec3(p));
  if (points.empty())
    for (const glm::dvec3& corner : corners_of(box)) fit.include(corner);
  const glm::dvec3 low(box.low), high(box.high);
  // The distance to a single point far from the origin must exceed rounding.
  const double diagonal = std::max({glm::length(high - low), 1e-5 * glm::length(high), 1e-30});
  if (options.orthographic) {
    // If objects are left out, the eye stands about as far before the subject as an eye in perspective.
    pose[3] = glm::dvec4(fit.parallel_eye(box, (subject.left_out.empty() ? 1 : 2) * diagonal), 1.0);
  } else {
    // The eye keeps a distance from the nearest point, because otherwise it would lie in a flat model that is seen
    // edge-on.
    pose[3] = glm::dvec4(fit.eye(1e-3 * diagonal), 1.0);
    if (!points.empty() && !options.target) centre(pose, frustum, points);
  }

  const ClipDistances clip = clip_around(surfaces, subject, pose, options.orthographic);
  if (options.orthographic) {
    const glm::dvec2 extent = fit.half_extent();
    // A model without extent across (a point, or a line seen from its end) still needs a picture with sides.
    const double half = std::max({extent.y, extent.x / aspect, 1e-3 * diagonal}) / (1 - 2 * options.margin);
    projection = make_orthographic(-half * aspect, half * aspect, -half, half, clip);
  } else {
    projection.clip = clip;
  }
  View view{width, height, options.samples, pose, projection, options.culling};
  validate(view);
  return view;
}

View frame(const Box& bounds, Axis up, int width, int height, const FrameOptions& options) {
  Scene scene;
  scene.up = up;
  if (!bounds.is_empty()) {
    Mesh corners;
    for (const glm::dvec3& corner : corners_of(bounds)) {
      const auto number = std::uint32_t(corners.positions.size());
      corners.positions.emplace_back(corner);
      corners.triangles.emplace_back(number);  // without area: only its vertex counts
    }
    add(scene, std::move(corners));
  }
  return frame(Surfaces(scene), width, height, options);
}

}  // namespace frontmost
