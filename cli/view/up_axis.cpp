// SPDX-License-Identifier: Apache-2.0
// A standing model has a flat base: triangles in the lowest plane of its bounds that face down. So a model lies if the
// only flat one of the six sides is along the other usual up axis:
//
//          up         .-.                      up
//           |        /   \                      |      ___
//           |        |   |                      |   .-'   |  <- flat, and nothing else is
//           |        |___|  <- flat             |   '-.___|      no other side is flat
//
// Plates are flat on both sides and boxes everywhere, so they cause no warning.
#include "cli/view/up_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace frontmost::cli {
namespace {

/// The shares of two opposite sides of the bounds that are covered by triangles in these sides that face outwards.
struct FlatSides {
  double low = 0, high = 0;
};

constexpr PrimitiveId most_asked = 1'000'000;

std::array<FlatSides, 3> find_flat_sides(const Surfaces& surfaces) {
  const Box& bounds = surfaces.bounds();
  const glm::dvec3 low(bounds.low), high(bounds.high), size = high - low;
  const glm::dvec3 thin = 0.01 * size;  // since bases of scans are uneven
  const PrimitiveId step = surfaces.primitive_count() / most_asked + 1;
  std::array<FlatSides, 3> sides;
  for (PrimitiveId id = 0; id < surfaces.primitive_count(); id += step) {
    const std::array<glm::vec3, 3> c = surfaces.corners(id);  // formats that leave the up axis open mirror nothing
    const glm::dvec3 least(glm::min(c[0], glm::min(c[1], c[2]))), most(glm::max(c[0], glm::max(c[1], c[2])));
    const glm::bvec3 is_low = glm::lessThanEqual(most - low, thin), is_high = glm::lessThanEqual(high - least, thin);
    if (!glm::any(is_low) && !glm::any(is_high)) continue;  // nearly all triangles of most models
    if (!is_finite(c[0]) || !is_finite(c[1]) || !is_finite(c[2])) continue;
    const glm::dvec3 doubled_area = glm::cross(glm::dvec3(c[1] - c[0]), glm::dvec3(c[2] - c[0]));
    for (int axis = 0; axis < 3; ++axis) {
      const double area = double(step) * 0.5 * std::abs(doubled_area[axis]);
      FlatSides& found = sides[std::size_t(axis)];
      if (doubled_area[axis] < 0 && is_low[axis]) found.low += area;
      if (doubled_area[axis] > 0 && is_high[axis]) found.high += area;
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double whole = size[(axis + 1) % 3] * size[(axis + 2) % 3];
    sides[std::size_t(axis)].low /= whole;
    sides[std::size_t(axis)].high /= whole;
  }
  return sides;
}

/// Whether the format leaves the up axis open. Formats whose specification defines it are trusted.
bool leaves_up_open(const SceneSource& source) {
  return source.format == ModelFormat::stl || source.format == ModelFormat::ply || source.format == ModelFormat::obj ||
         source.format == ModelFormat::off;
}

}  // namespace

bool depends_on_up(const ViewSettings& view) {
  return !view.position && !view.pose && !view.camera_index && !view.direction;
}

std::optional<std::string> up_warning(const ViewSettings& view, const LoadOptions& load, const Surfaces& surfaces) {
  const Scene& scene = surfaces.scene();
  if (!depends_on_up(view) || load.up || !leaves_up_open(scene.source)) return std::nullopt;
  const int up = scene.up == Axis::y ? 1 : 2, other = 3 - up;
  const glm::dvec3 size = glm::dvec3(surfaces.bounds().high) - glm::dvec3(surfaces.bounds().low);
  // Shares of covered sides: standing models have 0.06 (the Armadillo's feet) and more at the base, below 0.02
  // elsewhere.
  constexpr double base = 0.05, none = 0.02, least_height = 0.25;
  constexpr PrimitiveId fewest = 24;  // fewer triangles tell nothing
  if (surfaces.primitive_count() < fewest) return std::nullopt;
  if (!(size.x > 0 && size.y > 0 && size.z > 0) || size[other] < least_height * std::max({size.x, size.y, size.z}))
    return std::nullopt;
  const std::array<FlatSides, 3> sides = find_flat_sides(surfaces);
  const FlatSides& lies_on = sides[std::size_t(other)];
  if (lies_on.low < base || lies_on.high > none) return std::nullopt;
  for (const int axis : {0, up})
    if (std::max(sides[std::size_t(axis)].low, sides[std::size_t(axis)].high) > none) return std::nullopt;
  const char* const names = "xyz";
  return fmt::format(
      "the model may lie on its back: its only flat side faces -{}, but its up axis is {}; --up +{} stands it up",
      names[other], names[up], names[other]);
}

}  // namespace frontmost::cli
