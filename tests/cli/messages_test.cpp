// SPDX-License-Identifier: Apache-2.0
// Messages and exit statuses for calls that are wrong or cannot be done.
#include <gmock/gmock.h>

#include "cli/failure.h"
#include "cli/outputs.h"
#include "cli/render/blank.h"
#include "cli/render/jobs.h"
#include "cli/values.h"
#include "program.h"

namespace frontmost::test {
namespace {

struct Case {
  const char *line, *words;
};

class Messages : public ProgramTest {
 protected:
  Messages() { write("cube.stl", cube_stl()); }

  void expect_usage(std::initializer_list<Case> cases) const {
    for (const auto& [line, words] : cases) {
      SCOPED_TRACE(line);
      expect_failure(line, cli::exit_usage, words);
    }
  }
  void expect_could_not(std::initializer_list<Case> cases) const {
    for (const auto& [line, words] : cases) {
      SCOPED_TRACE(line);
      expect_failure(line, cli::exit_could_not, words);
    }
  }
};

TEST_F(Messages, OfSight) {
  write("three.txt", "0 0 0 1 1 1\n1 2 3\n");
  write("seven.txt", "1 2 3 4 5 6 7\n");
  write("far.txt", "0 0 0 1 1 1e39\n");
  std::filesystem::create_directory(path("folder"));
  expect_usage({{"sight cube.stl", "give --from and --to, or --pairs"},
                {"sight cube.stl --to 1,2,3", "give --from and --to, or --pairs"},
                {"sight cube.stl --pairs three.txt --to 1,2,3", "--pairs excludes --from and --to"},
                {"sight cube.stl --from 1,2", "--from: '1,2' has 2 values, 3 are needed, separated by commas"},
                {"sight cube.stl --from 1,2,x --to 1,2,3", "--from: 'x' is not a number"}});
  expect_could_not(
      {{"sight cube.stl --pairs three.txt", "three.txt: line 2: a pair of points needs six numbers; there are 3"},
       {"sight cube.stl --pairs seven.txt", "seven.txt: line 1: a pair of points needs six numbers; there are 7"},
       {"sight cube.stl --pairs far.txt", "far.txt: line 1: 1e39 is not between -3e+38 and 3e+38"},
       {"sight cube.stl --pairs none.txt", "none.txt: cannot open"},
       {"sight cube.stl --pairs folder", "folder: is a folder"}});
  EXPECT_THAT(run({"sight", "cube.stl", "--pairs", ""}).err, testing::HasSubstr("--pairs: the file name is empty"));
}

TEST_F(Messages, OfLidar) {
  write("empty.txt", "# nothing\n\n");
  write("two.txt", "1 2\n");
  expect_usage({{"lidar cube.stl -o a.ply", "give --from X,Y,Z, where the scanner stands"},
                {"lidar cube.stl --from 0,0,9", "nothing to do: give -o FILE or --json"},
                {"lidar cube.stl --from 0,0,9 -o a.png", "a.png: the suffix names no format; use .ply, .exr or .npy"},
                {"lidar cube.stl --from 0,0,9 --json --elevations 5,-5", "--elevations: the lowest comes first"},
                {"lidar cube.stl --from 0,0,9 --json --elevations 5,91", "--elevations: 91 is not between -90 and 90"},
                {"lidar cube.stl --from 0,0,9 --json --rings 0", "--rings: 0 is not between 1 and 16384"},
                {"lidar cube.stl --from 0,0,9 --json --steps 1.5", "--steps: 1.5 is not a whole number"},
                {"lidar cube.stl --from 0,0,9 --json --directions two.txt --steps 5",
                 "--directions excludes --rings, --steps, --azimuths, --elevations and --ring-elevations"},
                {"lidar cube.stl --from 0,0,9 -o a.ply -o a.ply", "a.ply: would be written twice"}});
  expect_could_not({{"lidar cube.stl --from 0,0,9 --json --directions empty.txt", "empty.txt: holds no direction"},
                    {"lidar cube.stl --from 0,0,9 --json --directions two.txt",
                     "two.txt: line 1: a direction needs three numbers; there are 2"},
                    {"lidar cube.stl --from 0,0,9 -o none/a.ply", "none/a.ply: the folder none does not exist"}});
  EXPECT_THAT(run({"lidar", "cube.stl", "--from", "0,0,9", "-o", ""}).err,
              testing::HasSubstr("--output: the file name is empty"));
}

TEST_F(Messages, OfCameras) {
  expect_usage(
      {{"camera cube.stl --camera-index 0", "--camera-index: there is no camera 0; cameras in the model: 0"},
       {"camera cube.stl --camera-position 0.5,0.5,0.5",
        "--camera-position is the point that the camera looks at; give --camera-direction as well"},
       {"camera cube.stl --camera-zoom-factor 0.01 --camera-view-angle 170",
        "--camera-zoom-factor: the view angle becomes larger than 179 degrees"},
       {"camera cube.stl --up 1,1,0", "--up: up is one of +x, +y, +z, -x, -y, -z"},
       {"camera cube.stl --pose 1,2,3 --pose-convention opencv-world-to-camera",
        "--pose: 3 numbers; a pose is 16 (or 12), row by row"},
       {"camera cube.stl --pose 1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17 --pose-convention opencv-world-to-camera",
        "--pose: more than 16 numbers"},
       {"camera cube.stl --pose 1,0,0,0,0,1,0,0,0,0,1,0", "--pose needs --pose-convention"},
       {"camera cube.stl --pose-convention opencv-world-to-camera", "--pose-convention needs --pose"},
       {"camera cube.stl --pixel-center half", "--pixel-center needs --intrinsics"},
       {"camera cube.stl --view front --camera-position 1,2,3", "--view and --camera-position exclude each other"},
       {"camera cube.stl --intrinsics 9,9,5,5 --camera-orthographic",
        "--intrinsics and --camera-orthographic exclude each other"},
       {"camera cube.stl --camera-position 9,9,9 --camera-focal-point 0,0,0 --camera-direction -x",
        "--camera-direction and --camera-focal-point exclude each other"},
       {"camera cube.stl --near 0", "--near: must be above 0"},
       {"camera cube.stl --far 0", "--far: must be above 0"},
       {"camera cube.stl --near 3 --far 3", "--near: must be below --far"},
       {"render cube.stl --resolution 16384,16384 --samples 2 -o a.png",
        "--samples: at most 268435456 samples in all (16384 x 16384 pixels of one sample)"}});
  write("words.txt", "no matrix at all");
  expect_could_not({{"camera cube.stl --pose words.txt --pose-convention opencv-world-to-camera",
                     "words.txt: line 1: 'no' is not a number"}});
}

TEST_F(Messages, OfCamerasThatAreNoPinholes) {
  expect_usage(
      {{"render cube.stl --camera-model fisheye --near 1 -o a.png", "--camera-model and --near exclude each other"},
       {"render cube.stl --camera-model panorama --cull back -o a.png", "--camera-model and --cull exclude each other"},
       {"render cube.stl --camera-model panorama --depth-format D16 -o a.png",
        "--camera-model: options of a depth buffer need a pinhole camera"},
       {"render cube.stl --fov 90 -o a.png",
        "--fov needs --camera-model fisheye; for a pinhole camera use --camera-view-angle"}});
}

TEST_F(Messages, OfCompare) {
  write("file", "");
  expect_usage({{"compare -", "the command compare reads its model several times: give a file"},
                {"compare cube.stl --samples 64", "--samples: compare takes 1, 2, 4, 8 or 16"}});
  expect_could_not({{"compare cube.stl -o file/page", "file/page: cannot be made into a folder"},
                    {"compare cube.stl -o file", "file: cannot be made into a folder"}});
  EXPECT_THAT(run({"compare", "cube.stl", "-o", ""}).err, testing::HasSubstr("--output: the folder's name is empty"));
}

TEST_F(Messages, OfOutputs) {
  std::filesystem::create_directory(path("folder"));
  expect_usage(
      {{"render cube.stl -o {x}.png",
        "{x}.png: unknown placeholder; use {model}, {view}, or {layer} with --layers; {{ and }} stand for braces"},
       {"render cube.stl -o a}.png", "a}.png: unknown placeholder; use {model}, {view}"},
       {"render cube.stl -o {layer}.png", "{layer}.png: unknown placeholder; use {model}, {view}"},
       {"render cube.stl -o a.png --layers 2", "--layers: no output has {layer} in its name"},
       {"render cube.stl -o cube.stl", "cube.stl: "},
       {"render cube.stl -o a.png --depth a.png",
        "a.png: two outputs have this name; only an .exr file that is not deep can hold several outputs"},
       {"render cube.stl -o a.png --reference a.png", "a.png: is both the reference and an output"}});
  expect_could_not(
      {{"render cube.stl --format png -o folder", "folder: is a folder"},
       {"render cube.stl -o cube.stl/a.png", "cube.stl/a.png: cube.stl is not a folder"},
       {"lines builtin:teapot -o a.svg --tessellation-error 0.001 --resolution 8000,8000",
        "frontmost: builtin:teapot: teapot: instance 0, mesh 0: this tessellation error needs more than"}});
}

TEST_F(Messages, OfStreams) {
  Call piped{.words = {"render", "-", "--stream", "-o", "a.png"}, .input = cube_stl()};
  EXPECT_THAT(run(piped).err,
              testing::HasSubstr("frontmost: standard input and pipes can be read only once: give the camera "
                                 "(--camera-position with --camera-focal-point, or --pose), --near and --far"));
  piped.words = {
      "render",      "-",      "--stream", "-o",    "a.png", "--camera-position", "5,5,5", "--camera-focal-point",
      "0.5,0.5,0.5", "--near", "1",        "--far", "20",    "--shadows",         "map"};
  EXPECT_THAT(run(piped).err, testing::HasSubstr("shadows need another pass"));
  piped.words.resize(13);
  piped.words.insert(piped.words.end(), {"--shading", "ids"});
  EXPECT_EQ(run(piped).status, 0);
}

// ---- By parts, without a process ----

TEST(FillTemplate, NamesAndBraces) {
  const auto fill = [](std::string_view text, std::optional<int> layer = std::nullopt) {
    return cli::fill_template(text, "cube", "front", layer);
  };
  EXPECT_EQ(fill("plain.png"), "plain.png");
  EXPECT_EQ(fill("{model}_{view}.png"), "cube_front.png");
  EXPECT_EQ(fill("{{{view}}}"), "{front}");
  EXPECT_EQ(fill("{layer}-{layer}", 12), "12-12");
  for (const char* text : {"{", "}", "{}", "{view", "view}", "{View}", "{layer}", "{{view}"})
    EXPECT_THAT(complaint([&] { return fill(text); }), testing::StartsWith(std::string(text) + ": ")) << text;
  EXPECT_EQ(cli::model_name("some/where/part.v2.stl"), "part.v2");
  EXPECT_EQ(cli::model_name("-"), "stdin");
  EXPECT_EQ(cli::model_name("builtin:teapot"), "teapot");
  EXPECT_EQ(cli::model_name(""), "model");
}

TEST(BatchFiles, HoldMatricesOfRowsAndNothingDeeper) {
  const auto pose = [](const std::string& value) {
    return complaint([&] {
      return cli::parse_batch(R"({"views":[{"pose":)" + value + R"(,"pose-convention":"opencv-world-to-camera"}]})",
                              "b.json", {});
    });
  };
  EXPECT_EQ(pose("[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]"), "none");
  EXPECT_EQ(pose("[1,0,0,0, 0,1,0,0, 0,0,1,0]"), "none");
  EXPECT_EQ(pose("[[[1],0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]"), "b.json: views[0].pose: must hold only numbers");
  EXPECT_EQ(pose(R"([["1",0,0,0]])"), "b.json: views[0].pose: must hold only numbers");
  // Following nesting this deep would overflow the stack.
  for (const std::size_t depth : {std::size_t(20), std::size_t(200'000)})
    EXPECT_EQ(pose(std::string(depth, '[') + std::string(depth, ']')), "b.json: is nested deeper than 16");
  EXPECT_EQ(pose(std::string(12, '[') + std::string(12, ']')), "b.json: views[0].pose: must hold only numbers");
}

TEST(Blank, CountsWhatKeepsTrianglesOut) {
  View view;
  view.width = view.height = 10;
  view.world_from_eye = look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
  view.projection = make_projection(1.0, 1, {1, 10});
  const auto at = [](float x, float y, float z) {
    return std::array<glm::vec3, 3>{glm::vec3(x, y, z), glm::vec3(x + 0.1f, y, z), glm::vec3(x, y + 0.1f, z)};
  };
  const auto clause = [&](std::initializer_list<std::array<glm::vec3, 3>> triangles) {
    cli::BlankReason reason(view);
    for (const auto& triangle : triangles) reason.add(std::span(&triangle, 1));
    return reason.clause();
  };
  EXPECT_EQ(clause({}), "the model has no triangles");
  EXPECT_EQ(clause({at(0, 0, 5)}), "all of the model is behind the camera");
  EXPECT_EQ(clause({at(0, 0, -0.5f)}), "all of the model is nearer than the near plane");
  EXPECT_EQ(clause({at(0, 0, -11)}), "all of the model is beyond the far plane");
  EXPECT_EQ(clause({at(50, 0, -5)}), "all of the model is outside the picture");
  EXPECT_EQ(clause({at(0, -50, -5)}), "all of the model is outside the picture");
  EXPECT_EQ(clause({at(0, 0, -5)}), "all of the model is smaller than a pixel or seen edge-on");
  EXPECT_EQ(clause({at(std::nanf(""), 0, -5)}), "all of the model has vertices that are not finite");
  view.culling = Culling::front;
  EXPECT_EQ(clause({at(0, 0, -5)}), "all of the model faces the side that --cull leaves out");
  view.culling = Culling::back;
  EXPECT_EQ(clause({at(0, 0, -5)}), "all of the model is smaller than a pixel or seen edge-on");
  view.culling = Culling::both;
  EXPECT_EQ(clause({at(0, 0, -5), at(0, 0, -5), at(0, 0, 5)}),
            "1 of 3 triangles: is behind the camera; 2 of 3 triangles: faces the side that --cull leaves out");
  // Some vertices lie before and some behind the near plane: neither "nearer" nor "outside" applies.
  view.culling = Culling::none;
  EXPECT_EQ(clause({{glm::vec3(0, 0, -0.5f), glm::vec3(0, 0, -2), glm::vec3(0, 0, -3)}}),
            "all of the model is smaller than a pixel or seen edge-on");
}

TEST(Values, RangesSayTheirEnds) {
  EXPECT_EQ(complaint([] { return cli::parse_number("-1", {0, 5}); }), "-1 is not between 0 and 5");
  EXPECT_EQ(complaint([] { return cli::parse_number("-1", {0, cli::any_number.high}); }), "-1 is below 0");
  EXPECT_EQ(complaint([] { return cli::parse_number("inf"); }), "inf is not a usable number");
  EXPECT_EQ(complaint([] { return cli::parse_integer("2.5", {0, 5}); }), "2.5 is not a whole number");
  EXPECT_EQ(cli::parse_integer(" +5 ", {0, 5}), 5);
  EXPECT_EQ(complaint([] { return cli::parse_matrix("1 2 inf"); }), "a matrix entry is not finite");
  EXPECT_EQ(complaint([] { return cli::parse_matrix(""); }), "0 numbers; a pose is 16 (or 12), row by row");
  EXPECT_EQ(complaint([] { return cli::parse_choice("x", "a|b"); }), "'x' is not one of a, b");
  EXPECT_EQ(cli::parse_choice("LESS", "never|less"), 1) << "in capitals too";
}

TEST(Values, NearestWordsCountSwapsAsOne) {
  constexpr std::string_view words[] = {"depth", "samples", "resolution"};
  EXPECT_EQ(cli::nearest_word("detph", words), "depth");
  EXPECT_EQ(cli::nearest_word("smaples", words), "samples");
  EXPECT_EQ(cli::nearest_word("resolutoin", words), "resolution");
  EXPECT_EQ(cli::nearest_word("res", words), "") << "most of it is missing";
  EXPECT_EQ(cli::nearest_word("", words), "");
  EXPECT_EQ(cli::nearest_word("depth", {}), "");
}

TEST(Values, SplitKeepsEmptyParts) {
  EXPECT_THAT(cli::split("a,b", ','), testing::ElementsAre("a", "b"));
  EXPECT_THAT(cli::split("", ','), testing::ElementsAre(""));
  EXPECT_THAT(cli::split(",a,,", ','), testing::ElementsAre("", "a", "", ""));
}

}  // namespace
}  // namespace frontmost::test
