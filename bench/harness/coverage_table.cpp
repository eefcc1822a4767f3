// SPDX-License-Identifier: Apache-2.0
#include "harness/coverage.h"
#include "harness/stage.h"
#include "harness/tables.h"

namespace frontmost::bench {

Table measure_coverage(const Options& options) {
  Table table("coverage: pixels that differ from llvmpipe's, by reason",
              {"scene", "covered", "differing", "only ours", "only theirs", "moved", "clipped", "depth", "disagreed",
               "moved vert."});
  for (const SceneEntry& entry : scene_entries()) {
    if (!options.wants_scene(entry)) continue;
    const Stage stage(entry.name, options.models);
    const auto peer = make_llvmpipe({stage.scene, stage.view, 1});
    if (!peer) break;
    const CoverageReport r = compare_coverage(stage.scene, zbuffer(stage.surfaces, stage.view), *peer);
    const auto whole = [](std::size_t n) { return Cell::whole(n); };
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
  }
  return table;
}

}  // namespace frontmost::bench
