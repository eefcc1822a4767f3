// SPDX-License-Identifier: Apache-2.0
// frontmost report: its table, its report and its files.
#include <frontmost/files.h>
#include <gmock/gmock.h>

#include "report_squares.h"

namespace frontmost::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

using Report = ReportTest;

TEST_F(Report, TheTableHasARowForEveryObject) {
  const std::string text = succeed(std::string("report squares.obj") + view).out;
  EXPECT_THAT(text, HasSubstr("10 x 10 pixels, on a canvas of 30 x 30: 45 see an object, 55 see none\n"
                              "3 objects: 2 seen, 0 hidden, 0 beyond the frame, 1 cover no sample\n"));
  EXPECT_THAT(
      text,
      HasSubstr("     0  far           33          36    91.7 %     8.3 %     0.0 %         10  seen, 92 % of it, "
                "the rest hidden by near 8 %\n"));
  EXPECT_THAT(
      text,
      HasSubstr("     1  near          12          16    75.0 %     0.0 %    25.0 %          9  seen, 75 % of it, "
                "25 % beyond the frame\n"));
  EXPECT_THAT(text, HasSubstr("outside: on the right of the picture: turn the camera 22"));
}

TEST_F(Report, TheReportHasAllNumbers) {
  const json report = succeed(std::string("report squares.obj --json") + view).json();
  EXPECT_EQ(report["canvas"], json({-10, -10, 30, 30}));
  EXPECT_EQ(report["background"], 55);
  const json &far = report["objects"][0], &near = report["objects"][1], &away = report["objects"][2];
  EXPECT_EQ(far["name"], "far");
  EXPECT_EQ(far["alone"], (json{{"samples", 36}, {"box", {2, 2, 6, 6}}}));
  EXPECT_EQ(far["visible"]["samples"], 33);
  EXPECT_EQ(far["hidden_by"], json::array({{{"object", 1}, {"samples", 3}}}));
  EXPECT_EQ(near["alone"]["box"], json({7, 1, 4, 4}));
  EXPECT_EQ(near["in_frame"]["box"], json({7, 1, 3, 4}));
  EXPECT_EQ(near["cut_share"], 0.25);
  EXPECT_EQ(near["centroid"], json({8.5, 3.0}));
  EXPECT_EQ(near["cut_by_near"], false);
  EXPECT_TRUE(away["alone"]["box"].is_null());
  EXPECT_TRUE(away["distance"].is_null());
  EXPECT_TRUE(away["centroid"].is_null());
  const json narrow = succeed(std::string("report squares.obj --json --canvas 1") + view).json();
  EXPECT_EQ(narrow["objects"][1]["alone"]["samples"], 12);
  EXPECT_EQ(narrow["objects"][1]["cut_share"], 0);
}

TEST_F(Report, SaysWhyObjectsAreSeenOrNot) {
  const std::string command = std::string("report squares.obj") + view;
  EXPECT_EQ(succeed(command + "--why far").out, "far is seen, 92 % of it, the rest hidden by near 8 %.\n");
  EXPECT_EQ(succeed(command + "--why 1").out, "near is seen, 75 % of it, 25 % beyond the frame.\n");
  const json away = succeed(command + "--json --why away").json()["objects"];
  ASSERT_EQ(away.size(), 1u);
  EXPECT_EQ(away[0]["object"], 2);
  const json& why = away[0]["why"];
  EXPECT_EQ(why["reason"], "outside");
  EXPECT_EQ(why["triangles"]["right"], 2);
  EXPECT_EQ(why["remedy"]["kind"], "turn");
  EXPECT_NEAR(why["remedy"]["right_degrees"].get<double>(), 22.3, 0.4);
  EXPECT_EQ(why["remedy"]["up_degrees"], 0);
  std::string far_view = view;
  far_view.replace(far_view.find("--near 1 "), 9, "--near 11 ");
  const json near = succeed("report squares.obj --json --why far" + far_view).json()["objects"][0];
  EXPECT_EQ(near["why"]["remedy"], (json{{"kind", "set_near"}, {"value", 9.9}}));
  expect_failure(command + "--why wall", 2, "squares.obj has no object wall; frontmost report lists all 3");
  expect_failure(command + "--why fat", 2, "; did you mean far?");
}

TEST_F(Report, ExplainIsACommandThatSaysTheSame) {
  EXPECT_EQ(succeed(std::string("explain squares.obj far") + view).out,
            "far is seen, 92 % of it, the rest hidden by near 8 %.\n");
  EXPECT_EQ(succeed(std::string("explain") + view + "squares.obj 1").out,
            "near is seen, 75 % of it, 25 % beyond the frame.\n");
  EXPECT_EQ(succeed(std::string("explain squares.obj away --json") + view).json(),
            succeed(std::string("report squares.obj --why away --json") + view).json());
  expect_failure("explain squares.obj", 2, "no OBJECT given; give the name or the number");
  expect_failure("explain", 2, "no MODEL given");
  expect_failure("explain squares.obj far near", 2, "two objects are given, 'far' and 'near'");
  expect_failure("explain squares.obj 3", 2, "squares.obj has no object 3; frontmost report lists all 3");
  expect_failure("explain squares.obj EA", 2, "squares.obj has no object EA; did you mean near?");
  expect_failure("explain squares.obj far --canvas 2", 2, "--canvas is not an option of 'frontmost explain'");
  EXPECT_THAT(succeed("explain --help").out, testing::HasSubstr("frontmost explain MODEL OBJECT [options]"));
}

TEST_F(Report, ViewsOfAFileEqualThoseOneByOne) {
  write("views.json", R"({"views": [{"name": "first", "view": "front"}, {"view": "iso", "resolution": [30, 20]},
                                    {"camera-orthographic": true}], "outputs": {"output": "{view}.png"}})");
  const json all = succeed("report squares.obj --views views.json --resolution 40,40 --json").json();
  ASSERT_EQ(all["views"].size(), 3u);
  const char* const single[] = {"--view front --resolution 40,40", "--view iso --resolution 30,20",
                                "--camera-orthographic --resolution 40,40"};
  for (std::size_t i = 0; i < 3; ++i) {
    const json one = succeed(std::string("report squares.obj --json ") + single[i]).json();
    for (const char* key : {"width", "height", "canvas", "background", "objects"})
      EXPECT_EQ(all["views"][i][key], one[key]) << i << key;
  }
  EXPECT_EQ(all["views"][0]["name"], "first");
  EXPECT_EQ(all["views"][1]["name"], "iso");
  EXPECT_THAT(succeed("report squares.obj --views views.json --resolution 40,40 --why near").out,
              testing::MatchesRegex("first:\nnear is .*\n\niso:\nnear is .*\n\n2:\nnear is .*\n\n"));
  expect_failure("report squares.obj --views views.json -o page.html", 2,
                 "--views excludes --output, because a page holds one view");
  write("panorama.json", R"({"views": [{"camera-model": "panorama"}]})");
  expect_failure("report squares.obj --views panorama.json", 2, "views[0]: the command report needs a pinhole camera");
  write("depth.json", R"({"views": [{"depth-func": "LESS"}]})");
  expect_failure("report squares.obj --views depth.json", 2, "leave out the options of a depth buffer");
}

TEST_F(Report, AllHidersAreThereOnRequest) {
  const json plain = succeed(std::string("report squares.obj --json") + view).json();
  EXPECT_FALSE(plain["objects"][0].contains("hidden_by_any"));
  EXPECT_EQ(plain["cycles"], json::array());
  const json all = succeed(std::string("report squares.obj --json --all-hiders") + view).json();
  const json expected = json::array({{{"object", 1}, {"samples", 3}}});
  EXPECT_EQ(all["objects"][0]["hidden_by_any"], expected);
  EXPECT_EQ(all["objects"][0]["hidden_only_by"], expected);
  EXPECT_EQ(all["objects"][1]["hidden_by_any"], json::array());
}

TEST_F(Report, CocosAnnotationsHaveWhatIsSeenAndWhatIsHidden) {
  const json told = succeed(std::string("report squares.obj --json --coco coco.json") + view).json();
  EXPECT_EQ(told["files"], json({"coco.json"}));
  const json coco = json::parse(read("coco.json"));
  EXPECT_EQ(coco["images"], json::array({{{"id", 1}, {"file_name", "squares.png"}, {"width", 10}, {"height", 10}}}));
  ASSERT_EQ(coco["categories"].size(), 3u);
  EXPECT_EQ(coco["categories"][1], (json{{"id", 2}, {"name", "near"}, {"supercategory", ""}}));
  ASSERT_EQ(coco["annotations"].size(), 2u) << "what is not seen is left out";
  const json &far = coco["annotations"][0], &near = coco["annotations"][1];
  EXPECT_EQ(far["category_id"], 1);
  EXPECT_EQ(far["area"], 33);
  EXPECT_EQ(far["bbox"], json({2, 2, 6, 6}));
  EXPECT_EQ(far["iscrowd"], 0);
  // Runs down columns of ten: two and two pixels of nothing, six of the object, and so on; the last column has three.
  EXPECT_EQ(far["segmentation"], (json{{"size", {10, 10}}, {"counts", "f06400000003M?"}}));
  EXPECT_EQ(far["amodal_area"], 36);
  EXPECT_EQ(near["bbox"], json({7, 1, 3, 4}));
  EXPECT_EQ(near["cut_share"], 0.25);
  EXPECT_EQ(near["name"], "near");
  succeed(std::string("report squares.obj --coco coco.json --coco-polygons") + view);
  const json polygons = json::parse(read("coco.json"))["annotations"][0]["segmentation"];
  EXPECT_EQ(polygons, json({{7, 2, 7, 5, 8, 5, 8, 8, 2, 8, 2, 2}}));
  expect_failure("report squares.obj --coco-polygons", 2, "--coco-polygons needs --coco");
  expect_failure("report squares.obj --coco a --output a", 2, "written twice");
}

TEST_F(Report, CocosCategoriesAreThoseOfTheSceneFile) {
  write("cube.stl", cube_stl());
  write("room.json", R"({"categories": [{"name": "box", "number": 7}], "objects": [
    {"model": "cube.stl", "name": "a", "category": "box"}, {"model": "cube.stl", "name": "b", "translation": [3, 0, 0]}]})");
  const Outcome outcome = run({"report", "room.json", "--resolution", "64,48", "--coco", "coco.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json coco = json::parse(read("coco.json"));
  EXPECT_EQ(coco["categories"][0]["id"], 7);
  EXPECT_EQ(coco["categories"][0]["name"], "box");
  EXPECT_EQ(coco["categories"][1]["id"], 8);
  EXPECT_EQ(coco["categories"][1]["name"], "b");
  EXPECT_EQ(coco["annotations"][0]["category_id"], 7);
  EXPECT_EQ(coco["annotations"][1]["category_id"], 8);
}

TEST_F(Report, ABopSceneHasPosesMasksAndDepth) {
  const json told = succeed(std::string("report squares.obj --json --bop new/scene") + view).json();
  EXPECT_EQ(told["files"].size(), 8u);
  for (const json& file : told["files"]) EXPECT_TRUE(exists(file)) << file;
  const json camera = json::parse(read("new/scene/scene_camera.json"))["0"];
  EXPECT_EQ(camera["cam_K"], json({100, 0, 4.5, 0, 100, 4.5, 0, 0, 1}));
  EXPECT_EQ(camera["cam_R_w2c"], json({1, 0, 0, 0, -1, 0, 0, 0, -1}));
  EXPECT_EQ(camera["cam_t_w2c"], json({0, 0, 10}));
  EXPECT_EQ(camera["depth_scale"], 0.1);
  const json poses = json::parse(read("new/scene/scene_gt.json"))["0"];
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[1]["obj_id"], 2);
  EXPECT_EQ(poses[1]["cam_t_m2c"], json({0, 0, 10}));
  const json infos = json::parse(read("new/scene/scene_gt_info.json"))["0"];
  EXPECT_EQ(infos[1], (json{{"px_count_all", 16},
                            {"px_count_valid", 12},
                            {"px_count_visib", 12},
                            {"visib_fract", 0.75},
                            {"bbox_obj", {7, 1, 3, 3}},
                            {"bbox_visib", {7, 1, 2, 3}}}));
  EXPECT_EQ(infos[0]["px_count_visib"], 33);
  const Image mask = load_image(path("new/scene/mask_visib/000000_000001.png"));
  double marked = 0;
  for (const float value : mask.find("R")->floats()) marked += double(value);
  EXPECT_EQ(marked, 12);
  const Image whole = load_image(path("new/scene/mask/000000_000000.png"));
  EXPECT_EQ(whole.find("R")->floats()[2 * 10 + 7], 1) << "hidden, and still of the object";
  const Image depth = load_image(path("new/scene/depth/000000.png"));
  EXPECT_NEAR(depth.find("Z")->floats()[5 * 10 + 5], 10, 1e-4);
}

/// Transforms a point to the camera of a BOP scene, by the pose `of`: "cam_R_m2c" for m2c.
glm::dvec3 in_camera(const json& pose, const std::string& of, const glm::dvec3& point) {
  const json &turn = pose["cam_R_" + of], &move = pose["cam_t_" + of];
  glm::dvec3 result;
  for (int row = 0; row < 3; ++row) {
    result[row] = move[std::size_t(row)].get<double>();
    for (int k = 0; k < 3; ++k) result[row] += turn[std::size_t(3 * row + k)].get<double>() * point[k];
  }
  return result;
}

TEST_F(Report, BopsPosesOfModelsFarFromZeroAreForTheCoordinatesOfTheirFiles) {
  constexpr double far = 1e6;
  const glm::dvec3 away(far);
  write("cube.stl", cube_stl(0));
  write("moved.obj", squares(far));          // text: an origin is subtracted from its coordinates
  write("moved.stl", cube_stl(float(far)));  // floats: an origin is subtracted from its place
  write("home.json", R"({"objects": [{"model": "moved.obj", "parts": "apart", "translation": [-1e6, -1e6, -1e6]}]})");
  const std::string eye = " --bop scene --resolution 40,30 --camera-position ";
  const std::string near_eye = eye + "8,3,4 --camera-focal-point 0,0,0";
  const std::string far_eye = eye + "1000008,1000003,1000004 --camera-focal-point 1000000,1000000,1000000";
  const auto poses_of = [&](const std::string& model, const std::string& from) {
    succeed("report " + model + from);
    json found = json::parse(read("scene/scene_gt.json"))["0"];
    found.push_back(json::parse(read("scene/scene_camera.json"))["0"]);
    return found;
  };
  struct Case {
    const char *home, *moved;
    bool is_world_moved;
  };
  for (const auto& [home, moved, is_world_moved] :
       {Case{"squares.obj", "moved.obj", true}, {"cube.stl", "moved.stl", true}, {"squares.obj", "home.json", false}}) {
    const json before = poses_of(home, near_eye), after = poses_of(moved, is_world_moved ? far_eye : near_eye);
    ASSERT_EQ(before.size(), after.size()) << moved;
    for (const glm::dvec3& point : {glm::dvec3(0), {3, 0, 0}, {0, 5, 1}}) {
      for (std::size_t i = 0; i + 1 < before.size(); ++i)
        EXPECT_LT(glm::distance(in_camera(after[i], "m2c", away + point), in_camera(before[i], "m2c", point)), 1e-6)
            << moved << i;
      EXPECT_LT(glm::distance(in_camera(after.back(), "w2c", is_world_moved ? away + point : point),
                              in_camera(before.back(), "w2c", point)),
                1e-6)
          << moved;
    }
  }
}

TEST_F(Report, MasksArePicturesOfEveryObjectInTheFrame) {
  const json told = succeed(std::string("report squares.obj --json --masks new/masks") + view).json();
  EXPECT_EQ(told["files"], json({"new/masks/000000_visible.png", "new/masks/000000_amodal.png",
                                 "new/masks/000001_visible.png", "new/masks/000001_amodal.png"}));
  const auto marked = [&](const std::string& name) {
    const Image mask = load_image(path("new/masks/" + name));
    EXPECT_EQ(mask.width, 10);
    EXPECT_EQ(mask.height, 10);
    double sum = 0;
    for (const float value : mask.find("R")->floats()) sum += double(value);
    return sum;
  };
  EXPECT_EQ(marked("000000_visible.png"), 33);
  EXPECT_EQ(marked("000000_amodal.png"), 36);
  EXPECT_EQ(marked("000001_visible.png"), 12);
  EXPECT_EQ(marked("000001_amodal.png"), 12) << "what is beyond the frame has no pixels";
  EXPECT_EQ(load_image(path("new/masks/000000_amodal.png")).find("R")->floats()[2 * 10 + 7], 1) << "hidden";
  EXPECT_EQ(load_image(path("new/masks/000000_visible.png")).find("R")->floats()[2 * 10 + 7], 0) << "hidden";
  expect_failure("report squares.obj --masks squares.obj/masks", 1, "squares.obj/masks");
  expect_failure("report missing.obj --masks other", 1, "missing.obj");
  EXPECT_FALSE(exists("other"));
}

TEST_F(Report, MasksOfAnEarlierReportGoAndOtherFilesStay) {
  std::filesystem::create_directories(path("new/masks"));
  std::filesystem::create_directories(path("scene/mask"));
  write("new/masks/000007_visible.png", "old");
  write("new/masks/holiday.png", "kept");
  write("scene/mask/000000_000009.png", "old");
  succeed(std::string("report squares.obj --masks new/masks --bop scene") + view);
  EXPECT_FALSE(exists("new/masks/000007_visible.png"));
  EXPECT_TRUE(exists("new/masks/holiday.png"));
  EXPECT_FALSE(exists("scene/mask/000000_000009.png"));
  EXPECT_TRUE(exists("scene/mask/000000_000001.png"));
}

TEST_F(Report, ASceneOfBopThatCannotBeWholeIsNotThere) {
  std::filesystem::create_directories(path("taken/scene_gt.json"));
  std::filesystem::create_directories(path("blocked"));
  expect_failure(std::string("report squares.obj --bop taken") + view, 1, "taken/scene_gt.json: cannot replace");
  EXPECT_FALSE(exists("taken/mask/000000_000000.png"));
  write("blocked/mask", "in the way");
  expect_failure(std::string("report squares.obj --bop blocked") + view, 1, "blocked/mask: not a folder");
  EXPECT_FALSE(exists("blocked/scene_gt.json"));
}

TEST_F(Report, OptionsThatWouldDoNothingAreRefused) {
  expect_failure("report squares.obj --bop-visible bop19", 2, "--bop-visible needs --bop");
  expect_failure("report squares.obj --categories kinds.json", 2, "--categories needs --coco or --bop");
  expect_failure("report squares.obj -o report.png", 2, "report.png: the report is a page; use .html");
}

TEST_F(Report, CategoriesOfAFileCountInCocoAndBop) {
  write("kinds.json", R"({"categories": ["plate", {"name": "wall", "number": 17}],
                          "objects": {"far": "wall", "near": "plate", "door": "wall"}})");
  const Outcome outcome = run({"report", "squares.obj", "--categories", "kinds.json", "--coco", "coco.json", "--bop",
                               "scene", "--resolution", "40,30", "--view", "front"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("warning: kinds.json: objects: no object has the name \"door\"\n"));
  const json coco = json::parse(read("coco.json"));
  ASSERT_EQ(coco["categories"].size(), 3u) << "the third object goes by its name";
  EXPECT_EQ(coco["categories"][1]["id"], 17);
  EXPECT_EQ(coco["categories"][1]["name"], "wall");
  EXPECT_EQ(coco["categories"][2]["id"], 18);
  EXPECT_EQ(coco["annotations"][0]["category_id"], 17);
  const json poses = json::parse(read("scene/scene_gt.json"))["0"];
  EXPECT_EQ(poses[0]["obj_id"], 17);
  EXPECT_EQ(poses[1]["obj_id"], 1);
  EXPECT_EQ(poses[2]["obj_id"], 20) << "the third mesh, counted on from the highest category";
  expect_failure("report squares.obj --coco c.json --categories none.json", 1, "none.json: ");
  write("wrong.json", R"({"categories": ["plate"], "objects": {"far": "wall"}})");
  expect_failure("report squares.obj --coco c.json --categories wrong.json", 1,
                 "wrong.json: objects.far: \"wall\" is none of the file's categories");
  expect_failure("report squares.obj --categories kinds.json --coco kinds.json", 2, "is the file of categories itself");
}

TEST_F(Report, BopsOwnDefinitionOfVisibleHasATolerance) {
  // The near square is a millimetre before the far one. That is less than the tolerance, so both are wholly visible.
  succeed(std::string("report squares.obj --bop scene --bop-visible bop19") + view);
  const json infos = json::parse(read("scene/scene_gt_info.json"))["0"];
  EXPECT_EQ(infos[0]["px_count_visib"], 36);
  EXPECT_EQ(infos[1]["px_count_visib"], 12);
  expect_failure(std::string("report squares.obj --bop scene --camera-orthographic"), 2, "perspective");
  expect_failure("report squares.obj --bop squares.obj/scene", 1, "squares.obj/scene");
}

TEST_F(Report, WhatTheFileHidesIsSaid) {
  // One of the two triangles is below a hidden node.
  write("two.gltf", R"({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_node_visibility"],
      "nodes": [{"name": "seen", "mesh": 0}, {"children": [2], "extensions": {"KHR_node_visibility": {"visible": false}}},
                {"name": "a < lid", "mesh": 0, "translation": [3, 0, 0]}], "scenes": [{"nodes": [0, 1]}], "scene": 0,
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri":
      "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAA"}]})");
  const std::string command = "report two.gltf --quiet --view front --resolution 20,20";
  const std::string text = succeed(command).out;
  EXPECT_THAT(text,
              HasSubstr("1 object: 1 seen, 0 hidden, 0 beyond the frame, 0 cover no sample; 1 hidden by the file\n"));
  EXPECT_THAT(text, testing::ContainsRegex("\n     -  a < lid .* hidden by the file\n$"));
  const json report = succeed(command + " --json").json();
  EXPECT_EQ(report["objects"].size(), 1u);
  EXPECT_EQ(report["hidden_by_file"], json({"a < lid"}));
  EXPECT_EQ(run({"report", "two.gltf", "--quiet", "--why", "a < lid"}).out, "a < lid is hidden by the file.\n");
  EXPECT_EQ(succeed(command + " --why seen --json").json()["hidden_by_file"], json::array());
  expect_failure(command + " --why lid", 2, "two.gltf has no object lid");
  succeed(command + " -o page.html");
  EXPECT_THAT(read("page.html"), HasSubstr("Hidden by the file, and not drawn: a &lt; lid</p>"));
  // For a scene file, the message names the object.
  write("placed.json", R"({"objects": [{"model": "two.gltf", "name": "box"}]})");
  EXPECT_EQ(succeed("report placed.json --quiet --resolution 20,20 --json").json()["hidden_by_file"],
            json({"box/a < lid"}));
  EXPECT_EQ(succeed("report squares.obj --json --resolution 20,20").json()["hidden_by_file"], json::array());
}

TEST_F(Report, LongTablesSayHowMuchIsLeftOut) {
  const std::string text = succeed("report builtin:city --resolution 320,180").out;
  EXPECT_THAT(text, HasSubstr(" more; --json has all\n"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2 + 2 + 40 + 1);
}

TEST_F(Report, AModelWithoutAnythingIsAllBackground) {
  write("empty.obj", "v 0 0 0\n");
  EXPECT_THAT(run({"report", "empty.obj", "--resolution", "10,10"}).out, HasSubstr("0 see an object, 100 see none"));
}

TEST_F(Report, WrongOptionsAreNamed) {
  expect_failure("report squares.obj --canvas 0.5", 2, "--canvas: 0.5 is not between 1 and 16");
  expect_failure("report squares.obj --samples 4", 2, "--samples is not an option of 'frontmost report'");
  expect_failure("report", 2, "no MODEL given");
}

}  // namespace
}  // namespace frontmost::test
