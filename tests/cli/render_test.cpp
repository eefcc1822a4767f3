// SPDX-License-Identifier: Apache-2.0
// frontmost render: every output, every report, and the same bytes on every machine.
#include <frontmost/base.h>
#include <frontmost/files.h>
#include <gmock/gmock.h>

#include <cmath>

#include "program.h"
#include "support/models.h"

namespace frontmost::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Render : public ProgramTest {
 protected:
  Render() { write("cube.stl", cube_stl()); }

  [[nodiscard]] Image image(const std::string& name) const { return load_image(path(name)); }
};

TEST_F(Render, DepthIsPlanarAndInSceneUnits) {
  EXPECT_THAT(succeed(render_cube + "--depth d.exr --ray-distance r.npy").err, IsEmpty());
  const Image depth = image("d.exr");
  const Buffer<float>& z = depth.find("Z")->floats();
  EXPECT_FLOAT_EQ(z[32 * 64 + 32], 10);
  EXPECT_FLOAT_EQ(z[28 * 64 + 28], 10);
  EXPECT_TRUE(std::isinf(z[0]));
  // The distance along the ray grows with the slope: pixel (28.5 - 32) / 100.
  const Image ray = image("r.npy");
  EXPECT_FLOAT_EQ(ray.channels[0].floats()[28 * 64 + 28], 10 * std::sqrt(1 + 2 * 0.035 * 0.035));
  // The near side is 10 pixels wide.
  const auto covered = std::count_if(z.begin(), z.end(), [](float v) { return std::isfinite(v); });
  EXPECT_EQ(covered, 100);
}

TEST_F(Render, BackgroundDepthAndDepthScale) {
  succeed(render_cube + "--depth d.pfm --background-depth 0");
  EXPECT_EQ(image("d.pfm").channels[0].floats()[0], 0);
  succeed(render_cube + "--depth d.png --depth-scale 1000");
  EXPECT_NEAR(image("d.png").find("Z")->floats()[32 * 64 + 32], 10, 1e-3);
}

TEST_F(Render, IdsOfEveryKind) {
  succeed(render_cube + "--ids primitive=p.exr --ids object=o.npy --ids material=m.png --normals n.exr");
  const Image primitives = image("p.exr");
  const std::uint32_t id = primitives.find("primitive")->integers()[32 * 64 + 32];
  EXPECT_TRUE(id == 4 || id == 5) << id;  // the side at low y comes third in the file
  EXPECT_EQ(primitives.find("primitive")->integers()[0], no_index);
  EXPECT_EQ(image("o.npy").channels[0].integers()[32 * 64 + 32], 0u);
  EXPECT_TRUE(exists("m.png"));
  const Image normals = image("n.exr");
  EXPECT_NEAR(normals.find("N.Y")->floats()[32 * 64 + 32], -1, 1e-5);
}

TEST_F(Render, OneExrHoldsEverything) {
  succeed(render_cube + "-o all.exr --depth all.exr --normals all.exr --ids object=all.exr");
  const Image all = image("all.exr");
  for (const char* channel : {"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "object"}) {
    EXPECT_TRUE(all.find(channel)) << channel;
  }
  EXPECT_THAT(files(), ElementsAre("all.exr", "cube.stl"));
}

TEST_F(Render, PicturesInEveryFormat) {
  for (const char* name : {"a.png", "a.exr", "a.pfm", "a.npy"}) {
    succeed(render_cube + "-o " + name);
    const Image picture = image(name);
    EXPECT_EQ(picture.width, 64);
    EXPECT_NEAR(picture.channels[0].floats()[0], 1, 1e-6) << "white background in " << name;
  }
  succeed(render_cube + "-o b.png --bits 16 --background transparent");
  EXPECT_EQ(image("b.png").find("A")->floats()[0], 0);
  succeed(render_cube + "-o c.png --background #ff0000");
  EXPECT_EQ(image("c.png").find("G")->floats()[0], 0);
  for (const char* shading : {"lit", "flat", "normals", "depth", "ids", "uv"}) {
    succeed(render_cube + "-o s.png --no-shadows --shading " + shading);
  }
}

TEST_F(Render, PicturesInJpegAndWebp) {
  succeed(render_cube + "-o a.png -o a.jpg -o b.jpeg");
  EXPECT_EQ(read("a.jpg").substr(0, 3), "\xff\xd8\xff");
  EXPECT_EQ(read("a.jpg"), read("b.jpeg"));
  EXPECT_EQ(succeed(render_cube + "-o - --format jpg").out, read("a.jpg"));
  succeed(render_cube + "-o hashed.jpg --hash");
  EXPECT_EQ(read("hashed.jpg"), read("a.jpg")) << "by way of floats";
  succeed(render_cube + "-o coarse.jpg --quality 10");
  EXPECT_LT(read("coarse.jpg").size(), read("a.jpg").size());
  succeed("precision cube.stl --format D16 --resolution 64,64 --heat-map h.jpg");
  EXPECT_EQ(read("h.jpg").substr(0, 3), "\xff\xd8\xff");
#ifdef FRONTMOST_HAS_WEBP
  succeed(render_cube + "-o a.webp");
  EXPECT_EQ(read("a.webp").substr(8, 4), "WEBP");
  succeed(render_cube + "-o clear.webp --background transparent");
  EXPECT_EQ(read("clear.webp").find("ALPH"), std::string("RIFF....WEBPVP8X..............").size()) << "it has alpha";
#else
  expect_failure(render_cube + "-o a.webp", 1, "libwebp-dev");
#endif
}

TEST_F(Render, TheModelsOwnLightsShineWhenTheyAreAskedFor) {
  write("lamp.gltf", R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],
    "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":4,"color":[1,0,0]}]}},
    "nodes":[{"mesh":0},{"name":"lamp","translation":[0.3,0.3,1],"extensions":{"KHR_lights_punctual":{"light":0}}}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
    "bufferViews":[{"buffer":0,"byteLength":36}],
    "buffers":[{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  const std::string lamp = "render lamp.gltf --view front --resolution 60,60 ";
  const std::string hint = "the model has a light of its own; use --lights file or --lights both";
  const Outcome untold = succeed(lamp + "-o untold.png --json");
  EXPECT_THAT(untold.err, HasSubstr(hint));
  EXPECT_EQ(untold.json()["warnings"], json({hint}));
  EXPECT_EQ(untold.json()["lights"], 1);
  EXPECT_EQ(untold.json()["look"]["lights"], "key");
  EXPECT_THAT(succeed(lamp + "--depth d.exr").err, IsEmpty()) << "no picture";
  for (const char* lights : {"key", "file", "both", "none"}) {
    const Outcome told = succeed(lamp + "-o " + lights + ".png --json --shadows rays --lights " + lights);
    EXPECT_THAT(told.err, IsEmpty());
    EXPECT_EQ(told.json()["look"]["lights"], lights);
  }
  EXPECT_EQ(read("untold.png"), read("key.png"));
  EXPECT_THAT(succeed(lamp + "-o map.png --lights file").err, HasSubstr("that casts no shadow with --shadows map"));
  const auto middle = [&](const std::string& name, const char* channel) {
    return image(name).find(channel)->floats()[40 * 60 + 20];
  };
  EXPECT_GT(middle("file.png", "R"), middle("none.png", "R") + 0.1f);
  EXPECT_EQ(middle("file.png", "G"), middle("none.png", "G"));
  EXPECT_GT(middle("key.png", "G"), middle("none.png", "G") + 0.1f);
  EXPECT_GE(middle("both.png", "R"), middle("key.png", "R"));
  expect_failure(lamp + "-o a.png --lights moon", 2, "--lights");
  EXPECT_THAT(succeed("render cube.stl -o a.png --resolution 60,60 --lights file").err,
              HasSubstr("the model has no lights of its own, so --lights file leaves only the environment's light"));
  EXPECT_THAT(succeed("render cube.stl -o a.png --resolution 60,60 --lights both").err, IsEmpty());
}

TEST_F(Render, ShadowsByMapByRaysAndNone) {
  const std::string teapot = "render builtin:teapot --resolution 160,120 ";
  succeed(teapot + "-o default.png");
  for (const char* how : {"off", "map", "rays"}) succeed(teapot + "--shadows " + how + " -o " + how + ".png");
  succeed(teapot + "--no-shadows -o none.png");
  succeed(teapot + "--method raycast --shadows rays -o both.png");
  EXPECT_EQ(read("default.png"), read("map.png"));
  EXPECT_EQ(read("none.png"), read("off.png"));
  EXPECT_NE(read("rays.png"), read("map.png"));
  EXPECT_NE(read("rays.png"), read("off.png"));
  EXPECT_GT(succeed(teapot + "--shadows rays -o rays.png --json").json()["timings_ms"]["index"].get<double>(), 0);
  expect_failure(teapot + "--shadows soft -o soft.png", 2, "off, map, rays");
}

TEST_F(Render, StandardOutputAndInput) {
  const Outcome piped =
      run(Call{.words = {"render", "-", "-o", "-", "--format", "png", "--resolution", "32,32"}, .input = cube_stl()});
  EXPECT_EQ(piped.status, 0) << piped.err;
  EXPECT_EQ(piped.out.substr(1, 3), "PNG");
  EXPECT_THAT(piped.err, IsEmpty());
  succeed("render cube.stl -o file.png --resolution 32,32");
  EXPECT_EQ(piped.out, read("file.png"));
}

TEST_F(Render, TemplatesNameFiles) {
  succeed("render cube.stl --view top -o {model}_{view}.png --resolution 16,16");
  EXPECT_TRUE(exists("cube_top.png"));
  expect_failure("render cube.stl -o {modle}.png", 2, "use {model}, {view}");
}

TEST_F(Render, JsonSaysWhatWasSeen) {
  const Outcome outcome = succeed(render_cube + "--json --repeat 3 -o a.png --depth d.exr");
  const json report = outcome.json();
  EXPECT_EQ(report["seen"]["covered_pixels"], 100);
  EXPECT_EQ(report["seen"]["pixels"], 4096);
  EXPECT_EQ(report["seen"]["objects"][0]["covered_pixels"], 100);
  EXPECT_EQ(report["seen"]["hash"].get<std::string>().size(), 16u);
  EXPECT_EQ(report["triangles"], 12);
  EXPECT_EQ(report["files"].size(), 2u);
  EXPECT_EQ(report["files"][0]["what"], "picture");
  EXPECT_EQ(report["files"][1]["path"], "d.exr");
  EXPECT_EQ(report["view"]["resolution"], json({64, 64}));
  EXPECT_TRUE(report["warnings"].is_array());
  for (const char* stage : {"load", "surfaces", "shade", "save", "total"}) {
    EXPECT_GE(report["timings_ms"].value(stage, -1.0), 0) << stage;
  }
  const json& visible = report["timings_ms"]["visible"];
  EXPECT_LE(visible["min"].get<double>(), visible["median"].get<double>());
  EXPECT_LE(visible["median"].get<double>(), visible["max"].get<double>());
}

TEST_F(Render, TheAnswerDoesNotDependOnHowItRuns) {
  const std::string line = "render builtin:teapot --resolution 200,150 --hash -o a.png --depth d.exr --normals n.exr ";
  const std::string expected = succeed(line).out;
  const std::string picture = read("a.png");
  EXPECT_THAT(expected, testing::StartsWith("visible "));
  EXPECT_THAT(expected, testing::ContainsRegex("picture [0-9a-f]{16} a.png"));
  std::vector<std::string> ways = {"--threads 1", "--threads 2", "--threads 7", "--repeat 2"};
  for (const Isa isa : available_isas()) ways.push_back("--isa " + std::string(name(isa)));
  for (const std::string& way : ways) {
    EXPECT_EQ(succeed(line + way).out, expected) << way;
    EXPECT_EQ(read("a.png"), picture) << way;
  }
  EXPECT_EQ(succeed(line + "--method zbuffer --json --quiet").json()["seen"]["hash"], expected.substr(8, 16));
}

TEST_F(Render, SamplesChangeThePictureAndNotTheMaps) {
  const std::string line = "render builtin:teapot --resolution 100,80 --hash -o a.exr --depth d.exr --samples ";
  const std::string one = succeed(line + "1").out, eight = succeed(line + "8").out;
  EXPECT_EQ(one.substr(8, 16), eight.substr(8, 16));
  EXPECT_NE(one, eight);
  EXPECT_EQ(one.substr(one.rfind('\n', one.size() - 2)), eight.substr(eight.rfind('\n', eight.size() - 2)));
}

TEST_F(Render, BatchesRenderManyViews) {
  write("views.json", R"({"views": [{"name": "a", "view": "front"}, {"view": "top", "resolution": [20, 10]},
      {"camera-direction": [1, 1, -1]}], "outputs": {"output": "{model}_{view}.png", "depth": "{view}.npy"}})");
  const json report = succeed("render cube.stl --batch views.json --resolution 32,32 --json").json();
  EXPECT_THAT(files(), ElementsAre("2.npy", "a.npy", "cube.stl", "cube_2.png", "cube_a.png", "cube_top.png", "top.npy",
                                   "views.json"));
  ASSERT_EQ(report["views"].size(), 3u);
  EXPECT_EQ(report["views"][1]["view"]["resolution"], json({20, 10}));
  EXPECT_TRUE(report["views"][2]["timings_ms"].contains("visible"));
  EXPECT_THAT(succeed("render cube.stl --batch views.json --hash").out,
              testing::ContainsRegex("top:depth [0-9a-f]{16} top.npy"));
}

TEST_F(Render, BatchComplaintsComeBeforeAnyWork) {
  write("same.json", R"({"views": [{"view": "front"}, {"view": "top"}], "outputs": {"output": "a.png"}})");
  expect_failure("render cube.stl --batch same.json", 2, "would be written twice");
  write("bad.json", R"({"views": [{"view": "fornt"}]})");
  expect_failure("render cube.stl --batch bad.json -o a.png", 2, "bad.json: views[0].view: 'fornt' is not one of");
  expect_failure("render cube.stl --batch none.json -o a.png", 1, "none.json: cannot open");
  EXPECT_THAT(files(), ElementsAre("bad.json", "cube.stl", "same.json"));
}

TEST_F(Render, OutputsAreCheckedBeforeAnyWork) {
  // The model does not exist: if it were read first, the message would be about it.
  expect_failure("render none.stl -o missing/a.png", 1, "the folder missing does not exist");
  expect_failure("render none.stl -o a.tif", 2, "a.tif: the suffix names no format");
  expect_failure("render none.stl --depth a.jpg", 2, "a.jpg: JPEG and WebP hold only colour pictures");
  expect_failure("render none.stl -o a.jpeg --background transparent", 2, "a.jpeg: JPEG holds no alpha");
  expect_failure("render none.stl -o a.jpg --quality 0", 2, "--quality");
  expect_failure("render none.stl -o a.jpeg --format png", 2, "--format differs from the suffix");
  expect_failure("render none.stl -o -", 2, "--format");
  expect_failure("render none.stl -o a.png --depth a.png", 2, "two outputs have this name");
  expect_failure("render none.stl -o a.exr --depth ./a.exr", 2, "would be written twice");
  expect_failure("render none.stl --ids face=a.png", 2, "'face' is not one of");
  expect_failure("render none.stl --ids a.png", 2, "KIND=FILE");
  expect_failure("render none.stl --ids object=a.pfm", 2, "PFM cannot hold ids");
  expect_failure("render none.stl -o - --format png --json", 2, "standard output");
  expect_failure("render none.stl -o - --format png --hash", 2, "standard output");
  expect_failure("render none.stl -o .png/", 2, "suffix");
  write("file", "x");
  expect_failure("render none.stl -o file/a.png", 1, "file is not a folder");
  write("cube.exr", cube_stl());
  expect_failure("render cube.exr --input-format stl -o ./cube.exr", 2, "is the model itself");
  expect_failure("render cube.stl", 2, "nothing to do: give an output such as -o FILE");
  expect_failure("render cube.stl out.png", 2, "nothing to do: give an output such as -o out.png (");
  expect_failure("render cube.stl -o a.png --method raytrace", 2, "--method");
  expect_failure("render cube.stl -o a.png --isa neon", 2, "--isa: 'neon' is not one of");
  expect_failure("render cube.stl -o a.png --samples 3", 2, "--samples: '3' is not one of 1, 2, 4, 8, 16");
  expect_failure("render cube.stl -o a.png --bits 12", 2, "--bits");
  expect_failure("render cube.stl -o a.png --background mauve", 2, "--background: 'mauve' is not a colour");
}

TEST_F(Render, DevicesAreWrittenAsTheyAre) {
  succeed(render_cube + "-o /dev/null --format png");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(Render, ABlankPictureSaysWhy) {
  write("empty.stl", std::string(80, ' ') + std::string(4, '\0'));
  write("flap.stl", triangle_stl());
  const std::pair<const char*, const char*> cases[] = {
      {"render empty.stl", "the model has no triangles"},
      {"render cube.stl --camera-position 0,-5,0 --camera-direction -y", "is behind the camera"},
      {"render cube.stl --camera-position 0,-5,0 --camera-direction y --near 50", "is nearer than the near plane"},
      {"render cube.stl --camera-position 0,-5,0 --camera-direction y --far 1", "is beyond the far plane"},
      {"render cube.stl --camera-position 0,-5,0 --camera-direction 1,0.3,0", "is outside the picture"},
      {"render cube.stl --cull both", "faces the side that --cull leaves out"},
      {"render flap.stl --view bottom --cull back", "faces the side that --cull leaves out"},
      {"render flap.stl --view top --cull front", "faces the side that --cull leaves out"},
      {"render cube.stl --camera-position 0.3,-90000,0.2 --camera-direction y", "is smaller than a pixel"},
  };
  for (const auto& [words, reason] : cases) {
    const std::string line = std::string(words) + " --resolution 32,32 -o a.png";
    const Outcome outcome = succeed(line);
    EXPECT_THAT(outcome.err, HasSubstr("warning: nothing is in view: ")) << line;
    EXPECT_THAT(outcome.err, HasSubstr(reason)) << line;
    const json report = succeed(line + " --json --quiet").json();
    EXPECT_THAT(report["warnings"].dump(), HasSubstr(reason)) << line;
  }
  EXPECT_THAT(succeed("render flap.stl --view top --cull back --resolution 32,32 -o a.png").err, IsEmpty());
}

TEST_F(Render, ReadersWarningsAreFewAndCounted) {
  FRONTMOST_NEEDS_MODELS();
  const Outcome outcome = run({"info", model("scenes/pandora.obj"), "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::size_t warnings = outcome.json()["warnings"].size();
  const auto lines = std::count(outcome.err.begin(), outcome.err.end(), '\n');
  EXPECT_EQ(std::size_t(lines), warnings > 5 ? 6 : warnings);
  EXPECT_THAT(run({"info", model("scenes/pandora.obj"), "--quiet"}).err, IsEmpty());
}

TEST_F(Render, NumbersDoNotDependOnTheLocale) {
  const Outcome german = run(Call{.words = {"camera", "cube.stl", "--json", "--camera-position", "1.5,-2.5,3"},
                                  .environment = {"LC_ALL=de_DE.UTF-8", "LANG=de_DE.UTF-8"}});
  EXPECT_EQ(german.out, succeed("camera cube.stl --json --camera-position 1.5,-2.5,3").out);
}

TEST_F(Render, NamesFromFilesCannotDriveTheTerminal) {
  write("bell.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\no red\x1b[31m\a\nf 1 2 3\n");
  const Outcome outcome = succeed("info bell.obj");
  EXPECT_EQ(outcome.out.find_first_of("\x1b\a"), std::string::npos);
  EXPECT_THAT(outcome.out, HasSubstr("red\\x1B[31m\\x07"));
}

TEST_F(Render, TheLongNamesAreTheShortOnes) {
  succeed("render cube.stl --resolution 32,24 -o short.png");
  succeed("render cube.stl --resolution=32,24 --output long.png");
  succeed("render cube.stl --resolution=32,24 --output=equals.png");
  EXPECT_EQ(read("short.png"), read("long.png"));
  EXPECT_EQ(read("short.png"), read("equals.png"));
}

TEST_F(Render, AmbientOcclusionDarkensWhatIsNear) {
  const std::string render = "render builtin:gallery --resolution 64,48 -o ";
  succeed(render + "plain.png");
  succeed(render + "none.png --ambient-occlusion 0");
  succeed(render + "dark.png --ambient-occlusion 1");
  succeed(render + "narrow.png --ambient-occlusion 1 --occlusion-radius 1e-6");
  EXPECT_EQ(read("plain.png"), read("none.png"));
  EXPECT_NE(read("plain.png"), read("dark.png"));
  EXPECT_NE(read("narrow.png"), read("dark.png"));
  expect_failure(render + "x.png --occlusion-radius 1", cli::exit_usage,
                 "--occlusion-radius needs --ambient-occlusion");
  expect_failure(render + "x.png --ambient-occlusion 1 --camera-model panorama --camera-position 0,0,0",
                 cli::exit_usage, "--camera-model and --ambient-occlusion exclude each other");
  expect_failure("render cube.stl --stream --ambient-occlusion 1 -o x.png", cli::exit_usage,
                 "--stream does not keep the model, so --ambient-occlusion needs --occlusion-radius");
  expect_failure(render + "x.png --ambient-occlusion 1.5", cli::exit_usage, "--ambient-occlusion");
}

TEST_F(Render, TheEnvironmentTheKeyLightAndHowLightIsShownCanBeChosen) {
  const std::string render = "render builtin:gallery --resolution 64,48 -o ";
  succeed(render + "default.png");
  succeed(render + "studio.png --environment studio --exposure 0 --tone-mapping none --light-intensity 1");
  EXPECT_EQ(read("default.png"), read("studio.png"));
  for (const char* options : {"--environment sky", "--environment none", "--environment-angle 90", "--exposure -1",
                              "--tone-mapping aces", "--tone-mapping khronos", "--light-direction +x",
                              "--light-intensity 0", "--environment sky --show-environment"}) {
    succeed(render + "other.png " + options);
    EXPECT_NE(read("default.png"), read("other.png")) << options;
  }
  // Without any light, only the emission of materials is left.
  succeed(render + "dark.png --environment none --light-intensity 0 --background black");
  const std::string dark = read("dark.png");
  succeed(render + "darker.png --environment none --light-intensity 0 --background black --exposure -20");
  EXPECT_EQ(dark, read("darker.png"));
  expect_failure(render + "x.png --environment missing.hdr", 1, "missing.hdr");
  expect_failure(render + "x.png --tone-mapping filmic", cli::exit_usage, "none, aces, khronos");
  expect_failure(render + "x.png --exposure 33", cli::exit_usage, "--exposure");
  expect_failure(render + "x.png --light-direction 0,0,0", cli::exit_usage, "--light-direction");
  expect_failure(render + "x.png --show-environment --blend srgb", cli::exit_usage,
                 "--show-environment and --blend srgb exclude each other");
}

TEST_F(Render, AnEnvironmentMayBeAFileWhichNoViewReplaces) {
  const std::string blue(8 * 12, '\x3f');  // 4 x 2 pixels of 0.747
  write("blue.pfm", "PF\n4 2\n-1.0\n" + blue);
  const std::string render = "render cube.stl --resolution 32,24 ";
  succeed(render + "-o studio.png");
  const json look = succeed(render + "-o file.png --environment blue.pfm --json").json()["look"];
  EXPECT_NE(read("studio.png"), read("file.png"));
  EXPECT_EQ(look["environment"], "blue.pfm");
  expect_failure(render + "--environment blue.pfm -o blue.pfm", cli::exit_usage, "is the environment itself");
  write(
      "views.json",
      R"({"views": [{"outputs": {"output": "blue.pfm"}}, {"outputs": {"output": "b.png", "environment": "blue.pfm"}}]})");
  expect_failure(render + "--batch views.json", cli::exit_usage, "blue.pfm: is the environment itself");
}

TEST_F(Render, TheReportSaysHowPicturesLook) {
  const std::string render = "render cube.stl --resolution 32,24 --json ";
  EXPECT_EQ(succeed(render + "-o a.png").json()["look"],
            json::parse(R"({"shading": "lit", "blend": "linear", "opacity": 1.0, "lights": "key", "shadows": "map",
                            "ambient_occlusion": 0.0, "environment": "studio", "environment_angle_degrees": 0.0,
                            "exposure": 0.0, "tone_mapping": "none"})"));
  const json told =
      succeed(render +
              "-o a.svg --environment sky --environment-angle 90 --exposure 1 --tone-mapping aces "
              "--light-intensity 2 --light-direction +z --no-shadows --ambient-occlusion 0.5 --opacity 0.5")
          .json()["look"];
  EXPECT_EQ(told, json::parse(R"({"shading": "lit", "blend": "linear", "opacity": 0.5, "lights": "key",
                                  "shadows": "off", "ambient_occlusion": 0.5, "environment": "sky",
                                  "environment_angle_degrees": 90.0, "exposure": 1.0, "tone_mapping": "aces",
                                  "light_direction": [0.0, 0.0, 1.0], "light_intensity": 2.0})"));
  EXPECT_EQ(succeed(render + "-o a.png --shading flat --blend srgb").json()["look"],
            json::parse(R"({"shading": "flat", "blend": "srgb", "opacity": 1.0})"));
  EXPECT_FALSE(succeed(render + "--depth a.exr").json().contains("look")) << "no picture";
  write("views.json", R"({"views": [{"outputs": {"exposure": 2}}, {}], "outputs": {"output": "{view}.png"}})");
  const json views = succeed(render + "--batch views.json").json()["views"];
  EXPECT_EQ(views[0]["look"]["exposure"], 2.0);
  EXPECT_EQ(views[1]["look"]["exposure"], 0.0);
}

}  // namespace
}  // namespace frontmost::test
