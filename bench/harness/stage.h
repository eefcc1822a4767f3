// SPDX-License-Identifier: Apache-2.0
// A scene ready to draw, and frames of it.
#pragma once

#include "harness/scenes.h"

namespace frontmost::bench {

struct Stage {
  Stage(std::string_view scene_name, const std::string& models)
      : scene(make_scene(scene_name, models)),
        surfaces(scene),
        view(make_view(surfaces.bounds(0), find_scene(scene_name).camera)) {}
  Stage(Scene&& other_scene, const View& other_view)
      : scene(std::move(other_scene)), surfaces(scene), view(other_view) {}
  Scene scene;
  Surfaces surfaces;
  View view;
};

/// One triangle that covers all of a perspective view.
[[nodiscard]] inline Scene make_cover(const View& view) {
  const Projection& p = view.projection;
  const double z = -0.5 * (p.clip.near + p.clip.far);
  // The triangle has twice the picture's height and width from the lower left corner, and a little more on each side.
  const double x0 = -z * (p.left - 0.1), y0 = -z * (p.bottom - 0.1);
  const double width = -z * (p.right - p.left + 0.3), height = -z * (p.top - p.bottom + 0.3);
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  for (const glm::dvec2 corner : {glm::dvec2(0, 0), glm::dvec2(2, 0), glm::dvec2(0, 2)})
    mesh.positions.emplace_back(view.world_from_eye * glm::dvec4(x0 + corner.x * width, y0 + corner.y * height, z, 1));
  mesh.triangles.push_back({0, 1, 2});
  scene.instances.push_back({"cover", 0, glm::dmat4(1.0)});
  return scene;
}

/// Draws one view repeatedly, in the same memory.
class Frames {
 public:
  explicit Frames(const Stage& stage) : Frames(stage.surfaces, stage.view) {}
  Frames(const Surfaces& surfaces, const View& view) : surfaces_(surfaces), view_(view) {}

  const Visible& draw(const Execution& execution) { return zbuffer_.draw(surfaces_, view_, execution); }
  /// Draws another picture into the same planes, so that the next frame must clear all tiles, also those left blank.
  void draw_other(const Stage& other) { (void)zbuffer_.draw(other.surfaces, other.view, {.threads = 1}); }

 private:
  const Surfaces& surfaces_;
  View view_;
  ZBuffer zbuffer_;
};

}  // namespace frontmost::bench
