// SPDX-License-Identifier: Apache-2.0
// What is measured, one function a table. Each makes its scenes, measures our methods and the peers in turn, and says
// by Table::fail() where a promise does not hold; docs/performance.md says what the columns mean.
#pragma once

#include "harness/program.h"
#include "harness/table.h"

namespace frontmost::bench {

/// Frontmost beside llvmpipe and Embree on the same views.
[[nodiscard]] Table measure_peers(const Options& options);

/// One thread and all of them.
[[nodiscard]] Table measure_threads(const Options& options);
/// Every instruction set of this machine.
[[nodiscard]] Table measure_isas(const Options& options);
/// Building Surfaces.
[[nodiscard]] Table measure_surfaces(const Options& options);
/// Clear, cull, transform, set-up, raster.
[[nodiscard]] Table measure_stages(const Options& options);
/// Culling, hiding, order, samples.
[[nodiscard]] Table measure_features(const Options& options);
/// The depth buffer with OpenGL's state beside the z-buffer.
[[nodiscard]] Table measure_depth_buffer(const Options& options);
/// How near frames come to what memory and processor allow.
[[nodiscard]] Table measure_limits(const Options& options);
/// Bytes a triangle, a pixel and a sample.
[[nodiscard]] Table measure_memory(const Options& options);
/// Our pictures and llvmpipe's, pixel by pixel. Fails where a pixel differs for no reason.
[[nodiscard]] Table measure_coverage(const Options& options);
/// Ray casting beside Embree: index, views, and single rays in all directions.
[[nodiscard]] Table measure_raycast(const Options& options);
/// Scans from inside of models, of the test models' folder.
[[nodiscard]] Table measure_scans(const Options& options);
/// Accounts of the objects of one view.
[[nodiscard]] Table measure_accounts(const Options& options);
/// Ids, depths, boxes and shares of many views of a few objects.
[[nodiscard]] Table measure_reports(const Options& options);
/// Visible areas of triangles, from one place and from many.
[[nodiscard]] Table measure_faces(const Options& options);
/// Areas in which a depth buffer may show the wrong one of two faces.
[[nodiscard]] Table measure_fights(const Options& options);
/// Our pictures and Embree's.
[[nodiscard]] Table measure_ray_coverage(const Options& options);

}  // namespace frontmost::bench
