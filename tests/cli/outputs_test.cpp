// SPDX-License-Identifier: Apache-2.0
// File names: templates, formats, and outputs that may not share a name.
#include "cli/outputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/failure.h"
#include "program.h"

namespace frontmost::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<FileToWrite> plan(std::vector<OutputRequest> requests, std::optional<ImageFormat> format = {}) {
  OutputSettings settings;
  settings.files = std::move(requests);
  settings.format = format;
  return plan_outputs(settings, "cube", "front");
}

std::string complaint(std::vector<OutputRequest> requests) {
  return test::complaint([&] { return plan(std::move(requests)); });
}

TEST(Outputs, TemplatesAreFilledIn) {
  EXPECT_EQ(fill_template("{model}_{view}.png", "cube", "front"), "cube_front.png");
  EXPECT_EQ(fill_template("a{{b}}.png", "cube", "front"), "a{b}.png");
  EXPECT_EQ(fill_template("plain", "cube", "front"), "plain");
  // Inserted text is not expanded again.
  EXPECT_EQ(fill_template("{model}", "{view}", "front"), "{view}");
  for (const char* text : {"{models}", "{", "}", "{model", "{}"}) {
    EXPECT_THROW((void)fill_template(text, "cube", "front"), UsageError) << text;
  }
}

TEST(Outputs, ModelNamesAreFileNamesWithoutSuffix) {
  EXPECT_EQ(model_name("parts/my part.v2.stl"), "my part.v2");
  EXPECT_EQ(model_name("builtin:teapot"), "teapot");
  EXPECT_EQ(model_name("-"), "stdin");
  EXPECT_EQ(model_name("größe.ply"), "größe");
}

TEST(Outputs, FormatsComeFromSuffixesInAnyCase) {
  EXPECT_EQ(plan({{OutputKind::picture, "a.PNG"}}).front().format, ImageFormat::png);
  EXPECT_EQ(plan({{OutputKind::depth, "a.exr"}}).front().format, ImageFormat::exr);
  EXPECT_EQ(plan({{OutputKind::depth, "a.pfm"}}).front().format, ImageFormat::pfm);
  EXPECT_EQ(plan({{OutputKind::depth, "a.npy"}}).front().format, ImageFormat::npy);
  EXPECT_EQ(plan({{OutputKind::picture, "-"}}, ImageFormat::exr).front().format, ImageFormat::exr);
  EXPECT_EQ(plan({{OutputKind::picture, "a.jpg"}}).front().format, ImageFormat::jpeg);
  EXPECT_EQ(plan({{OutputKind::picture, "a.JPEG"}}).front().format, ImageFormat::jpeg);
  EXPECT_EQ(plan({{OutputKind::picture, "a.webp"}}).front().format, ImageFormat::webp);
  EXPECT_EQ(plan({{OutputKind::picture, "-"}}, ImageFormat::jpeg).front().format, ImageFormat::jpeg);
  for (const char* name : {"a.tif", "a.", "a", ".png", "jpg"})
    EXPECT_THAT(complaint({{OutputKind::picture, name}}), HasSubstr("names no format")) << name;
  EXPECT_THAT(complaint({{OutputKind::picture, "-"}}), HasSubstr("--format"));
}

TEST(Outputs, FormatsThatCannotHoldAKindAreRefusedEarly) {
  EXPECT_THAT(complaint({{OutputKind::object_ids, "a.pfm"}}), HasSubstr("PFM cannot hold ids"));
  for (const char* name : {"a.jpg", "a.jpeg", "a.webp"})
    for (const OutputKind kind : {OutputKind::depth, OutputKind::ray_distance, OutputKind::window_depth,
                                  OutputKind::normals, OutputKind::primitive_ids, OutputKind::object_ids})
      EXPECT_THAT(complaint({{kind, name}}),
                  HasSubstr("JPEG and WebP hold only colour pictures; use .exr, .npy or .png"));
  OutputSettings transparent;
  transparent.background = std::nullopt;
  transparent.files = {{OutputKind::picture, "a.webp"}};
  EXPECT_EQ(plan_outputs(transparent, "m", "v").size(), 1u);
  transparent.files = {{OutputKind::picture, "a.jpg"}};
  EXPECT_THROW((void)plan_outputs(transparent, "m", "v"), UsageError);
}

TEST(Outputs, ExrFilesAreSharedAndNoOthers) {
  const auto files = plan({{OutputKind::picture, "a.exr"}, {OutputKind::depth, "a.exr"}});
  ASSERT_EQ(files.size(), 1u);
  EXPECT_THAT(files[0].kinds, ElementsAre(OutputKind::picture, OutputKind::depth));
  EXPECT_THAT(complaint({{OutputKind::picture, "a.png"}, {OutputKind::depth, "a.png"}}), HasSubstr("two outputs"));
  EXPECT_THAT(complaint({{OutputKind::depth, "a.exr"}, {OutputKind::depth, "a.exr"}}), HasSubstr("two outputs"));
}

TEST(Outputs, TheDifferenceLiesBesideThePicture) {
  OutputSettings settings;
  settings.reference = "golden/old.png";
  EXPECT_EQ(difference_path(settings, plan({{OutputKind::picture, "out/new.png"}})), "out/new.difference.png");
  EXPECT_EQ(difference_path(settings, {}), "old.difference.png");
  settings.reference_difference = "d.exr";
  EXPECT_EQ(difference_path(settings, {}), "d.exr");
}

}  // namespace
}  // namespace frontmost::cli
