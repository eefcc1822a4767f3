// SPDX-License-Identifier: Apache-2.0
#include "surfaces/vertex_table.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

#include "support/seeds.h"

namespace frontmost::test {
namespace {

std::uint8_t intern(VertexTable& table, const glm::vec3& p) { return table.intern({p, 7}, p); }

TEST(VertexTable, GivesEveryPositionANumberOfItsOwn) {
  VertexTable table;
  std::mt19937 random(test::noted_seed(1));
  for (int round = 0; round < 200; ++round) {
    table.clear();
    std::set<int> numbers;
    for (std::size_t i = 0; i < Cluster::max_vertices; ++i) {
      const glm::vec3 p(float(random() % 100), float(round), float(i));
      EXPECT_EQ(table.find({p, 7}), VertexTable::none);  // whatever the table held before clear()
      const std::uint8_t number = intern(table, p);
      EXPECT_TRUE(numbers.insert(number).second);
      EXPECT_EQ(table[number], p);
      EXPECT_EQ(table.find({p, 7}), number);
      EXPECT_EQ(intern(table, p), number);
      EXPECT_EQ(table.size(), i + 1);
    }
  }
}

TEST(VertexTable, FindsNearlyAllVerticesAgain) {
  VertexTable table;
  std::mt19937 random(test::noted_seed(2));
  int lost = 0, looked_for = 0;
  for (int round = 0; round < 500; ++round) {
    table.clear();
    std::vector<glm::vec3> positions;
    for (int i = 0; i < Cluster::max_vertices; ++i)
      positions.push_back(glm::vec3(float(random()), float(random()), float(random())));
    for (const glm::vec3& p : positions) intern(table, p);
    for (const glm::vec3& p : positions) lost += table.find({p, 7}) == VertexTable::none, ++looked_for;
  }
  EXPECT_LT(lost, looked_for / 50);
}

TEST(VertexTable, TellsPositionsApartByTheirBits) {
  VertexTable table;
  const std::uint8_t zero = intern(table, {0, 0, 0}), minus = intern(table, {-0.0f, 0, 0});
  EXPECT_NE(zero, minus);
  EXPECT_EQ(intern(table, {0, 0, 0}), zero);
}

TEST(VertexTable, TellsInstancesApartThatMeet) {
  VertexTable table;
  const glm::vec3 mesh(1, 2, 3), world(4, 5, 6);
  const std::uint8_t one = table.intern({mesh, 0}, world), other = table.intern({mesh, 1}, world);
  EXPECT_NE(one, other);
  EXPECT_EQ(table[one], table[other]);
  EXPECT_EQ(table.find({mesh, 1}), other);
  EXPECT_EQ(table.find({mesh, 2}), VertexTable::none);
}

TEST(VertexTable, PadsToWholeVectorsWithinItsBounds) {
  VertexTable table;
  EXPECT_EQ(table.pad(), 0u);
  EXPECT_TRUE(table.bounds().is_empty());
  for (int i = 0; i < 17; ++i) intern(table, {float(i), float(-i), float(100 + i)});
  EXPECT_EQ(table.pad(), 32u);
  EXPECT_EQ(table.axis(0)[31], 16.0f);
  EXPECT_EQ(table.bounds().low, glm::vec3(0, -16, 100));
  EXPECT_EQ(table.bounds().high, glm::vec3(16, 0, 116));
}

}  // namespace
}  // namespace frontmost::test
