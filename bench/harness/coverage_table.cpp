// SPDX-License-Identifier: Apache-2.0
#include "harness/coverage.h"
#include "harness/stage.h"
#include "harness/tables.h"

namespace frontmost::bench {
namespace {

Cell whole(std::size_t n) { return Cell::whole(n); }

void compare(const SceneEntry& entry, const Options& options, Table& table) {
  const Stage stage(entry.name, options.models);
  const auto peer = make_llvmpipe({stage.scene, stage.view, 1});
  if (!peer) return;
  const CoverageReport r = compare_coverage(stage.scene, zbuffer(stage.surfaces, stage.view), *peer);
  table.add({entry.name,
             whole(r.covered),
             whole(r.differing()),
             whole(r.only_ours),
             whole(r.only_theirs),
             whole(r.moved),
             whole(r.clipped),
             whole(r.depth),
             whole(r.disagreed),
             {100.0 * double(r.moved_vertices) / double(r.vertices), 3}});
  if (r.disagreed != 0) table.fail();
}

void compare_rays(const SceneEntry& entry, const Options& options, Table& table) {
  const Stage stage(entry.name, options.models);
  const auto peer = make_embree({stage.scene, stage.view, 0});
  if (!peer) return;
  const RayReport r = compare_with_rays(stage.scene, zbuffer(stage.surfaces, stage.view), *peer);
  table.add({entry.name, whole(r.covered), whole(r.differing()), whole(r.only_ours), whole(r.only_rays), whole(r.edge),
             whole(r.clipped), whole(r.depth), whole(r.disagreed)});
}

}  // namespace

Table measure_coverage(const Options& options) {
  Table table("coverage: pixels that differ from llvmpipe's, by reason",
              {"scene", "covered", "differing", "only ours", "only theirs", "moved", "clipped", "depth", "disagreed",
               "moved vert.%"});
  for (const SceneEntry& entry : scene_entries())
    if (options.llvmpipe && options.wants_scene(entry)) compare(entry, options, table);
  return table;
}

Table measure_ray_coverage(const Options& options) {
  Table table("rays: pixels that differ from Embree's, by reason",
              {"scene", "covered", "differing", "only ours", "only rays", "edge", "clipped", "depth", "disagreed"});
  for (const SceneEntry& entry : scene_entries())
    if (options.embree && options.wants_scene(entry)) compare_rays(entry, options, table);
  return table;
}

}  // namespace frontmost::bench
