// SPDX-License-Identifier: Apache-2.0
// Visible triangles and their visible areas: from one place, and from many around the scene.
#include <frontmost/report.h>

#include <cmath>
#include <numbers>

#include "harness/stage.h"
#include "harness/tables.h"

namespace frontmost::bench {
namespace {

constexpr std::string_view kScenes[] = {"teapot", "bunny", "city-fly", "soup100k", "sphere1m"};
constexpr int kViews = 8;

std::vector<View> views_around(const Surfaces& surfaces) {
  const glm::dvec3 middle(surfaces.bounds().centre());
  std::vector<View> views;
  for (int i = 0; i < kViews; ++i) {
    const double angle = 2 * std::numbers::pi * i / kViews;
    const glm::dvec3 aside(std::cos(angle), 0.5, std::sin(angle));
    views.push_back(frontmost::make_view(0.8, 640, 480)
                        .looking(middle + aside * (1.2 * surfaces.bounds().diagonal()), middle, {0, 1, 0})
                        .enclosing(surfaces.bounds()));
  }
  return views;
}

}  // namespace

Table measure_faces(const Options& options) {
  Table table("visible faces: 1920 x 1080 from one place, 640 x 480 from eight around; one thread, ms a view",
              {"scene", "triangles", "seen", "one view", "of eight"});
  const Execution one{.threads = 1};
  for (const std::string_view name : options.scenes_or(kScenes)) {
    const Stage stage(name, options.models);
    const std::vector<View> views = views_around(stage.surfaces);
    std::size_t seen = 0;
    const std::vector<Time> times =
        race({Contestant([&] { seen = visible_faces(stage.surfaces, stage.view, one).faces.size(); }),
              Contestant([&] { (void)faces_ever_seen(stage.surfaces, views, one); })},
             options.sampling);
    table.add({name,
               Cell::whole(stage.surfaces.primitive_count()),
               Cell::whole(seen),
               {times[0].processor, 1},
               {times[1].processor / kViews, 1}});
  }
  return table;
}

}  // namespace frontmost::bench
