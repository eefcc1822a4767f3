// SPDX-License-Identifier: Apache-2.0
// One model on the workbench: opened, drawn, asked about, written to files.
#pragma once

#include <frontmost/abuffer.h>
#include <frontmost/files.h>
#include <frontmost/pictures.h>
#include <frontmost/raycast.h>
#include <frontmost/zbuffer.h>

#include <optional>
#include <string>
#include <vector>

#include "web/images.h"
#include "web/json.h"

namespace frontmost::web {

/// Questions are JSON objects, and so are answers; planes of numbers are told by their places in memory, where they
/// stay until the next question. Everything throws Error as the library does, and nlohmann::json's exceptions for
/// questions that lack something.
class Workbench {
 public:
  /// A file that the next model names: {"name"}, which may have folders; with {"first"} those before are gone.
  PlainJson put_file(std::span<const std::byte> bytes, const PlainJson& question);
  /// The bytes of a model, and its {"name"}; without bytes it is one of the files that were put. \returns what there
  /// is:
  /// {"name", "triangles", "objects", "materials", "bounds", "warnings", ...}; or, where textures have to be decoded
  /// first, {"images"}, their files' places: after put_image() for each {"again"} goes on. The model before is gone,
  /// unless this one cannot be read. Files that were put are gone in any case.
  PlainJson open(std::vector<std::byte>&& bytes, const PlainJson& question);
  /// {"number", "width", "height"} and the pixels, four bytes each; or {"number", "problem"}.
  PlainJson put_image(std::span<const std::byte> bytes, const PlainJson& question);
  /// {"name"}: a built-in scene.
  PlainJson open_builtin(const PlainJson& question);

  /// {"width", "height", "view": "three-quarter", ...} -> a camera that shows all of it.
  PlainJson frame(const PlainJson& question);
  /// {"camera", "show", ...} -> {"pixels", "width", "height", "near", "far", "milliseconds"}; with "hash" the hash of
  /// what is visible, too; with "coarse" pixels share colours. "show" is picture, depth, primitives, objects,
  /// materials, normals or layer.
  PlainJson draw(const PlainJson& question);
  /// The feature edges of the last view: x and y of both ends, and 1 where they are hidden; five floats an edge.
  PlainJson edges(const PlainJson& question);
  /// {"x", "y"} -> what lies one behind the other there, nearest first.
  PlainJson point(const PlainJson& question);
  /// Every object of the last view: its shares, who hides it, why it is not seen.
  PlainJson report(const PlainJson& question);
  /// {"views"} -> of each object how many faces some view all around sees.
  PlainJson sphere(const PlainJson& question);
  /// {"format"} -> the bytes of a file of the last view.
  PlainJson write(const PlainJson& question);
  /// The last view's camera in all conventions.
  PlainJson conventions(const PlainJson& question);

  /// What WebGL needs to draw the last view: corners of all triangles, a colour for each corner, the matrix to clip
  /// coordinates of OpenGL, four rows, and the number of the view.
  PlainJson triangles(const PlainJson& question);
  /// The numbers of the triangles that WebGL has drawn, from 1 on, 0 where there is none, four bytes a pixel, the top
  /// row first; {"subpixel_bits"} as WebGL tells, {"view"} as triangles() -> {"differences", "counts"}: for each pixel
  /// that differs x, y, the reason, pixels to the nearest border, steps of a 24-bit depth buffer, and both triangles or
  /// -1; seven floats.
  PlainJson compare(std::span<const std::byte> bytes, const PlainJson& question);

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
  /// A model on its way in.
  struct Opening {
    std::string name;
    std::vector<std::byte> bytes;
    GivenImages images;
  };
  [[nodiscard]] Model& model() const;
  [[nodiscard]] const Visible& seen();
  PlainJson take(Scene&& scene);
  [[nodiscard]] PlainJson pixels_of(const Bitmap& bitmap);
  void color_ids(const Visible& visible, IdKind kind);

  std::unique_ptr<Opening> opening_;
  std::unique_ptr<Model> model_;
  ZBuffer zbuffer_;
  Visible visible_;  ///< of the last view, one sample a pixel
  bool is_current_ = false;
  int view_number_ = 0;
  View view_;
  Bitmap bitmap_;
  std::vector<float> segments_, corners_, differences_;
  std::vector<std::uint32_t> colors_;
  std::string file_;
};

}  // namespace frontmost::web
