// SPDX-License-Identifier: Apache-2.0
#include "surfaces/cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "support/random_scene.h"

namespace frontmost::test {
namespace {

SpaceCell cell_at(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return {x | y << SpaceCell::y_shift | z << SpaceCell::z_shift};
}

TEST(SpaceCell, IsNearFromOneBeforeToTwoAfter) {
  for (const std::uint32_t at : {0u, 1u, 2u, 511u, 512u, 1021u, 1023u})
    for (int step = -4; step <= 4; ++step) {
      const int other = int(at) + step;
      if (other < 0 || other > 1023) continue;
      SCOPED_TRACE(testing::Message() << at << " and " << other);
      const bool expected = step >= -1 && step <= 2;
      const auto o = std::uint32_t(other);
      EXPECT_EQ(cell_at(at, 7, 9).is_near(cell_at(o, 7, 9)), expected);
      EXPECT_EQ(cell_at(7, at, 1023).is_near(cell_at(7, o, 1022)), expected);
      EXPECT_EQ(cell_at(0, 1023, at).is_near(cell_at(2, 1022, o)), expected);
    }
}

/// The formula of CellMap with sums in the same order, one triangle at a time.
SpaceCell expected_cell(const Mesh& mesh, const CellMap& map, std::uint32_t triangle) {
  const glm::uvec3& c = mesh.triangles[triangle];
  const glm::vec3 sum = mesh.positions[c.x] + mesh.positions[c.y] + mesh.positions[c.z];
  std::uint32_t place[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& row = map.rows[axis];
    const float at = ((row[0] * sum.x + row[1] * sum.y) + row[2] * sum.z) + row[3];
    place[axis] = std::uint32_t(at > 0 ? std::min(at, map.last) : 0.0f);
  }
  return cell_at(place[0], place[1], place[2]);
}

TEST(FindCells, EqualsThePlainFormulaForEveryInstructionSet) {
  Mesh mesh = random_mesh(Kind::shared_grid, 1003, 5);
  CellMap map{{{{40, 3, -2, 200}, {1, 50, 4, 300}, {-7, 2, 30, 100}}}, 511};
  for (const Isa isa : available_isas())
    for (const std::uint32_t begin : {0u, 5u})
      for (const std::uint32_t end : {5u, 6u, 40u, 1003u}) {
        SCOPED_TRACE(testing::Message() << name(isa) << ", " << begin << " to " << end);
        std::vector<SpaceCell> cells(end - begin + 1, SpaceCell{77});
        EXPECT_TRUE(find_cells({mesh, begin, end}, map, isa, cells.data()));
        for (std::uint32_t t = begin; t < end; ++t)
          ASSERT_EQ(cells[t - begin].packed, expected_cell(mesh, map, t).packed) << t;
        EXPECT_EQ(cells.back().packed, 77u);  // nothing is written beyond the last
      }
}

TEST(FindCells, TellsWhereACornerIsNotFinite) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {infinity, -infinity, std::nanf("")})
    for (const Isa isa : available_isas())
      for (const std::uint32_t at : {0u, 30u, 36u}) {
        Mesh mesh = random_mesh(Kind::soup, 37, 6);
        mesh.positions[mesh.triangles[at].y].z = bad;
        std::vector<SpaceCell> cells(37);
        const CellMap map{{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}, 1023};
        EXPECT_FALSE(find_cells({mesh, 0, 37}, map, isa, cells.data())) << name(isa) << ", " << at;
        EXPECT_LE(cells[at].z(), 1023u);
        if (at == 0) continue;
        EXPECT_TRUE(find_cells({mesh, 0, at}, map, isa, cells.data()));
      }
}

}  // namespace
}  // namespace frontmost::test
