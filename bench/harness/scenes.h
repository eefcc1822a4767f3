// SPDX-License-Identifier: Apache-2.0
// The scenes and views that visibility is measured on: made by code, equal on every machine.
#pragma once

#include <frontmost/frontmost.h>

#include <span>
#include <string>
#include <string_view>

namespace frontmost::bench {

/// From where a scene is seen.
enum class Camera : std::uint8_t {
  fit,           ///< all of it, from direction (3, 2, 4)
  over_terrain,  ///< flown through: most pixels are covered, a third of the triangles is outside
  in_city,       ///< the same between the houses
  in_street,     ///< from a crossing, at the height of doors: walls run past the eye, and cross the near plane
  away,          ///< everything lies behind the eye
  wall,          ///< over the city, from before its wall
  close,         ///< all of the picture is covered
};

struct SceneEntry {
  std::string_view name;
  Camera camera = Camera::fit;
  double times_llvmpipe = 0;  ///< how many times faster than llvmpipe it shall be, 0: not compared
  bool is_large = false;      ///< takes tens of seconds to make and to draw with the peers
};

/// Those of opaque surfaces, smallest first.
[[nodiscard]] std::span<const SceneEntry> scene_entries();
/// One mesh in four instances, a twelfth of its bounds' diagonal apart, to be drawn as if translucent. The camera looks
/// at the first.
[[nodiscard]] std::span<const SceneEntry> translucent_entries();
/// \throws Error bad_argument naming the known ones.
[[nodiscard]] const SceneEntry& find_scene(std::string_view name);

/// `models` is the folder of test models; the bunny and the teapot are taken from it where it is there.
[[nodiscard]] Scene make_scene(std::string_view name, const std::string& models);
/// A mesh of boxes, as the city is, as one object each.
[[nodiscard]] Scene taken_apart(const Scene& scene);
[[nodiscard]] View make_view(const Box& bounds, Camera camera, int width = 1920, int height = 1080);

}  // namespace frontmost::bench
