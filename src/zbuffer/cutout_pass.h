// SPDX-License-Identifier: Apache-2.0
// Triangles with holes, drawn after all others: what is seen is the minimum over the fragments that are there, so they
// may come last, and only those that are nearer than what they meet are looked up in their texture.
#pragma once

#include <span>

#include "frontmost/visible.h"
#include "zbuffer/triangle_records.h"

namespace frontmost::zbuffer_detail {

/// Merges the set's cut-outs into `visible`, which shows everything else. Precondition: there are some.
/// O(fragments of cut-outs), and as often as there are strips of rows a look at each of these triangles.
void draw_cutouts(const ClusterSet& set, const ScreenTransform& transform, Visible& visible,
                  const Execution& execution);
/// The same of triangles that are on the screen already, all of them of `cutouts`.
void draw_cutouts(const Cutouts& cutouts, std::span<const TriangleRecord> records, Visible& visible,
                  const Execution& execution);

}  // namespace frontmost::zbuffer_detail
