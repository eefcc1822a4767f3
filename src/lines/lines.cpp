// SPDX-License-Identifier: Apache-2.0
#include "frontmost/lines.h"

#include <atomic>

#include "base/float_environment.h"
#include "base/parallel.h"
#include "base/pool.h"
#include "lines/hidden_parts.h"
#include "lines/joined.h"

namespace frontmost {
namespace {

using namespace lines_detail;

constexpr std::size_t kTrianglesPerPart = 4096, kEdgesPerPart = 1024;

Buffer<std::int8_t> facing_of(const WeldedMesh& mesh, const Sight& sight, const Execution& execution) {
  Buffer<std::int8_t> facing(mesh.triangles.size());
  parallel_for(execution, facing.size(), kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const glm::uvec3& t = mesh.triangles[i];
      facing[i] = std::int8_t(sight.facing(mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]));
    }
  });
  return facing;
}

std::vector<DrawnPart> cut_all(const std::vector<FeatureEdge>& features, const Occlusion& occlusion,
                               const Execution& execution) {
  std::vector<std::vector<DrawnPart>> lists((features.size() + kEdgesPerPart - 1) / kEdgesPerPart);
  Pool<EdgeCutter> cutters;
  std::atomic<std::size_t> done{0};
  parallel_for(execution, features.size(), kEdgesPerPart, [&](std::size_t begin, std::size_t end) {
    const auto cutter = cutters.borrow([&] { return std::make_unique<EdgeCutter>(occlusion); });
    for (std::size_t i = begin; i < end; ++i) cutter->cut(features[i], std::uint32_t(i), lists[begin / kEdgesPerPart]);
    report_progress(execution, "lines", 0.3 + 0.7 * double(done += end - begin) / double(features.size()));
  });
  return joined(lists);
}

}  // namespace

Drawing lines(const Surfaces& surfaces, const View& view, const LineOptions& options, const Execution& execution) {
  validate(view);
  if (!(options.crease_angle >= 0 && options.crease_angle <= 3.1415926535897932))
    throw Error(ErrorCode::bad_argument, "crease_angle: must be from 0 to pi");
  const IeeeScope ieee;
  report_progress(execution, "lines", 0);
  const WeldedMesh mesh = weld(surfaces, execution);
  const Sight sight(view);
  const Buffer<std::int8_t> facing = facing_of(mesh, sight, execution);
  const std::vector<FeatureEdge> features = find_features({mesh, facing}, surfaces, options, execution);
  report_progress(execution, "lines", 0.2);
  const OccluderGrid grid({mesh, facing}, view, execution);
  report_progress(execution, "lines", 0.3);

  Drawing drawing;
  drawing.view = view;
  drawing.edges.reserve(features.size());
  const auto id_of = [&](std::uint32_t triangle) { return triangle == no_index ? no_primitive : mesh.ids[triangle]; };
  for (const FeatureEdge& f : features)
    drawing.edges.push_back({mesh.positions[f.from], mesh.positions[f.to], f.kind, id_of(f.left), id_of(f.right)});
  drawing.parts =
      cut_all(features, {mesh, sight, view, grid, shadow_kernels(execution.isa), options.counts_hidden}, execution);
  return drawing;
}

}  // namespace frontmost
