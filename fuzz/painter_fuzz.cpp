// SPDX-License-Identifier: Apache-2.0
// Feeds arbitrary geometry and an arbitrary camera to the painter's order. It must not crash or hang; threads change no
// bit; pieces and their visible parts are polygons within the picture. If coordinates have only a few bits, so that
// vertices touch and faces are coplanar, the painted order gives the z-buffer's picture. Input:
// support/geometry_fuzz.h.
#include <cmath>
#include <cstdlib>

#include "painter/trapped.h"
#include "support/geometry_fuzz.h"

using namespace frontmost;

namespace {

/// Few triangles, as all may be cut by all.
constexpr std::size_t kMostTriangles = 24;

void require(bool holds) {
  if (!holds) std::abort();
}

/// Each triangle takes nine signed bytes, in sixteenths.
Scene coarse_scene_of(const std::uint8_t* data, std::size_t size) {
  std::vector<glm::vec3> corners(std::min(size / 9, kMostTriangles) * 3);
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) corners[i][axis] = float(std::int8_t(data[3 * i + std::size_t(axis)])) / 16;
  return test::scene_of(reinterpret_cast<const std::uint8_t*>(corners.data()), corners.size() * sizeof(glm::vec3));
}

/// Checks the polygons of a PaintOrder or of VisibleParts.
template <class Order>
void check(const Surfaces& surfaces, const Order& order) {
  for (const PaintPolygon& polygon : order.polygons) {
    require(polygon.id < surfaces.primitive_count() && polygon.corner_count >= 3);
    require(polygon.first_corner + polygon.corner_count <= order.corners.size());
  }
  for (const PaintCorner& corner : order.corners) require(corner.at == corner.at);
}

void check_parts(const VisibleParts& parts) {
  for (const PaintCorner& corner : parts.corners) {
    require(corner.at.x >= -1e-3 && corner.at.x <= parts.view.width + 1e-3);
    require(corner.at.y >= -1e-3 && corner.at.y <= parts.view.height + 1e-3);
  }
}

/// Marks samples where the two pictures differ without a reason.
std::vector<bool> wrong(const Surfaces& surfaces, const Visible& expected, const Visible& painted) {
  const Agreement found = check_agreement(surfaces, expected, painted, {.threads = 1});
  std::vector<bool> is_wrong(painted.primitives.size());
  for (std::size_t i = 0; i < is_wrong.size(); ++i)
    is_wrong[i] = painted.primitives[i] != expected.primitives[i] && found.differences[i] == Difference::unexplained;
  return is_wrong;
}

/// Whether `at` is beside a cut: paint() covers from snapped vertices, so it may show there the face that ends at the
/// cut.
bool is_next_to_cut(const PaintOrder& order, const glm::dvec2& at) {
  for (const PaintPolygon& polygon : order.polygons)
    for (std::size_t i = 0; i < polygon.corner_count; ++i) {
      const PaintCorner& from = order.corners[polygon.first_corner + i];
      const PaintCorner& to = order.corners[polygon.first_corner + (i + 1) % polygon.corner_count];
      const glm::dvec2 way(to.at - from.at), beside = at - glm::dvec2(from.at);
      const double share = glm::clamp(glm::dot(beside, way) / glm::dot(way, way), 0.0, 1.0);
      if (from.is_cut && glm::length(beside - share * way) < 1.0 / 64) return true;
    }
  return false;
}

/// Skips faces close to the eye: vertices on 1/256 pixel tilt those so far that even the z-buffer differs from rays.
void check_picture(const Surfaces& surfaces, const PaintOrder& order) {
  const Visible painted = paint(surfaces, order);
  const std::vector<bool> by_samples = wrong(surfaces, zbuffer(surfaces, order.view, {.threads = 1}), painted);
  if (std::find(by_samples.begin(), by_samples.end(), true) == by_samples.end()) return;
  const std::vector<bool> by_rays = wrong(surfaces, raycast(surfaces, order.view, {.threads = 1}), painted);
  const std::span<const glm::ivec2> offsets = sample_offsets(order.view.samples);
  for (int y = 0; y < order.view.height; ++y)
    for (int x = 0; x < order.view.width; ++x)
      for (std::size_t s = 0; s < offsets.size(); ++s) {
        const std::size_t i = painted.index(x, y, int(s));
        const glm::dvec2 at = glm::dvec2(x, y) + glm::dvec2(offsets[s]) / 256.0;
        if (by_samples[i] && by_rays[i]) require(is_next_to_cut(order, at));
      }
}

template <class Order>
bool equal(const Order& a, const Order& b) {
  const auto same_polygon = [](const PaintPolygon& p, const PaintPolygon& q) {
    return p.id == q.id && p.corner_count == q.corner_count && p.first_corner == q.first_corner;
  };
  const auto same_corner = [](const PaintCorner& p, const PaintCorner& q) {
    return p.at == q.at && p.is_cut == q.is_cut;
  };
  return std::equal(a.polygons.begin(), a.polygons.end(), b.polygons.begin(), b.polygons.end(), same_polygon) &&
         std::equal(a.corners.begin(), a.corners.end(), b.corners.begin(), b.corners.end(), same_corner);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  test::ViewBytes bytes;
  if (size < sizeof(bytes)) return 0;
  std::memcpy(&bytes, data, sizeof(bytes));
  const bool is_coarse = bytes.spare & 8;
  const std::uint8_t* const geometry = data + sizeof(bytes);
  const std::size_t length = size - sizeof(bytes);
  const Scene scene = is_coarse ? coarse_scene_of(geometry, length) : test::scene_of(geometry, length, kMostTriangles);
  const Execution two{.threads = 2, .isa = Isa::best, .watch = nullptr}, one{.threads = 1};
  const PainterOptions options{.method = PaintMethod(bytes.spare & 3), .most_polygons = 3000, .most_cuts = 2000};
  const Occluders occluders = Occluders::where([&](PrimitiveId id) { return !(bytes.spare & 4) || id % 3 != 0; });
  try {
    const View view = test::view_of(bytes);
    const Surfaces surfaces(scene);
    const PaintOrder order = painter(surfaces, view, options, two);
    require(equal(order, painter(surfaces, view, options, one)));
    check(surfaces, order);
    const VisibleParts parts = visible_parts(order, occluders, two);
    require(equal(parts, visible_parts(order, occluders, one)));
    check(surfaces, parts);
    check_parts(parts);
    for (const test::PolygonCorners& outline : test::trapped(parts, 1, occluders, two))
      for (const glm::dvec2& at : outline) require(at == at);
    const bool is_right = options.method == PaintMethod::depth_sort || options.method == PaintMethod::bsp;
    if (!is_right || !is_coarse || !(std::abs(bytes.eye_x) < 100 && std::abs(bytes.eye_y) < 100)) return 0;
    check_picture(surfaces, order);
  } catch (const Error&) {
    // The camera is at its own target or not finite, or there are too many cuts: all are documented errors.
  }
  return 0;
}
