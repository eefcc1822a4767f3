// SPDX-License-Identifier: Apache-2.0
// One polygon after another in pieces of one colour each.
#pragma once

#include <optional>

#include "frontmost/figure.h"
#include "shade/figure/color_cut.h"
#include "shade/figure/point_shader.h"
#include "view/screen_cutout.h"

namespace frontmost::shading {

/// A piece of a polygon: `corner_count` of ColoredPieces::corners from `first_corner` on.
struct ColoredPiece {
  std::size_t first_corner = 0;
  std::uint32_t corner_count = 0;
  std::uint32_t shape = 0;  ///< rising; pieces of one shape have one colour
  glm::u8vec4 color{0};
};

/// The pieces of a polygon, without holes and what is wholly clear.
struct ColoredPieces {
  std::vector<ColoredPiece> pieces;
  std::vector<PaintCorner> corners;
  std::uint32_t shape_count = 0;
};

/// \throws Error limit_exceeded.
[[noreturn]] void refuse_more_than(std::size_t most);

/// Not for several threads at once.
class PolygonColors {
 public:
  /// Borrows all.
  PolygonColors(const Surfaces& surfaces, const View& view, const PointShader& shader, const ColorOptions& options,
                const Execution& execution);

  /// Until the next call. Precondition: three corners or more. \throws Error cancelled, and as refuse_more_than().
  [[nodiscard]] const ColoredPieces& pieces_of(PrimitiveId id, std::span<const PaintCorner> outline);

 private:
  /// A piece that is still to be looked at; depths are affine over the screen.
  struct Part {
    std::vector<PaintCorner> corners;
    std::uint32_t cut = no_index;  ///< the last that it was made by
  };
  /// Cuts, each with the one before it: a part lies on one side of all of them.
  struct Cut {
    ScreenLine line;
    std::uint32_t before = no_index;
  };
  /// What a part's samples say.
  struct Judgement {
    bool is_one_color = true;
    glm::vec4 color{0};
  };

  void begin(PrimitiveId id, std::span<const PaintCorner> outline);
  void divide(Part part);
  void look(const Part& part);
  void add_places(std::span<const PaintCorner> corners, double count);
  void shade_places();
  [[nodiscard]] bool is_beside_a_cut(const Part& part, const glm::dvec2& at) const;
  [[nodiscard]] Judgement judge(const Part& part) const;
  void cut(const Part& part, const ScreenLine& line);
  void keep(const Part& part, const glm::vec4& color);
  void group_by_color();
  [[nodiscard]] std::span<const TexcoordLines> texture_lines();

  const Surfaces& surfaces_;
  const View& view_;
  const PointShader& shading_;
  const ColorOptions& options_;
  const Execution& execution_;
  const ScreenRays rays_;
  FragmentShader shader_;

  PrimitiveId id_ = no_primitive;
  std::optional<ScreenCutout> holes_;
  std::optional<std::vector<TexcoordLines>> texture_lines_;  ///< made when they are asked for
  std::vector<TriangleSetup> setup_;
  std::vector<Part> parts_;
  std::vector<Cut> cuts_;
  std::vector<glm::dvec2> outline_;
  std::vector<ColorSample> samples_;
  std::size_t corner_samples_ = 0;  ///< the first ones
  struct Kept {
    glm::vec4 color;
    std::uint32_t shape;
    std::vector<PaintCorner> corners;
  };
  std::vector<Kept> kept_;
  ColoredPieces pieces_;
};

}  // namespace frontmost::shading
