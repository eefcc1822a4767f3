// SPDX-License-Identifier: Apache-2.0
// frontmost report --views with --coco, --bop and --masks: all views in one set of files, and objects that are left
// out.
#include <frontmost/files.h>
#include <gmock/gmock.h>
#include <signal.h>

#include "report_squares.h"

namespace frontmost::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Datasets : public ReportTest {
 protected:
  /// Writes three views: the squares, a view from farther away, and one that sees only the near square.
  Datasets() {
    write("views.json", R"({"views": [{"name": "near"}, {"name": "far", "camera-position": [0, 0, 20]},
                                      {"camera-position": [0.5, 0.5, 3], "camera-focal-point": [0.5, 0.5, 0]}]})");
  }

  /// Options of each view of the file, to follow those of `view`.
  static constexpr const char* each[] = {"", " --camera-position 0,0,20",
                                         " --camera-position 0.5,0.5,3 --camera-focal-point 0.5,0.5,0"};

  /// `view` without the options that are given again.
  static std::string view_of(std::size_t number) {
    std::string text = view;
    const auto drop = [&](const std::string& option) { text.replace(text.find(option), option.size(), ""); };
    if (number > 0) drop("--camera-position 0,0,10");
    if (number == 2) drop("--camera-focal-point 0,0,0");
    return text + each[number] + " ";
  }

  /// Bytes of a file, which must exist.
  std::string bytes(const std::string& name) const {
    EXPECT_TRUE(exists(name)) << name;
    return exists(name) ? read(name) : std::string();
  }
};

TEST_F(Datasets, ASceneOfBopHasAnImageForEachView) {
  const json told = succeed(std::string("report squares.obj --json --views views.json --bop scene") + view).json();
  for (const json& file : told["files"]) EXPECT_TRUE(exists(file)) << file;
  std::size_t files = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string alone = "alone" + std::to_string(i), number = "00000" + std::to_string(i);
    const json one = succeed("report squares.obj --json --bop " + alone + view_of(i)).json();
    files += one["files"].size() - 3;
    for (const char* const name : {"scene_camera.json", "scene_gt.json", "scene_gt_info.json"})
      EXPECT_EQ(json::parse(bytes(std::string("scene/") + name))[std::to_string(i)],
                json::parse(bytes(alone + "/" + name))["0"])
          << i << name;
    EXPECT_EQ(bytes("scene/depth/" + number + ".png"), bytes(alone + "/depth/000000.png")) << i;
    const std::size_t objects = json::parse(bytes(alone + "/scene_gt.json"))["0"].size();
    for (std::size_t k = 0; k < objects; ++k)
      for (const std::string folder : {"mask", "mask_visib"})
        EXPECT_EQ(bytes("scene/" + folder + "/" + number + "_00000" + std::to_string(k) + ".png"),
                  bytes(alone + "/" + folder + "/000000_00000" + std::to_string(k) + ".png"))
            << i << k << folder;
  }
  EXPECT_EQ(told["files"].size(), 3 + files);
  // A later report of fewer views leaves none of these files.
  succeed("report squares.obj --bop scene" + view_of(0));
  EXPECT_FALSE(exists("scene/depth/000001.png"));
  EXPECT_FALSE(exists("scene/mask/000001_000000.png"));
  EXPECT_TRUE(exists("scene/mask/000000_000000.png"));
  succeed("report squares.obj --resolution 9,9 --camera-position 0,0,9 --camera-focal-point 0,0,20 --bop scene");
  EXPECT_FALSE(exists("scene/mask/000000_000000.png")) << "nothing is in view";
}

TEST_F(Datasets, AnnotationsOfCocoNameTheImageOfTheirView) {
  succeed(std::string("report squares.obj --views views.json --coco all.json") + view);
  const json all = json::parse(bytes("all.json"));
  ASSERT_EQ(all["images"].size(), 3u);
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    succeed("report squares.obj --coco one.json" + view_of(i));
    const json one = json::parse(bytes("one.json"));
    EXPECT_EQ(all["categories"], one["categories"]);
    EXPECT_EQ(all["images"][i]["id"], i + 1);
    for (json annotation : one["annotations"]) {
      annotation["id"] = count + 1;
      annotation["image_id"] = i + 1;
      EXPECT_EQ(all["annotations"][count++], annotation) << i;
    }
  }
  EXPECT_EQ(all["annotations"].size(), count);
  EXPECT_EQ(all["images"][0]["file_name"], "squares_near.png");
  EXPECT_EQ(all["images"][2]["file_name"], "squares_2.png") << "as render --batch -o {model}_{view}.png";
  write("same.json", R"({"views": [{"view": "iso"}, {"view": "top"}, {"view": "iso"}]})");
  expect_failure("report squares.obj --views same.json --coco c.json", 2,
                 "same.json: views[2]: has the name iso, like views[0], but --coco needs a picture for each view");
  // Standard output holds nothing else.
  EXPECT_EQ(succeed(std::string("report squares.obj --views views.json --coco -") + view).out, bytes("all.json"));
}

TEST_F(Datasets, MasksHaveTheNumbersOfTheirViews) {
  const json told = succeed(std::string("report squares.obj --json --views views.json --masks masks") + view).json();
  EXPECT_THAT(told["files"], testing::Contains("masks/000001_000000_amodal.png"));
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string alone = "alone" + std::to_string(i);
    const json one = succeed("report squares.obj --json --masks " + alone + view_of(i)).json();
    for (const std::string file : one["files"])
      EXPECT_EQ(bytes("masks/00000" + std::to_string(i) + "_" + file.substr(alone.size() + 1)), bytes(file)) << file;
  }
  write("views.json", R"({"views": [{}]})");
  write("masks/000042.png", "a picture"), write("masks/000001_000002.png", "another one");
  succeed(std::string("report squares.obj --views views.json --masks masks") + view);
  EXPECT_EQ(bytes("masks/000042.png") + bytes("masks/000001_000002.png"), "a pictureanother one");
  EXPECT_TRUE(exists("masks/000000_000000_amodal.png"));
  EXPECT_FALSE(exists("masks/000001_000000_amodal.png")) << "of an earlier report";
}

TEST_F(Datasets, ViewsThatBopHasNotAreRefusedBeforeAnythingIsRead) {
  write("views.json", R"({"views": [{"view": "front"}, {"view": "iso", "camera-orthographic": true}]})");
  expect_failure("report missing.obj --views views.json --bop scene", 2,
                 "views.json: views[1]: --bop needs a perspective camera, because BOP has no other cameras");
  EXPECT_FALSE(exists("scene"));
  expect_failure("report missing.obj --views views.json --masks scene", 1, "missing.obj");
  EXPECT_FALSE(exists("scene"));
  write("views.json", R"({"views": [{"name": "a"}, {"name": "b", "near": 5, "far": 4}]})");
  expect_failure("report squares.obj --views views.json --masks scene", 2, "views[1]");
  EXPECT_FALSE(exists("scene"));
}

TEST_F(Datasets, CtrlCLeavesNothing) {
  std::string views = "{}";
  for (int i = 1; i < 4000; ++i) views += ",{}";
  write("views.json", R"({"views": [)" + views + "]}");
  const Outcome outcome = run(Call{.words = {"report", "squares.obj", "--views", "views.json", "--resolution",
                                             "300,300", "--bop", "scene", "--coco", "c.json", "--masks", "masks"},
                                   .signal = SIGINT,
                                   .signal_after = 0.5});
  EXPECT_EQ(outcome.status, 130);
  for (const char* const name : {"scene", "masks", "c.json"}) EXPECT_FALSE(exists(name)) << name;
}

TEST_F(Datasets, WhatIsLeftOutHidesOthersAllTheSame) {
  write("kinds.json", R"({"objects": {"far": "wall", "near": "toy"}})");
  const std::string report = std::string("report squares.obj --json --coco c.json --bop scene --masks masks") + view;
  const auto annotations = [&] { return json::parse(bytes("c.json"))["annotations"]; };
  succeed(report);
  const json far = annotations()[0];
  ASSERT_EQ(far["visible_share"], 33 / 36.0);
  // An object can be left out by name; surfaces that it hides stay hidden.
  const json told = succeed(report + "--leave-out near").json();
  EXPECT_EQ(annotations(), json::array({far}));
  const json categories = json::parse(bytes("c.json"))["categories"];
  ASSERT_EQ(categories.size(), 2u) << "its name is no category";
  EXPECT_EQ(categories[1]["name"], "away");
  EXPECT_EQ(json::parse(bytes("scene/scene_gt.json"))["0"].size(), 1u);
  EXPECT_EQ(told["files"].size(), 1 + 6 + 2u);
  EXPECT_EQ(told["objects"].size(), 3u) << "the report has all";
  EXPECT_FALSE(exists("masks/000001_visible.png"));
  // Objects can be left out by a category, or by several.
  succeed(report + "--categories kinds.json --leave-out wall");
  EXPECT_EQ(annotations().size(), 1u);
  EXPECT_EQ(annotations()[0]["name"], "near");
  succeed(report + "--categories kinds.json --leave-out wall --leave-out near");
  EXPECT_EQ(annotations(), json::array());
  // A stretched floor is no reason to refuse the other objects.
  write("stretched.json", R"({"objects": [{"model": "squares.obj", "name": "floor", "scale": [1, 2, 1]},
                                          {"model": "squares.obj", "name": "things"}]})");
  expect_failure(std::string("report stretched.json --bop scene") + view, 1, "object 0 (floor) is stretched");
  succeed(std::string("report stretched.json --bop scene --leave-out floor") + view);
  expect_failure(report + "--leave-out naer", 2,
                 "--leave-out: squares.obj has no object and no category naer; did you mean near?");
  expect_failure("report squares.obj --leave-out near", 2, "--leave-out needs --coco, --bop or --masks");
}

}  // namespace
}  // namespace frontmost::test
