// SPDX-License-Identifier: Apache-2.0
// Runs occlusion culling, times it, and checks it against the visible samples.
#include "cli/compare/compare_culling.h"

#include <frontmost/occlusion.h>

#include "cli/stopwatch.h"

namespace frontmost::cli {
namespace {

std::vector<bool> instances_at_samples(const Surfaces& surfaces, const Visible& visible, std::size_t count) {
  std::vector<bool> seen(count);
  PrimitiveId last = no_primitive;
  for (const PrimitiveId id : visible.primitives) {
    if (id == last || id == no_primitive) continue;
    seen[surfaces.source(id).instance] = true;
    last = id;
  }
  return seen;
}

}  // namespace

CullingRun run_culling(const Surfaces& surfaces, const Visible& reference, int runs, const Execution& execution) {
  CullingRun result;
  const Stopwatch preparing;
  Occlusion occlusion(surfaces, ObjectUnit::instances, execution);
  result.prepare = preparing.milliseconds();
  std::span<const ObjectSight> sights;
  for (int i = 0; i < runs; ++i) {
    const Stopwatch culling;
    sights = occlusion.cull(reference.view, {}, execution);
    result.times.push_back(culling.milliseconds());
  }
  const std::vector<bool> seen = instances_at_samples(surfaces, reference, sights.size());
  for (std::size_t i = 0; i < sights.size(); ++i) {
    ++(sights[i] == ObjectSight::outside  ? result.outside
       : sights[i] == ObjectSight::hidden ? result.hidden
                                          : result.open);
    result.seen += seen[i];
    result.wrong += seen[i] && sights[i] != ObjectSight::may_be_seen;
  }
  return result;
}

}  // namespace frontmost::cli
