// SPDX-License-Identifier: Apache-2.0
//   Surfaces --viewed_faces()--> faces on the screen --seen_parts()--> parts of them --added up--> VisibleFaces
//        \--sides_of_meshes()--/
#include <algorithm>

#include "base/parallel.h"
#include "frontmost/report.h"
#include "report/faces/cells.h"

namespace frontmost {
namespace {

using faces_detail::Areas;
using faces_detail::SeenPart;

/// The limit of steps: fifteen times what the most crowded of 237 models takes, and 64 more for each face.
std::uint64_t most_steps_of(const faces_detail::ViewedFaces& screen) {
  return (std::uint64_t(1) << 31) + 64 * std::uint64_t(screen.faces.size());
}

/// The visible faces by id, ascending.
std::vector<VisibleFace> find_faces(const Surfaces& surfaces, const View& view,
                                    const std::vector<EdgeNeighbours>& sides, const Execution& execution) {
  constexpr std::size_t kFacesAtOnce = 4096;
  const faces_detail::ViewedFaces screen = faces_detail::viewed_faces(surfaces, view, sides, execution);
  const faces_detail::FacesOfView faces{surfaces, screen, faces_detail::AreaRule(view), most_steps_of(screen)};
  const faces_detail::SeenParts found = faces_detail::seen_parts(faces, view, execution);
  std::vector<Areas> areas(screen.faces.size());
  parallel_for(execution, areas.size(), kFacesAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (found.is_whole[i] == 0) continue;
      const auto& c = screen.faces[i].corners;
      areas[i] = faces.rule.areas_of(std::array{screen.points[c[0]], screen.points[c[1]], screen.points[c[2]]});
    }
  });
  for (const std::vector<SeenPart>& parts : found.parts)
    for (const SeenPart& part : parts) areas[part.face] += part.areas;
  std::vector<VisibleFace> seen;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    if (!(areas[i].pixels > 0)) continue;
    if (seen.empty() || seen.back().id != screen.faces[i].id) seen.push_back({screen.faces[i].id, 0, 0, 0});
    seen.back().pixels += areas[i].pixels;
    seen.back().area += areas[i].units;
    seen.back().solid_angle += areas[i].solid_angle;
  }
  return seen;
}

/// The area of a triangle, in scene units squared.
double area_of_triangle(const std::array<glm::vec3, 3>& corners) {
  const glm::dvec3 a(corners[0]);
  return 0.5 * glm::length(glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a));
}

}  // namespace

VisibleFaces visible_faces(const Surfaces& surfaces, const View& view, const Execution& execution) {
  const IeeeScope ieee;
  validate(view);
  return {view, find_faces(surfaces, view, faces_detail::sides_of_meshes(surfaces.scene(), execution), execution)};
}

std::vector<SeenFace> faces_ever_seen(const Surfaces& surfaces, std::span<const View> views,
                                      const Execution& execution) {
  const IeeeScope ieee;
  for (const View& view : views) validate(view);
  const std::vector<EdgeNeighbours> sides = faces_detail::sides_of_meshes(surfaces.scene(), execution);
  std::vector<SeenFace> best(surfaces.primitive_count());
  for (std::uint32_t number = 0; number < views.size(); ++number)
    for (const VisibleFace& face : find_faces(surfaces, views[number], sides, execution)) {
      SeenFace& found = best[face.id];
      found.id = face.id;
      ++found.view_count;
      found.largest_pixels = std::max(found.largest_pixels, face.pixels);
      const double share = std::min(face.area / area_of_triangle(surfaces.corners(face.id)), 1.0);
      if (share <= found.largest_share) continue;
      found.largest_share = share;
      found.best_view = number;
    }
  std::erase_if(best, [](const SeenFace& face) { return face.view_count == 0; });
  return best;
}

}  // namespace frontmost
