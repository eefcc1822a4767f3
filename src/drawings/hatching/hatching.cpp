// SPDX-License-Identifier: Apache-2.0
// Each line is intersected with every triangle that it passes, then cut where it is hidden or bright (toned_scene.h).
// The pieces of one line are sorted along it and united where they overlap or continue in the next triangle: rounding
// separates them by less than a hundredth of a pixel.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/parallel.h"
#include "frontmost/lines.h"
#include "hatching/toned_scene.h"
#include "lines/strokes/parts.h"

namespace frontmost {
namespace {

using namespace lines_detail;

constexpr std::size_t most_sets = 16;
constexpr double touching = 0.01;  // pixels: a smaller gap is no gap

/// Sorts pieces, removes overlaps, and joins pieces that touch.
std::vector<HatchPiece> united(std::vector<HatchPiece> pieces) {
  std::sort(pieces.begin(), pieces.end());
  std::vector<HatchPiece> whole;
  for (HatchPiece piece : pieces) {
    if (!whole.empty() && whole.back().set == piece.set && whole.back().line == piece.line) {
      HatchPiece& last = whole.back();
      if (last.instance == piece.instance && piece.begin <= last.end + touching) {
        last.end = std::max(last.end, piece.end);
        continue;
      }
      piece.begin = std::max(piece.begin, last.end);
    }
    if (piece.begin < piece.end) whole.push_back(piece);
  }
  return whole;
}

/// Orders the lines of each set and instance separately.
std::vector<HatchLine> in_pen_order(std::vector<HatchLine> lines, const Execution& execution) {
  const auto is_before = [](const HatchLine& a, const HatchLine& b) {
    return std::tie(a.set, a.instance) < std::tie(b.set, b.instance);
  };
  std::stable_sort(lines.begin(), lines.end(), is_before);
  std::vector<HatchLine> of_rank;
  std::vector<Chain> chains;
  for (const HatchLine& line : lines) {
    if (of_rank.empty() || is_before(of_rank.back(), line)) of_rank.push_back(line);
    chains.push_back({{line.from, line.to}, {}, std::uint32_t(of_rank.size() - 1), false});
  }
  constexpr double never = -1;
  lines.clear();
  for (const Chain& chain : lines_detail::nearest_first(std::move(chains), never, execution)) {
    const HatchLine& like = of_rank[chain.rank];
    lines.push_back({chain.points.front(), chain.points.back(), like.set, like.instance});
  }
  return lines;
}

/// The bits of TonedScene::Task::sets_by_material.
std::vector<std::uint32_t> sets_by_material(const std::vector<HatchSet>& sets, std::size_t materials) {
  const auto is_everywhere = [](const HatchSet& set) { return set.materials.empty(); };
  if (std::all_of(sets.begin(), sets.end(), is_everywhere)) return {};
  std::vector<std::uint32_t> bits(materials + 1);
  for (std::size_t i = 0; i < sets.size(); ++i) {
    for (const std::uint32_t material : sets[i].materials)
      if (material < materials) bits[material] |= 1u << i;
    if (!is_everywhere(sets[i])) continue;
    for (std::uint32_t& all : bits) all |= 1u << i;
  }
  return bits;
}

void check(const HatchOptions& options) {
  const auto refuse = [](const char* what) { throw Error(ErrorCode::bad_argument, "hatch", what); };
  if (options.sets.size() > most_sets) refuse("more than 16 sets");
  for (const HatchSet& set : options.sets) {
    if (!(std::abs(set.angle) <= 1e3)) refuse("the angle must be from -1000 to 1000 radians");
    if (!(set.spacing >= 0.5 && set.spacing <= 1e5)) refuse("the spacing must be from 0.5 to 100000 pixels");
    if (!(std::abs(set.offset) <= 1e6)) refuse("the offset must be from -1000000 to 1000000 pixels");
    if (!(set.below >= -1 && set.below <= 1)) refuse("the brightness must be from -1 to 1");
  }
  if (!(options.shortest >= 0 && options.shortest <= 1000)) refuse("the shortest line must be from 0 to 1000 pixels");
}

}  // namespace

std::vector<HatchSet> hatch_sets(double spacing, double angle) {
  const double crossed = angle + std::numbers::pi / 2;
  return {{angle, spacing, 0, 0.62}, {angle, spacing, spacing / 2, 0.35}, {crossed, spacing, 0, 0.15}};
}

std::vector<HatchLine> hatch(const Surfaces& surfaces, const View& view, const HatchOptions& options,
                             const Execution& execution) {
  validate(view);
  check(options);
  const IeeeScope ieee;
  report_progress(execution, "hatching", 0);
  const TonedScene scene(surfaces, view, options.tone, execution);
  report_progress(execution, "hatching", 0.2);
  std::vector<HatchRows> rows;
  for (const HatchSet& set : options.sets) rows.emplace_back(set, view);
  std::vector<HatchLine> lines;
  const TonedScene::Task task{options.sets, options.by_instance, nullptr,
                              sets_by_material(options.sets, surfaces.scene().materials.size())};
  for (const HatchPiece& piece : united(scene.pieces(task, rows, execution))) {
    if (piece.end - piece.begin < options.shortest) continue;
    const HatchRows& row = rows[piece.set];
    lines.push_back({row.point(piece.line, piece.begin), row.point(piece.line, piece.end), piece.set, piece.instance});
  }
  if (options.nearest_first) lines = in_pen_order(std::move(lines), execution);
  report_progress(execution, "hatching", 1);
  return lines;
}

}  // namespace frontmost
