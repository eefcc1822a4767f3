// SPDX-License-Identifier: Apache-2.0
// One model on the workbench: opened, drawn, asked about, written to files.
#pragma once

#include <frontmost/abuffer.h>
#include <frontmost/io.h>
#include <frontmost/raycast.h>
#include <frontmost/shade.h>
#include <frontmost/zbuffer.h>

#include <optional>
#include <string>
#include <vector>

#include "web/json.h"

namespace frontmost::web {

/// Questions are JSON objects, and so are answers; planes of numbers are told by their places in memory, where they
/// stay until the next question. Everything throws Error as the library does, and Json's exceptions for questions that
/// lack something.
class Workbench {
 public:
  /// The bytes of a file, and its name. \returns what there is: {"name", "triangles", "objects", "materials", "bounds",
  /// "warnings", ...}. The model before is gone, unless this one cannot be read.
  Json open(std::span<const std::byte> bytes, const Json& question);
  /// {"name"}: a built-in scene.
  Json open_builtin(const Json& question);

  /// {"width", "height", "view": "three-quarter", ...} -> a camera that shows all of it.
  Json frame(const Json& question);
  /// {"camera", "show", ...} -> {"pixels", "width", "height", "near", "far", "milliseconds"}; with "hash" the hash of
  /// what is visible, too. "show" is picture, depth, primitives, objects, materials, normals or layer.
  Json draw(const Json& question);
  /// The feature edges of the last view: x and y of both ends, and 1 where they are hidden; five floats an edge.
  Json edges(const Json& question);
  /// {"x", "y"} -> what lies one behind the other there, nearest first.
  Json point(const Json& question);
  /// Every object of the last view: its shares, who hides it, why it is not seen.
  Json report(const Json& question);
  /// {"views"} -> of each object how many faces some view all around sees.
  Json sphere(const Json& question);
  /// {"format"} -> the bytes of a file of the last view.
  Json write(const Json& question);
  /// The last view's camera in all conventions.
  Json conventions(const Json& question);

  [[nodiscard]] const Scene& scene() const { return model().scene; }
  [[nodiscard]] const Surfaces& surfaces() const { return model().surfaces; }

 private:
  /// Surfaces and what draws them borrow the scene, which must not move.
  struct Model {
    explicit Model(Scene&& taken) : scene(std::move(taken)), surfaces(scene), shader(surfaces) {}
    Scene scene;
    Surfaces surfaces;
    Shader shader;
    std::optional<RayIndex> index;  ///< made when it is asked
  };
  [[nodiscard]] Model& model() const;
  [[nodiscard]] const Visible& seen();
  Json take(Scene&& scene);
  [[nodiscard]] Json pixels_of(const Bitmap& bitmap);
  void color_ids(const Visible& visible, IdKind kind);

  std::unique_ptr<Model> model_;
  ZBuffer zbuffer_;
  Visible visible_;  ///< of the last view, one sample a pixel
  bool is_current_ = false;
  View view_;
  Bitmap bitmap_;
  std::vector<float> segments_;
  std::string file_;
};

}  // namespace frontmost::web
