// SPDX-License-Identifier: Apache-2.0
// Promises that are ratios between Frontmost's own frames.
#include <cmath>

#include "harness/stage.h"
#include "harness/tables.h"

namespace frontmost::bench {
namespace {

View with_culling(View view, Culling culling) {
  view.culling = culling;
  return view;
}

View with_samples(View view, int samples) {
  view.samples = samples;
  return view;
}

/// Cost of `a` divided by the cost of `b`, on one thread.
double ratio(Frames& a, Frames& b, const Options& options) {
  const std::vector<Time> times = race(
      {Contestant([&] { a.draw({.threads = 1}); }), Contestant([&] { b.draw({.threads = 1}); })}, options.sampling);
  return times[0].processor / times[1].processor;
}

void measure_culling(const Options& options, Table& table) {
  for (const char* name : {"bunny", "sphere1m", "sphere4m", "boxes-random"}) {
    const Stage stage(name, options.models);
    Frames none(stage), back(stage.surfaces, with_culling(stage.view, Culling::back));
    table.add({std::string("back-face culling, ").append(name), {ratio(none, back, options)}, "at least", {1.6}});
  }
}

double ratio_of_scenes(const char* a, const char* b, const Options& options) {
  const Stage first(a, options.models), second(b, options.models);
  Frames first_frames(first), second_frames(second);
  return ratio(first_frames, second_frames, options);
}

void measure_samples(const Options& options, Table& table) {
  for (const char* name : {"bunny", "terrain1m-fly"}) {
    const Stage stage(name, options.models);
    Frames one(stage);
    for (const int samples : {2, 4, 8, 16}) {
      Frames many(stage.surfaces, with_samples(stage.view, samples));
      table.add(
          {std::to_string(samples).append(" samples, ").append(name), {ratio(many, one, options)}, "", {std::nan("")}});
    }
  }
}

}  // namespace

Table measure_features(const Options& options) {
  Table table("promises: how many times dearer, one thread", {"what", "times", "", "target"});
  measure_culling(options, table);
  table.add({"the city without its wall", {ratio_of_scenes("city-no-wall", "city-wall", options)}, "at least", {10.0}});
  table.add({"500 boxes, inner first", {ratio_of_scenes("boxes-in", "boxes-out", options)}, "at most", {1.5}});
  table.add({"500 boxes, shuffled", {ratio_of_scenes("boxes-random", "boxes-out", options)}, "at most", {1.5}});
  measure_samples(options, table);
  return table;
}

}  // namespace frontmost::bench
