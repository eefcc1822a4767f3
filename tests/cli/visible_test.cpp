// SPDX-License-Identifier: Apache-2.0
// frontmost visible: lists of visible faces, from one place and from many.
#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "program.h"

namespace frontmost::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

class VisibleCommand : public ProgramTest {
 protected:
  /// A square of two triangles, 8 x 8 pixels of the view, and a triangle behind it.
  VisibleCommand() {
    write("plate.obj",
          "o square\nv -4 -4 0\nv 4 -4 0\nv 4 4 0\nv -4 4 0\nf 1 2 3\nf 1 3 4\n"
          "o behind\nv -1 -1 -1\nv 1 -1 -1\nv 0 1 -1\nf 5 6 7\n");
    write("views.json", R"({"views": [
      {"camera-position": [0, 0, 10]}, {"camera-position": [0, 0, -10], "outputs": {"output": "x.png"}}]})");
  }
  [[nodiscard]] std::vector<std::string> lines(const std::string& name) const {
    std::vector<std::string> result;
    std::istringstream text(read(name));
    for (std::string line; std::getline(text, line);) result.push_back(line);
    return result;
  }

  /// The numbers in a row.
  static std::vector<double> numbers(const std::string& row) {
    std::vector<double> result;
    std::istringstream text(row);
    for (std::string word; std::getline(text, word, ',');) result.push_back(std::stod(word));
    return result;
  }
  static auto are(const std::vector<double>& expected) {
    return testing::Pointwise(testing::DoubleNear(1e-9), expected);
  }

  static constexpr const char* lens =
      " --camera-focal-point 0,0,0 --camera-view-up +y --intrinsics 10,10,5,5 --pixel-center half --resolution 10,10 "
      "--near 1 --far 100 ";
  static constexpr const char* from_above = " --camera-position 0,0,10 ";
};

TEST_F(VisibleCommand, OfOneViewListsTheAreasOfFaces) {
  const std::string text = succeed(std::string("visible plate.obj -o faces.csv") + lens + from_above).out;
  EXPECT_EQ(text,
            "10 x 10 pixels: 64.000 see a face, 36.000 see none\n"
            "2 of 3 faces seen, 1 not\n"
            "the smallest part covers 32 pixels\n");
  const std::vector<std::string> rows = lines("faces.csv");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0], "primitive,object,triangle,pixels,area,solid_angle");
  // Half of a rectangle's solid angle: 4 atan(a b / (d sqrt(a^2 + b^2 + d^2))), where a and b are half its sides.
  const double half_square = 2 * std::atan(16 / (10 * std::sqrt(132.0)));
  EXPECT_THAT(numbers(rows[1]), are({0, 0, 0, 32, 32, half_square}));
  EXPECT_THAT(numbers(rows[2]), are({1, 0, 1, 32, 32, half_square}));
}

TEST_F(VisibleCommand, OfManyViewsListsWhatIsEverSeen) {
  const std::string text = succeed(std::string("visible plate.obj --views views.json -o faces.csv") + lens).out;
  EXPECT_EQ(text, "2 views: 3 of 3 faces ever seen, 0 not\n");
  const std::vector<std::string> rows = lines("faces.csv");
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0], "primitive,object,triangle,views,best_view,largest_share,largest_pixels");
  EXPECT_THAT(numbers(rows[1]), are({0, 0, 0, 2, 0, 1, 32}));
  EXPECT_THAT(numbers(rows[3]), are({2, 1, 0, 1, 1, 1, 2.0 * 100 / 81}));
  EXPECT_FALSE(exists("x.png"));
}

TEST_F(VisibleCommand, FromAllAroundEverySideOfACubeIsSeenByHalfOfTheViews) {
  write("cube.stl", cube_stl());
  const json report = succeed("visible cube.stl --sphere 100 --resolution 20,20 -o faces.csv --json").json();
  EXPECT_EQ(report["views"], 100);
  EXPECT_EQ(report["faces"], 12);
  EXPECT_EQ(report["seen"], 12);
  EXPECT_EQ(report["files"], json({"faces.csv"}));
  const std::vector<std::string> rows = lines("faces.csv");
  ASSERT_EQ(rows.size(), 13u);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    int primitive = 0, object = 0, triangle = 0, views = 0;
    ASSERT_EQ(std::sscanf(rows[i].c_str(), "%d,%d,%d,%d", &primitive, &object, &triangle, &views), 4);
    // An eye at a finite distance sees a side from less than half of all places.
    EXPECT_GT(views, 25) << rows[i];
    EXPECT_LE(views, 50) << rows[i];
  }
}

TEST_F(VisibleCommand, NpyHoldsTheSameAsCsv) {
  const std::string model = "visible builtin:teapot --resolution 100,80 -q -o ";
  const std::string table = succeed(model + "- -o faces.npy").out;
  const auto rows = std::size_t(std::count(table.begin(), table.end(), '\n')) - 1;
  const std::string bytes = read("faces.npy");
  EXPECT_THAT(bytes, HasSubstr("[('primitive', '<u4'), ('object', '<u4'), ('triangle', '<u4'), ('pixels', '<f8'), "
                               "('area', '<f8'), ('solid_angle', '<f8')]"));
  EXPECT_THAT(bytes, HasSubstr("'shape': (" + std::to_string(rows) + ",)"));
  EXPECT_EQ((bytes.size() - rows * 36) % 64, 0u);
}

TEST_F(VisibleCommand, TheReportSaysHowMuchIsSeen) {
  const json report = succeed(std::string("visible plate.obj --json") + lens + from_above).json();
  EXPECT_EQ(report["seen"], 2);
  EXPECT_NEAR(report["pixels"].get<double>(), 64, 1e-9);
  EXPECT_NEAR(report["background"].get<double>(), 36, 1e-9);
  EXPECT_NEAR(report["smallest"].get<double>(), 32, 1e-9);
  write("empty.obj", "v 0 0 0\n");
  EXPECT_TRUE(succeed("visible empty.obj --json").json()["smallest"].is_null());
}

TEST_F(VisibleCommand, TheModelItselfIsColouredByWhatIsSeen) {
  succeed(std::string("visible plate.obj -o seen.ply") + lens + from_above);
  const std::string model = read("seen.ply");
  const std::size_t end = model.find("end_header\n") + 11;
  EXPECT_THAT(
      model.substr(0, end),
      HasSubstr("element face 3\nproperty list uchar uint vertex_indices\nproperty uint object\n"
                "property uint triangle\nproperty double pixels\nproperty double area\n"
                "property double solid_angle\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"));
  constexpr std::size_t row = 1 + 3 * 4 + 2 * 4 + 3 * 8 + 3;
  ASSERT_EQ(model.size(), end + 7 * 3 * 4 + 3 * row);
  const auto color = [&](std::size_t face) { return model.substr(model.size() - (2 - face) * row - 3, 3); };
  EXPECT_EQ(color(0), "\xFD\xE7\x25");  // wholly visible: yellow
  EXPECT_EQ(color(2), "\x80\x80\x80");  // not visible
  succeed("visible plate.obj --views views.json -o ever.ply" + std::string(lens));
  EXPECT_THAT(read("ever.ply"), HasSubstr("property double largest_share\n"));
  EXPECT_THAT(succeed("info seen.ply").out, HasSubstr("3 triangles"));
}

TEST_F(VisibleCommand, AModelOfWhatIsSeenLeavesOutTheRest) {
  const std::string text =
      succeed(std::string("visible plate.obj --keep-visible a.glb --keep-visible a.ply --keep-visible a.stl") + lens +
              from_above)
          .out;
  EXPECT_THAT(text, HasSubstr("1 of 3 faces and 1 of 2 objects left out\n"));
  for (const char* name : {"a.glb", "a.ply", "a.stl"}) {
    const json report = succeed(std::string("visible ") + name + " --json" + lens + from_above + "--up +y").json();
    EXPECT_EQ(report["faces"], 2) << name;
    EXPECT_EQ(report["seen"], 2) << name;
    EXPECT_NEAR(report["pixels"].get<double>(), 64, 1e-9) << name;
  }
  EXPECT_THAT(read("a.ply"), HasSubstr("property uint object\nproperty uint triangle\nend_header\n"));
  const json report = succeed(std::string("visible plate.obj --keep-visible b.stl --json") + lens + from_above).json();
  EXPECT_EQ(report["left_out"], (json{{"faces", 1}, {"objects", 1}}));
  EXPECT_EQ(report["files"], json({"b.stl"}));
}

TEST_F(VisibleCommand, WrongOptionsAreNamed) {
  expect_failure("visible plate.obj --views views.json --sphere 3", 2, "--views and --sphere exclude each other");
  expect_failure("visible plate.obj --sphere 3 --view top", 2, "--sphere looks from all around");
  expect_failure("visible plate.obj --sphere 0", 2, "--sphere: 0 is not between 1 and 100000");
  expect_failure("visible plate.obj -o faces.txt", 2, "faces.txt: the suffix names no format; use .csv, .npy or .ply");
  expect_failure("visible plate.obj --keep-visible a.obj", 2, "a.obj: the suffix names no format of models");
  expect_failure("visible plate.obj -o a.ply --keep-visible a.ply", 2, "would be written twice");
  expect_failure("visible plate.obj -o - --json", 2, "both write to standard output");
  expect_failure("visible plate.obj --views missing.json", 1, "missing.json: ");
  expect_failure("visible plate.obj --views views.json -o views.json", 2, "the suffix names no format");
  write("panorama.json", R"({"views": [{"camera-model": "panorama"}]})");
  expect_failure("visible plate.obj --views panorama.json", 2,
                 "panorama.json: views[0]: the command visible needs a pinhole camera");
  EXPECT_THAT(files(), ElementsAre("panorama.json", "plate.obj", "views.json"));
}

}  // namespace
}  // namespace frontmost::test
