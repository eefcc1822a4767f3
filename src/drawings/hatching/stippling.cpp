// SPDX-License-Identifier: Apache-2.0
// Stippling hatches the rows of a grid and draws dots on their visible parts.
//
// Each row of the grid of dots is a hatch line, so hidden and bright parts are found as for hatching. A dot is drawn if
// the darkness on the line at the dot's place reaches the limit of that place.
#include <algorithm>
#include <tuple>

#include "base/parallel.h"
#include "frontmost/lines.h"
#include "hatching/toned_scene.h"
#include "lines/strokes/parts.h"

namespace frontmost {
namespace {

using namespace lines_detail;

constexpr double most_dots = 2e7;

/// Sorts dots by row, then from the left; coincident dots of coinciding surfaces become one.
void sort(std::vector<HatchPiece>& dots) {
  std::sort(dots.begin(), dots.end());
  const auto is_same = [](const HatchPiece& a, const HatchPiece& b) { return a.line == b.line && a.begin == b.begin; };
  dots.erase(std::unique(dots.begin(), dots.end(), is_same), dots.end());
}

std::vector<Stipple> in_pen_order(const std::vector<Stipple>& dots, const Execution& execution) {
  std::vector<Chain> chains;
  for (const Stipple& dot : dots) chains.push_back({{dot.at}, {}, dot.instance, false});
  std::stable_sort(chains.begin(), chains.end(), [](const Chain& a, const Chain& b) { return a.rank < b.rank; });
  constexpr double never = -1;
  std::vector<Stipple> ordered;
  for (const Chain& chain : lines_detail::nearest_first(std::move(chains), never, execution))
    ordered.push_back({chain.points.front(), chain.rank});
  return ordered;
}

}  // namespace

std::vector<Stipple> stipple(const Surfaces& surfaces, const View& view, const StippleOptions& options,
                             const Execution& execution) {
  validate(view);
  if (!(options.spacing >= 0.5 && options.spacing <= 1000))
    throw Error(ErrorCode::bad_argument, "stipple", "the spacing must be from 0.5 to 1000 pixels");
  if (double(view.width) * view.height / (options.spacing * options.spacing) > most_dots)
    throw Error(ErrorCode::limit_exceeded, "stipple", "there would be room for more than 20000000 dots");
  const IeeeScope ieee;
  report_progress(execution, "hatching", 0);
  const TonedScene scene(surfaces, view, options.tone, execution);
  report_progress(execution, "hatching", 0.2);
  const double cell = DotGrid::cell_of(options.spacing);
  const std::vector<HatchSet> sets = {{0, cell, cell / 2, 1}};
  const std::vector<HatchRows> rows = {HatchRows(sets[0], view)};
  const DotGrid grid(options.spacing, view.width);
  std::vector<HatchPiece> pieces = scene.pieces({sets, options.by_instance, &grid}, rows, execution);
  sort(pieces);
  std::vector<Stipple> dots;
  for (const HatchPiece& piece : pieces) dots.push_back({rows[0].point(piece.line, piece.begin), piece.instance});
  if (options.nearest_first) dots = in_pen_order(dots, execution);
  report_progress(execution, "hatching", 1);
  return dots;
}

}  // namespace frontmost
