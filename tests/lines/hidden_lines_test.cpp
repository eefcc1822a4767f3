// SPDX-License-Identifier: Apache-2.0
// Parts against every triangle of the scene, point by point.
#include <gtest/gtest.h>

#include "frontmost/lines.h"
#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

/// How many triangles hide a point, by the intersection of the line of sight with each; none where that is within
/// rounding of changing.
class PointOracle {
 public:
  PointOracle(const Surfaces& surfaces, const View& view) : view_(view) {
    for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
      const auto c = surfaces.corners(id);
      triangles_.push_back({glm::dvec3(c[0]), glm::dvec3(c[1]), glm::dvec3(c[2])});
    }
  }

  struct Answer {
    bool is_certain = true;
    std::uint32_t hidden_by = 0;
  };
  /// x is on `edge`: a triangle that the edge lies within does not hide it.
  [[nodiscard]] Answer ask(const glm::dvec3& x, const DrawnEdge& edge) const {
    Answer answer;
    for (std::size_t id = 0; id < triangles_.size(); ++id) {
      const auto& t = triangles_[id];
      if (id == edge.left || id == edge.right || shared_corners(t, {edge.from, edge.to}) == 2) continue;
      const glm::dvec3 direction = view_.projection.orthographic ? -view_.forward() : view_.eye() - x;
      const glm::dvec3 u = t[1] - t[0], v = t[2] - t[0], n = glm::cross(u, v);
      const double slope = glm::dot(n, direction), size = glm::length(n) * glm::length(direction);
      if (std::abs(slope) <= 1e-9 * size) {
        // Seen from its edge: hides nothing, unless by rounding.
        answer.is_certain &= slope == 0 || std::abs(glm::dot(n, x - t[0])) > 1e-6 * glm::length(n);
        continue;
      }
      const double s = glm::dot(n, t[0] - x) / slope;
      const glm::dvec3 hit = x + s * direction;
      const double planar = glm::dot(hit - view_.eye(), view_.forward());
      double inside = 1e300;
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 side = t[(k + 1) % 3] - t[k];
        inside = std::min(inside, glm::dot(n, glm::cross(side, hit - t[k])) / (glm::length(n) * glm::length(side)));
      }
      const double before = s * glm::length(direction), near = planar - view_.projection.clip.near;
      const double scale = 1 + glm::length(x) + glm::length(hit);
      constexpr double kDoubt = 1e-7;
      if (inside < -kDoubt * scale || before < -kDoubt * scale || near < -kDoubt * scale) continue;
      if (inside > kDoubt * scale && before > kDoubt * scale && near > kDoubt * scale)
        ++answer.hidden_by;
      else
        answer.is_certain = false;
    }
    return answer;
  }

 private:
  static int shared_corners(const std::array<glm::dvec3, 3>& t, const std::array<glm::dvec3, 2>& own) {
    int shared = 0;
    for (const glm::dvec3& corner : t) shared += corner == own[0] || corner == own[1];
    return shared;
  }

  const View& view_;
  std::vector<std::array<glm::dvec3, 3>> triangles_;
};

struct Checked {
  std::size_t asked = 0, certain = 0;
};

Checked check(const Scene& scene, const View& view, bool counts, std::uint64_t seed) {
  const Surfaces surfaces(scene);
  const Drawing drawing = lines(surfaces, view, {.crease_angle = 0, .counts_hidden = counts});
  const PointOracle oracle(surfaces, view);
  Random random(seed);
  Checked checked;
  const DrawnPart* before = nullptr;
  for (const DrawnPart& part : drawing.parts) {
    if (before && before->edge == part.edge) {
      EXPECT_EQ(before->end, part.begin);
      EXPECT_EQ(before->to, part.from);
      EXPECT_NE(before->hidden_by, part.hidden_by);
    }
    before = &part;
    EXPECT_LT(part.begin, part.end);
    const DrawnEdge& edge = drawing.edges[part.edge];
    const double t = part.begin + (part.end - part.begin) * random.within(0.1f, 0.9f);
    const PointOracle::Answer answer = oracle.ask(edge.from + (edge.to - edge.from) * t, edge);
    ++checked.asked;
    if (!answer.is_certain) continue;
    ++checked.certain;
    if (counts)
      EXPECT_EQ(part.hidden_by, answer.hidden_by) << part.edge << " at " << t;
    else
      EXPECT_EQ(part.hidden_by != 0, answer.hidden_by != 0) << part.edge << " at " << t;
  }
  return checked;
}

class EveryKind : public testing::TestWithParam<Kind> {};

TEST_P(EveryKind, IsHiddenWhereATriangleIsBefore) {
  Checked all;
  for (std::uint64_t seed = 0; seed < seeds(8); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed + 100);
    // Sheets all pass through each other: hundreds of thousands of segments.
    const Scene scene = scene_of(random_mesh(GetParam(), GetParam() == Kind::sheets ? 30 : 150, seed));
    View view = random_view(random, 160, 120);
    const Checked checked = check(scene, view, seed % 2 == 0, seed);
    all.asked += checked.asked;
    all.certain += checked.certain;
  }
  // Triangles in one plane are all in doubt.
  EXPECT_GT(double(all.certain), GetParam() == Kind::coplanar ? 0 : 0.99 * double(all.asked));
  EXPECT_GT(all.asked, 30u);
}

INSTANTIATE_TEST_SUITE_P(Lines, EveryKind, testing::ValuesIn(all_kinds));

TEST(Lines, ThreadsChangeNothing) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 3000, 5));
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 320, 240);
  const Drawing one = lines(surfaces, view, {}, {.threads = 1}), three = lines(surfaces, view, {}, {.threads = 3});
  ASSERT_EQ(one.parts.size(), three.parts.size());
  for (std::size_t i = 0; i < one.parts.size(); ++i) {
    ASSERT_EQ(one.parts[i].edge, three.parts[i].edge);
    ASSERT_EQ(one.parts[i].end, three.parts[i].end);
    ASSERT_EQ(one.parts[i].to, three.parts[i].to);
    ASSERT_EQ(one.parts[i].hidden_by, three.parts[i].hidden_by);
  }
}

}  // namespace
}  // namespace frontmost::test
