// SPDX-License-Identifier: Apache-2.0
// Batch files: their meaning, and error messages that name the place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/failure.h"
#include "cli/render/jobs.h"
#include "cli/view/view_options.h"
#include "program.h"

namespace frontmost::cli {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string complaint(const std::string& text) {
  return test::complaint([&] { return parse_batch(text, "b.json", {}); });
}

TEST(Batch, ViewsTakeWhatTheySayAndKeepTheRest) {
  Settings defaults;
  defaults.view.resolution = glm::ivec2(64, 48);
  const auto views = parse_batch(R"({"views": [
      {"name": "a", "view": "front"},
      {"camera-position": [1, 2, 3.5], "resolution": "32,16", "camera-orthographic": true, "samples": 1},
      {"view": "iso", "outputs": {"depth": "d.exr", "background": "transparent"}}],
      "outputs": {"output": "{view}.png", "ids": {"object": "{view}_o.png"}, "hash": false}})",
                                 "b.json", defaults);
  ASSERT_EQ(views.size(), 3u);
  EXPECT_EQ(view_name(views[0].view), "a");
  EXPECT_EQ(views[0].view.named, NamedView::front);
  EXPECT_EQ(views[0].view.resolution, glm::ivec2(64, 48));
  EXPECT_EQ(view_name(views[1].view), "1");
  EXPECT_EQ(views[1].view.position, glm::dvec3(1, 2, 3.5));
  EXPECT_EQ(views[1].view.resolution, glm::ivec2(32, 16));
  EXPECT_TRUE(views[1].view.orthographic);
  EXPECT_EQ(view_name(views[2].view), "iso");
  EXPECT_EQ(views[1].output.files.size(), 2u);
  EXPECT_EQ(views[2].output.files.size(), 3u);
  EXPECT_FALSE(views[2].output.background);
  EXPECT_TRUE(views[1].output.background);
  EXPECT_FALSE(views[0].output.hash);
}

TEST(Batch, PosesMayBeRows) {
  const auto views = parse_batch(R"({"views": [{"pose": [[1,0,0,4],[0,1,0,5],[0,0,1,6],[0,0,0,1]],
      "pose-convention": "opencv-world-to-camera", "intrinsics": [500, 500, 32, 24]}]})",
                                 "b.json", {});
  EXPECT_EQ((*views[0].view.pose)[3], glm::dvec4(4, 5, 6, 1));
}

TEST(Batch, ComplaintsNameThePlace) {
  EXPECT_THAT(complaint("{\n\"views\": [\n{,}]}"), StartsWith("b.json: line 3: is not valid JSON"));
  EXPECT_THAT(complaint("[]"), StartsWith("b.json: must be an object"));
  EXPECT_THAT(complaint("{}"), StartsWith("b.json: views: must be a list"));
  EXPECT_THAT(complaint(R"({"views": []})"), HasSubstr("at least one"));
  EXPECT_THAT(complaint(R"({"views": [{}], "x": 1})"), StartsWith("b.json: x: is not known"));
  EXPECT_THAT(complaint(R"({"views": [{}, {"resolution": [0, 5]}]})"),
              StartsWith("b.json: views[1].resolution: '0,5'"));
  EXPECT_THAT(complaint(R"({"views": [{"veiw": "front"}]})"),
              HasSubstr("views[0].veiw: is not known; did you mean view"));
  EXPECT_THAT(complaint(R"({"views": [3]})"), StartsWith("b.json: views[0]: must be an object"));
  EXPECT_THAT(complaint(R"({"views": [{"near": null}]})"), StartsWith("b.json: views[0].near: must be a string"));
  EXPECT_THAT(complaint(R"({"views": [{"near": [true]}]})"), HasSubstr("only numbers"));
  EXPECT_THAT(complaint(R"({"views": [{"camera-orthographic": 1}]})"), HasSubstr("true or false"));
  EXPECT_THAT(complaint(R"({"views": [{"output": "a.png"}]})"), HasSubstr("views[0].output: is not known"));
  EXPECT_THAT(complaint(R"({"views": [{"name": "a/b"}]})"), HasSubstr("must not hold a /"));
  EXPECT_THAT(complaint(R"({"views": [{}], "outputs": {"ids": {"face": "a.png"}}})"),
              StartsWith("b.json: outputs.ids.face: 'face' is not one of"));
  EXPECT_THAT(complaint(R"({"views": [{}], "outputs": {"threads": 3}})"), HasSubstr("outputs.threads"));
}

}  // namespace
}  // namespace frontmost::cli
