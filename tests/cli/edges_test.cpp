// SPDX-License-Identifier: Apache-2.0
// frontmost render --edges: pictures and figures with the visible edges over them.
#include <frontmost/files.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "program.h"

namespace frontmost::test {
namespace {

using testing::HasSubstr;

class Edges : public ProgramTest {
 protected:
  Edges() { write("cube.stl", cube_stl()); }
  [[nodiscard]] Image image(const std::string& name) const { return load_image(path(name)); }

  /// The number of paths in the layer of edges of an SVG file, which comes after the shapes.
  [[nodiscard]] std::size_t edge_paths(const std::string& file) const {
    const std::string text = read(file);
    const std::size_t figure = text.find("inkscape:label=\"figure\""), edges = text.find("inkscape:label=\"edges\"");
    EXPECT_NE(edges, std::string::npos);
    EXPECT_LT(figure, edges);
    std::size_t found = 0;
    for (std::size_t at = text.find("<path", edges); at != std::string::npos; at = text.find("<path", at + 1)) ++found;
    return found;
  }
};

TEST_F(Edges, AreDarkAndChangeNothingElse) {
  // The near side of the cube covers the pixels 27 to 36 in both directions, and hides all of its other edges.
  for (const std::string& options : {std::string(), std::string("--samples 1 "), std::string("--method raycast ")}) {
    succeed(render_cube + options + "-o plain.npy");
    succeed(render_cube + options + "--edges --edge-width 2 -o edges.npy");
    const Image plain = image("plain.npy"), edges = image("edges.npy");
    ASSERT_EQ(plain.channels.size(), edges.channels.size());
    for (std::size_t c = 0; c < 3; ++c)
      for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
          const float before = plain.channels[c].floats()[std::size_t(y * 64 + x)],
                      after = edges.channels[c].floats()[std::size_t(y * 64 + x)];
          const int out = std::max({27 - x, x - 36, 27 - y, y - 36});  // 0 and 1: the pixels on both sides of an edge
          const bool is_at_corner = (x < 27 || x > 36) && (y < 27 || y > 36);
          if (out < -1 || out > 2) {
            EXPECT_EQ(after, before) << x << " " << y;
          } else if ((out == 0 || out == 1) && !is_at_corner) {
            EXPECT_LT(after, 0.0101f) << x << " " << y;
          }
        }
  }
}

TEST_F(Edges, AreTheSameBytesOnAnyNumberOfThreads) {
  const std::string render = "render builtin:gallery --resolution 200,120 --edges --threads ";
  for (const std::string threads : {"1", "2", "5"})
    succeed(render + threads + " --quiet -o " + threads + ".png -o " + threads + ".svg");
  for (const std::string kind : {".png", ".svg"}) {
    EXPECT_EQ(read("1" + kind), read("2" + kind));
    EXPECT_EQ(read("1" + kind), read("5" + kind));
  }
}

TEST_F(Edges, AreStrokesOverTheShapesOfFigures) {
  succeed(render_cube + "--edges -o near.svg -o near.pdf --quiet");
  EXPECT_EQ(edge_paths("near.svg"), 1u);  // the near side, once around
  // A pen of one pixel, 1/96 inch, in dark grey.
  EXPECT_THAT(read("near.svg"), HasSubstr("stroke=\"#1a1a1a\" stroke-width=\".265\""));
  // Nine edges are visible: three inner ones, and the outline in three pieces between these.
  succeed("render cube.stl --view iso --camera-orthographic --edges --edge-width 3 -o iso.svg --quiet");
  EXPECT_EQ(edge_paths("iso.svg"), 6u);
  EXPECT_THAT(read("iso.svg"), HasSubstr("stroke-width=\".794\""));
  succeed("render cube.stl --view iso --camera-orthographic -o plain.svg --quiet");
  EXPECT_THAT(read("plain.svg"), testing::Not(HasSubstr("edges")));
}

TEST_F(Edges, OfSeveralModelsHideBehindEachOther) {
  // A wall of 3 by 3, before the cube and in front of all of it.
  write("wall.obj", "v -1 -1 -1\nv 2 -1 -1\nv 2 -1 2\nv -1 -1 2\nf 1 2 3 4\n");
  const std::string options = render_cube.substr(render_cube.find("--")) + "--edges --quiet -o ";
  succeed("render wall.obj " + options + "wall.svg");
  succeed("render cube.stl wall.obj " + options + "both.svg");
  EXPECT_EQ(edge_paths("wall.svg"), 1u);
  const auto edges = [&](const std::string& file) { return read(file).substr(read(file).find("\"edges\"")); };
  EXPECT_EQ(edges("both.svg"), edges("wall.svg"));
  write("other.stl", cube_stl(1));
  succeed("render cube.stl other.stl --edges --quiet -o two.svg");
  EXPECT_GT(edge_paths("two.svg"), 9u);
}

TEST_F(Edges, OfABatchAreThoseOfSingleViews) {
  write("views.json", R"({"views": [{"view": "front"}, {"view": "iso"}, {"view": "top"}],
                          "outputs": {"output": "{view}.svg"}})");
  const std::string render = "render builtin:gallery --resolution 200,120 --edges --quiet ";
  succeed(render + "--batch views.json");
  for (const std::string view : {"front", "iso", "top"}) {
    succeed(render + "--view " + view + " -o alone.svg");
    EXPECT_GT(edge_paths(view + ".svg"), 10u);
    EXPECT_TRUE(read(view + ".svg") == read("alone.svg")) << view;
  }
}

TEST_F(Edges, HaveATimeOfTheirOwn) {
  EXPECT_GT(succeed(render_cube + "--edges -o p.png --json").json()["timings_ms"]["edges"], 0);
  EXPECT_FALSE(succeed(render_cube + "-o p.png --json").json()["timings_ms"].contains("edges"));
}

TEST_F(Edges, StandOnTransparentGroundAndInOtherFormats) {
  succeed(render_cube +
          "--edges --edge-width 2 --background transparent -o clear.png -o clear.webp -o clear.exr --bits 16");
  const Image clear = image("clear.png");
  const Buffer<float>& alpha = clear.find("A")->floats();
  EXPECT_EQ(alpha[30 * 64 + 26], 1);  // the outer half of the left edge
  EXPECT_EQ(alpha[30 * 64 + 24], 0);
  EXPECT_LT(clear.find("R")->floats()[30 * 64 + 26], 0.0101f);
  EXPECT_LT(image("clear.exr").find("R")->floats()[30 * 64 + 26], 0.0101f);
}

TEST_F(Edges, AreAsWideAsThePictureIsLarge) {
  const auto dark = [&](const std::string& options) {
    succeed("render cube.stl --view front --camera-orthographic --edges -o wide.npy " + options);
    const Image wide = image("wide.npy");
    const Buffer<float>& red = wide.channels[0].floats();
    // Ink across the left edge, in the middle row.
    double ink = 0;
    const std::size_t middle = std::size_t(wide.height / 2) * std::size_t(wide.width);
    for (int x = 0; x < wide.width / 2; ++x) ink += double(red[middle + std::size_t(x)]) < 0.1;
    return ink;
  };
  EXPECT_NEAR(dark("--resolution 320,180"), 1, 1);
  EXPECT_NEAR(dark("--resolution 3600,3600"), 4, 1);
  EXPECT_NEAR(dark("--resolution 320,180 --edge-width 10"), 10, 1);
}

TEST_F(Edges, RefuseWhatHasNone) {
  expect_failure("render cube.stl --edge-width 2 -o p.png", 2, "--edge-width needs --edges");
  const std::pair<const char*, const char*> cases[] = {
      {"--depth d.exr", "--edges: there is no picture to draw edges over"},
      {"--json", "files of --depth, --ids and --normals have none; add -o"},
      {"--hash", "--edges: there is no picture to draw edges over"},
      {"--stream -o p.png", "--edges: edges need the whole model at once; leave out --stream"},
      {"--layers 2 -o p{layer}.png", "--edges: layers have no edges; leave out --layers"},
      {"--deep d.exr", "--edges: deep files have no edges; leave out --deep"},
      {"--camera-model panorama -o p.png", "--edges: edges need a pinhole camera; leave out --camera-model"},
      {"--cull back -o p.png", "--edges: all surfaces hide edges; leave out --cull"},
      {"--depth-func greater -o p.png", "--edges: edges are hidden exactly, without the options of a depth buffer"},
      {"--mpi -o p.png", "--edges: edges need the whole model in one process; leave out --mpi"},
      {"--edge-width 0 -o p.png", "--edge-width"},
  };
  for (const auto& [options, message] : cases)
    expect_failure(std::string("render cube.stl --edges ") + options, 2, message);
  EXPECT_THAT(files(), testing::ElementsAre("cube.stl"));
}

}  // namespace
}  // namespace frontmost::test
