// SPDX-License-Identifier: Apache-2.0
// Cells divided for holding much: how many triangles lines then examine, and that the answers stay the same.
#include <gtest/gtest.h>

#include "lines/hiding/grid_plan.h"
#include "lines/hiding/hidden_parts.h"
#include "support/effort.h"
#include "support/meshes.h"

namespace frontmost::test {
namespace {

using namespace lines_detail;

/// All edges of a scene, and the triangles that may hide them.
class Crowded {
 public:
  Crowded(const Scene& scene, const View& view, bool counts, bool divides)
      : surfaces_(scene),
        view_(view),
        sight_(view),
        mesh_(weld(surfaces_, {})),
        seen_(see(mesh_, sight_, {})),
        edges_(find_features(seen_, surfaces_, {.crease_angle = 0}, {}).edges),
        grid_(seen_, view, counts, {}, {128, divides ? 0 : std::numeric_limits<double>::infinity()}),
        counts_(counts) {}

  [[nodiscard]] EdgeOccluders occlusion() const {
    return {mesh_, sight_, view_, grid_, shadow_kernels(Isa::best), counts_, !counts_};
  }
  [[nodiscard]] std::vector<DrawnPart> parts(EdgeCutter& cutter) const {
    std::vector<DrawnPart> parts;
    for (std::uint32_t i = 0; i < edges_.size(); ++i) cutter.cut(line(i), i, parts);
    return parts;
  }
  [[nodiscard]] std::vector<DrawnPart> parts() const {
    EdgeCutter cutter(occlusion());
    return parts(cutter);
  }
  /// Total number of occluders in the cells that the edges pass.
  [[nodiscard]] double asked() const {
    double sum = 0;
    for (const FeatureEdge& edge : edges_) {
      const auto place = [&](std::uint32_t v) {
        return glm::dvec2(sight_.to_screen(sight_.in_eye(mesh_.positions[v]))) * grid_.scale();
      };
      grid_.visit_cells(place(edge.from), place(edge.to), [&](const OccluderGrid::Visit& cell) {
        sum += double(cell.last - cell.first);
        return true;
      });
    }
    return sum;
  }
  [[nodiscard]] std::size_t edge_count() const { return edges_.size(); }
  [[nodiscard]] std::size_t triangle_count() const { return mesh_.triangles.size(); }

 private:
  [[nodiscard]] SightedEdge line(std::size_t i) const {
    const FeatureEdge& e = edges_[i];
    return {
        mesh_.positions[e.from], mesh_.positions[e.to], {e.from, e.from}, {e.to, e.to}, {e.left, e.right}, 0, e.outer};
  }

  const Surfaces surfaces_;
  const View view_;
  const Sight sight_;
  const WeldedMesh mesh_;
  const SeenMesh seen_;
  const std::vector<FeatureEdge> edges_;
  const OccluderGrid grid_;
  const bool counts_;
};

TEST(DividedCells, AnswerAsTheWholeCellsDo) {
  std::size_t compared = 0;
  for (const Crowd kind : all_crowds)
    for (std::uint64_t seed = 0; seed < seeds(3); ++seed) {
      SCOPED_TRACE(int(kind) * 10 + int(seed));
      const bool counts = seed == 1;
      if (counts && kind != Crowd::cone && kind != Crowd::dense)
        continue;  // In the other crowds each triangle hides
                   // all others.
      const Scene scene = scene_of(crowd(kind, kind == Crowd::fan ? 300 : 600));
      Random random(seed);
      const View view = seed < 2 ? frame(Surfaces(scene), 200, 150) : random_view(random, 200, 150);
      const Crowded divided(scene, view, counts, true), whole(scene, view, counts, false);
      const std::vector<DrawnPart> parts = divided.parts(), expected = whole.parts();
      ASSERT_EQ(parts.size(), expected.size());
      for (std::size_t i = 0; i < parts.size(); ++i) {
        ASSERT_EQ(parts[i].edge, expected[i].edge);
        ASSERT_EQ(parts[i].begin, expected[i].begin) << i;
        ASSERT_EQ(parts[i].end, expected[i].end) << i;
        ASSERT_EQ(parts[i].hidden_by, expected[i].hidden_by) << i;
        ASSERT_EQ(parts[i].is_outline, expected[i].is_outline) << i;
      }
      compared += parts.size();
    }
  EXPECT_GT(compared, 1000u);
}

TEST(DividedCells, AreAskedNearLinearly) {
  double per_edge[2];
  for (const bool is_large : {false, true}) {
    const Scene scene = scene_of(crowd(Crowd::dense, is_large ? 16000 : 4000));
    const View view = frame(Surfaces(scene), 640, 480);
    const Crowded divided(scene, view, false, true);
    per_edge[is_large] = divided.asked() / double(divided.edge_count());
    if (!is_large) {
      EXPECT_LT(divided.asked(), 0.3 * Crowded(scene, view, false, false).asked());
    }
  }
  // The second model has four times as many triangles: without dividing, each edge would examine four times as many.
  EXPECT_LT(per_edge[1], 2 * per_edge[0]) << per_edge[0];
}

/// If all triangles coincide, every edge is tested against every triangle of its cells, divided or not, at the cost
/// that the header states. Dividing in vain may not add much to that cost.
TEST(DividedCells, CostLittleWhereTheyCannotHelp) {
  for (const Crowd kind : {Crowd::stack, Crowd::leaning_stack, Crowd::book, Crowd::fan, Crowd::cone}) {
    SCOPED_TRACE(int(kind));
    const Scene scene = scene_of(crowd(kind, 2000));
    const View view = frame(Surfaces(scene), 640, 480);
    const Crowded divided(scene, view, false, true);
    EXPECT_LT(divided.asked(), 1.5 * Crowded(scene, view, false, false).asked());
    EdgeCutter cutter(divided.occlusion());
    (void)divided.parts(cutter);
    EXPECT_LT(double(cutter.boxes_asked()), 2.0 * double(divided.edge_count()) * double(divided.triangle_count()));
  }
}

/// If dividing does not pay, all of the cell's triangles are examined at once.
TEST(DividedCells, AskOftenWhetherToStop) {
  const Scene scene = scene_of(crowd(Crowd::stack, 20000));
  const Surfaces surfaces(scene);
  const WeldedMesh mesh = weld(surfaces, {});
  const View view = frame(surfaces, 640, 480);
  const SeenMesh seen = see(mesh, Sight(view), {});
  CountingWatch watch;
  const Execution execution = watch.execution();
  const GridPlan plan(seen, view, true, execution);
  std::vector<CellEntry> entries;
  for (std::uint32_t i = 0; i < plan.footprints.size(); ++i) entries.push_back({1, i});
  ASSERT_GT(entries.size(), 30000u);
  const Square middle = plan.grid.square(plan.grid.columns / 2, plan.grid.rows / 2);
  watch.restart();
  const std::size_t count = entries.size();
  const DividedCell<CellEntry> divided =
      divide_entries(plan, {{middle.x + 0.4, middle.y + 0.1, 0.2}, std::move(entries)});
  EXPECT_EQ(divided.cells.count(), 1u);
  EXPECT_EQ(divided.items[0].size(), count);
  EXPECT_GT(watch.asked(), count / 10000);
}

/// A triangle in the plane where nearness or distance grows by `slope` from `value` at the apex. Its vertices carry the
/// rounding error of a large picture.
CellDepth around_apex(Random& random, const glm::dvec2& apex, double value, const glm::dvec2& slope, bool is_parallel) {
  glm::dvec3 corners[3];
  const double angle = random.within(0, 6.28f), width = std::pow(10.0, random.within(-3, 0.4f));
  for (int k = 0; k < 3; ++k) {
    const double length = k == 0 ? 0 : std::pow(10.0, random.within(-3, 1)), at = angle + (k == 2 ? width : 0);
    const glm::dvec2 along = glm::dvec2(std::cos(at), std::sin(at)) * length;
    const double there = value + glm::dot(slope, along);
    const double x = apex.x + along.x + 4e-13 * random.within(-1, 1);
    const double y = apex.y + along.y + 4e-13 * random.within(-1, 1);
    corners[k] = {x, y, is_parallel ? there : 1 / there};
  }
  return {corners[0], corners[1], corners[2], is_parallel};
}

TEST(DividedCells, OfTwoTrianglesInOnePlaneNeitherIsBeyondTheOtherFarAway) {
  Random random(11);
  int wrong = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const bool is_parallel = trial % 2 == 0;
    const double reach = trial % 3 == 0 ? 2000 : 8, x = reach * random.unit(), y = reach * random.unit();
    const double steep = std::pow(10.0, random.within(-3, 3)), turn = random.within(0, 6.28f);
    const glm::dvec2 slope = glm::dvec2(std::cos(turn), std::sin(turn)) * steep;
    const CellDepth one = around_apex(random, {x, y}, 5, slope, is_parallel);
    const CellDepth other = around_apex(random, {x, y}, 5, slope, is_parallel);
    const double angle = random.within(0, 6.28f);
    const Square far{x + 16 * std::cos(angle), y + 16 * std::sin(angle), 0};
    wrong += one.is_beyond(other, far) || other.is_beyond(one, far);
  }
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace frontmost::test
