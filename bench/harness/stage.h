// SPDX-License-Identifier: Apache-2.0
// A scene made ready, and one frame of it.
#pragma once

#include "harness/scenes.h"

namespace frontmost::bench {

struct Stage {
  Stage(std::string_view scene_name, const std::string& models)
      : scene(make_scene(scene_name, models)),
        surfaces(scene),
        view(make_view(surfaces, find_scene(scene_name).camera)) {}
  Scene scene;
  Surfaces surfaces;
  View view;
};

/// Draws views of one stage again and again.
class Frames {
 public:
  explicit Frames(const Stage& stage) : Frames(stage.surfaces, stage.view) {}
  Frames(const Surfaces& surfaces, const View& view) : surfaces_(surfaces), view_(view) {}

  void draw(const Execution& execution) { visible_ = zbuffer(surfaces_, view_, execution); }
  [[nodiscard]] const Visible& visible() const { return visible_; }

 private:
  const Surfaces& surfaces_;
  View view_;
  Visible visible_;
};

}  // namespace frontmost::bench
