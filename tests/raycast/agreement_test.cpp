// SPDX-License-Identifier: Apache-2.0
// The ray caster and the z-buffer share no code; every difference between them has a reason.

#include <gtest/gtest.h>

#include <algorithm>

#include "frontmost/files.h"
#include "frontmost/precision.h"
#include "frontmost/raycast.h"
#include "frontmost/zbuffer.h"
#include "support/effort.h"
#include "support/models.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

Agreement expect_explained(const Surfaces& surfaces, const View& view) {
  Agreement answer = check_agreement(surfaces, zbuffer(surfaces, view), raycast(surfaces, view));
  const auto first = std::find(answer.differences.begin(), answer.differences.end(), Difference::unexplained);
  const auto sample = std::size_t(first - answer.differences.begin()), pixel = sample % view.pixel_count();
  EXPECT_EQ(answer.count(Difference::unexplained), 0u)
      << "first at pixel " << pixel % std::size_t(view.width) << ", " << pixel / std::size_t(view.width) << ", sample "
      << sample / view.pixel_count();
  return answer;
}

class EveryKindAgrees : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Agreement, EveryKindAgrees, testing::ValuesIn(all_kinds));

TEST_P(EveryKindAgrees, WithTheZBuffer) {
  // Exact arithmetic decides most pixels of stacked sheets.
  const std::uint64_t count = seeds(GetParam() == Kind::sheets ? 8 : 40);
  std::size_t differing = 0, samples = 0;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const RandomCase random = random_case(GetParam(), seed, 900);
    const Surfaces surfaces(random.scene);
    const View& view = random.view;
    differing += expect_explained(surfaces, view).differing();
    samples += view.sample_count();
  }
  EXPECT_GT(samples, count * 5'000);
  // Coplanar triangles and stacked sheets coincide: either may be seen everywhere.
  const bool are_one = GetParam() == Kind::coplanar || GetParam() == Kind::sheets;
  const std::size_t most = are_one ? samples / 10 : samples / 50;
  EXPECT_LT(differing, most) << "reasons have become the excuse";
}

TEST(Agreement, OnBuiltInScenes) {
  for (const std::string_view name : builtin_names()) {
    SCOPED_TRACE(std::string(name));
    const Scene scene = builtin(name);
    const Surfaces surfaces(scene);
    if (surfaces.primitive_count() > 2'000'000) continue;
    for (const bool orthographic : {false, true}) {
      FrameOptions options;
      options.orthographic = orthographic;
      const View view = frame(surfaces, 640, 480, options);
      EXPECT_LT(expect_explained(surfaces, view).differing(), view.pixel_count() / 200);
    }
  }
}

TEST(Agreement, OnModels) {
  FRONTMOST_NEEDS_MODELS();
  for (const char* file :
       {"organic/stanford-bunny.obj", "organic/lucy-100k.ply", "organic/dragon-800k.ply", "cad/crank-arm.stl",
        "cad/propeller-ascii.stl", "assembly/as1.glb", "assembly/2-cylinder-engine.glb", "difficult/soup.stl",
        "difficult/quadknot.obj", "difficult/negative-scale-test.glb", "hero/damaged-helmet.glb"}) {
    SCOPED_TRACE(file);
    const Scene scene = load(model(file));
    const Surfaces surfaces(scene);
    const View view = tries_little ? frame(surfaces, 200, 150) : frame(surfaces, 800, 600);
    const Agreement answer = expect_explained(surfaces, view);
    RecordProperty(file, std::to_string(answer.differing()) +
                             " differ: " + std::to_string(answer.count(Difference::edge)) + " edge, " +
                             std::to_string(answer.count(Difference::depth)) + " depth");
    EXPECT_LT(answer.differing(), view.pixel_count() / 100);
  }
}

}  // namespace
}  // namespace frontmost::test
