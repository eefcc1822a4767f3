// SPDX-License-Identifier: Apache-2.0
// Accounts of a view's objects, and reports of many views of a few objects, as for data sets: ids, depths, boxes and
// shares of every view.
#include <cmath>
#include <numbers>

#include "harness/stage.h"
#include "harness/tables.h"

namespace frontmost::bench {
namespace {

constexpr std::string_view kScenes[] = {"teapot", "bunny", "sphere100k"};
constexpr std::string_view kAccounts[] = {"city-fly", "teapot", "bunny"};
constexpr int kViews = 200, kObjects = 10;

/// Copies the first object of a scene `count` times, in rows of five that hide each other.
Scene repeated(Scene scene, int count) {
  const Box bounds = Surfaces(scene).bounds();
  const double step = 0.6 * bounds.diagonal();
  const Instance first = scene.instances[0];
  scene.instances.clear();
  for (int i = 0; i < count; ++i) {
    Instance& instance = scene.instances.emplace_back(first);
    instance.name = std::to_string(i);
    instance.world_from_mesh[3] += glm::dvec4(step * (i % 5), 0, step * (i / 5), 0);
  }
  return scene;
}

/// Views from around the scene. A third of them is so near that the frame cuts objects.
std::vector<View> views_around(const Surfaces& surfaces) {
  const glm::dvec3 middle(surfaces.bounds().centre());
  std::vector<View> views;
  for (int i = 0; i < kViews; ++i) {
    const double angle = 2 * std::numbers::pi * i / kViews * 7, height = 0.2 + 0.6 * i / kViews;
    const double distance = surfaces.bounds().diagonal() * (i % 3 == 0 ? 0.6 : 1.2);
    const glm::dvec3 aside(std::cos(angle), height, std::sin(angle));
    views.push_back(frontmost::make_view(0.8, 640, 480)
                        .looking(middle + aside * distance, middle, {0, 1, 0})
                        .enclosing(surfaces.bounds()));
  }
  return views;
}

/// One row: the time of a picture, and the time that each account adds.
void measure_accounts_of(std::string_view name, const Surfaces& surfaces, const View& view, const Sampling& sampling,
                         Table& table) {
  const Execution one{.threads = 1};
  ZBuffer buffer;
  const Visible& visible = buffer.draw(surfaces, view, one);
  const Accounting accounts = account(surfaces, visible, {}, one);
  const std::vector<Time> times =
      race({Contestant([&] { (void)buffer.draw(surfaces, view, one); }),
            Contestant([&] { (void)account(surfaces, visible, {.canvas = 1}, one); }),
            Contestant([&] { (void)account(surfaces, visible, {}, one); }),
            Contestant([&] { (void)account(surfaces, visible, {.all_hiders = true}, one); }),
            Contestant([&] { (void)explain_all(surfaces, visible, accounts, one); })},
           sampling);
  table.add({name,
             Cell::whole(accounts.objects.size()),
             Cell::whole(surfaces.primitive_count()),
             {times[0].processor},
             {times[1].processor},
             {times[2].processor},
             {times[3].processor},
             {times[4].processor}});
}

}  // namespace

Table measure_accounts(const Options& options) {
  Table table("accounts: what each adds to the picture, one thread; ms",
              {"scene", "objects", "triangles", "zbuffer", "in frame", "on the canvas", "any hiders", "explain"});
  for (const std::string_view name : options.scenes_or(kAccounts)) {
    const bool is_city = name.starts_with("city");
    const Scene whole = make_scene(name, options.models);
    const Scene scene = is_city ? taken_apart(whole) : repeated(whole, 20);
    const Surfaces surfaces(scene);
    const View view = is_city ? make_view(surfaces.bounds(), find_scene(name).camera) : views_around(surfaces)[1];
    measure_accounts_of(std::string(name), surfaces, view, options.sampling, table);
  }
  return table;
}

Table measure_reports(const Options& options) {
  Table table("reports: 200 views of ten objects, 640 x 480, a canvas of three times that, one thread; ms a view",
              {"scene", "triangles", "zbuffer", "depths", "account", "explain", "views/s", "with why"});
  for (const std::string_view name : options.scenes_or(kScenes)) {
    const Scene scene = repeated(make_scene(name, options.models), kObjects);
    const Surfaces surfaces(scene);
    const std::vector<View> views = views_around(surfaces);
    const Execution one{.threads = 1};
    ZBuffer buffer;
    // Each contestant begins with the picture; the picture's time is subtracted afterwards.
    const auto for_views = [&](const auto& what) {
      return Contestant([&buffer, &surfaces, &views, one, what] {
        for (const View& view : views) what(buffer.draw(surfaces, view, one));
      });
    };
    const std::vector<Time> times =
        race({for_views([](const Visible&) {}), for_views([](const Visible& visible) { (void)depths_of(visible); }),
              for_views([&](const Visible& visible) { (void)account(surfaces, visible, {}, one); }),
              for_views([&](const Visible& visible) {
                (void)explain_all(surfaces, visible, account(surfaces, visible, {}, one), one);
              })},
             options.sampling);
    const auto ms = [&](std::size_t i) { return times[i].processor / kViews; };
    const double picture = ms(0), depths = ms(1) - picture, accounts = ms(2) - picture, why = ms(3) - ms(2);
    const double report = picture + depths + accounts;
    table.add({name,
               Cell::whole(surfaces.primitive_count()),
               {picture},
               {depths},
               {accounts},
               {why},
               {1000 / report, 0},
               {1000 / (report + why), 0}});
  }
  return table;
}

}  // namespace frontmost::bench
