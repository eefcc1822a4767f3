// SPDX-License-Identifier: Apache-2.0
// Merging the pictures of parts: known answers, and the laws that streaming and compositing rely on.
#include <gtest/gtest.h>

#include "frontmost/view.h"
#include "frontmost/zbuffer.h"
#include "support/random_scene.h"

namespace frontmost {
namespace {

View small_view(int width = 4, int samples = 1) {
  View view;
  view.width = width;
  view.height = 1;
  view.samples = samples;
  view.projection = make_projection(1.0, double(width), {0.5, 100});
  return view;
}

Visible of_samples(std::initializer_list<std::pair<float, PrimitiveId>> samples) {
  Visible visible = nothing_visible(small_view(int(samples.size())));
  std::size_t i = 0;
  for (const auto& [key, id] : samples) {
    visible.keys[i] = key;
    visible.primitives[i++] = id;
  }
  return visible;
}

void expect_same(const Visible& a, const Visible& b) {
  ASSERT_EQ(a.keys.size(), b.keys.size());
  for (std::size_t i = 0; i < a.keys.size(); ++i) {
    ASSERT_EQ(a.primitives[i], b.primitives[i]) << i;
    ASSERT_EQ(a.keys[i], b.keys[i]) << i;
  }
}

Visible merged(const Visible& a, const Visible& b) {
  Visible result = a;
  merge(result, b);
  return result;
}

constexpr PrimitiveId none = no_primitive;

TEST(Merge, TheNearerStaysAndOfEqualsTheLowerId) {
  const Visible a = of_samples({{0.5f, 3}, {0.25f, 3}, {0.5f, 7}, {0, none}, {0.5f, 1}});
  const Visible b = of_samples({{0.25f, 1}, {0.5f, 9}, {0.5f, 2}, {0.125f, 4}, {0, none}});
  expect_same(merged(a, b), of_samples({{0.5f, 3}, {0.5f, 9}, {0.5f, 2}, {0.125f, 4}, {0.5f, 1}}));
}

TEST(Merge, OnTheFarPlaneKeysAreZeroAndStillSeen) {
  expect_same(merged(of_samples({{0, none}}), of_samples({{0, 5}})), of_samples({{0, 5}}));
  expect_same(merged(of_samples({{0, 5}}), of_samples({{0, none}})), of_samples({{0, 5}}));
}

TEST(Merge, TheFirstIdIsAddedToWhatIsSeen) {
  Visible into = of_samples({{0.5f, 3}, {0, none}, {0, none}});
  merge(into, of_samples({{0.75f, 0}, {0.25f, 2}, {0, none}}), 100);
  expect_same(into, of_samples({{0.75f, 100}, {0.25f, 102}, {0, none}}));
}

TEST(Merge, ViewsMustBeTheSame) {
  Visible into = nothing_visible(small_view());
  View other = small_view();
  other.projection.clip.far = 200;
  EXPECT_THROW(merge(into, nothing_visible(other)), Error);
  EXPECT_THROW(merge(into, nothing_visible(small_view(8))), Error);
  EXPECT_THROW(merge(into, nothing_visible(small_view(4, 4))), Error);
  EXPECT_NO_THROW(merge(into, nothing_visible(small_view())));
}

std::span<const std::uint64_t> numbers(const Buffer<std::uint64_t>& packed) { return {packed.data(), packed.size()}; }

TEST(Pack, IsKeyBitsAboveAnInvertedId) {
  const Buffer<std::uint64_t> packed = pack(of_samples({{0.5f, 3}, {1, 0}, {0, none}, {0, 5}}), 100);
  EXPECT_EQ(packed[0], 0x3F000000'FFFFFF98u);
  EXPECT_EQ(packed[1], 0x3F800000'FFFFFF9Bu);
  EXPECT_EQ(packed[2], 0u);
  EXPECT_EQ(packed[3], 0x00000000'FFFFFF96u) << "on the far plane";
}

TEST(Pack, TheGreaterOfTwoIsWhatMergingKeeps) {
  const Visible a = of_samples({{0.5f, 3}, {0.25f, 3}, {0.5f, 7}, {0, none}, {0.5f, 1}, {0, 5}, {0, none}});
  const Visible b = of_samples({{0.25f, 1}, {0.5f, 9}, {0.5f, 2}, {0.125f, 4}, {0, none}, {0, none}, {0, none}});
  Buffer<std::uint64_t> greatest = pack(a), other = pack(b);
  for (std::size_t i = 0; i < greatest.size(); ++i) greatest[i] = std::max(greatest[i], other[i]);
  expect_same(unpack(a.view, numbers(greatest)), merged(a, b));
  expect_same(unpack(a.view, numbers(pack(a))), a);
}

TEST(Pack, OfPartsIsThatOfTheWhole) {
  const Scene whole = test::scene_of(test::random_mesh(test::Kind::coplanar, 400, 3));
  const View view = frame(Surfaces(whole), 100, 70, {.samples = 4});
  Buffer<std::uint64_t> greatest = pack(nothing_visible(view));
  for (const PrimitiveId first : {250u, 0u}) {
    Scene part = whole;
    std::vector<glm::uvec3>& triangles = part.meshes[0].triangles;
    triangles.erase(first ? triangles.begin() : triangles.begin() + 250,
                    first ? triangles.begin() + 250 : triangles.end());
    const Buffer<std::uint64_t> packed = pack(zbuffer(Surfaces(part), view), first, {.threads = 2});
    for (std::size_t i = 0; i < greatest.size(); ++i) greatest[i] = std::max(greatest[i], packed[i]);
  }
  expect_same(unpack(view, numbers(greatest), {.threads = 2}), zbuffer(Surfaces(whole), view));
}

TEST(Pack, RefusesWhatDoesNotFit) {
  EXPECT_EQ(pack(of_samples({{0.5f, 3}}), none - 4)[0] & 0xFFFFFFFFu, 1u);
  EXPECT_THROW((void)pack(of_samples({{0.5f, 4}}), none - 4), Error);
  EXPECT_THROW((void)pack(of_samples({{0.5f, 4}}), none), Error);
  EXPECT_NO_THROW((void)pack(of_samples({{0, none}}), none)) << "nothing has no id";
  Visible moved = of_samples({{0.5f, 3}});
  const Visible taken = std::move(moved);
  EXPECT_THROW((void)pack(moved), Error);
  const std::vector<std::uint64_t> two = {0, 0}, wild = {0x3F800001'00000000u}, negative = {0x80000000'00000000u};
  EXPECT_THROW((void)unpack(small_view(1), two), Error);
  EXPECT_THROW((void)unpack(small_view(1), wild), Error);
  EXPECT_THROW((void)unpack(small_view(1), negative), Error);
}

TEST(Merge, IdsDoNotRunOver) {
  Visible into = nothing_visible(small_view(1));
  merge(into, of_samples({{0.5f, 3}}), none - 4);
  EXPECT_EQ(into.primitives[0], none - 1);
  EXPECT_THROW(merge(into, of_samples({{0.5f, 4}}), none - 4), Error);
}

/// A scene's triangles distributed over parts, each a scene of its own.
std::vector<Scene> cut(const Scene& whole, std::size_t triangles_at_once) {
  std::vector<Scene> parts;
  const Mesh& mesh = whole.meshes.at(0);
  for (std::size_t begin = 0; begin < mesh.triangles.size(); begin += triangles_at_once) {
    Scene& part = parts.emplace_back(whole);
    const auto first = mesh.triangles.begin() + std::ptrdiff_t(begin);
    const std::size_t count = std::min(triangles_at_once, mesh.triangles.size() - begin);
    part.meshes[0].triangles.assign(first, first + std::ptrdiff_t(count));
  }
  return parts;
}

TEST(Merge, PartsMergedInAnyOrderAreTheWhole) {
  std::uint64_t seed = 0;
  for (const test::Kind kind : test::all_kinds) {
    SCOPED_TRACE(++seed);
    const Scene scene = test::scene_of(test::random_mesh(kind, 300, seed));
    const Surfaces surfaces(scene);
    test::Random random(seed);
    View view = test::random_view(random, 61, 47);
    view.samples = seed % 2 ? 4 : 1;
    const Visible whole = zbuffer(surfaces, view);
    const std::vector<Scene> parts = cut(scene, 37);
    Visible forwards = nothing_visible(view), backwards = nothing_visible(view);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::size_t last = parts.size() - 1 - i;
      merge(forwards, zbuffer(Surfaces(parts[i]), view), PrimitiveId(37 * i));
      merge(backwards, zbuffer(Surfaces(parts[last]), view), PrimitiveId(37 * last), {.threads = 2});
    }
    expect_same(forwards, whole);
    expect_same(backwards, whole);
    merge(forwards, whole);  // idempotent
    expect_same(forwards, whole);
  }
}

}  // namespace
}  // namespace frontmost
