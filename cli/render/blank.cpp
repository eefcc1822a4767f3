// SPDX-License-Identifier: Apache-2.0
// Each triangle is charged with the first thing that hides it, in the order in which a renderer would find it; the
// sentence names what hides all, or else counts.
#include "cli/render/blank.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace frontmost::cli {
namespace {

enum Cause { non_finite, behind, too_near, too_far, outside, culled, too_small, cause_count };

constexpr std::array<std::string_view, cause_count> clauses = {"has corners that are not finite",
                                                               "is behind the camera",
                                                               "is nearer than the near plane",
                                                               "is beyond the far plane",
                                                               "is outside the picture",
                                                               "faces the way that --cull leaves out",
                                                               "is smaller than a pixel or seen edge-on"};

using Corners = std::array<glm::dvec3, 3>;

/// Corners in eye space, z turned into distance.
Corners in_eye(const std::array<glm::vec3, 3>& corners, const View& view) {
  Corners result;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 offset = glm::dvec3(corners[i]) - view.eye();
    result[i] = {glm::dot(offset, view.right()), glm::dot(offset, view.up()), glm::dot(offset, view.forward())};
  }
  return result;
}

template <class Test>
bool all(const Corners& corners, const Test& test) {
  return std::all_of(corners.begin(), corners.end(), test);
}

bool is_outside(const Corners& c, const Projection& p) {
  const auto reach = [&](const glm::dvec3& v) { return p.orthographic ? 1.0 : v.z; };
  return all(c, [&](const glm::dvec3& v) { return v.x < p.left * reach(v); }) ||
         all(c, [&](const glm::dvec3& v) { return v.x > p.right * reach(v); }) ||
         all(c, [&](const glm::dvec3& v) { return v.y < p.bottom * reach(v); }) ||
         all(c, [&](const glm::dvec3& v) { return v.y > p.top * reach(v); });
}

bool is_culled(const Corners& c, const View& view) {
  if (view.culling == Culling::none) return false;
  if (view.culling == Culling::both) return true;
  // Positive when the corners run counter-clockwise as seen from the eye: y up, looking along +distance.
  const glm::dvec3 normal = glm::cross(c[1] - c[0], c[2] - c[0]);
  const double facing = view.projection.orthographic ? normal.z : glm::dot(normal, c[0]);
  return view.culling == Culling::back ? facing < 0 : facing > 0;
}

Cause cause_of(const std::array<glm::vec3, 3>& corners, const View& view) {
  const Corners c = in_eye(corners, view);
  if (!all(c, [](const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); })) {
    return non_finite;
  }
  if (!view.projection.orthographic && all(c, [](const glm::dvec3& v) { return v.z <= 0; })) return behind;
  if (all(c, [&](const glm::dvec3& v) { return v.z < view.projection.clip.near; })) return too_near;
  if (all(c, [&](const glm::dvec3& v) { return v.z > view.projection.clip.far; })) return too_far;
  if (is_outside(c, view.projection)) return outside;
  return is_culled(c, view) ? culled : too_small;
}

}  // namespace

bool is_blank(const Visible& visible) {
  return std::all_of(visible.primitives.begin(), visible.primitives.end(),
                     [](PrimitiveId id) { return id == no_primitive; });
}

std::string blank_reason(const Surfaces& surfaces, const View& view) {
  if (surfaces.primitive_count() == 0) return "the model has no triangles";
  std::array<std::uint64_t, cause_count> counts{};
  for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) ++counts[cause_of(surfaces.corners(id), view)];
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < cause_count; ++i) {
    if (counts[i] == surfaces.primitive_count()) return fmt::format("all of the model {}", clauses[i]);
    if (counts[i] > 0)
      parts.push_back(fmt::format("{} of {} triangles: {}", counts[i], surfaces.primitive_count(), clauses[i]));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace frontmost::cli
