// SPDX-License-Identifier: Apache-2.0
// Cuts consecutive polygons into pieces of one colour each.
//
// A piece belongs to one polygon. A figure keeps every visible polygon, whole or in pieces, in its place in the
// painting order.
#pragma once

#include <optional>

#include "figures/colored_order.h"
#include "figures/coloring/piece_places.h"
#include "figures/coloring/point_shader.h"
#include "view/screen_cutout.h"

namespace frontmost::shading {

/// \throws Error limit_exceeded.
[[noreturn]] void refuse_more_than(std::size_t most);

/// Samples many pieces before it judges them, so that the shader has whole batches. Not for several threads at once.
class PolygonColors {
 public:
  /// Borrows all but the view.
  PolygonColors(const Surfaces& surfaces, const View& view, const PointShader& shader, const FigureOptions& options,
                const Execution& execution);

  /// Appends some of these parts in pieces, without holes and clear pieces. The result depends only on these polygons.
  /// Precondition: each has at least three corners. \throws Error cancelled, and as refuse_more_than() does.
  void color(const VisibleParts& parts, std::span<const PaintPolygon> polygons, ColoredOrder& into);

 private:
  /// A piece that is still to be judged.
  struct Piece {
    std::vector<glm::dvec2> corners;
    std::vector<ColorSample> samples;  ///< includes samples of the piece from which it was cut
    std::size_t known_samples = 0;
    bool is_sliver = false;        ///< all of it lies beside cuts
    std::uint32_t polygon = 0;     ///< index of its polygon
    std::uint32_t node = 0;        ///< node in the tree of cuts
    std::uint32_t cut = no_index;  ///< the last cut that made it
  };
  /// A cut, linked to the one before it: a piece lies on one side of all of its cuts.
  struct Cut {
    ScreenLine line;
    std::uint32_t before = no_index;
  };
  /// A cut piece or a kept one. The order of the tree is the painting order.
  struct Node {
    std::uint32_t below = no_index, above = no_index;  ///< nodes
    std::uint32_t kept = no_index;
  };
  struct Kept {
    glm::vec4 color;
    std::vector<glm::dvec2> corners;
    std::uint32_t group = 0;  ///< of pieces of nearly one colour
  };
  struct Polygon {
    PaintPolygon outline;
    bool is_grouped = false;  ///< pieces of one colour become one shape
    std::uint32_t node = 0;
    std::optional<ScreenCutout> holes{};
    std::optional<std::vector<TexcoordLines>> texture_lines{};  ///< made when first needed
  };
  /// The result of a piece's samples.
  struct Judgement {
    bool is_one_color = true;
    glm::vec4 color{0};
  };

  void begin(std::span<const PaintPolygon> polygons);
  void start(const VisibleParts& parts, std::uint32_t polygon);
  void take_pieces(const VisibleParts& parts);
  void place_samples(Piece& piece);
  void shade_samples();
  void divide(Piece& piece);
  [[nodiscard]] float within(const Piece& piece) const;
  [[nodiscard]] bool is_beside_a_cut(const Piece& piece, const glm::dvec2& at) const;
  [[nodiscard]] Judgement judge(const Piece& piece) const;
  void cut(Piece& piece, const ScreenLine& line);
  void keep(Piece& piece, const glm::vec4& color);
  [[nodiscard]] std::span<const TexcoordLines> texture_lines(const Piece& piece);

  void list_kept(const Polygon& polygon);
  void emit(const Polygon& polygon, ColoredOrder& into);
  void group_kept();

  const Surfaces& surfaces_;
  const PointShader& shading_;
  const FigureOptions& options_;
  const Execution& execution_;
  const ScreenRays rays_;
  FragmentShader shader_;

  std::vector<Polygon> polygons_;
  std::size_t started_ = 0;       ///< polygons
  std::vector<Piece> waiting_;    ///< a stack: the next piece is last
  std::vector<Piece> looked_at_;  ///< the pieces of the current round
  std::vector<ColorSample*> asked_;
  std::vector<Node> nodes_;
  std::vector<Cut> cuts_;
  std::vector<Kept> kept_;
  std::vector<Kept*> listed_;
  std::vector<std::uint32_t> path_;
};

}  // namespace frontmost::shading
