// SPDX-License-Identifier: Apache-2.0
// A rank is a number for everything that the parts of a stroke have in common: whether they are hidden, whether they
// are an outline, their kind and their instance, as far as the options ask for it. Ranks are numbered in that order, so
// sorting by rank sorts by drawing order.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/parallel.h"
#include "frontmost/lines.h"
#include "lines/strokes/parts.h"

namespace frontmost {
namespace {

using namespace lines_detail;

/// Maps the common properties of a stroke's parts to one number, which gives the order of strokes.
class Classes {
 public:
  Classes(const Surfaces& surfaces, const Drawing& drawing, const StrokeOptions& options)
      : surfaces_(surfaces), drawing_(drawing), options_(options) {}

  /// Lower keys are drawn above higher ones: outlines come first, hidden lines last.
  [[nodiscard]] std::uint64_t key(const DrawnPart& part) const {
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

 private:
  [[nodiscard]] std::uint32_t instance_of(const DrawnEdge& edge) const {
    const PrimitiveId id = edge.left != no_primitive ? edge.left : edge.right;
    return id == no_primitive ? no_index : surfaces_.source(id).instance;
  }

  const Surfaces& surfaces_;
  const Drawing& drawing_;
  const StrokeOptions& options_;
};

void check(const StrokeOptions& options) {
  if (!(options.apart >= 0.002 && options.apart <= 1))
    throw Error(ErrorCode::bad_argument, "strokes", "lines that count as one must be apart by from 0.002 to 1 pixel");
  if (!(options.tolerance >= 1e-4 && options.tolerance <= 1))
    throw Error(ErrorCode::bad_argument, "strokes", "the tolerance must be from 0.0001 to 1 pixel");
  if (!(options.arc_tolerance >= 0 && options.arc_tolerance <= 100))
    throw Error(ErrorCode::bad_argument, "strokes", "the tolerance of arcs must be from 0 to 100 pixels");
  if (!(options.shortest >= 0 && options.shortest <= 1e4))
    throw Error(ErrorCode::bad_argument, "strokes", "the shortest stroke must be from 0 to 10000 pixels");
  if (!(options.grazing_angle >= 0 && options.grazing_angle <= std::numbers::pi / 2))
    throw Error(ErrorCode::bad_argument, "strokes", "the grazing angle must be from 0 to pi/2");
}

/// Selects the parts of a drawing that get strokes.
class Choice {
 public:
  Choice(const Surfaces& surfaces, const Drawing& drawing, const StrokeOptions& options)
      : surfaces_(surfaces), drawing_(drawing), options_(options), cosine_(std::cos(options.grazing_angle)) {}

  [[nodiscard]] bool has(const DrawnPart& part) const {
    if (part.hidden_by == 0) return true;
    return options_.with_hidden && (options_.grazing_angle == 0 || !is_grazing(drawing_.edges[part.edge]));
  }

 private:
  /// True regardless of the triangles' winding.
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

/// The segments of all parts with their ranks, and for each rank a stroke without points.
struct Ranked {
  std::vector<LineSegment> segments;
  std::vector<Stroke> strokes;
};

Ranked ranked(const Surfaces& surfaces, const Drawing& drawing, const StrokeOptions& options) {
  const Classes classes(surfaces, drawing, options);
  std::map<std::uint64_t, std::pair<std::uint32_t, Stroke>> known;
  std::vector<std::uint64_t> keys(drawing.parts.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    keys[i] = classes.key(drawing.parts[i]);
    known.try_emplace(keys[i], 0, classes.stroke(drawing.parts[i]));
  }
  Ranked result;
  for (auto& [key, entry] : known) {
    entry.first = std::uint32_t(result.strokes.size());
    result.strokes.push_back(entry.second);
  }
  const Choice choice(surfaces, drawing, options);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const DrawnPart& part = drawing.parts[i];
    if (!choice.has(part)) continue;
    const EdgeKind kind = drawing.edges[part.edge].kind;
    result.segments.push_back({part.from, part.to, known.find(keys[i])->second.first,
                               kind == EdgeKind::silhouette || kind == EdgeKind::boundary});
  }
  return result;
}

/// Whether all points are less than `apart` from the first: such a chain is seen as a point. It is left over where two
/// tessellations of one circle pass through each other.
bool is_point(const Chain& chain, double apart) {
  const glm::dvec2& begin = chain.points.front();
  return std::all_of(chain.points.begin(), chain.points.end(),
                     [&](const glm::dvec2& p) { return glm::distance(begin, p) < apart; });
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
  const Ranked parts = ranked(surfaces, drawing, options);
  std::vector<Chain> chains = chained(draw_once(parts.segments, options.apart, execution));
  std::erase_if(chains, [&](const Chain& chain) { return is_point(chain, options.apart); });
  report_progress(execution, "strokes", 0.6);
  if (options.shortest > 0) {
    const auto is_hidden = [&](std::uint32_t rank) { return parts.strokes[rank].is_hidden; };
    chains = without_short_ones(std::move(chains), {options.shortest, 2 * options.apart, is_hidden}, execution);
  }
  parallel_for(execution, chains.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      straighten(chains[i], options.tolerance);
      if (options.arc_tolerance > 0) find_arcs(chains[i], options.arc_tolerance);
    }
  });
  report_progress(execution, "strokes", 0.8);
  if (options.nearest_first) chains = nearest_first(std::move(chains), options.tolerance, execution);
  check_cancelled(execution);
  // Hidden chains have the highest ranks and are drawn first, below the others.
  std::stable_sort(chains.begin(), chains.end(), [&](const Chain& a, const Chain& b) {
    return parts.strokes[a.rank].is_hidden > parts.strokes[b.rank].is_hidden;
  });
  Strokes result;
  for (const Chain& chain : chains) append(chain, parts.strokes[chain.rank], options.arc_tolerance > 0, result);
  report_progress(execution, "strokes", 1);
  return result;
}

}  // namespace frontmost
