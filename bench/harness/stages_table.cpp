// SPDX-License-Identifier: Apache-2.0
// Where a frame's time goes. The z-buffer interleaves its stages tile by tile, so no clock fits between them. Instead,
// the table draws frames that stop early; the time that each adds to the one before is the cost of its last stage:
//
//   clear      no surfaces at all: both planes are written. Before each frame another picture covers the planes, so
//              that no tile can be left as it is
//   cull       the same surfaces, all nearer than the near plane: every cluster is tested and rejected
//   transform  every triangle collapsed to its first vertex: clusters are binned and transformed, and every triangle
//              fails the first test, as it covers no sample
//   set-up     Culling::both: triangles are fetched and tested, and rejected for their facing
//   raster     the frame itself: edges and depth planes, coverage, depth tests
//
// Only in the last stage do near surfaces hide clusters before these are transformed. If much is hidden, the stages
// before look dearer than they are and raster looks cheaper; its time can even be negative.
#include "harness/stage.h"
#include "harness/tables.h"

namespace frontmost::bench {
namespace {

constexpr std::string_view kVaried[] = {"teapot",        "bunny",  "sphere1m", "terrain1m",
                                        "terrain1m-fly", "soup1m", "city-fly", "boxes-random"};

Scene collapsed(const Scene& scene) {
  Scene points = scene;
  for (Mesh& mesh : points.meshes)
    for (glm::uvec3& triangle : mesh.triangles) triangle = glm::uvec3(triangle.x);
  return points;
}

View beyond_everything(View view) {
  ClipDistances& clip = view.projection.clip;
  clip = {clip.far * 1e3, clip.far * 1e4};
  return view;
}

View without_faces(View view) {
  view.culling = Culling::both;
  return view;
}

}  // namespace

Table measure_stages(const Options& options) {
  Table table(std::string("stages, ms, threads: ").append(std::to_string(options.threads)),
              {"scene", "clear", "cull", "transform", "set-up", "raster", "whole"});
  const Scene nothing;
  const Surfaces no_surfaces(nothing);
  for (const std::string_view name : options.scenes_or(kVaried)) {
    const Stage stage(name, options.models);
    const Scene points = collapsed(stage.scene);
    const Surfaces point_surfaces(points);
    Frames clear(no_surfaces, stage.view), cull(stage.surfaces, beyond_everything(stage.view)),
        transform(point_surfaces, stage.view), set_up(stage.surfaces, without_faces(stage.view)), whole(stage);
    std::vector<Contestant> contestants;
    const Stage cover(make_cover(stage.view), stage.view);
    for (Frames* frames : {&clear, &cull, &transform, &set_up, &whole})
      contestants.emplace_back([frames, &options] { frames->draw({.threads = options.threads}); },
                               [frames, &cover] { frames->draw_other(cover); });
    const std::vector<Time> times = race(contestants, options.sampling);
    const auto ms = [&](std::size_t i) { return cost(times[i], options.threads); };
    std::vector<Cell> cells{name, {ms(0)}};
    for (std::size_t i = 1; i < times.size(); ++i) cells.emplace_back(ms(i) - ms(i - 1));
    cells.emplace_back(ms(times.size() - 1));
    table.add(cells);
  }
  return table;
}

}  // namespace frontmost::bench
