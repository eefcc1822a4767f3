// SPDX-License-Identifier: Apache-2.0
// A model on the workbench, which is opened, drawn, asked about, and written to files.
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

/// Questions and answers are JSON objects. Answers give planes of numbers by their addresses in memory, valid until the
/// next question. All functions throw Error as the library does, and exceptions of nlohmann::json for incomplete
/// questions.
class Workbench {
 public:
  /// Stores a file that the next model names: {"name"}, which may contain folders. With {"first"}, earlier files are
  /// removed.
  PlainJson put_file(std::span<const std::byte> bytes, const PlainJson& question);
  /// Opens the bytes of a model called {"name"}; without bytes, the stored file of that name. \returns {"name",
  /// "triangles", "objects", "materials", "bounds", "warnings", ...}. If textures have to be decoded first, it returns
  /// {"images"}, the addresses of their files; {"again"} continues after put_image() for each. The previous model is
  /// replaced, unless this one cannot be read. Stored files are removed in any case.
  PlainJson open(std::vector<std::byte>&& bytes, const PlainJson& question);
  /// Stores {"number", "width", "height"} and the pixels, four bytes each; or {"number", "problem"}.
  PlainJson put_image(std::span<const std::byte> bytes, const PlainJson& question);
  /// Opens the built-in scene {"name"}.
  PlainJson open_builtin(const PlainJson& question);

  /// Makes a camera of {"width", "height", "view": "three-quarter", ...} that shows the whole model.
  PlainJson frame(const PlainJson& question);
  /// Draws {"camera", "show", ...} -> {"pixels", "width", "height", "near", "far", "milliseconds"}. With "hash", the
  /// answer has the hash of visibility, too; with "coarse", neighbouring pixels share colours. "show" is picture,
  /// depth, primitives, objects, materials, normals or layer.
  PlainJson draw(const PlainJson& question);
  /// The feature edges of the last view: x and y of both ends, and 1 if hidden; five floats an edge.
  PlainJson edges(const PlainJson& question);
  /// The surfaces at {"x", "y"}, nearest first.
  PlainJson point(const PlainJson& question);
  /// All objects of the last view: visible shares, hiders, and reasons.
  PlainJson report(const PlainJson& question);
  /// {"views"} -> for each object, the number of faces that views from all around see.
  PlainJson sphere(const PlainJson& question);
  /// The bytes of a file of the last view in {"format"}.
  PlainJson write(const PlainJson& question);
  /// The last view's camera in all conventions.
  PlainJson conventions(const PlainJson& question);

  /// Data for WebGL to draw the last view: corners of all triangles, a colour for each corner, the matrix to OpenGL's
  /// clip coordinates (four rows), and the number of the view.
  PlainJson triangles(const PlainJson& question);
  /// Compares triangle numbers drawn by WebGL: from 1 on, 0 for none, four bytes a pixel, top row first.
  /// {"subpixel_bits"} comes from WebGL, {"view"} from triangles(). \returns {"differences", "counts"}: for each
  /// differing pixel x, y, the reason, pixels to the nearest border, steps of a 24-bit depth buffer, and both triangles
  /// or -1; seven floats.
  PlainJson compare(std::span<const std::byte> bytes, const PlainJson& question);

  [[nodiscard]] const Scene& scene() const { return model().scene; }
  [[nodiscard]] const Surfaces& surfaces() const { return model().surfaces; }

 private:
  /// A scene with its borrowers, which require that the scene does not move.
  struct Model {
    explicit Model(Scene&& taken) : scene(std::move(taken)), surfaces(scene), shader(surfaces) {}
    Scene scene;
    Surfaces surfaces;
    Shader shader;
    std::optional<RayIndex> index;  ///< made at its first use
  };
  /// A model that is being opened.
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
  Visible visible_;  ///< answer of the last view, one sample a pixel
  bool is_current_ = false;
  int view_number_ = 0;
  View view_;
  Bitmap bitmap_;
  std::vector<float> segments_, corners_, differences_;
  std::vector<std::uint32_t> colors_;
  std::string file_;
};

}  // namespace frontmost::web
