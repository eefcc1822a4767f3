// SPDX-License-Identifier: Apache-2.0
// Error messages of reports, word for word, and the picture of fights, colour for colour.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "frontmost/precision.h"
#include "frontmost/zbuffer.h"
#include "support/random_scene.h"
#include "support/refusal.h"
#include "support/test_images.h"

namespace frontmost::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

template <class Action>
std::string words(const Action& action) {
  return refusal_of(ErrorCode::bad_argument, action);
}

View small_view(int width = 4) {
  View view;
  view.width = width;
  view.height = 2;
  view.projection = make_projection(1.0, double(width) / 2, {0.5, 100});
  return view;
}

DepthFights fights_of(std::vector<float> errors) {
  DepthFights fights;
  fights.view = small_view(int(errors.size()) / 2);
  fights.errors = Buffer<float>(errors.size());
  std::copy(errors.begin(), errors.end(), fights.errors.begin());
  return fights;
}

glm::vec3 pixel(const Image& image, std::size_t i) {
  return {image.find("R")->floats()[i], image.find("G")->floats()[i], image.find("B")->floats()[i]};
}

TEST(FightImage, ColoursSayHowFar) {
  Image backdrop = random_floats(4, 2, {"R", "G", "B"});
  for (Channel& channel : backdrop.channels)
    for (float& value : channel.floats()) value = 0.5f;
  const Image image = fight_image(fights_of({0, 1e-9f, 1e-6f, 1e-1f, 5, infinity, 3e-4f, 0}), backdrop);
  ASSERT_EQ(image.channels.size(), 4u);
  for (const float alpha : image.find("A")->floats()) EXPECT_EQ(alpha, 1.0f);
  // Where nothing fights, the picture shows the backdrop in dim grey: 0.02 + 0.12 times its luminance.
  EXPECT_NEAR(pixel(image, 0).x, 0.08f, 1e-6);
  EXPECT_EQ(pixel(image, 0).x, pixel(image, 0).z);
  EXPECT_EQ(pixel(image, 0), pixel(image, 7));
  const glm::vec3 violet(0.25f, 0.02f, 0.45f), yellow(1, 0.85f, 0.2f);
  EXPECT_EQ(pixel(image, 1), violet) << "less than a millionth of the distance is as a millionth";
  EXPECT_EQ(pixel(image, 2), violet);
  EXPECT_LT(glm::distance(pixel(image, 3), yellow), 1e-5f) << "a tenth of the distance";
  EXPECT_EQ(pixel(image, 4), yellow);
  EXPECT_EQ(pixel(image, 5), glm::vec3(0.25f, 0.75f, 1.0f)) << "nothing is seen";
  EXPECT_GT(pixel(image, 6).x, violet.x) << "between both ends the colours run over red";
}

TEST(FightImage, NeedsAPictureOfItsSizeInColours) {
  const DepthFights fights = fights_of(std::vector<float>(8, 0.0f));
  const std::string refused = "fight image: the backdrop must be a picture of the same size";
  EXPECT_EQ(words([&] { (void)fight_image(fights, random_floats(4, 2, {"R", "G", "B"})); }), "none");
  EXPECT_EQ(words([&] { (void)fight_image(fights, random_floats(2, 4, {"R", "G", "B"})); }), refused);
  EXPECT_EQ(words([&] { (void)fight_image(fights, random_floats(4, 2, {"R", "G", "Z"})); }), refused);
  EXPECT_EQ(words([&] {
              (void)fight_image(fights, random_ids(4, 2, {"R", "G", "B"}));
            }),
            refused)
      << "ids are no colours";
  Image short_of = random_floats(4, 2, {"R", "G", "B"});
  short_of.channels[1].values = Buffer<float>(7, 0.0f);
  EXPECT_EQ(words([&] { (void)fight_image(fights, short_of); }),
            "image: channel G does not have width x height values");
}

TEST(RefusedReports, AnswersOfDifferentViews) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 5, 1));
  const Surfaces surfaces(scene);
  const Visible a = zbuffer(surfaces, small_view()), wider = zbuffer(surfaces, small_view(6));
  const std::string agreement_words = words([&] { (void)check_agreement(surfaces, a, wider); });
  EXPECT_EQ(agreement_words.substr(0, 11), "agreement: ");
  EXPECT_NE(agreement_words.find("different views"), std::string::npos) << agreement_words;
  const ExactVisible exact = find_exact_visible(surfaces, small_view());
  EXPECT_EQ(words([&] { (void)find_depth_fights(surfaces, exact, wider); }),
            "depth fights: the two results were made for different views; both must have the same view");
  EXPECT_EQ(words([&] { (void)find_depth_fights(surfaces, exact, a); }), "none");
  Agreement fine = check_agreement(surfaces, a, a);
  EXPECT_EQ(words([&] { see_through(fine, surfaces, wider, wider); }),
            "agreement: the layers were made for different views; all must have the same view");
}

TEST(RefusedReports, DistancesAndGaps) {
  const auto gap = [](const DepthSetup& setup, double distance) {
    return words([&] { (void)resolvable_gap(setup, distance); });
  };
  EXPECT_EQ(gap({{1, 10}}, 1), "none");
  EXPECT_EQ(gap({{1, 10}}, 10), "none");
  EXPECT_EQ(gap({{1, 10}}, 0.99), "distance: must lie between near and far");
  EXPECT_EQ(gap({{1, 10}}, std::nan("")), "distance: must lie between near and far");
  EXPECT_EQ(gap({{std::nan(""), 10}}, 5), "near: must be a finite number");
  EXPECT_EQ(gap({{1, 1}}, 1), "far: must be greater than near");
  EXPECT_EQ(words([] { (void)share_of_values({{1, 10}}, 11); }), "distance: must lie between near and far");
  for (const double wanted : {0.0, -1.0, std::nan("")})
    EXPECT_EQ(words([&] { (void)near_for_gap({{1, 10}}, 5, wanted); }), "gap: must be greater than 0") << wanted;
  EXPECT_EQ(words([] { (void)near_for_gap({{1, 10}}, 5, 1e-9); }), "none") << "none may do, which is no error";
}

// Distances of a table: the ends and, between them, 1, 2 and 5 times powers of ten, ascending and never too many.
TEST(RoundDistances, OfAnyPlanes) {
  for (const ClipDistances& clip : {ClipDistances{0.1, 1000},
                                    {1e-30, 1e30},
                                    {3, 3.0001},
                                    {-5, 20},
                                    {0, 1},
                                    {0.5, std::numeric_limits<double>::infinity()}}) {
    const std::vector<double> distances = round_distances(clip);
    ASSERT_GE(distances.size(), 2u);
    ASSERT_LE(distances.size(), 210u);
    EXPECT_EQ(distances.front(), clip.near);
    if (std::isfinite(clip.far)) {
      EXPECT_EQ(distances.back(), clip.far);
    }
    for (std::size_t i = 1; i < distances.size(); ++i) ASSERT_GT(distances[i], distances[i - 1]) << clip.near;
  }
}

}  // namespace
}  // namespace frontmost::test
