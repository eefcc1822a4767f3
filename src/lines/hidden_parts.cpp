// SPDX-License-Identifier: Apache-2.0
// A point X of an edge is hidden by a triangle when it lies within its three planes through the eye, and beyond its
// own: four functions that are linear along the edge, so that their signs at both ends say all. X within a plane
// through the eye is hidden (the shadow is closed), X within the triangle's own plane is not.

#include "lines/hidden_parts.h"

#include <algorithm>
#include <cmath>

namespace frontmost::lines_detail {
namespace {

/// Where a function that is linear from 0 to 1, with these ends, is not negative; `is_strict`: where it is positive.
/// Nothing of no length: {1, 0}.
std::pair<double, double> where_positive(const Signed& at_0, const Signed& at_1, bool is_strict) {
  if (at_0.sign >= 0 && at_1.sign >= 0) {
    if (is_strict && at_0.sign == 0 && at_1.sign == 0) return {1, 0};
    return {0, 1};
  }
  if (at_0.sign <= 0 && at_1.sign <= 0) return {1, 0};
  // The values may be wrong by rounding, their signs are not.
  const double a = std::abs(at_0.value), b = std::abs(at_1.value);
  const double root = a + b > 0 ? a / (a + b) : 0.5;
  if (at_0.sign < 0) return {root, 1};
  return {0, root};
}

Signed with_sign_of_value(double value) { return {value, value > 0 ? 1 : value < 0 ? -1 : 0}; }

}  // namespace

EdgeCutter::Interval EdgeCutter::within_view() const {
  Interval shown{0, 1};
  const auto keep = [&](double at_0, double at_1) {
    const auto [begin, end] = where_positive(with_sign_of_value(at_0), with_sign_of_value(at_1), false);
    shown = {std::max(shown.begin, begin), std::min(shown.end, end)};
  };
  const Projection& p = o_.view.projection;
  const double w0 = p.orthographic ? 1 : from_eye_.z, w1 = p.orthographic ? 1 : to_eye_.z;
  keep(from_eye_.z - p.clip.near, to_eye_.z - p.clip.near);
  if (p.clip.far < std::numeric_limits<double>::infinity()) keep(p.clip.far - from_eye_.z, p.clip.far - to_eye_.z);
  keep(from_eye_.x - p.left * w0, to_eye_.x - p.left * w1);
  keep(p.right * w0 - from_eye_.x, p.right * w1 - to_eye_.x);
  keep(from_eye_.y - p.bottom * w0, to_eye_.y - p.bottom * w1);
  keep(p.top * w0 - from_eye_.y, p.top * w1 - to_eye_.y);
  return shown;
}

glm::dvec2 EdgeCutter::on_screen(double t) const {
  // From the nearer end, so that both ends are met.
  const glm::dvec3 p = t <= 0.5 ? from_eye_ + (to_eye_ - from_eye_) * t : to_eye_ + (from_eye_ - to_eye_) * (1 - t);
  return glm::dvec2(o_.sight.to_screen(p));
}

EdgeCutter::Interval EdgeCutter::hidden_by(const Occluder& occluder) const {
  const glm::uvec3& corners = o_.mesh.triangles[occluder.triangle];
  const std::vector<glm::dvec3>& at = o_.mesh.positions;
  const int facing = o_.facing[occluder.triangle];
  const FacePlane plane(at[corners.x], at[corners.y], at[corners.z]);
  const auto depth = [&](std::uint32_t vertex, const glm::dvec3& place) {
    if (vertex == corners.x || vertex == corners.y || vertex == corners.z) return Signed{};
    const Signed height = plane.height(place);
    return Signed{-height.value * facing, -height.sign * facing};
  };
  const auto [begin, end] = where_positive(depth(edge_.from, from_), depth(edge_.to, to_), true);
  if (!(begin < end)) return {1, 0};
  const Interval shadow = in_shadow_of(occluder, plane);
  return {std::max(begin, shadow.begin), std::min(end, shadow.end)};
}

EdgeCutter::Interval EdgeCutter::in_shadow_of(const Occluder& occluder, const FacePlane& plane) const {
  const glm::uvec3& corners = o_.mesh.triangles[occluder.triangle];
  const std::vector<glm::dvec3>& at = o_.mesh.positions;
  const int facing = o_.facing[occluder.triangle];
  Interval shadow{0, 1};
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t a = corners[k], b = corners[(k + 1) % 3];
    // Neighbours ask the same plane, turned over: what they say fits to the bit.
    const Sight::EyePlane side = o_.sight.plane_through(at[std::min(a, b)], at[std::max(a, b)]);
    const int sign = a < b ? facing : -facing;
    const auto turn = [&](std::uint32_t vertex, const glm::dvec3& place) {
      if (vertex == a || vertex == b) return Signed{};
      const Signed value = side.turn(place);
      return Signed{value.value * sign, value.sign * sign};
    };
    const auto [begin, end] = where_positive(turn(edge_.from, from_), turn(edge_.to, to_), false);
    shadow = {std::max(shadow.begin, begin), std::min(shadow.end, end)};
    if (!(shadow.begin < shadow.end)) return {1, 0};
  }
  if (double(occluder.nearest) > o_.sight.near() * (1 + 1e-6)) return shadow;
  const Interval beyond = beyond_near(corners, plane, facing);
  return {std::max(shadow.begin, beyond.begin), std::min(shadow.end, beyond.end)};
}

/// Where the triangle is not between the eye and the near plane: with its normal n, a point A of it and the eye E, the
/// line of sight to X meets it at the distance of X times n.(A - E) / n.(X - E).
EdgeCutter::Interval EdgeCutter::beyond_near(const glm::uvec3& corners, const FacePlane& plane, int facing) const {
  const Sight& sight = o_.sight;
  const glm::dvec3 &n = plane.normal(), &a = o_.mesh.positions[corners.x];
  const auto beyond = [&](const glm::dvec3& x, double distance) {
    if (sight.is_parallel())
      return with_sign_of_value(-facing *
                                ((distance - sight.near()) * glm::dot(n, sight.forward()) - glm::dot(n, x - a)));
    return with_sign_of_value(-facing *
                              (distance * glm::dot(n, a - sight.eye()) - sight.near() * glm::dot(n, x - sight.eye())));
  };
  const auto [begin, end] = where_positive(beyond(from_, from_eye_.z), beyond(to_, to_eye_.z), false);
  return {begin, end};
}

/// \returns true when all of the edge is hidden.
bool EdgeCutter::collect(const Interval& shown, std::span<const Occluder> cell, double farthest) {
  const std::size_t before = hidden_.size();
  for (const Occluder& occluder : cell) {
    if (double(occluder.nearest) > farthest) break;
    if (occluder.low.x > high_.x || occluder.high.x < low_.x || occluder.low.y > high_.y || occluder.high.y < low_.y)
      continue;
    if (asked_[occluder.triangle] == asking_) continue;
    asked_[occluder.triangle] = asking_;
    Interval hidden = hidden_by(occluder);
    hidden = {std::max(hidden.begin, shown.begin), std::min(hidden.end, shown.end)};
    if (hidden.begin < hidden.end) hidden_.push_back(hidden);
  }
  return !counts_ && hidden_.size() > before && is_covered(shown);
}

/// Unites what is hidden, in order.
bool EdgeCutter::is_covered(const Interval& shown) {
  std::sort(hidden_.begin(), hidden_.end(), [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
  std::size_t kept = 0;
  for (std::size_t i = 1; i < hidden_.size(); ++i) {
    if (hidden_[i].begin <= hidden_[kept].end)
      hidden_[kept].end = std::max(hidden_[kept].end, hidden_[i].end);
    else
      hidden_[++kept] = hidden_[i];
  }
  hidden_.resize(kept + 1);
  return hidden_[0].begin <= shown.begin && hidden_[0].end >= shown.end;
}

void EdgeCutter::emit(const Interval& shown, std::uint32_t number, std::vector<DrawnPart>& parts) {
  changes_.clear();
  for (const Interval& hidden : hidden_) {
    changes_.emplace_back(hidden.begin, 1);
    changes_.emplace_back(hidden.end, -1);
  }
  changes_.emplace_back(shown.end, 0);
  std::sort(changes_.begin(), changes_.end());
  const std::size_t first = parts.size();
  double begin = shown.begin;
  int depth = 0;
  for (const auto& [t, change] : changes_) {
    if (t > begin) {
      const auto hidden_by = std::uint32_t(counts_ ? depth : std::min(depth, 1));
      if (parts.size() > first && parts.back().hidden_by == hidden_by)
        parts.back().end = t;
      else
        parts.push_back({number, begin, t, {}, {}, hidden_by});
      begin = t;
    }
    depth += change;
  }
  for (std::size_t i = first; i < parts.size(); ++i) {
    parts[i].from = i == first ? on_screen(parts[i].begin) : parts[i - 1].to;
    parts[i].to = on_screen(parts[i].end);
  }
}

void EdgeCutter::cut(const FeatureEdge& edge, std::uint32_t number, std::vector<DrawnPart>& parts) {
  asked_.resize(o_.mesh.triangles.size(), 0);
  ++asking_;
  edge_ = edge;
  from_ = o_.mesh.positions[edge.from];
  to_ = o_.mesh.positions[edge.to];
  from_eye_ = o_.sight.in_eye(from_);
  to_eye_ = o_.sight.in_eye(to_);
  const Interval shown = within_view();
  if (!(shown.begin < shown.end)) return;
  const glm::dvec2 a = on_screen(shown.begin), b = on_screen(shown.end);
  const glm::dvec2 pad(OccluderGrid::kPad), low = glm::min(a, b) * o_.grid.scale() - pad;
  low_ = glm::vec2(low - 1e-6 * glm::abs(low));
  const glm::dvec2 high = glm::max(a, b) * o_.grid.scale() + pad;
  high_ = glm::vec2(high + 1e-6 * glm::abs(high));
  const double farthest = std::max(from_eye_.z, to_eye_.z) * (1 + 1e-9);
  hidden_.clear();
  o_.grid.visit_cells(a, b, [&](std::span<const Occluder> cell) { return !collect(shown, cell, farthest); });
  emit(shown, number, parts);
}

}  // namespace frontmost::lines_detail
