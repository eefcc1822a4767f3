// SPDX-License-Identifier: Apache-2.0
// Each unseen triangle is counted under the first cause that keeps it out of the view. The sentence names the cause
// that holds for all of them, or gives the counts.
#include "cli/render/blank.h"

#include <fmt/format.h>
#include <frontmost/zbuffer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <vector>

namespace frontmost::cli {
namespace {

enum Cause { non_finite, behind, too_near, too_far, outside, culled, too_small };

constexpr std::array<std::string_view, 7> clauses = {"has vertices that are not finite",
                                                     "is behind the camera",
                                                     "is nearer than the near plane",
                                                     "is beyond the far plane",
                                                     "is outside the picture",
                                                     "faces the side that --cull leaves out",
                                                     "is smaller than a pixel or seen edge-on"};

using WorldCorners = std::array<glm::dvec3, 3>;

/// Returns corners in eye space, with z replaced by the distance.
WorldCorners in_eye(const std::array<glm::vec3, 3>& corners, const View& view) {
  WorldCorners result;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 offset = glm::dvec3(corners[i]) - view.eye();
    result[i] = {glm::dot(offset, view.right()), glm::dot(offset, view.up()), glm::dot(offset, view.forward())};
  }
  return result;
}

template <class Test>
bool all(const WorldCorners& corners, const Test& test) {
  return std::all_of(corners.begin(), corners.end(), test);
}

bool is_outside(const WorldCorners& c, const Projection& p) {
  const auto reach = [&](const glm::dvec3& v) { return p.orthographic ? 1.0 : v.z; };
  return all(c, [&](const glm::dvec3& v) { return v.x < p.left * reach(v); }) ||
         all(c, [&](const glm::dvec3& v) { return v.x > p.right * reach(v); }) ||
         all(c, [&](const glm::dvec3& v) { return v.y < p.bottom * reach(v); }) ||
         all(c, [&](const glm::dvec3& v) { return v.y > p.top * reach(v); });
}

/// Whether culling removes the triangle. With Culling::material, double-sided triangles count as one-sided; they only
/// get here if they are tiny.
bool is_culled(const WorldCorners& c, const View& view) {
  if (view.culling == Culling::none) return false;
  if (view.culling == Culling::both) return true;
  // `facing` is positive if the corners run counter-clockwise as seen from the eye, with y up and a view along
  // +distance.
  const glm::dvec3 normal = glm::cross(c[1] - c[0], c[2] - c[0]);
  const double facing = view.projection.orthographic ? normal.z : glm::dot(normal, c[0]);
  return view.culling == Culling::front ? facing > 0 : facing < 0;
}

Cause cause_of(const std::array<glm::vec3, 3>& corners, const View& view) {
  const WorldCorners c = in_eye(corners, view);
  if (!all(c, [](const glm::dvec3& v) { return is_finite(v); })) {
    return non_finite;
  }
  if (!view.projection.orthographic && all(c, [](const glm::dvec3& v) { return v.z <= 0; })) return behind;
  if (all(c, [&](const glm::dvec3& v) { return v.z < view.projection.clip.near; })) return too_near;
  if (all(c, [&](const glm::dvec3& v) { return v.z > view.projection.clip.far; })) return too_far;
  if (is_outside(c, view.projection)) return outside;
  return is_culled(c, view) ? culled : too_small;
}

constexpr float most_steps = 8;
constexpr std::size_t one_in = 1000;

/// Whether a blank picture would show something if materials had no holes.
bool is_all_holes(const Surfaces& surfaces, const View& view, const Execution& execution) {
  const auto has_holes = [](const Material& material) { return material.alpha == Material::Alpha::mask; };
  const std::vector<Material>& materials = surfaces.scene().materials;
  if (std::none_of(materials.begin(), materials.end(), has_holes)) return false;
  Scene scene = surfaces.scene();
  for (Material& material : scene.materials) material.alpha = Material::Alpha::opaque;
  return !is_blank(zbuffer(Surfaces(scene, execution), view, execution));
}

float linear(float srgb) { return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f); }

/// The range of a channel's values that look like the background, in the channel's own scale.
struct Alike {
  float low, high;
  [[nodiscard]] bool holds(float value) const { return value >= low && value <= high; }
};

/// Returns the ranges of the colour channels. `scale` converts an sRGB value from 0 to 1 to the channel's scale.
template <class Scale>
std::array<Alike, 3> alike_to(const glm::vec3& background, const Scale& scale) {
  std::array<Alike, 3> alike{};
  for (int c = 0; c < 3; ++c) {
    const float low = background[c] - most_steps / 255, high = background[c] + most_steps / 255;
    // Values brighter than white are displayed as white.
    alike[std::size_t(c)] = {low <= 0 ? -INFINITY : scale(low), high >= 1 ? INFINITY : scale(high)};
  }
  return alike;
}

/// Whether less than one in `one_in` of the covered pixels differs from the background. stands_out(i) says whether
/// pixel i differs. False if no pixel is covered.
template <class StandsOut>
bool too_few(std::span<const PrimitiveId> primitives, const StandsOut& stands_out) {
  std::size_t covered = 0, distinct = 0;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    if (primitives[i] == no_primitive) continue;
    ++covered;
    if (!stands_out(i)) continue;
    if (++distinct * one_in >= primitives.size()) return false;
  }
  return covered > 0 && distinct * one_in < covered;
}

}  // namespace

bool is_blank(const Visible& visible) {
  return std::all_of(visible.primitives.begin(), visible.primitives.end(),
                     [](PrimitiveId id) { return id == no_primitive; });
}

void BlankReason::add(std::span<const std::array<glm::vec3, 3>> triangles) {
  std::array<std::uint64_t, cause_count> counts{};
  for (const std::array<glm::vec3, 3>& corners : triangles) ++counts[cause_of(corners, view_)];
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < counts.size(); ++i) counts_[i] += counts[i];
}

void BlankReason::gather(Ranks& ranks) {
  const auto* first = reinterpret_cast<const std::byte*>(counts_.data());
  const std::vector<Ranks::Message> all = ranks.gather({first, first + sizeof counts_});
  for (std::size_t rank = 1; rank < all.size(); ++rank) {
    decltype(counts_) theirs{};
    std::memcpy(theirs.data(), all[rank].data(), std::min(sizeof theirs, all[rank].size()));
    for (std::size_t i = 0; i < cause_count; ++i) counts_[i] += theirs[i];
  }
}

bool BlankReason::has_small() const { return counts_[too_small] > 0; }

std::string BlankReason::clause() const {
  static_assert(clauses.size() == cause_count);
  const std::uint64_t all = std::accumulate(counts_.begin(), counts_.end(), std::uint64_t(0));
  if (all == 0) return "the model has no triangles";
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < cause_count; ++i) {
    if (counts_[i] == all) return fmt::format("all of the model {}", clauses[i]);
    if (counts_[i] > 0) parts.push_back(fmt::format("{} of {} triangles: {}", counts_[i], all, clauses[i]));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

std::string blank_reason(const Surfaces& surfaces, const View& view, const Execution& execution) {
  BlankReason reason(view);
  std::vector<std::array<glm::vec3, 3>> corners;
  constexpr PrimitiveId at_once = 4096;
  for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
    corners.push_back(surfaces.corners(id));
    if (corners.size() < at_once) continue;
    reason.add(corners);
    corners.clear();
  }
  reason.add(corners);
  if (reason.has_small() && is_all_holes(surfaces, view, execution))
    return "all of the model in the picture is cut away by alpha mode MASK of its materials";
  return reason.clause();
}

bool nothing_stands_out(const Image& picture, std::span<const PrimitiveId> primitives, const glm::vec3& background) {
  const std::size_t pixels = std::size_t(picture.width) * std::size_t(picture.height);
  std::array<const float*, 3> planes{};
  for (std::size_t c = 0; c < 3; ++c) {
    const Channel* const channel = picture.find(std::array{"R", "G", "B"}[c]);
    if (!channel) return false;
    planes[c] = channel->floats().data();
  }
  const std::array<Alike, 3> alike = alike_to(background, linear);
  return too_few(primitives.first(pixels), [&](std::size_t i) {
    return !alike[0].holds(planes[0][i]) || !alike[1].holds(planes[1][i]) || !alike[2].holds(planes[2][i]);
  });
}

bool nothing_stands_out(const Bitmap& picture, std::span<const PrimitiveId> primitives, const glm::vec3& background) {
  const std::size_t pixels = std::size_t(picture.width) * std::size_t(picture.height);
  const std::array<Alike, 3> alike = alike_to(background, [](float srgb) { return 255 * srgb; });
  return too_few(primitives.first(pixels), [&](std::size_t i) {
    const std::uint8_t* const rgba = picture.rgba.data() + 4 * i;
    return !alike[0].holds(rgba[0]) || !alike[1].holds(rgba[1]) || !alike[2].holds(rgba[2]);
  });
}

bool nothing_stands_out(const Figure& figure, const glm::vec3& background) {
  const auto is_like = [&](const FigureShape& shape) {
    // Contrast of a translucent shape with the background behind it.
    const float opacity = float(shape.color.a) / 255;
    const glm::vec3 color = glm::vec3(shape.color) / 255.0f;
    const glm::vec3 apart = glm::abs(color - background) * opacity * 255.0f;
    return std::max({apart.r, apart.g, apart.b}) <= most_steps;
  };
  return !figure.shapes.empty() && std::all_of(figure.shapes.begin(), figure.shapes.end(), is_like);
}

bool is_invisible(const Surfaces& surfaces, std::span<const PrimitiveId> primitives) {
  const std::vector<Material>& materials = surfaces.scene().materials;
  bool is_anything_seen = false;
  for (const PrimitiveId id : primitives) {
    if (id == no_primitive) continue;
    const PrimitiveSource source = surfaces.source(id);
    const std::uint32_t material = surfaces.scene().meshes[source.mesh].material_of(source.triangle);
    if (material >= materials.size() || materials[material].alpha != Material::Alpha::blend ||
        materials[material].base_color.a > 0)
      return false;
    is_anything_seen = true;
  }
  return is_anything_seen;
}

std::string contrast_warning(bool is_invisible) {
  if (is_invisible)
    return "nothing in the picture stands out from its background: the opacity of all materials in it is 0";
  return fmt::format(
      "nothing in the picture stands out from its background: fewer than 1 in {} of the covered pixels differ from it "
      "by more than {:.0f} of 255 steps; try another --background",
      one_in, most_steps);
}

}  // namespace frontmost::cli
