// SPDX-License-Identifier: Apache-2.0
// frontmost render with a depth buffer: state from flags and batch files, stored values out, wrong usage.
#include <frontmost/files.h>
#include <gmock/gmock.h>

#include "program.h"

namespace frontmost::test {
namespace {

using testing::HasSubstr;

class DepthBufferFlags : public ProgramTest {
 protected:
  DepthBufferFlags() { write("cube.stl", cube_stl()); }

  [[nodiscard]] Buffer<float> window(const std::string& name) const {
    return load_image(path(name)).find("window_depth")->floats();
  }
};

// The cube's near side is 10 from the eye. Between planes at 5 and 20, its depth is (1/5 - 1/10) / (1/5 - 1/20) = 2/3.
const std::string render_between_planes = render_cube + "--near 5 --far 20 ";
constexpr std::size_t middle_pixel = 32 * 64 + 32;

TEST_F(DepthBufferFlags, WindowDepthIsWhatIsStored) {
  succeed(render_between_planes + "--window-depth w.exr");
  EXPECT_NEAR(window("w.exr")[middle_pixel], 2.0 / 3, 1.0 / 16777215);
  EXPECT_EQ(window("w.exr")[0], 1);
  succeed(render_between_planes + "--window-depth w.npy --depth-format D8");
  EXPECT_FLOAT_EQ(load_image(path("w.npy")).channels[0].floats()[middle_pixel], 170 / 255.0f);
  succeed(render_between_planes + "--window-depth w.exr --depth-format F32 --reversed");
  EXPECT_FLOAT_EQ(window("w.exr")[middle_pixel], 1 / 3.0f);
  EXPECT_EQ(window("w.exr")[0], 0);
  succeed(render_between_planes + "--window-depth w.exr --depth-format F32 --depth-range 0.5,0.25 --depth-clear 0.75");
  // With the winding reversed, LESS sees the far side: 11 away, (1/5 - 1/11) / (1/5 - 1/20) = 8/11.
  EXPECT_FLOAT_EQ(window("w.exr")[middle_pixel], 0.5f - 0.25f * 8 / 11);
  EXPECT_EQ(window("w.exr")[0], 0.75f);
  succeed(render_between_planes + "--window-depth w.exr --depth-mask off");
  EXPECT_EQ(window("w.exr")[middle_pixel], 1);
  succeed(render_between_planes + "--window-depth w.exr --depth-format D16 --polygon-offset 0,-1000 --depth w.exr");
  EXPECT_NEAR(window("w.exr")[middle_pixel], 2.0 / 3 - 1000 / 65535.0, 1e-5);
  EXPECT_FLOAT_EQ(load_image(path("w.exr")).find("Z")->floats()[middle_pixel], 10) << "the surface is where it is";
  succeed(render_between_planes + "--window-depth w.png --depth-scale 65535");
  EXPECT_NEAR(load_image(path("w.png")).find("window_depth")->floats()[middle_pixel], 2.0 / 3, 1e-5);
}

TEST_F(DepthBufferFlags, TheFunctionDecidesWhichSideIsSeen) {
  const auto seen = [&](const std::string& flags) {
    succeed(render_between_planes + "--ids primitive=p.npy " + flags);
    return load_image(path("p.npy")).channels[0].integers()[middle_pixel] / 2;
  };
  const std::uint32_t nearest = seen(""), last = seen("--depth-func ALWAYS"),
                      farthest = seen("--depth-func GREATER --depth-clear 0");
  EXPECT_EQ(nearest, 2u);  // the side at low y comes third in the file
  EXPECT_EQ(seen("--depth-func LESS"), nearest);
  EXPECT_EQ(seen("--depth-func less"), nearest) << "any case";
  EXPECT_EQ(seen("--reversed --depth-format F32"), nearest);
  EXPECT_NE(farthest, nearest);
  EXPECT_EQ(last, farthest) << "the side at high y comes after";
  EXPECT_EQ(seen("--depth-func NEVER"), no_primitive / 2);
}

TEST_F(DepthBufferFlags, TheReportSaysTheState) {
  const nlohmann::json report = succeed(render_between_planes + "--depth-format D16 --reversed --json").json();
  EXPECT_EQ(report["depth_buffer"]["format"], "D16");
  EXPECT_EQ(report["depth_buffer"]["func"], "GREATER");
  EXPECT_EQ(report["depth_buffer"]["clear"], 0);
  EXPECT_EQ(report["depth_buffer"]["reversed"], true);
  EXPECT_FALSE(succeed(render_between_planes + "--json").json().contains("depth_buffer"));
}

TEST_F(DepthBufferFlags, BatchFilesSayItToo) {
  write("b.json", R"({"views": [{"name": "a", "depth-format": "D8", "depth-range": [0.5, 1]}, {"name": "b"}],
                      "outputs": {"window-depth": "{view}.exr"}})");
  succeed(render_between_planes + "--batch b.json");
  EXPECT_FLOAT_EQ(window("a.exr")[middle_pixel],
                  213 / 255.0f);  // 0.5 + 0.5 * 2/3 is 212.5, which rounds to the even neighbour or up
  EXPECT_NEAR(window("b.exr")[middle_pixel], 2.0 / 3, 1e-6);
}

TEST_F(DepthBufferFlags, WrongUsageIsNamed) {
  expect_failure(render_between_planes + "-o a.png --depth-func SMALLER", 2,
                 "--depth-func: 'SMALLER' is not one of NEVER, LESS");
  expect_failure(render_between_planes + "-o a.png --depth-format D32", 2,
                 "--depth-format: 'D32' is not one of D8, D16, D24, F32");
  expect_failure(render_between_planes + "-o a.png --depth-range 0,2", 2, "--depth-range: 2 is not between 0 and 1");
  expect_failure(render_between_planes + "-o a.png --depth-clear nan", 2, "--depth-clear: ");
  expect_failure(render_between_planes + "-o a.png --polygon-offset 1", 2,
                 "--polygon-offset: '1' has 1 values, 2 are needed");
  expect_failure("info cube.stl --depth-func LESS", 2, "--depth-func is not an option of 'frontmost info'");
  EXPECT_THAT(succeed("render --help").out, HasSubstr("Depth buffer, with the names of OpenGL:"));
}

}  // namespace
}  // namespace frontmost::test
