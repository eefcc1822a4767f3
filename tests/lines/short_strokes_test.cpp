// SPDX-License-Identifier: Apache-2.0
// Strokes too short for the pen to travel to: some are left out, and some must stay.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "frontmost/lines.h"
#include "support/random_scene.h"
#include "support/stroke_length.h"

namespace frontmost::test {
namespace {

constexpr double kShortest = 5;

/// A drawing of given lines in pixels.
class Sketch {
 public:
  Sketch& add(EdgeKind kind, const std::vector<glm::dvec2>& points, bool is_hidden = false) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      DrawnPart part;
      part.edge = std::uint32_t(drawing_.edges.size());
      part.from = points[i];
      part.to = points[i + 1];
      part.hidden_by = is_hidden;
      drawing_.parts.push_back(part);
      DrawnEdge edge;
      edge.kind = kind;
      drawing_.edges.push_back(edge);
    }
    return *this;
  }
  [[nodiscard]] Strokes strokes(double shortest = kShortest, bool by_kind = false, double joining = 0.01) const {
    const Scene scene = scene_of({});
    StrokeOptions options;
    options.by_kind = by_kind;
    options.shortest = shortest;
    options.joining = joining;
    return frontmost::chain_strokes(Surfaces(scene), drawing_, options);
  }

 private:
  Drawing drawing_;
};

TEST(ShortStrokes, InTheAirAreLeftOut) {
  for (const EdgeKind kind : {EdgeKind::silhouette, EdgeKind::boundary, EdgeKind::crease, EdgeKind::intersection}) {
    Sketch sketch;
    sketch.add(kind, {{0, 0}, {100, 0}}).add(kind, {{20, 20}, {23, 21}}).add(kind, {{50, 0}, {52, 3}});
    EXPECT_EQ(sketch.strokes(0).strokes.size(), 3u);
    EXPECT_EQ(sketch.strokes().strokes.size(), 1u);
    EXPECT_NEAR(total_length(sketch.strokes()), 100, 1e-9);
  }
}

TEST(ShortStrokes, ThatEndInTheAirTogetherAreLeftOutTogether) {
  // Three strokes from a junction, one of them to a second junction, and none attached to a longer line.
  Sketch sketch;
  sketch.add(EdgeKind::silhouette, {{10, 10}, {12, 10}})
      .add(EdgeKind::silhouette, {{12, 10}, {13, 12}})
      .add(EdgeKind::silhouette, {{12, 10}, {14, 9}})
      .add(EdgeKind::silhouette, {{14, 9}, {15, 8}})
      .add(EdgeKind::silhouette, {{14, 9}, {16, 10}});
  EXPECT_TRUE(sketch.strokes().strokes.empty());
}

/// An outline in pieces, one of them a short stroke between two T-junctions with longer lines.
TEST(ShortStrokes, OfOutlinesStay) {
  for (const EdgeKind kind : {EdgeKind::silhouette, EdgeKind::boundary}) {
    Sketch sketch;
    sketch.add(kind, {{0, 0}, {100, 0}}).add(kind, {{0, 3}, {100, 3}}).add(kind, {{50, 0}, {50, 3}});
    EXPECT_NEAR(total_length(sketch.strokes()), 203, 1e-9);
    // A crease in its place is dropped: both lines go on without it.
    Sketch other;
    other.add(kind, {{0, 0}, {100, 0}}).add(kind, {{0, 3}, {100, 3}}).add(EdgeKind::crease, {{50, 0}, {50, 3}});
    EXPECT_NEAR(total_length(other.strokes()), 200, 1e-9);
  }
}

TEST(ShortStrokes, ClosedOutlinesStayAndOtherLoopsGo) {
  const std::vector<glm::dvec2> loop = {{10, 10}, {11, 10}, {11, 11}, {10, 11}, {10, 10}};
  EXPECT_EQ(Sketch().add(EdgeKind::silhouette, loop).strokes().strokes.size(), 1u);
  EXPECT_TRUE(Sketch().add(EdgeKind::crease, loop).strokes().strokes.empty());
}

TEST(ShortStrokes, ThatLinkLinesStay) {
  // A plate seen almost edge-on: two long lines, and at each end a short one with a third line to its vertex.
  Sketch sketch;
  sketch.add(EdgeKind::crease, {{0, 0}, {100, 0}})
      .add(EdgeKind::crease, {{100, 0}, {100, 3}})
      .add(EdgeKind::crease, {{100, 3}, {0, 3}})
      .add(EdgeKind::crease, {{100, 0}, {160, 20}})
      .add(EdgeKind::crease, {{100, 3}, {160, 40}});
  const Strokes whole = sketch.strokes(0), kept = sketch.strokes();
  EXPECT_EQ(whole.strokes.size(), 5u);
  EXPECT_EQ(kept.strokes.size(), 5u);
  EXPECT_NEAR(total_length(kept), total_length(whole), 1e-9);
}

TEST(Strokes, GoOnThroughJunctions) {
  const auto count = [](const std::vector<glm::dvec2>& tips) {
    Sketch sketch;
    for (const glm::dvec2& tip : tips) sketch.add(EdgeKind::crease, {{50, 50}, tip});
    return sketch.strokes(0).strokes.size();
  };
  EXPECT_EQ(count({{10, 50}, {90, 50}, {50, 90}}), 2u);
  EXPECT_EQ(count({{10, 50}, {90, 50}, {50, 90}, {50, 10}}), 2u);
  EXPECT_EQ(count({{10, 50}, {90, 58}, {90, 52}}), 2u) << "the straighter one";
  EXPECT_EQ(count({{10, 50}, {90, 80}, {50, 90}}), 3u) << "37 degrees";
  EXPECT_EQ(count({{50, 10}, {85, 70}, {15, 70}}), 3u) << "the corner of a cube";
  std::vector<glm::dvec2> star;
  for (int i = 0; i < 8; ++i) star.emplace_back(50 + 40 * std::cos(i * 0.7854), 50 + 40 * std::sin(i * 0.7854));
  EXPECT_EQ(count(star), 4u);
  star.emplace_back(60, 95);
  EXPECT_EQ(count(star), 9u) << "more than eight ends";
  // A line of another class at the same place is no part of the junction.
  Sketch mixed;
  mixed.add(EdgeKind::crease, {{10, 50}, {50, 50}}).add(EdgeKind::crease, {{50, 50}, {90, 50}});
  mixed.add(EdgeKind::crease, {{50, 50}, {50, 90}}, true);
  EXPECT_EQ(mixed.strokes(0).strokes.size(), 2u);
}

TEST(Strokes, GoOnAcrossGaps) {
  const auto count = [](const std::vector<glm::dvec2>& one, const std::vector<glm::dvec2>& other, double joining) {
    return Sketch().add(EdgeKind::crease, one).add(EdgeKind::crease, other).strokes(0, false, joining).strokes.size();
  };
  EXPECT_EQ(count({{10, 50}, {50, 50}}, {{52, 50}, {90, 50}}, 3), 1u);
  EXPECT_EQ(count({{10, 50}, {50, 50}}, {{52, 50}, {90, 50}}, 1.9), 2u) << "too far";
  EXPECT_EQ(count({{10, 50}, {50, 50}}, {{90, 68}, {52, 51}}, 3), 1u) << "24 degrees";
  EXPECT_EQ(count({{10, 50}, {50, 50}}, {{52, 50}, {90, 80}}, 3), 2u) << "38 degrees";
  EXPECT_EQ(count({{10, 50}, {50, 50}}, {{10, 52}, {50, 52}}, 3), 2u) << "beside each other";
}

TEST(ShortStrokes, OfOneKindLinkOthers) {
  Sketch sketch;
  sketch.add(EdgeKind::silhouette, {{0, 0}, {100, 0}})
      .add(EdgeKind::crease, {{100, 0}, {102, 2}})
      .add(EdgeKind::silhouette, {{102, 2}, {200, 9}});
  EXPECT_EQ(sketch.strokes(kShortest, true).strokes.size(), 3u);
  EXPECT_NEAR(total_length(sketch.strokes(kShortest, true)), total_length(sketch.strokes(0, true)), 1e-9);
}

TEST(ShortStrokes, AreNotHeldByWhatIsHidden) {
  Sketch sketch;
  sketch.add(EdgeKind::silhouette, {{0, 0}, {100, 0}}, true)
      .add(EdgeKind::silhouette, {{100, 0}, {102, 0}})
      .add(EdgeKind::silhouette, {{102, 0}, {200, 0}}, true);
  const Strokes all = sketch.strokes();
  ASSERT_EQ(all.strokes.size(), 2u);
  EXPECT_TRUE(all.strokes[0].is_hidden && all.strokes[1].is_hidden);
}

/// Outlines of a scene of blocks: closed ones stay closed, whatever length counts as short.
TEST(ShortStrokes, NeverOpenAnOutline) {
  const Scene scene = builtin("gallery");
  const Surfaces surfaces(scene);
  LineOptions options;
  options.outlines = true;
  const View view = frame(surfaces, 400, 300);
  const Drawing drawing = draw_lines(surfaces, view, options);
  const auto outline_of = [&](double shortest) {
    StrokeOptions all;
    all.with_hidden = false;
    all.shortest = shortest;
    const Strokes found = chain_strokes(surfaces, drawing, all);
    double length = 0, closed = 0;
    for (const Stroke& stroke : found.strokes) {
      if (!stroke.is_outline) continue;
      for (std::uint32_t i = 0; i + (stroke.is_closed ? 0 : 1) < stroke.count; ++i)
        length += glm::distance(found.points[stroke.first + i], found.points[stroke.first + (i + 1) % stroke.count]);
      closed += stroke.is_closed;
    }
    return glm::dvec2(length, closed);
  };
  const glm::dvec2 whole = outline_of(0), less = outline_of(4);
  EXPECT_GT(whole.x, 100);
  EXPECT_GT(less.x, 0.995 * whole.x);
  EXPECT_EQ(less.y, whole.y);
}

TEST(ShortStrokes, TakeALimitFromZeroUp) {
  const Sketch sketch = Sketch().add(EdgeKind::crease, {{0, 0}, {1, 0}});
  for (const double wrong : {-1.0, 1e5, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW((void)sketch.strokes(wrong), Error);
}

TEST(ShortStrokes, ByTheThousandsTakeNoTime) {
  Sketch sketch;
  for (int i = 0; i < 20'000; ++i) {
    const double x = i % 200 * 10, y = i / 200 * 10;
    sketch.add(EdgeKind::crease, {{x, y}, {x + 1, y + 1}});
  }
  sketch.add(EdgeKind::crease, {{0, 0}, {2000, 1000}});
  EXPECT_EQ(sketch.strokes().strokes.size(), 1u);
}

}  // namespace
}  // namespace frontmost::test
