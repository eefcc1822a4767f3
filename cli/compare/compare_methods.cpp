// SPDX-License-Identifier: Apache-2.0
// Wraps the methods as functions of one type, and calls them as users of the library do. Preparation (an index) and
// work for a view are timed separately, because many views of one model share the preparation.
#include "cli/compare/compare_methods.h"

#include <frontmost/abuffer.h>
#include <frontmost/painter.h>
#include <frontmost/raycast.h>
#include <frontmost/zbuffer.h>

#include <algorithm>

namespace frontmost::cli {
namespace {

Answer answer_by_zbuffer(const Surfaces& surfaces, const View& view, const Execution& execution, StageClock& clock) {
  return {clock.time("visible", [&] { return zbuffer(surfaces, view, execution); }), {}, surfaces.primitive_count()};
}

Answer answer_by_raycast(const Surfaces& surfaces, const View& view, const Execution& execution, StageClock& clock) {
  const RayIndex index = clock.time("index", [&] { return RayIndex(surfaces, execution); });
  return {clock.time("visible", [&] { return raycast(index, view, execution); }), {}, index.triangle_count()};
}

/// Answers by the A-buffer. Finds two layers, because the second one shows through the first.
Answer answer_by_abuffer(const Surfaces& surfaces, const View& view, const Execution& execution, StageClock& clock) {
  std::vector<Visible> layers = clock.time("visible", [&] { return visible_layers(surfaces, view, 2, {}, execution); });
  return {std::move(layers[0]), std::move(layers[1]), surfaces.primitive_count()};
}

/// Answers by a method that sorts the polygons and paints them one over the other.
template <PaintMethod method>
Answer answer_by_painter(const Surfaces& surfaces, const View& view, const Execution& execution, StageClock& clock) {
  return {
      clock.time("visible", [&] { return paint(surfaces, painter(surfaces, view, {.method = method}, execution)); }),
      {},
      surfaces.primitive_count()};
}

KeptLists lists_of_abuffer(const Surfaces& surfaces, const View& view, const Execution& execution) {
  const FragmentCounts counts = count_fragments(surfaces, view, {}, execution);
  return {counts.fragments, counts.longest};
}

constexpr ComparedMethod all_methods[] = {
    {"zbuffer", "Z-buffer", "Draws every triangle, and keeps the nearest depth and id at every sample.",
     answer_by_zbuffer},
    {"raycast", "Ray casting",
     "Finds for every sample the first triangle that its ray hits, through a hierarchy of boxes.", answer_by_raycast},
    {"abuffer", "A-buffer",
     "Keeps all fragments of a pixel in order of depth, so that translucent surfaces show the next layer; here two "
     "layers.",
     answer_by_abuffer, lists_of_abuffer},
    {"painter", "Painter's algorithm",
     "Sorts polygons so that painting one over the other is right everywhere, and paints them in this order.",
     answer_by_painter<PaintMethod::depth_sort>},
    {"painter-centroid", "Painter's, by centroids",
     "The painter's algorithm with polygons sorted only by their centroids, as in simple programs: wrong where "
     "the order of centroids is not the order of hiding.",
     answer_by_painter<PaintMethod::centroid>, nullptr, true},
};

}  // namespace

std::span<const ComparedMethod> compared_methods() { return all_methods; }

void StageClock::note(std::string_view name, double milliseconds) {
  const auto found = std::find_if(stages_.begin(), stages_.end(), [&](const Stage& s) { return s.name == name; });
  Stage& stage = found != stages_.end() ? *found : stages_.emplace_back(Stage{std::string(name), {}});
  stage.times.push_back(milliseconds);
}

}  // namespace frontmost::cli
