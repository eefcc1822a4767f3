// SPDX-License-Identifier: Apache-2.0
// Pictures of scans: the hits of rays, with the same materials, lights and shadows as other pictures.
#pragma once

#include "shade/canvas/canvas.h"
#include "shade/picture_parts.h"
#include "shade/prepared_scene.h"

namespace frontmost::shading {

/// Everything from which a picture of a scan is made.
struct ScanRequest {
  PreparedScene& scene;
  const ScanInput& input;
  const ShadeOptions& options;
  const Execution& execution;
};

/// The range of distances that a picture of depths maps from bright to dark; both 0 if nothing is hit.
[[nodiscard]] DepthRange depth_range(const RangeScan& scan);

/// \throws Error bad_argument for a scan whose planes or ids do not fit, or options out of range.
void check_scan(const ScanRequest& request);

/// Precondition: check_scan().
void paint_scan(const ScanRequest& request, TileCanvas& canvas, const glm::vec4& background);

}  // namespace frontmost::shading
