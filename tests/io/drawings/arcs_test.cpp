// SPDX-License-Identifier: Apache-2.0
// Arcs in the formats that have them: their direction, their length, and which curves are one arc.
#include <cmath>
#include <sstream>

#include "io/drawings/sample_page.h"

namespace frontmost::test {
namespace {

struct Round {
  std::vector<glm::dvec2> points;
  std::vector<double> bulges;
  bool is_closed = false;
};

std::string file_of(const Round& round, PageFormat format) {
  Page page{100, 100, "", {}};
  PageGroup group{"", {}};
  group.add(round.points, round.is_closed);
  group.bulges = round.bulges;
  page.layers = {{"", {group}}};
  return saved(page, format);
}

/// The first entity of a DXF, and its angles in degrees.
struct DxfArc {
  std::string kind;
  double begin = -1, end = -1;
};

DxfArc dxf_of(const Round& round) {
  const std::string dxf = file_of(round, PageFormat::dxf);
  std::istringstream pairs(dxf.substr(dxf.find("ENTITIES\n") + 9));
  DxfArc first;
  std::string code, value;
  while (std::getline(pairs, code) && std::getline(pairs, value) && (code != "0" || first.kind.empty())) {
    if (code == "0") first.kind = value;
    if (code == "50") first.begin = std::stod(value);
    if (code == "51") first.end = std::stod(value);
  }
  return first;
}

std::string svg_of(const Round& round) {
  const std::string svg = file_of(round, PageFormat::svg);
  const std::size_t begin = svg.find(" d=\"") + 4;
  return svg.substr(begin, svg.find('"', begin) - begin);
}

const double quarter = std::tan(std::acos(-1.0) / 8);

TEST(Arcs, TurnEitherWay) {
  // Arcs about (50, 20) with y down, from the right: a quarter on to below, and a quarter back to above.
  const Round on{{{60, 20}, {50, 30}}, {quarter, 0}}, back{{{60, 20}, {50, 10}}, {-quarter, 0}};
  EXPECT_EQ(svg_of(on), "M60 20a10 10 0 0 1-10 10");
  EXPECT_EQ(svg_of(back), "M60 20a10 10 0 0 0-10-10");
  // DXF has y up, and its arcs run anticlockwise.
  EXPECT_EQ(dxf_of(on).begin, 270);
  EXPECT_EQ(std::fmod(dxf_of(on).end, 360), 0);
  EXPECT_EQ(std::fmod(dxf_of(back).begin, 360), 0);
  EXPECT_EQ(dxf_of(back).end, 90);
}

TEST(Arcs, OfMoreThanHalfACircleTakeTheLongWay) {
  const double three_quarters = std::tan(3 * std::acos(-1.0) / 8), a_little_more = std::tan(0.26 * std::acos(-1.0));
  EXPECT_EQ(svg_of({{{60, 20}, {50, 10}}, {three_quarters, 0}}), "M60 20a10 10 0 1 1-10-10");
  EXPECT_NE(svg_of({{{60, 20}, {40, 20}}, {a_little_more, 0}}).find(" 0 1 1-20 0"), std::string::npos);
  EXPECT_NE(svg_of({{{60, 20}, {40, 20}}, {1 / a_little_more, 0}}).find(" 0 0 1-20 0"), std::string::npos);
}

TEST(Arcs, AsFlatAsCoordinatesAreRoundedAreLines) {
  // The bulge is the height divided by half the chord: 0.002 and 0.00005 mm.
  EXPECT_NE(svg_of({{{10, 10}, {30, 10}}, {2e-4, 0}}).find('a'), std::string::npos);
  EXPECT_EQ(svg_of({{{10, 10}, {30, 10}}, {5e-6, 0}}), "M10 10l20 0");
}

TEST(Arcs, OfOneCircleAreOneInDxf) {
  EXPECT_EQ(dxf_of({{{60, 20}, {50, 30}, {40, 20}}, {quarter, quarter, 0}}).kind, "ARC");
  EXPECT_EQ(dxf_of({{{60, 20}, {40, 20}}, {1, 1}, true}).kind, "CIRCLE");
  // Centres or radii differ by more than rounding.
  EXPECT_EQ(dxf_of({{{60, 20}, {50, 30}, {40, 20.05}}, {quarter, quarter, 0}}).kind, "LWPOLYLINE");
  // One path goes forth and back, another one and a half times around.
  EXPECT_EQ(dxf_of({{{60, 20}, {40, 20}, {60, 20}}, {1, -1, 0}}).kind, "LWPOLYLINE");
  EXPECT_EQ(dxf_of({{{60, 20}, {40, 20}, {60, 20}, {40, 20}}, {1, 1, 1, 0}}).kind, "LWPOLYLINE");
  // A path of an arc and a line.
  EXPECT_EQ(dxf_of({{{60, 20}, {50, 30}, {40, 20}}, {quarter, 0, 0}}).kind, "LWPOLYLINE");
}

}  // namespace
}  // namespace frontmost::test
