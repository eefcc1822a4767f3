// SPDX-License-Identifier: Apache-2.0
// What a run of `frontmost render` reports: as JSON, or as lines of hashes.
//
//   {"model": ..., "triangles": ...,            one view: what there is to say of it stands beside that of the model
//    "name": ..., "view": {...}, "seen": {...}, "files": [...], "timings_ms": {...}}
//
//   {"model": ..., "triangles": ...,            a batch: the same for each
//    "views": [{"name": ..., "view": {...}, ...}, ...], "timings_ms": {...}}
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/json.h"
#include "cli/render/render_view.h"

namespace frontmost::cli {

/// Milliseconds of what was done once for all views.
struct RunTimings {
  double load = 0, surfaces = 0, total = 0;
  std::optional<double> index;  ///< of the method raycast
};

/// What there is to say of the model.
struct ModelFacts {
  std::uint64_t triangles = 0;
  const std::vector<std::string>& warnings;
  bool lets_light_through = false;                            ///< some of its materials are blended
  std::optional<int> passes = std::nullopt;                   ///< over a stream
  glm::dvec3 origin{0};                                       ///< of the scene
  std::size_t lights = 0;                                     ///< the scene's own
  std::optional<std::size_t> finished_before = std::nullopt;  ///< views of a shard
};

/// With one view, its facts stand at the top; with a batch, under "views". There is a job for each view.
[[nodiscard]] Json render_json(const Settings& settings, const ModelFacts& model, const std::vector<Job>& jobs,
                               const std::vector<ViewResult>& views, const RunTimings& timings);
/// "what HASH path", one line a result, "visible HASH" first; a batch has "view:" in front.
[[nodiscard]] std::string hash_lines(const std::vector<ViewResult>& views, bool is_batch);

}  // namespace frontmost::cli
