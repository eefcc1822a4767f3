// SPDX-License-Identifier: Apache-2.0
// Clipping against a reference without clipping: homogeneous edge functions in double, sample by sample.
//
// M. Olano, T. Greer. Triangle Scan Conversion using 2D Homogeneous Coordinates. 1997.

#include <gtest/gtest.h>

#include <cmath>

#include "frontmost/zbuffer.h"
#include "support/effort.h"
#include "support/random_scene.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

/// The reference's verdict on a sample: outside, inside at a depth, or too close to a border to tell after snapping.
enum class Verdict { outside, inside, unclear };

/// A triangle in homogeneous pixel coordinates: it covers sample (x, y) if no edge function is negative.
class HomogeneousTriangle {
 public:
  HomogeneousTriangle(const View& view, const std::array<glm::vec3, 3>& world) : view_(view) {
    const glm::dmat4 clip_from_world =
        clip_from_eye(view.projection, reversed_depth) * glm::inverse(view.world_from_eye);
    glm::dvec3 p[3];
    for (int k = 0; k < 3; ++k) {
      const glm::dvec4 clip = clip_from_world * glm::dvec4(glm::dvec3(world[std::size_t(k)]), 1);
      p[k] = {(clip.w + clip.x) * 0.5 * view.width, (clip.w - clip.y) * 0.5 * view.height, clip.w};
      const double distance = -(glm::inverse(view.world_from_eye) * glm::dvec4(glm::dvec3(world[std::size_t(k)]), 1)).z;
      depth_[k] = view.projection.orthographic ? distance : 1;
    }
    const double volume = glm::dot(p[0], glm::cross(p[1], p[2]));
    for (int k = 0; k < 3; ++k) edge_[k] = glm::cross(p[(k + 1) % 3], p[(k + 2) % 3]) / volume;
    // Affine on the screen: the distance in parallel projection, its reciprocal in perspective.
    plane_ = depth_[0] * edge_[0] + depth_[1] * edge_[1] + depth_[2] * edge_[2];
  }

  /// Error of a depth at a sample, as the number of pixels by which the sample would have to move.
  [[nodiscard]] double depth_error(double x, double y, double depth) const {
    const double value = view_.projection.orthographic ? depth : 1 / depth;
    const double rounding =
        1e-6 * (view_.projection.orthographic ? view_.projection.clip.far : 1 / view_.projection.clip.near);
    const double error = std::abs(glm::dot(plane_, glm::dvec3(x, y, 1)) - value);
    return std::max(error - rounding, 0.0) / std::hypot(plane_.x, plane_.y);
  }

  [[nodiscard]] Verdict at(double x, double y) const {
    const glm::dvec3 s(x, y, 1);
    double least = std::numeric_limits<double>::infinity();
    for (const glm::dvec3& e : edge_) least = std::min(least, pixels(e, s));
    const ClipDistances& clip = view_.projection.clip;
    const bool parallel = view_.projection.orthographic;
    const glm::dvec3 near = plane_ - glm::dvec3(0, 0, parallel ? clip.near : 1 / clip.near);
    const glm::dvec3 far = plane_ - glm::dvec3(0, 0, parallel ? clip.far : 1 / clip.far);
    least = std::min({least, (parallel ? 1 : -1) * pixels(near, s), (parallel ? -1 : 1) * pixels(far, s)});
    constexpr double kSnapped = 0.02;  // pixels; several units of snapping
    return std::isnan(least) || std::abs(least) < kSnapped ? Verdict::unclear
           : least > 0                                     ? Verdict::inside
                                                           : Verdict::outside;
  }

 private:
  /// Distance of the sample from a line, positive inside.
  static double pixels(const glm::dvec3& line, const glm::dvec3& s) {
    const double slope = std::hypot(line.x, line.y);
    return glm::dot(line, s) / std::max(slope, 1e-12 * std::abs(line.z));
  }

  const View& view_;
  glm::dvec3 edge_[3], plane_;
  double depth_[3];
};

TEST(Clipping, EqualsHomogeneousRasterisationWithoutClipping) {
  std::size_t inside = 0, outside = 0, unclear = 0;
  for (std::uint64_t seed = 0; seed < seeds(3000); ++seed) {
    Random random(seed);
    View view = random_view(random, 48, 40);
    const float reach = seed % 3 == 0 ? 1e4f : seed % 3 == 1 ? 8.0f : 2.0f;
    std::array<glm::vec3, 3> world{random.point(reach), random.point(reach), random.point(2)};
    Mesh mesh;
    add_triangle(mesh, world[0], world[1], world[2]);
    const Scene scene = scene_of(mesh);
    const Surfaces surfaces(scene);
    const Visible visible = draw_both_ways(surfaces, view);
    const HomogeneousTriangle triangle(view, world);
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) {
        const Verdict verdict = triangle.at(x + 0.5, y + 0.5);
        const std::size_t i = visible.index(x, y);
        ++(verdict == Verdict::unclear ? unclear : verdict == Verdict::inside ? inside : outside);
        if (verdict == Verdict::unclear) continue;
        ASSERT_EQ(visible.primitives[i] == 0, verdict == Verdict::inside)
            << "seed " << seed << " at " << x << ", " << y;
        if (verdict == Verdict::inside) {
          ASSERT_LT(triangle.depth_error(x + 0.5, y + 0.5, depth_of_key(view, visible.keys[i])), 0.02)
              << "seed " << seed << " at " << x << ", " << y << " depth " << depth_of_key(view, visible.keys[i]);
        }
      }
  }
  EXPECT_GT(inside, seeds(3000) * 100);
  EXPECT_GT(outside, seeds(3000) * 100);
  EXPECT_LT(unclear, (inside + outside) / 50);
}

}  // namespace
}  // namespace frontmost::test
