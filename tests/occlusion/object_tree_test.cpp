// SPDX-License-Identifier: Apache-2.0
// Many objects: the tree of groups gives the answers of a loop over all objects.
#include "occlusion/object_tree.h"

#include <gtest/gtest.h>

#include "occlusion/by_hand.h"
#include "occlusion/hidden_scene.h"
#include "support/effort.h"

namespace frontmost {
namespace {

using namespace test;
using namespace occlusion_detail;

std::vector<Box> random_boxes(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Box> boxes(count);
  for (Box& box : boxes) {
    if (random.below(20) == 0) continue;  // an empty box
    const glm::vec3 at = random.point(9);
    box.include(at);
    box.include(at + glm::abs(random.point(random.below(20) == 0 ? 5.0f : 0.2f)));
  }
  return boxes;
}

/// Adds the objects below an item to `found`. Checks that every box is the union of those below it.
Box spanned_by(const ObjectTree& tree, std::uint32_t item, std::vector<std::uint32_t>& found) {
  const std::size_t before = found.size();
  Box box;
  if (tree.is_object(item)) {
    found.push_back(tree.object(item));
    if (!tree.boxes().is_empty(item)) box = tree.boxes().get(item);
    return box;
  }
  const ItemRange items = tree.items_of(item), objects = tree.objects_of(item);
  for (std::uint32_t i = items.first; i < items.end(); ++i) box.include(spanned_by(tree, i, found));
  EXPECT_EQ(tree.boxes().is_empty(item), box.is_empty());
  if (!box.is_empty()) {
    EXPECT_EQ(tree.boxes().get(item).low, box.low);
    EXPECT_EQ(tree.boxes().get(item).high, box.high);
  }
  EXPECT_EQ(objects.count, found.size() - before);
  for (std::uint32_t i = 0; i < objects.count; ++i) EXPECT_EQ(tree.object(objects.first + i), found[before + i]);
  return box;
}

void expect_tree_of(const ObjectTree& tree, const std::vector<Box>& boxes) {
  std::vector<std::uint32_t> all, on_top;
  static_cast<void>(spanned_by(tree, tree.root(), all));
  for (std::uint32_t i = tree.top().first; i < tree.top().end(); ++i) static_cast<void>(spanned_by(tree, i, on_top));
  EXPECT_EQ(all, on_top);
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    const Box& box = boxes[all[i]];
    ASSERT_EQ(tree.boxes().is_empty(i), box.is_empty());
    if (!box.is_empty()) {
      ASSERT_EQ(tree.boxes().get(i).low, box.low);
    }
  }
  std::sort(all.begin(), all.end());
  for (std::uint32_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i], i);
  ASSERT_EQ(all.size(), boxes.size());
}

TEST(ObjectTree, EveryObjectIsThereOnceAndBoxesHoldWhatIsBelowThem) {
  for (const std::size_t count : {1, 15, 16, 17, 64, 65, 256, 257, 1025, 5000}) {
    SCOPED_TRACE(count);
    const std::vector<Box> boxes = random_boxes(count, count);
    const ObjectTree tree(boxes);
    EXPECT_LE(tree.top().count, ObjectTree::most_on_top);
    ASSERT_NO_FATAL_FAILURE(expect_tree_of(tree, boxes));
  }
  EXPECT_EQ(ObjectTree(std::span<const Box>()).item_count(), 0u);
}

TEST(ObjectTree, BoxesFollowWhatMoves) {
  std::vector<Box> boxes = random_boxes(3000, 1);
  ObjectTree tree(boxes);
  Random random(7);
  for (int step = 0; step < 20; ++step) {
    const std::vector<Box> others = random_boxes(40, std::uint64_t(step));
    for (const Box& box : others) {
      const auto object = std::uint32_t(random.below(3000));
      boxes[object] = box;
      tree.move(object, box);
    }
    tree.refit();
    ASSERT_NO_FATAL_FAILURE(expect_tree_of(tree, boxes)) << step;
  }
  EXPECT_FALSE(tree.is_outdated());
}

TEST(ObjectTree, NeighboursAreInOneGroup) {
  std::vector<Box> boxes;
  for (int i = 0; i < 4096; ++i) {
    // The objects are in a scrambled order.
    const int place = i * 2731 % 4096;
    const glm::vec3 at(place % 64, 0, place / 64);
    boxes.push_back({at, at + 0.9f});
  }
  const ObjectTree tree(boxes);
  for (std::uint32_t group = 4096; group < 4096 + 256; ++group) EXPECT_LT(tree.boxes().get(group).diagonal(), 16);
}

TEST(ObjectTree, CullingByGroupsSaysWhatALoopOverObjectsSays) {
  std::size_t hidden = 0, outside = 0, seen = 0;
  for (std::uint64_t seed = 0; seed < seeds(40); ++seed) {
    Scene scene = hidden_scene(1500, seed + 2000);
    scene.instances[3].mesh = std::uint32_t(scene.meshes.size());
    scene.meshes.emplace_back();  // a mesh without triangles
    const Surfaces surfaces(scene);
    const View view = random_view(97, 61, seed);
    const int cell = 1 + int(seed % 3);
    Occlusion occlusion(surfaces);
    const auto sights = occlusion.cull(view, {.cell = cell});
    const auto by_hand = sights_by_hand(surfaces, view, cell, Ends::count);
    ASSERT_TRUE(std::equal(by_hand.begin(), by_hand.end(), sights.begin())) << seed;
    hidden += count_of(sights, ObjectSight::hidden);
    outside += count_of(sights, ObjectSight::outside);
    seen += count_of(sights, ObjectSight::may_be_seen);
  }
  EXPECT_GT(hidden, seeds(40) * 300);
  EXPECT_GT(outside, seeds(40) * 100);
  EXPECT_GT(seen, seeds(40) * 30);
}

TEST(ObjectTree, CullingFollowsCrowdsThatMoveUntilTheirOrderIsMadeAnew) {
  for (std::uint64_t seed = 0; seed < seeds(4); ++seed) {
    Scene scene = hidden_scene(600, seed + 3000);
    Surfaces surfaces(scene);
    Occlusion kept(surfaces);
    Random random(seed);
    for (int step = 0; step < 12; ++step) {
      // Moves a few objects, or all of them several times.
      for (int moves = step % 4 == 3 ? 1500 : 1 + random.below(200); moves > 0; --moves)
        surfaces.move(scene, std::uint32_t(random.below(600)), random_placement(random, 2, 0.3f));
      const View view = random_view(97, 61, seed + 40 * std::uint64_t(step));
      const auto sights = kept.cull(view, {.cell = 1});
      const auto by_hand = sights_by_hand(surfaces, view, 1, Ends::count);
      ASSERT_TRUE(std::equal(by_hand.begin(), by_hand.end(), sights.begin())) << seed << " " << step;
    }
  }
}

TEST(ObjectTree, WhatIsTooLargeForFloatsDoesNotPutItsNeighboursOutside) {
  const Scene scene = hidden_scene(300, 5);
  const Surfaces without_it(scene);
  for (const glm::vec3& half : {glm::vec3(3e38f, 3e38f, 1.0f), glm::vec3(3.4e38f)}) {
    Scene with_it = scene;
    with_it.instances.push_back({"", std::uint32_t(with_it.meshes.size()), glm::dmat4(1.0)});
    with_it.instances.back().world_from_mesh[3].z = -20;
    with_it.meshes.push_back(tessellated_box(half, 1, 0));
    const Surfaces surfaces(with_it);
    Occlusion occlusion(surfaces), without(without_it);
    for (std::uint64_t seed = 0; seed < 9; ++seed) {
      View view = random_view(97, 61, seed);
      // The plate is all at one depth, and only one of its sums across overflows.
      if (seed == 0) view = make_view(1, 97, 61).looking({0, 0, 19}, {0, 0, 0}, {0.3, 1, 0}).between(0.1, 80);
      const auto sights = occlusion.cull(view, {.cell = 1}), expected = without.cull(view, {.cell = 1});
      EXPECT_EQ(sights.back(), ObjectSight::may_be_seen) << seed;
      for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_EQ(sights[i] == ObjectSight::outside, expected[i] == ObjectSight::outside) << seed << " " << i;
    }
  }
}

}  // namespace
}  // namespace frontmost
