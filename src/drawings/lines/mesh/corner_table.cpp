// SPDX-License-Identifier: Apache-2.0
// A counting sort in bands of triangles, each of which has its own counters.
//
//    triangles     | band 0     | band 1     | band 2     |        each band counts the corners at every vertex
//    counters      band 0: v0 v1 v2 ...   band 1: v0 v1 v2 ...     sums over bands say where each band's corners go
//
// So bands fill the table at the same time and without locks, and the corners at a vertex come in the order of their
// triangles, whatever number of bands there is.
#include "lines/mesh/corner_table.h"

#include <algorithm>
#include <string>
#include <vector>

#include "base/parallel.h"

namespace frontmost::lines_detail {
namespace {

/// Each takes four bytes a vertex.
constexpr std::size_t kMostBands = 8;
constexpr std::size_t kTrianglesBetweenPolls = 1 << 18;

}  // namespace

CornerTable::CornerTable(const WeldedMesh& mesh, const Execution& execution) {
  if (mesh.triangles.size() > Corner::most_triangles)
    throw Error(ErrorCode::limit_exceeded, "lines",
                "more than " + std::to_string(Corner::most_triangles) + " triangles");
  first_ = Buffer<std::uint32_t>(mesh.positions.size() + 1);
  corners_ = Buffer<Corner>(3 * mesh.triangles.size());
  const std::size_t bands = std::min(std::size_t(thread_count(execution)), kMostBands);
  const std::size_t vertices = mesh.positions.size(), triangles = mesh.triangles.size();
  const auto for_each_corner = [&](const auto& visit) {
    parallel_for(execution, bands, 1, [&](std::size_t band, std::size_t) {
      const std::size_t end = triangles * (band + 1) / bands;
      for (std::size_t t = triangles * band / bands; t < end; ++t) {
        if (t % kTrianglesBetweenPolls == 0) check_cancelled(execution);
        for (std::uint32_t k = 0; k < 3; ++k) visit(band, (&mesh.triangles[t].x)[k], Corner(std::uint32_t(t), k));
      }
    });
  };
  std::vector<std::vector<std::uint32_t>> next(bands);
  parallel_for(execution, bands, 1, [&](std::size_t band, std::size_t) { next[band].assign(vertices, 0); });
  for_each_corner([&](std::size_t band, std::uint32_t vertex, Corner) { ++next[band][vertex]; });
  std::uint32_t count = 0;
  for (std::size_t v = 0; v < vertices; ++v) {
    first_[v] = count;
    for (std::vector<std::uint32_t>& places : next) {
      const std::uint32_t here = places[v];
      places[v] = count;
      count += here;
    }
  }
  first_[vertices] = count;
  for_each_corner(
      [&](std::size_t band, std::uint32_t vertex, Corner corner) { corners_[next[band][vertex]++] = corner; });
}

}  // namespace frontmost::lines_detail
