// SPDX-License-Identifier: Apache-2.0
// Cells that are divided because much meets in them: how much lines then ask, and that they get the same answers.
#include "lines/hiding/fine_cells.h"

#include <gtest/gtest.h>

#include "lines/hiding/hidden_parts.h"
#include "support/crowds.h"
#include "support/effort.h"

namespace frontmost::test {
namespace {

using namespace lines_detail;

/// A scene's edges, all of them, and what hides them.
class Crowded {
 public:
  Crowded(const Scene& scene, const View& view, bool counts, bool divides)
      : surfaces_(scene),
        view_(view),
        sight_(view),
        mesh_(weld(surfaces_, {})),
        seen_(see(mesh_, sight_, {})),
        edges_(find_features(seen_, surfaces_, {.crease_angle = 0}, {}).edges),
        grid_(seen_, view, counts, to_cut(divides), {}),
        counts_(counts) {}

  [[nodiscard]] std::vector<DrawnPart> parts(Isa isa) const {
    const Occlusion occlusion{mesh_, sight_, view_, grid_, shadow_kernels(isa), counts_, !counts_};
    EdgeCutter cutter(occlusion);
    std::vector<DrawnPart> parts;
    for (std::uint32_t i = 0; i < edges_.size(); ++i) cutter.cut(line(i), i, parts);
    return parts;
  }
  /// How many occluders there are in the cells that the edges pass, all in all.
  [[nodiscard]] double asked() const {
    double sum = 0;
    for (const FeatureEdge& edge : edges_) {
      const auto place = [&](std::uint32_t v) {
        return glm::dvec2(sight_.to_screen(sight_.in_eye(mesh_.positions[v]))) * grid_.scale();
      };
      grid_.visit_cells({place(edge.from), place(edge.to), edge.from, edge.to}, [&](const OccluderGrid::Visit& cell) {
        sum += double(cell.last - cell.first);
        return true;
      });
    }
    return sum;
  }
  [[nodiscard]] std::size_t edge_count() const { return edges_.size(); }

 private:
  [[nodiscard]] SightedEdge line(std::size_t i) const {
    const FeatureEdge& e = edges_[i];
    return {
        mesh_.positions[e.from], mesh_.positions[e.to], {e.from, e.from}, {e.to, e.to}, {e.left, e.right}, 0, e.outer};
  }
  [[nodiscard]] LinesToCut to_cut(bool divides) const {
    return {edges_.size(), [this](std::size_t i) { return line(i); }, 128, divides ? 0.0 : 1e300};
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

TEST(FineCells, AnswerAsTheWholeCellsDo) {
  std::size_t compared = 0;
  for (const Crowd kind : all_crowds)
    for (std::uint64_t seed = 0; seed < seeds(3); ++seed) {
      SCOPED_TRACE(int(kind) * 10 + int(seed));
      const bool counts = seed == 1;
      if (counts && kind != Crowd::cone && kind != Crowd::dense) continue;  // of others each hides all
      const Scene scene = scene_of(crowd(kind, kind == Crowd::fan ? 300 : 600));
      Random random(seed);
      const View view = seed < 2 ? frame(Surfaces(scene), 200, 150) : random_view(random, 200, 150);
      const Crowded divided(scene, view, counts, true), whole(scene, view, counts, false);
      const std::vector<DrawnPart> parts = divided.parts(Isa::best), expected = whole.parts(Isa::best);
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

TEST(FineCells, AreAskedNearLinearly) {
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
  // Four times as many triangles: without dividing each edge asks four times as many.
  EXPECT_LT(per_edge[1], 2 * per_edge[0]) << per_edge[0];
}

TEST(FineCells, LeaveFewerOfStacksConesAndBooks) {
  for (const Crowd kind : {Crowd::stack, Crowd::leaning_stack, Crowd::cone, Crowd::book}) {
    SCOPED_TRACE(int(kind));
    const Scene scene = scene_of(crowd(kind, 4000));
    const View view = frame(Surfaces(scene), 640, 480);
    EXPECT_LT(Crowded(scene, view, false, true).asked(), 0.6 * Crowded(scene, view, false, false).asked());
  }
}

/// Where dividing does not pay, all of the cell's triangles are looked at once.
TEST(FineCells, AskOftenWhetherToStop) {
  const Scene scene = scene_of(crowd(Crowd::stack, 20000));
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 640, 480);
  const WeldedMesh mesh = weld(surfaces, {});
  const SeenMesh seen = see(mesh, Sight(view), {});
  OnGrid on_grid{seen, Sight(view), Buffer<glm::dvec3>(mesh.positions.size())};
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    on_grid.places[v] = on_grid.sight.to_screen(on_grid.sight.in_eye(mesh.positions[v]));
  Buffer<Footprint> footprints(mesh.triangles.size());
  lines_detail::Crowd held{{320, 240, 1}, {}, {0}};
  for (std::uint32_t t = 0; t < footprints.size(); ++t) {
    footprints[t] = {{0, 0}, {640, 480}, 1, t};
    held.entries.push_back({1, t});
  }
  std::size_t asked = 0;
  Watch watch;
  watch.cancelled = [&] {
    ++asked;
    return false;
  };
  const std::vector<GridLine> lines = {{{320.1, 240.2}, {320.9, 240.7}}};
  const FineCells cells = divide({on_grid, footprints, lines, true}, held, {.threads = 1, .watch = &watch});
  EXPECT_EQ(cells.cells.size(), 1u);
  EXPECT_GT(asked, footprints.size() / 10000);
}

/// A triangle of the plane in which nearness or distance grows by `slope` from `value` at the apex, whose places are
/// off by what rounding leaves of them on a large picture.
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

TEST(FineCells, OfTwoTrianglesInOnePlaneNeitherIsBeyondTheOtherFarAway) {
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

TEST(FineCells, DividedAndSlicedPlacesAreFoundAgain) {
  Random random(5);
  const Division division{{2, 3, 0.25}, 0};
  for (int trial = 0; trial < 1000; ++trial) {
    const auto place = [&] {
      const float x = random.within(1.5f, 3.5f);
      return glm::dvec2(x, random.within(2.5f, 4.5f));
    };
    const glm::dvec2 a = place(), b = place();
    bool visited[Division::count] = {};
    visit_parts(division, a, b, [&](int x, int y, const glm::dvec2& low, const glm::dvec2& high) {
      visited[y * Division::side + x] = true;
      EXPECT_LE(low.x, high.x);
      EXPECT_LE(low.y, high.y);
      return true;
    });
    for (int i = 0; i <= 200; ++i) {
      const glm::dvec2 p = (a + (b - a) * (i / 200.0) - glm::dvec2(2, 3)) * 4.0;
      if (p.x < 0 || p.y < 0 || p.x >= Division::side || p.y >= Division::side) continue;
      ASSERT_TRUE(visited[int(p.y) * Division::side + int(p.x)]);
    }
  }
  const Slices sectors{7, {}, 10, {-3, -1, 0.5, 2}};
  const auto of = [&](const GridLine& line) { return sectors.of(line, {0, 0}, {1, 1}); };
  EXPECT_EQ(of({{0, 0}, {1, 0}, 7, 3}).first, 1u);
  EXPECT_EQ(of({{1, 0}, {0, 0}, 3, 7}).first, 1u);
  EXPECT_EQ(of({{0, 0}, {0, 1}, 7, 3}).first, 2u);
  EXPECT_EQ(of({{0, 0}, {0, 1}, 3, 4}).first, 4u);     // not from the apex: all
  EXPECT_EQ(of({{0, 0}, {0, 1e-5}, 7, 4}).first, 4u);  // too short to go anywhere
  const Slices strips{no_index, {1, 0}, 10, {0, 0.25, 0.5}};
  const Slices::Range range = strips.of({{-5, 0.5}, {0.4, 0.5}}, {0, 0}, {1, 1});
  EXPECT_EQ(range.first, 0u);
  EXPECT_EQ(range.last, 1u);
}

}  // namespace
}  // namespace frontmost::test
