// SPDX-License-Identifier: Apache-2.0
// All triangles are placed before the eye in parallel, each part of them into its own section of the list; the sections
// are then joined. So the list is in the order of ids for any number of threads.
//
//    ids        0 ........ 4095 | 4096 ...... 8191 | ...
//    filled     ####----------- | ######---------- |          part by part
//    closed up  ##########                                    in the order of ids
//
// A triangle is left out if it is certainly before the near plane, beyond the far plane, beside the picture, edge-on,
// or culled. The side from which it is seen is an exact sign. A triangle that may cross the near or far plane is cut
// there later, exactly, by the same cuts as cycles; until then it may be anywhere on the screen.
#include <algorithm>
#include <limits>

#include "painter/stages.h"
#include "surfaces/cluster_set.h"
#include "view/facing_rule.h"

namespace frontmost::painter_detail {
namespace {

constexpr std::size_t kTrianglesPerPart = 4096;
/// Relative margin of distances: more than rounding moves them.
constexpr double kMargin = 1e-9;

class Gatherer {
 public:
  Gatherer(const Surfaces& surfaces, const View& view, const Sight& sight)
      : surfaces_(surfaces),
        view_(view),
        sight_(sight),
        empty_(sight),
        facing_(view.culling, placed_scene(surfaces).sides.get()) {}

  enum class Place : std::uint8_t { outside, inside, crossing };

  /// The place of a triangle; `crossing`: the near or far plane may cut it.
  Place gather(PrimitiveId id, PolygonExtent& extent, Face& face) const {
    face = {surfaces_.corners(id), id};
    for (const glm::vec3& corner : face.corners)
      if (!is_finite(corner)) return Place::outside;
    ExtentBuilder box = empty_;
    double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
    for (const glm::vec3& corner : face.corners) {
      const glm::dvec3 in_eye = sight_.in_eye(glm::dvec3(corner));
      nearest = std::min(nearest, in_eye.z);
      farthest = std::max(farthest, in_eye.z);
      box.include(in_eye);
    }
    const double slack = kMargin * std::max(std::abs(nearest), std::abs(farthest));
    if (farthest + slack < sight_.near() || nearest - slack > sight_.far()) return Place::outside;
    const bool is_crossing = nearest - slack < sight_.near() || farthest + slack > sight_.far();
    extent = is_crossing ? anywhere() : box.extent();
    extent.low = glm::max(extent.low, glm::vec2(0));
    extent.high = glm::min(extent.high, glm::vec2(view_.width, view_.height));
    if (!(extent.low.x < extent.high.x && extent.low.y < extent.high.y) || !turn_to_eye(face)) return Place::outside;
    return is_crossing ? Place::crossing : Place::inside;
  }

 private:
  static PolygonExtent anywhere() {
    const float infinite = std::numeric_limits<float>::infinity();
    return {glm::vec2(-infinite), glm::vec2(infinite), -infinite, infinite};
  }

  /// Makes a face counter-clockwise to the eye. \returns false if the face is not visible at all.
  bool turn_to_eye(Face& face) const {
    const auto& c = face.corners;
    const int facing = sight_.facing(glm::dvec3(c[0]), glm::dvec3(c[1]), glm::dvec3(c[2]));
    if (facing == 0) return false;
    if (facing_.culling() != Culling::none) {
      const bool is_front = (facing > 0) != surfaces_.is_mirrored(surfaces_.source(face.id).instance);
      if (!facing_.keeps(face.id, is_front)) return false;
    }
    if (facing < 0) std::swap(face.corners[1], face.corners[2]);
    return true;
  }

  const Surfaces& surfaces_;
  const View& view_;
  const Sight& sight_;
  const ExtentBuilder empty_;
  const FacingRule facing_;
};

/// The plane at a distance before the eye, facing away from it.
Plane plane_at(const View& view, double distance) {
  return {view.eye() + view.forward() * distance, Leg{view.up()}, Leg{view.right()}};
}

/// Cuts away everything outside the near and far planes. \returns no_index if nothing remains.
std::uint32_t clip(Pieces& pieces, std::uint32_t piece, std::uint32_t near_plane, const Plane& near,
                   std::uint32_t far_plane, const Plane* far) {
  const Sides at_near = pieces.sides(piece, near);
  if (!at_near.front) return no_index;
  if (at_near.both()) piece = pieces.cut(piece, near_plane).front;
  if (!far) return piece;
  const Sides at_far = pieces.sides(piece, *far);
  if (!at_far.back) return no_index;
  return at_far.both() ? pieces.cut(piece, far_plane).back : piece;
}

/// The triangles kept of a part of consecutive ids, in the order of their ids.
struct Part {
  std::size_t count = 0;
  std::vector<std::uint32_t> crossing;  ///< numbered from 0
};

/// Fills a section of the list for every part, then joins the sections. \returns the triangles that cross.
std::vector<std::uint32_t> fill(const Surfaces& surfaces, const Gatherer& gatherer, Pieces& pieces,
                                const Execution& execution) {
  const std::size_t all = surfaces.primitive_count();
  pieces.resize(all);
  std::vector<Part> parts((all + kTrianglesPerPart - 1) / kTrianglesPerPart);
  parallel_for(execution, all, kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
    Part& part = parts[begin / kTrianglesPerPart];
    for (std::size_t id = begin; id < end; ++id) {
      PolygonExtent extent;
      Face face;
      const Gatherer::Place place = gatherer.gather(PrimitiveId(id), extent, face);
      if (place == Gatherer::Place::outside) continue;
      if (place == Gatherer::Place::crossing) part.crossing.push_back(std::uint32_t(part.count));
      pieces.set(begin + part.count++, extent, face);
    }
  });
  std::size_t total = 0;
  std::vector<std::uint32_t> crossing;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto first = std::uint32_t(i * kTrianglesPerPart);
    for (const std::uint32_t k : parts[i].crossing) crossing.push_back(std::uint32_t(total) + k);
    for (std::uint32_t k = 0; k < parts[i].count && first != total; ++k)
      pieces.set(total + k, pieces.extent(first + k), pieces.face(first + k));
    total += parts[i].count;
  }
  pieces.resize(total);
  return crossing;
}

}  // namespace

std::vector<std::uint32_t> gather(const Surfaces& surfaces, const View& view, Pieces& pieces,
                                  const Execution& execution) {
  const std::vector<std::uint32_t> crossing = fill(surfaces, {surfaces, view, pieces.sight()}, pieces, execution);
  std::vector<std::uint32_t> members(pieces.size());
  for (std::uint32_t i = 0; i < members.size(); ++i) members[i] = i;

  const bool has_far = view.projection.clip.far < std::numeric_limits<double>::infinity();
  const Plane near = plane_at(view, pieces.sight().near());
  const Plane far = has_far ? plane_at(view, pieces.sight().far()) : near;
  const std::uint32_t near_plane = pieces.add_plane(near), far_plane = pieces.add_plane(far);
  for (const std::uint32_t i : crossing)
    members[i] = clip(pieces, i, near_plane, near, far_plane, has_far ? &far : nullptr);
  members.erase(std::remove(members.begin(), members.end(), no_index), members.end());
  return members;
}

}  // namespace frontmost::painter_detail
