// SPDX-License-Identifier: Apache-2.0
// Tables of the z-buffer and its peers, one function each. A function makes its scenes, measures our methods and the
// peers in turn, and calls Table::fail() if a promise does not hold. docs/performance.md explains the columns.
#pragma once

#include "harness/program.h"
#include "harness/table.h"

namespace frontmost::bench {

/// Frontmost beside llvmpipe and Embree on the same views.
[[nodiscard]] Table measure_peers(const Options& options);

/// Time on one thread and on all.
[[nodiscard]] Table measure_threads(const Options& options);
/// Time by every instruction set of this machine.
[[nodiscard]] Table measure_isas(const Options& options);
/// Time to build Surfaces.
[[nodiscard]] Table measure_surfaces(const Options& options);
/// Time of each stage: clear, cull, transform, set-up, raster.
[[nodiscard]] Table measure_stages(const Options& options);
/// Effect of culling, hiding, triangle order and samples.
[[nodiscard]] Table measure_features(const Options& options);
/// The depth buffer with OpenGL's state beside the z-buffer.
[[nodiscard]] Table measure_depth_buffer(const Options& options);
/// How near frames come to what memory and processor allow.
[[nodiscard]] Table measure_limits(const Options& options);
/// Bytes for each triangle, pixel and sample.
[[nodiscard]] Table measure_memory(const Options& options);
/// Our pictures against llvmpipe's, pixel by pixel. The table fails if a pixel differs without a reason.
[[nodiscard]] Table measure_coverage(const Options& options);
/// Ray casting beside Embree: index, views, and single rays in all directions.
[[nodiscard]] Table measure_raycast(const Options& options);
/// Scans from inside the models of the test models' folder.
[[nodiscard]] Table measure_scans(const Options& options);
/// Accounts of the objects in one view.
[[nodiscard]] Table measure_accounts(const Options& options);
/// Ids, depths, boxes and shares of many views of a few objects.
[[nodiscard]] Table measure_reports(const Options& options);
/// Visible areas of triangles, from one place and from many.
[[nodiscard]] Table measure_faces(const Options& options);
/// Areas where a depth buffer may show the wrong one of two faces.
[[nodiscard]] Table measure_fights(const Options& options);
/// Our pictures against Embree's.
[[nodiscard]] Table measure_ray_coverage(const Options& options);

}  // namespace frontmost::bench
