// SPDX-License-Identifier: Apache-2.0
// Remedies stay right when their numbers are rounded. A near plane is rounded towards the eye and a far plane away from
// it. Turns are rounded to a tenth of the angle that the picture shows, so the object comes to lie near the middle.
#include <algorithm>
#include <cmath>

#include "report/accounting/object_mask.h"
#include "report/why/places.h"

namespace frontmost {
namespace why_detail {
namespace {

constexpr Execution kOneThread{.threads = 1};

Scene scene_of_one(const Scene& scene, std::uint32_t object) {
  const Instance& instance = scene.instances[object];
  const Mesh& mesh = scene.meshes[instance.mesh];
  Scene lone;
  lone.meshes.emplace_back();
  lone.meshes[0].positions = mesh.positions;
  lone.meshes[0].triangles = mesh.triangles;
  lone.instances.push_back({"", 0, instance.world_from_mesh});
  return lone;
}

/// The pixels within the picture that a range of positions touches; at least one.
struct PixelStretch {
  int first, count;

  PixelStretch(const ValueRange& extent, int size)
      : first(std::clamp(int(std::floor(extent.low)), 0, size - 1)),
        count(std::clamp(int(std::ceil(extent.high)) - first, 1, size - first)) {}
};

/// The pixels where the object may appear in a picture with `factor` times the width and height, with room for the
/// snapping of corners.
accounting_detail::PixelRect touched_pixels(const View& enlarged, const ObjectPlaces& places, int factor) {
  const auto stretch = [factor](const ValueRange& extent, int size) {
    return PixelStretch({extent.low * factor - 1, extent.high * factor + 1}, size);
  };
  const PixelStretch columns = stretch(places.columns, enlarged.width), rows = stretch(places.rows, enlarged.height);
  return {columns.first, rows.first, columns.first + columns.count - 1, rows.first + rows.count - 1};
}

/// The part of a view that consists of these pixels, at the same scale.
View cropped(const View& view, const PixelStretch& columns, const PixelStretch& rows) {
  const Projection& whole = view.projection;
  const double across = (whole.right - whole.left) / view.width, down = (whole.top - whole.bottom) / view.height;
  View part = view;
  part.width = columns.count;
  part.height = rows.count;
  part.projection.left = whole.left + across * columns.first;
  part.projection.right = whole.left + across * (columns.first + columns.count);
  part.projection.top = whole.top - down * rows.first;
  part.projection.bottom = whole.top - down * (rows.first + rows.count);
  return part;
}

constexpr double kRadian = 57.29577951308232;  // degrees

double power_of_ten(int exponent) {
  double power = 1;
  for (int i = std::abs(exponent); i > 0; --i) power *= 10;
  return exponent < 0 ? 1 / power : power;
}

/// The exponent of the greatest power of ten that does not exceed a positive number.
int decimal_exponent(double value) {
  int exponent = int(std::floor(std::log10(value)));
  while (power_of_ten(exponent) > value) --exponent;
  while (power_of_ten(exponent + 1) <= value) ++exponent;
  return exponent;
}

/// `count` times ten to the power of `exponent`, rounded as if it were read from a decimal number.
double tens(double count, int exponent) {
  return exponent < 0 ? count / power_of_ten(-exponent) : count * power_of_ten(exponent);
}

/// A number rounded down, or up, to two decimal digits.
double round_to_two(double value, bool down) {
  if (value == 0) return 0;
  const int exponent = decimal_exponent(std::abs(value)) - 1;
  const double count = value / power_of_ten(exponent);
  double whole = down ? std::floor(count) : std::ceil(count);
  while (down && tens(whole, exponent) > value) --whole;
  while (!down && tens(whole, exponent) < value) ++whole;
  return tens(whole, exponent);
}

/// The nearest multiple of ten to the power of `exponent`.
double round_to_tens(double value, int exponent) { return tens(std::round(value / power_of_ten(exponent)), exponent); }

double near_for(const ValueRange& nearer, const Projection& projection) {
  const double low = nearer.low, high = nearer.high;
  if (projection.orthographic) return round_to_two(low - 0.01 * (projection.clip.near - low), true);
  // An object that reaches to the eye cannot be shown whole.
  return round_to_two(low > 0.01 * high ? 0.99 * low : 0.5 * high, true);
}

/// Turns or moves the camera so that a point comes into the picture, near its middle.
class CameraAim {
 public:
  CameraAim(const View& view, const PointAhead& target)
      : projection_(view.projection),
        target_(target),
        middle_((projection_.left + projection_.right) / 2, (projection_.bottom + projection_.top) / 2),
        size_(projection_.right - projection_.left, projection_.top - projection_.bottom) {}

  /// A move along one axis, if that suffices; otherwise a move along both.
  [[nodiscard]] Remedy move() const {
    const int step = decimal_exponent(std::min(size_.x, size_.y)) - 1;
    const auto offset = [&](int axis) {
      const double from_middle = target_[axis] - middle_[axis];
      return std::abs(from_middle) <= kInner * size_[axis] ? 0 : round_to_tens(from_middle, step);
    };
    return {RemedyKind::move, 0, offset(0), offset(1), {}};
  }

  [[nodiscard]] Remedy turn() const {
    if (target_ == PointAhead(0)) return {};
    const double smaller = std::min(std::min(size_.x, size_.y) * kRadian, 99.0);
    const int step = std::min(decimal_exponent(smaller) - 1, 0);
    const auto rounded = [&](double angle) { return round_to_tens(angle * kRadian, step) / kRadian; };
    const double right = rounded(angle_right());
    const Remedy aside{RemedyKind::turn, 0, right, 0, {}};
    if (shows(aside)) return aside;
    const Remedy upwards{RemedyKind::turn, 0, 0, rounded(angle_up(0)), {}};
    if (target_.z > 0 && shows(upwards)) return upwards;
    return {RemedyKind::turn, 0, right, rounded(angle_up(right)), {}};
  }

 private:
  static constexpr double kInner = 0.4;  // share of the size on each side of the middle that is surely in the picture

  [[nodiscard]] double angle_right() const {
    const double across = std::hypot(target_.x, target_.z);
    if (across == 0) return 0;
    const double length = glm::length(target_) / glm::length(glm::dvec3(middle_, 1));
    return std::atan2(target_.x, target_.z) - std::asin(std::clamp(length * middle_.x / across, -1.0, 1.0));
  }
  [[nodiscard]] PointAhead turned_right(double angle) const {
    return {target_.x * std::cos(angle) - target_.z * std::sin(angle), target_.y,
            target_.z * std::cos(angle) + target_.x * std::sin(angle)};
  }
  /// The angle upwards that remains after a turn to the right.
  [[nodiscard]] double angle_up(double right) const {
    const PointAhead p = turned_right(right);
    return std::atan2(p.y, p.z) - std::atan2(middle_.y, 1);
  }
  [[nodiscard]] bool shows(const Remedy& turn) const {
    const PointAhead p = turned_right(turn.right);
    const double ahead = p.z * std::cos(turn.up) + p.y * std::sin(turn.up);
    const double up = p.y * std::cos(turn.up) - p.z * std::sin(turn.up);
    return ahead > 0 && std::abs(p.x / ahead - middle_.x) <= kInner * size_.x &&
           std::abs(up / ahead - middle_.y) <= kInner * size_.y;
  }

  const Projection& projection_;
  PointAhead target_;
  glm::dvec2 middle_, size_;
};

/// Radius in pixels. A circle of this radius contains a sample wherever it lies, even if corners are snapped.
constexpr double kSampledRadius = 0.72;

/// Whether the part of the enlarged picture that the object may touch has few enough samples to be examined.
bool is_small_enough(const ObjectPlaces& places, const View& view, int factor) {
  constexpr double kMostSamples = 1 << 22;
  const double across = (places.columns.high - places.columns.low) * factor + 3;
  const double down = (places.rows.high - places.rows.low) * factor + 3;
  return across * down * view.samples <= kMostSamples;
}

}  // namespace

LoneObject::LoneObject(const Scene& scene, std::uint32_t object)
    : scene_(scene_of_one(scene, object)), surfaces_(scene_, kOneThread) {}

bool LoneObject::has_sample(const View& view, const ObjectPlaces& places, int factor) const {
  if (places.columns.is_empty()) return false;
  View enlarged = view;
  enlarged.width *= factor;
  enlarged.height *= factor;
  const accounting_detail::ObjectCanvas canvas(enlarged, touched_pixels(enlarged, places, factor));
  accounting_detail::ObjectMask mask(placed_scene(surfaces_), canvas, Isa::best);
  mask.draw(0);
  const auto is_marked = [&](const accounting_detail::MaskPlane& plane) {
    return accounting_detail::count_marked(plane, mask.touched(), Isa::best).count > 0;
  };
  return !mask.touched().is_empty() && std::any_of(mask.planes().begin(), mask.planes().end(), is_marked);
}

double LoneObject::area(const View& view, const ObjectPlaces& places) const {
  if (places.columns.is_empty()) return 0;
  const View part = cropped(view, PixelStretch(places.columns, view.width), PixelStretch(places.rows, view.height));
  double pixels = 0;
  for (const VisibleFace& face : visible_faces(surfaces_, part, kOneThread).faces) pixels += face.pixels;
  return pixels;
}

Remedy remedy_for(SightReason reason, const ObjectPlaces& places, const View& view) {
  const Projection& projection = view.projection;
  switch (reason) {
    case SightReason::behind_eye: return CameraAim(view, places.behind.middle).turn();
    case SightReason::nearer_than_near: return {RemedyKind::set_near, near_for(places.nearer, projection), 0, 0, {}};
    case SightReason::beyond_far: {
      const double high = places.farther.high;
      return {RemedyKind::set_far, round_to_two(high + 0.01 * (high - projection.clip.far), false), 0, 0, {}};
    }
    case SightReason::outside: {
      const CameraAim aim(view, places.outside.middle);
      return projection.orthographic ? aim.move() : aim.turn();
    }
    case SightReason::faces_away: return {RemedyKind::show_both_sides, 0, 0, 0, {}};
    case SightReason::transparent: return {RemedyKind::make_opaque, 0, 0, 0, {}};
    default: return {};
  }
}

Remedy enlargement_for(const LoneObject& lone, const ObjectPlaces& places, const View& view) {
  constexpr int kMostPixels = 16384;
  const int largest = kMostPixels / std::max(view.width, view.height);
  const auto is_possible = [&](double factor) {
    return factor <= largest && double(view.sample_count()) * factor * factor <= double(most_samples);
  };
  const double sufficient = std::max(2.0, std::ceil(kSampledRadius / places.widest));
  for (int factor = 2; factor < sufficient && is_possible(factor); factor += (factor + 1) / 2)
    if (is_small_enough(places, view, factor) && lone.has_sample(view, places, factor))
      return {RemedyKind::enlarge, double(factor), 0, 0, {}};
  if (!is_possible(sufficient)) return {};
  return {RemedyKind::enlarge, sufficient, 0, 0, {}};
}

}  // namespace why_detail

View remedied(const View& view, const Remedy& remedy) {
  View changed = view;
  glm::dmat4& pose = changed.world_from_eye;
  switch (remedy.kind) {
    case RemedyKind::set_near: changed.projection.clip.near = remedy.value; break;
    case RemedyKind::set_far: changed.projection.clip.far = remedy.value; break;
    case RemedyKind::show_both_sides: changed.culling = Culling::none; break;
    case RemedyKind::move: pose[3] += pose[0] * remedy.right + pose[1] * remedy.up; break;
    case RemedyKind::turn: {
      const glm::dvec4 right = pose[0], up = pose[1], back = pose[2];
      const glm::dvec4 turned_back = back * std::cos(remedy.right) - right * std::sin(remedy.right);
      pose[0] = right * std::cos(remedy.right) + back * std::sin(remedy.right);
      pose[1] = up * std::cos(remedy.up) + turned_back * std::sin(remedy.up);
      pose[2] = turned_back * std::cos(remedy.up) - up * std::sin(remedy.up);
      break;
    }
    case RemedyKind::enlarge:
      changed.width = int(std::min(view.width * remedy.value, 1e6));
      changed.height = int(std::min(view.height * remedy.value, 1e6));
      break;
    default: break;
  }
  validate(changed);
  return changed;
}

}  // namespace frontmost
