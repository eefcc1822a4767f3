// SPDX-License-Identifier: Apache-2.0
// Consecutive polygons in pieces of one colour each.
//
// Pieces are of one polygon, and never cross into another: a figure keeps every visible polygon, whole or in pieces, in
// its place of the order of painting.
#pragma once

#include <optional>

#include "figures/colored_order.h"
#include "figures/coloring/piece_places.h"
#include "figures/coloring/point_shader.h"
#include "view/screen_cutout.h"

namespace frontmost::shading {

/// \throws Error limit_exceeded.
[[noreturn]] void refuse_more_than(std::size_t most);

/// Many pieces are looked at before the next ones are, so that the shader has whole batches. Not for several threads at
/// once.
class PolygonColors {
 public:
  /// Borrows all but the view.
  PolygonColors(const Surfaces& surfaces, const View& view, const PointShader& shader, const FigureOptions& options,
                const Execution& execution);

  /// Appends some of these parts in pieces, without holes and what is wholly clear. The result depends on these
  /// polygons alone. Precondition: three corners or more each. \throws Error cancelled, and as refuse_more_than().
  void color(const VisibleParts& parts, std::span<const PaintPolygon> polygons, ColoredOrder& into);

 private:
  /// A piece that is still to be looked at.
  struct Piece {
    std::vector<glm::dvec2> corners;
    std::vector<ColorSample> samples;  ///< those of the piece that it was cut from are known already
    std::size_t known_samples = 0;
    bool is_sliver = false;        ///< lies beside cuts everywhere
    std::uint32_t polygon = 0;     ///< of those that are coloured
    std::uint32_t node = 0;        ///< of the tree of cuts
    std::uint32_t cut = no_index;  ///< the last that it was made by
  };
  /// Cuts, each with the one before it: a piece lies on one side of all of them.
  struct Cut {
    ScreenLine line;
    std::uint32_t before = no_index;
  };
  /// A piece that was cut, or one that is kept. Pieces are painted as they come in the tree.
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
    std::optional<std::vector<TexcoordLines>> texture_lines{};  ///< made when they are asked for
  };
  /// What a piece's samples say.
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
  std::vector<Piece> waiting_;    ///< those that come first are last
  std::vector<Piece> looked_at_;  ///< now
  std::vector<ColorSample*> asked_;
  std::vector<Node> nodes_;
  std::vector<Cut> cuts_;
  std::vector<Kept> kept_;
  std::vector<Kept*> listed_;
  std::vector<std::uint32_t> path_;
};

}  // namespace frontmost::shading
