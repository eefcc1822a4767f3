// SPDX-License-Identifier: Apache-2.0
// T-junctions, with and without filling triangles of zero area.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "frontmost/lines.h"
#include "lines/mesh/mesh.h"
#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using namespace lines_detail;

View junction_view(const glm::dvec3& eye) {
  View view;
  view.width = view.height = 200;
  view.world_from_eye = look_at(eye, glm::dvec3(0), {0, 1, 0});
  view.projection = make_projection(0.8, 1, {0.5, 100});
  return view;
}

/// Every edge with its visible parts, in an order that does not depend on the triangles' order. Ends of parts are
/// rounded, as other triangulations of the same planes have other vertices.
using Line = std::tuple<double, double, double, double, double, double, EdgeKind, double, double, std::uint32_t>;
std::vector<Line> lines_of(const Mesh& mesh, const View& view, const LineOptions& options) {
  const Scene scene = scene_of(mesh);
  const Drawing drawing = draw_lines(Surfaces(scene), view, options);
  const auto rounded = [](double t) { return std::round(t * 1e9) / 1e9; };
  std::vector<Line> all;
  for (const DrawnPart& part : drawing.parts) {
    const DrawnEdge& e = drawing.edges[part.edge];
    all.emplace_back(e.from.x, e.from.y, e.from.z, e.to.x, e.to.y, e.to.z, e.kind, rounded(part.begin),
                     rounded(part.end), part.hidden_by);
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// A triangle over the line from (-2, 0, 0) to (2, 0, 0), and below it one triangle for every interval between
/// `corners`, turned about the line by the folded height.
struct Junction {
  std::vector<float> corners;  ///< ascending, with both ends
  Mesh mesh;

  Junction(std::vector<float> places, float depth) : corners(std::move(places)) {
    for (const float x : corners) mesh.positions.emplace_back(x, 0.0f, 0.0f);
    mesh.positions.insert(mesh.positions.end(), {{0, 2, 0}, {0, depth == 0 ? -2.0f : 0.0f, depth}});
    const auto last = std::uint32_t(corners.size() - 1);
    mesh.triangles.push_back({0, last, last + 1});
    for (std::uint32_t i = 0; i < last; ++i) mesh.triangles.push_back({i + 1, i, last + 2});
  }
  void fill(std::uint32_t a, std::uint32_t b, std::uint32_t c) { mesh.triangles.push_back({a, b, c}); }
  [[nodiscard]] Drawing drawing(double crease_angle = 0) const {
    const Scene scene = scene_of(mesh);
    return draw_lines(Surfaces(scene), junction_view({1, 3, 9}), {.crease_angle = crease_angle});
  }
};

/// Number and total length of the drawn edges along the junction; edges elsewhere are the outline.
std::pair<std::size_t, double> along_x(const Drawing& drawing) {
  std::pair<std::size_t, double> found{0, 0};
  for (const DrawnEdge& edge : drawing.edges) {
    if (edge.from.y != 0 || edge.to.y != 0 || edge.from.z != 0 || edge.to.z != 0) continue;
    ++found.first;
    found.second += std::abs(edge.to.x - edge.from.x);
  }
  return found;
}

TEST(Seams, OfOnePlaneDrawNothing) {
  for (int turn = 0; turn < 6; ++turn) {
    Junction junction({-2, 0.5f, 2}, 0);
    constexpr std::uint32_t orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    junction.fill(orders[turn][0], orders[turn][1], orders[turn][2]);
    const Drawing drawing = junction.drawing();
    EXPECT_EQ(along_x(drawing).first, 0u);
    EXPECT_EQ(drawing.edges.size(), 4u);
    for (const DrawnEdge& edge : drawing.edges) EXPECT_EQ(edge.kind, EdgeKind::boundary);
  }
}

TEST(Seams, OfTwoPlanesDrawTheirCreaseOnce) {
  Junction junction({-2, 0.5f, 2}, 2);
  junction.fill(2, 1, 0);
  const Drawing drawing = junction.drawing();
  EXPECT_EQ(along_x(drawing), std::make_pair(std::size_t(2), 4.0));
  for (const DrawnEdge& edge : drawing.edges) {
    if (edge.from.y != 0 || edge.to.y != 0 || edge.from.z != 0 || edge.to.z != 0) continue;
    EXPECT_EQ(edge.kind, EdgeKind::crease);
    EXPECT_EQ(std::min(edge.left, edge.right), 0u);  // the long triangle's, by its own number
    EXPECT_LE(std::max(edge.left, edge.right), 2u);  // not the filler's
  }
  EXPECT_EQ(along_x(junction.drawing(1.6)).first, 0u);  // a right angle is not drawn
}

TEST(Seams, OfASilhouetteAreSilhouettes) {
  Junction junction({-2, -1, 2}, -4);  // the lower side turns away from the eye
  junction.mesh.positions.back().y = 1;
  junction.fill(0, 2, 1);
  for (const DrawnEdge& edge : junction.drawing().edges)
    if (edge.from.y == 0 && edge.to.y == 0 && edge.from.z == 0 && edge.to.z == 0) {
      EXPECT_EQ(edge.kind, EdgeKind::silhouette);
    }
  EXPECT_EQ(along_x(junction.drawing()), std::make_pair(std::size_t(2), 4.0));
}

TEST(Seams, OfManyFillersInAnyPattern) {
  const std::vector<float> corners = {-2, -1.5f, -0.25f, 0.5f, 2};
  using Fillers = std::vector<glm::uvec3>;
  const std::vector<Fillers> patterns = {{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}},
                                         {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}},
                                         {{0, 2, 4}, {0, 1, 2}, {2, 3, 4}},
                                         {{0, 3, 4}, {1, 3, 0}, {2, 1, 3}},
                                         // one more triangle, which shares no edge with others
                                         {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {1, 2, 3}}};
  for (const float depth : {0.0f, 2.0f})
    for (const Fillers& fillers : patterns) {
      Junction junction(corners, depth);
      for (const glm::uvec3& f : fillers) junction.fill(f.x, f.y, f.z);
      const auto [count, length] = along_x(junction.drawing());
      EXPECT_EQ(count, depth == 0 ? 0u : 4u);
      EXPECT_EQ(length, depth == 0 ? 0.0 : 4.0);
    }
}

TEST(Seams, AtABoundaryAreDrawnOnce) {
  Junction junction({-2, -1, 1, 2}, 0);
  junction.mesh.triangles.resize(1);
  junction.fill(0, 1, 3);
  junction.fill(1, 2, 3);
  const Drawing drawing = junction.drawing();
  EXPECT_EQ(along_x(drawing), std::make_pair(std::size_t(3), 4.0));
  EXPECT_EQ(drawing.edges.size(), 5u);
  // A filler without neighbours leaves no edges.
  junction.mesh.triangles.erase(junction.mesh.triangles.begin());
  EXPECT_TRUE(junction.drawing().edges.empty());
}

TEST(Seams, WithoutFillersAreOpen) {
  const Junction junction({-2, 0.5f, 2}, 0);
  EXPECT_EQ(along_x(junction.drawing()), std::make_pair(std::size_t(3), 8.0));
}

TEST(Seams, TrianglesWithTwoCornersAtOnePlaceChangeNothing) {
  Junction junction({-2, 0.5f, 2}, 2);
  junction.fill(0, 1, 2);
  const Drawing before = junction.drawing();
  junction.mesh.positions.push_back(junction.mesh.positions[1]);
  const auto copy = std::uint32_t(junction.mesh.positions.size() - 1);
  junction.fill(0, 0, 2);
  junction.fill(0, 1, copy);
  junction.fill(copy, 1, 1);
  const Drawing after = junction.drawing();
  ASSERT_EQ(after.edges.size(), before.edges.size());
  for (std::size_t i = 0; i < after.edges.size(); ++i) EXPECT_EQ(after.edges[i].kind, before.edges[i].kind);
}

TEST(Seams, AllButStraightTrianglesAreNoFillers) {
  Junction junction({-2, 0.5f, 2}, 0);
  junction.mesh.positions[1].y = 1e-30f;
  junction.fill(0, 1, 2);
  EXPECT_GT(along_x(junction.drawing()).first, 0u);
}

/// A surface whose triangle edges carry additional vertices. Some triangles are filled up to these by slivers, others
/// are split into smaller triangles at them.
class Patchwork {
 public:
  Patchwork(std::uint64_t seed, bool is_filled) : random_(seed), choices_(seed + 1000), is_filled_(is_filled) {
    constexpr int size = 5;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const float height = float(random_.below(3));
        mesh.positions.emplace_back(float(x - size / 2), height / 2, float(y - size / 2));
      }
    for (int y = 0; y + 1 < size; ++y)
      for (int x = 0; x + 1 < size; ++x) {
        const auto a = std::uint32_t(y * size + x), b = a + 1, c = a + size, d = c + 1;
        add(a, c, b);
        add(b, c, d);
      }
  }

  Mesh mesh;

 private:
  using Chain = std::vector<std::uint32_t>;

  /// The vertices from a to b, the same for both triangles at the edge.
  Chain chain(std::uint32_t a, std::uint32_t b) {
    const std::pair<std::uint32_t, std::uint32_t> side{std::min(a, b), std::max(a, b)};
    const auto [at, is_new] = chains_.try_emplace(side);
    if (is_new) {
      at->second.push_back(side.first);
      const glm::vec3 from = mesh.positions[side.first], to = mesh.positions[side.second];
      for (int eighth = 1; eighth < 8; ++eighth) {
        if (random_.below(4) != 0) continue;
        at->second.push_back(std::uint32_t(mesh.positions.size()));
        mesh.positions.push_back(from + (to - from) * (float(eighth) / 8));  // exactly on the side
      }
      at->second.push_back(side.second);
    }
    Chain found = at->second;
    if (a > b) std::reverse(found.begin(), found.end());
    return found;
  }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Chain sides[3] = {chain(a, b), chain(b, c), chain(c, a)};
    const bool is_long = random_.below(2) == 0;
    if (is_long && is_filled_) {
      mesh.triangles.push_back({a, b, c});
      for (const Chain& side : sides) fill(side, 0, side.size() - 1);
      return;
    }
    // A fan over the vertices of the first edge to the next one's last, then the rest of the other two edges.
    for (std::size_t i = 0; i + 1 < sides[0].size(); ++i) mesh.triangles.push_back({sides[0][i], sides[0][i + 1], c});
    split_last(sides[1]);
    split_last(sides[2]);
  }

  /// The vertices on an edge split the last piece once more.
  void split_last(const Chain& side) {
    if (side.size() == 2) return;
    // The piece with the whole edge.
    const std::uint32_t from = side.front(), to = side.back();
    for (std::size_t t = mesh.triangles.size(); t-- > 0;) {
      const glm::uvec3 corners = mesh.triangles[t];
      for (int k = 0; k < 3; ++k) {
        if (corners[k] != from || corners[(k + 1) % 3] != to) continue;
        mesh.triangles.erase(mesh.triangles.begin() + std::ptrdiff_t(t));
        for (std::size_t i = 0; i + 1 < side.size(); ++i)
          mesh.triangles.push_back({side[i], side[i + 1], corners[(k + 2) % 3]});
        return;
      }
    }
    FAIL() << "no piece has the side";
  }

  void fill(const Chain& side, std::size_t first, std::size_t last) {
    if (last - first < 2) return;
    const std::size_t middle = first + 1 + std::size_t(choices_.below(int(last - first) - 1));
    mesh.triangles.push_back({side[last], side[middle], side[first]});
    fill(side, first, middle);
    fill(side, middle, last);
  }

  Random random_, choices_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Chain> chains_;
  const bool is_filled_;
};

void expect_same(const std::vector<Line>& lines, const std::vector<Line>& expected) {
  std::vector<Line> only;
  std::set_symmetric_difference(lines.begin(), lines.end(), expected.begin(), expected.end(), std::back_inserter(only));
  EXPECT_TRUE(only.empty()) << only.size() << " of " << expected.size() << ", the first one "
                            << testing::PrintToString(only[0]);
}

TEST(Seams, AreDrawnAsWhatMeetsCornerToCorner) {
  std::size_t fillers = 0, drawn = 0;
  for (std::uint64_t seed = 0; seed < seeds(60); ++seed) {
    SCOPED_TRACE(seed);
    const Mesh filled = Patchwork(seed, true).mesh, cut = Patchwork(seed, false).mesh;
    ASSERT_EQ(filled.positions, cut.positions);
    Random random(seed + 7);
    const View view = random_view(random, 200, 160);
    for (const bool counts : {false, true}) {
      const LineOptions options{.crease_angle = seed % 2 == 0 ? 0.0 : 0.6, .counts_hidden = counts};
      const std::vector<Line> lines = lines_of(filled, view, options);
      expect_same(lines, lines_of(cut, view, options));
      drawn += lines.size();
    }
    for (const glm::uvec3& t : filled.triangles) {
      const glm::dvec3 a(filled.positions[t.x]), b(filled.positions[t.y]), c(filled.positions[t.z]);
      fillers += glm::cross(b - a, c - a) == glm::dvec3(0);
    }
  }
  EXPECT_GT(fillers, seeds(60) * 20);
  EXPECT_GT(drawn, seeds(60) * 50);
}

WeldedMesh closed(const Mesh& mesh) {
  const Scene scene = scene_of(mesh);
  WeldedMesh welded = weld(Surfaces(scene), {});
  const Buffer<std::int8_t> edge_on(welded.triangles.size(), 0);
  (void)close_seams(welded, edge_on, {});
  return welded;
}

TEST(Seams, SplitTheSameTriangleTheSameWay) {
  Junction junction({-2, -1, 0, 1, 2}, 0);
  junction.mesh.triangles.resize(1);
  junction.fill(0, 1, 4);
  junction.fill(1, 2, 4);
  junction.fill(2, 3, 4);
  const std::vector<glm::uvec3> one = junction.mesh.triangles;
  const WeldedMesh once = closed(junction.mesh);
  junction.mesh.triangles.push_back({one[0].y, one[0].z, one[0].x});
  const WeldedMesh twice = closed(junction.mesh);
  ASSERT_EQ(once.triangles.size(), 4u);
  ASSERT_EQ(twice.triangles.size(), 8u);
  const auto corners = [](glm::uvec3 t) {
    std::sort(&t.x, &t.x + 3);
    return std::make_tuple(t.x, t.y, t.z);
  };
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(corners(twice.triangles[i]), corners(twice.triangles[i + 4]));
    EXPECT_EQ(twice.ids[i], 0u);
    EXPECT_EQ(twice.ids[i + 4], 4u);
  }
}

TEST(Seams, ThatWouldBeTheSquareOfTheirPagesStayOpen) {
  // One spine has as many pages as vertices.
  constexpr std::uint32_t count = 3000;
  Mesh mesh;
  for (std::uint32_t i = 0; i <= count; ++i) mesh.positions.emplace_back(float(i), 0.0f, 0.0f);
  for (std::uint32_t i = 0; i < count; ++i) {
    mesh.positions.emplace_back(float(i), 1.0f, float(i) * float(i));
    mesh.triangles.push_back({0, count, count + 1 + i});
    if (i > 0) mesh.triangles.push_back({i, count, i == 1 ? 0 : i - 1});
  }
  EXPECT_EQ(closed(mesh).triangles.size(), count);
  // With few pages, the seams are closed.
  Mesh few = mesh;
  few.triangles.clear();
  for (const glm::uvec3& t : mesh.triangles)
    if (t.z <= count + 20) few.triangles.push_back(t);
  EXPECT_EQ(closed(few).triangles.size(), 20u * count);
}

/// A strip of fillers along one line.
TEST(Seams, AskOftenWhetherToStop) {
  const std::uint32_t count = tries_little ? 40000 : 200000;
  Buffer<glm::vec3> places(count + 2);
  WeldedMesh mesh;
  mesh.triangles = Buffer<glm::uvec3>(count);
  mesh.ids = Buffer<PrimitiveId>(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    mesh.triangles[i] = {i, i + 1, i + 2};
    mesh.ids[i] = i;
  }
  for (std::uint32_t i = 0; i < count + 2; ++i) places[i] = {float(i), 0.0f, 0.0f};
  mesh.positions = Positions(std::move(places));
  const CountingWatch watch;
  EXPECT_TRUE(close_seams(mesh, Buffer<std::int8_t>(count, 0), watch.execution()));
  EXPECT_EQ(mesh.triangles.size(), 0u);
  // Edges are sorted, three for each filler, and then their ends.
  EXPECT_GT(watch.asked(), 6 * count / 32768);
}

}  // namespace
}  // namespace frontmost::test
