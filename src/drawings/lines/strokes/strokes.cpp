// SPDX-License-Identifier: Apache-2.0
// A rank is a number for everything that the parts of a stroke have in common, as far as the options ask for it:
// whether they are hidden, whether they are an outline, their kind and their instance. Ranks are in drawing order.
//
//        a ________________ b          Short chain c ends in the air and is left out. Short chain d holds a line that
//              |    d/                 would end in the air otherwise, so d stays.
//             c     /________ e
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/parallel.h"
#include "frontmost/lines.h"
#include "geometry/buckets.h"
#include "lines/square_grid.h"
#include "lines/strokes/parts.h"

namespace frontmost {
namespace {

using namespace lines_detail;

double distance_to(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 along = b - a;
  const double square = glm::dot(along, along);
  const double t = square > 0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0;
  return glm::distance(p, a + t * along);
}

/// A grid of at most 2^20 cells over these places; cells are no smaller than `least`.
SquareGrid grid_over(const std::vector<glm::dvec2>& places, double least) {
  glm::dvec2 low(1e300), high(-1e300);
  for (const glm::dvec2& place : places) {
    low = glm::min(low, place);
    high = glm::max(high, place);
  }
  const double cell = std::max({(high.x - low.x) / 1023, (high.y - low.y) / 1023, least, 1e-6});
  return {low, cell, int((high.x - low.x) / cell) + 1, int((high.y - low.y) / cell) + 1};
}

/// An end of a short chain that lies on another chain. The first end of chain i is number 2 i, its last end 2 i + 1.
struct Touch {
  std::size_t end, chain;
  bool is_within;  ///< it is no end of that chain
  friend auto operator<=>(const Touch&, const Touch&) = default;
};

/// Leaves out short chains with an end that touches nothing, and short chains between lines that continue without them,
/// unless they are contours. A short chain stays if other lines would end in the air without it. A hidden chain does
/// not keep a visible one. Near-linear, unless most short chains lie within a thousandth of the drawing. Precondition:
/// no arcs.
class ShortChains {
 public:
  /// `strokes`: by rank, what the chains become.
  ShortChains(std::vector<Chain>& chains, const std::vector<Stroke>& strokes, const StrokeOptions& options,
              const Execution& execution)
      : chains_(chains),
        strokes_(strokes),
        shortest_(options.shortest),
        touching_(2 * options.apart),
        execution_(execution),
        is_short_(chains.size()),
        is_left_out_(chains.size()) {
    for (std::size_t i = 0; i < chains.size(); ++i) is_short_[i] = length_of(chains[i]) < shortest_;
  }

  std::vector<Chain> kept() {
    find_touches();
    std::vector<std::size_t> asked;
    for (std::size_t i = 0; i < chains_.size(); ++i)
      if (is_short_[i]) asked.push_back(i);
    while (!asked.empty()) {
      const std::size_t i = asked.back();
      asked.pop_back();
      if (is_left_out_[i] || !is_loose(i)) continue;
      is_left_out_[i] = true;
      // Short chains that ended on this one may be loose now.
      for (const std::size_t other : touched_by_[i]) asked.push_back(other);
    }
    std::vector<Chain> kept;
    for (std::size_t i = 0; i < chains_.size(); ++i)
      if (!is_left_out_[i]) kept.push_back(std::move(chains_[i]));
    return kept;
  }

 private:
  [[nodiscard]] const glm::dvec2& place(std::size_t end) const {
    const Chain& chain = chains_[end / 2];
    return end % 2 == 0 ? chain.points.front() : chain.points.back();
  }

  void find_touches() {
    std::vector<std::uint32_t> ends;
    std::vector<glm::dvec2> places;
    for (std::uint32_t i = 0; i < chains_.size(); ++i)
      if (is_short_[i] && !chains_[i].is_closed)
        for (const std::uint32_t end : {2 * i, 2 * i + 1}) {
          ends.push_back(end);
          places.push_back(place(end));
        }
    touched_by_.resize(chains_.size());
    if (ends.empty()) return;
    const SquareGrid grid = grid_over(places, shortest_);
    const auto list = [&](std::size_t i, const auto& add) {
      grid.visit_along(places[i], places[i], 0, [&](const PassedCell& passed) {
        add(passed.cell, ends[i]);
        return true;
      });
    };
    const Buckets<std::uint32_t> by_cell(grid.count(), ends.size(), list, execution_);
    for (std::size_t i = 0; i < chains_.size(); ++i) {
      if (i % 1024 == 0) check_cancelled(execution_);
      const Chain& chain = chains_[i];
      const std::size_t joins = chain.points.size() - (chain.is_closed ? 0 : 1);
      for (std::size_t k = 0; k < joins; ++k) {
        const glm::dvec2 &a = chain.points[k], &b = chain.points[k + 1 == chain.points.size() ? 0 : k + 1];
        grid.visit_along(a, b, touching_, [&](const PassedCell& passed) {
          for (const std::uint32_t end : by_cell[passed.cell])
            if (distance_to(place(end), a, b) <= touching_) add_touch(end, i);
          return true;
        });
      }
    }
    std::sort(touches_.begin(), touches_.end());
    touches_.erase(std::unique(touches_.begin(), touches_.end(),
                               [](const Touch& a, const Touch& b) { return a.end == b.end && a.chain == b.chain; }),
                   touches_.end());
    for (const Touch& touch : touches_) touched_by_[touch.chain].push_back(touch.end / 2);
  }

  void add_touch(std::size_t end, std::size_t chain) {
    const auto is_hidden = [&](std::size_t number) { return strokes_[chains_[number].rank].is_hidden; };
    // An end of a visible chain does not count as touching a hidden chain.
    if (end / 2 == chain || (is_hidden(chain) && !is_hidden(end / 2))) return;
    const auto is_near = [&](std::size_t other) { return glm::distance(place(end), place(other)) <= touching_; };
    touches_.push_back({end, chain, chains_[chain].is_closed || !(is_near(2 * chain) || is_near(2 * chain + 1))});
  }

  /// Whether the short chain may be left out: one of its ends is in the air, or it is no contour and lies between lines
  /// that continue without it.
  [[nodiscard]] bool is_loose(std::size_t number) const {
    if (chains_[number].is_closed) return !chains_[number].is_contour;
    bool is_link = true;
    for (std::size_t end = 2 * number; end < 2 * number + 2; ++end) {
      bool is_held = false, meets_end = false;
      for (auto touch = std::lower_bound(touches_.begin(), touches_.end(), Touch{end, 0, false});
           touch != touches_.end() && touch->end == end; ++touch) {
        if (is_left_out_[touch->chain]) continue;
        is_held = true;
        meets_end |= !touch->is_within;
      }
      if (!is_held) return true;
      is_link &= meets_end;
    }
    return !is_link && !chains_[number].is_contour;
  }

  std::vector<Chain>& chains_;
  const std::vector<Stroke>& strokes_;
  const double shortest_,
      touching_;  ///< pixels: chains below `shortest_` are short, ends and lines at most this far apart touch
  const Execution& execution_;
  std::vector<bool> is_short_, is_left_out_;
  std::vector<Touch> touches_;                        ///< ascending
  std::vector<std::vector<std::size_t>> touched_by_;  ///< by chain: the short chains that end on it
};

/// The segments of all parts with their ranks, and for each rank a stroke without points.
class Ranked {
 public:
  Ranked(const Surfaces& surfaces, const Drawing& drawing, const StrokeOptions& options)
      : surfaces_(surfaces), drawing_(drawing), options_(options), cosine_(std::cos(options.grazing_angle)) {
    std::map<std::uint64_t, std::pair<std::uint32_t, Stroke>> known;
    std::vector<std::uint64_t> keys;
    for (const DrawnPart& part : drawing.parts) {
      keys.push_back(key_of(part));
      known.try_emplace(keys.back(), 0, stroke(part));
    }
    for (auto& [key, entry] : known) {
      entry.first = std::uint32_t(strokes.size());
      strokes.push_back(entry.second);
    }
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const DrawnPart& part = drawing.parts[i];
      if (!is_drawn(part)) continue;
      const EdgeKind kind = drawing.edges[part.edge].kind;
      segments.push_back({part.from, part.to, known.find(keys[i])->second.first,
                          kind == EdgeKind::silhouette || kind == EdgeKind::boundary});
    }
  }

  std::vector<LineSegment> segments;
  std::vector<Stroke> strokes;

 private:
  /// Whether the part gets a stroke.
  [[nodiscard]] bool is_drawn(const DrawnPart& part) const {
    if (part.hidden_by == 0) return true;
    return options_.with_hidden && (options_.grazing_angle == 0 || !is_grazing(drawing_.edges[part.edge]));
  }

  /// The common properties of a stroke's parts, in the order of ranks: outlines come first, hidden lines last.
  [[nodiscard]] std::uint64_t key_of(const DrawnPart& part) const {
    const DrawnEdge& edge = drawing_.edges[part.edge];
    std::uint64_t key = part.hidden_by != 0;
    key = key << 1 | (options_.by_outline && !part.is_outline);
    key = key << 8 | (options_.by_kind ? std::uint64_t(edge.kind) : 0);
    return key << 32 | (options_.by_instance ? instance_of(edge) : 0);
  }

  [[nodiscard]] Stroke stroke(const DrawnPart& part) const {
    const DrawnEdge& edge = drawing_.edges[part.edge];
    return {edge.kind, part.hidden_by != 0, options_.by_outline && part.is_outline, instance_of(edge), 0, 0, false};
  }

  [[nodiscard]] std::uint32_t instance_of(const DrawnEdge& edge) const {
    const PrimitiveId id = edge.left != no_primitive ? edge.left : edge.right;
    return id == no_primitive ? no_index : surfaces_.source(id).instance;
  }

  /// Whether surfaces intersect at an angle below the grazing angle, whatever the winding of their triangles.
  [[nodiscard]] bool is_grazing(const DrawnEdge& edge) const {
    if (edge.kind != EdgeKind::intersection) return false;
    const glm::dvec3 a = normal(edge.left), b = normal(edge.right);
    return std::abs(glm::dot(a, b)) > cosine_ * glm::length(a) * glm::length(b);
  }
  [[nodiscard]] glm::dvec3 normal(PrimitiveId id) const {
    const std::array<glm::vec3, 3> corners = surfaces_.corners(id);
    const glm::dvec3 a(corners[0]);
    return glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
  }

  const Surfaces& surfaces_;
  const Drawing& drawing_;
  const StrokeOptions& options_;
  const double cosine_;
};

void check_range(double value, double least, double most, const char* reason) {
  if (!(value >= least && value <= most)) throw Error(ErrorCode::bad_argument, "strokes", reason);
}

void check(const StrokeOptions& options) {
  check_range(options.apart, 0.002, 1,
              "the greatest distance of lines that count as one must be from 0.002 to 1 pixel");
  check_range(options.tolerance, 1e-4, 1, "the tolerance must be from 0.0001 to 1 pixel");
  check_range(options.arc_tolerance, 0, 100, "the tolerance of arcs must be from 0 to 100 pixels");
  check_range(options.shortest, 0, 1e4, "the shortest stroke must be from 0 to 10000 pixels");
  check_range(options.joining, 0, 100, "the distance of ends that are joined must be from 0 to 100 pixels");
  check_range(options.grazing_angle, 0, std::numbers::pi / 2, "the grazing angle must be from 0 to pi/2");
}

/// How far ink reaches from each of the strokes.
std::vector<double> reaches_of(const std::vector<Stroke>& strokes, const StrokeOptions& options) {
  std::vector<double> reaches;
  for (const Stroke& stroke : strokes) {
    reaches.push_back(options.ink_reach(stroke));
    check_range(reaches.back(), 0, 1000, "the reach of ink must be from 0 to 1000 pixels");
  }
  return reaches;
}

void append(const Chain& chain, const Stroke& like, bool with_arcs, Strokes& all) {
  Stroke stroke = like;
  stroke.first = std::uint32_t(all.points.size());
  stroke.count = std::uint32_t(chain.points.size());
  stroke.is_closed = chain.is_closed;
  all.strokes.push_back(stroke);
  all.points.insert(all.points.end(), chain.points.begin(), chain.points.end());
  if (!with_arcs) return;
  all.bulges.insert(all.bulges.end(), chain.bulges.begin(), chain.bulges.end());
  all.bulges.resize(all.points.size(), 0);
}

}  // namespace

Strokes chain_strokes(const Surfaces& surfaces, const Drawing& drawing, const StrokeOptions& options,
                      const Execution& execution) {
  check(options);
  const IeeeScope ieee;
  report_progress(execution, "strokes", 0);
  const Ranked parts(surfaces, drawing, options);
  // For plotters, straight pairs would leave more strokes than joined_ends(), which then pairs ends of any direction.
  std::vector<Chain> chains = chained(draw_once(parts.segments, options.apart, execution), !options.nearest_first);
  // Where two tessellations of one circle pass through each other, chains are left over that are seen as points.
  std::erase_if(chains, [&](const Chain& chain) {
    return std::all_of(chain.points.begin(), chain.points.end(),
                       [&](const glm::dvec2& p) { return glm::distance(chain.points.front(), p) < options.apart; });
  });
  report_progress(execution, "strokes", 0.6);
  if (options.shortest > 0) chains = ShortChains(chains, parts.strokes, options, execution).kept();
  Strokes result;
  if (options.ink_reach) {
    result.covered = chains.size();
    chains = uncovered(std::move(chains), reaches_of(parts.strokes, options), execution);
    result.covered -= chains.size();
    report_progress(execution, "strokes", 0.7);
  }
  chains = joined_ends(std::move(chains), options.joining, options.nearest_first, execution);
  report_progress(execution, "strokes", 0.75);
  parallel_for(execution, chains.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      straighten(chains[i], options.tolerance);
      if (options.arc_tolerance > 0) find_arcs(chains[i], options.arc_tolerance);
    }
  });
  report_progress(execution, "strokes", 0.8);
  if (options.nearest_first) chains = nearest_first(std::move(chains), execution);
  check_cancelled(execution);
  // Hidden chains have the highest ranks and are drawn first, below the others.
  std::stable_sort(chains.begin(), chains.end(), [&](const Chain& a, const Chain& b) {
    return parts.strokes[a.rank].is_hidden > parts.strokes[b.rank].is_hidden;
  });
  for (const Chain& chain : chains) append(chain, parts.strokes[chain.rank], options.arc_tolerance > 0, result);
  report_progress(execution, "strokes", 1);
  return result;
}

}  // namespace frontmost
