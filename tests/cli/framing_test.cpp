// SPDX-License-Identifier: Apache-2.0
// How views are fitted to models, and messages about objects that reach out of the picture.
#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "program.h"

namespace frontmost::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// An OBJ of squares of size 2 in z = 0, each an object, at these centres.
std::string squares(const std::vector<std::pair<std::string, double>>& objects) {
  std::string text;
  for (const auto& [name, size] : objects) {
    text += "o " + name + "\n";
    for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
      text += "v " + std::to_string(x * size) + " " + std::to_string(y * size) + " 0\n";
    text += "f -4 -3 -2 -1\n";
  }
  return text;
}

class Framing : public ProgramTest {
 protected:
  Framing() {
    write("village.obj", squares({{"house", 1}, {"barn", 1}, {"well", 1}, {"field", 100}, {"sky", 1000}}));
    write("houses.obj", squares({{"house", 1}, {"barn", 1}, {"well", 1}}));
  }
  json camera(const std::string& words) { return succeed("camera " + words + " --json").json(); }
};

constexpr const char* kWarning =
    "2 of 5 objects reach far beyond the others and out of the picture: 'field', 'sky'; --frame all fits all objects";

TEST_F(Framing, ThoseThatReachOutAreNamedOnce) {
  const Outcome one = succeed("render village.obj -o x.png --resolution 16,16 --json");
  EXPECT_EQ(one.err, std::string("frontmost: warning: ") + kWarning + "\n");
  EXPECT_THAT(one.json()["warnings"], ElementsAre(kWarning));
  write(
      "views.json",
      R"({"views": [{"view": "front", "outputs": {"output": "a.png"}}, {"view": "back", "outputs": {"output": "b.png"}}]})");
  const Outcome several = succeed("render village.obj --batch views.json --resolution 16,16 --json");
  EXPECT_EQ(several.err, one.err);
  EXPECT_THAT(several.json()["warnings"], ElementsAre(kWarning));
  for (const std::string words : {"camera village.obj", "compare village.obj --resolution 16,16",
                                  "precision village.obj --format D16 --resolution 16,16"})
    EXPECT_THAT(succeed(words).err, HasSubstr(kWarning)) << words;
  EXPECT_THAT(succeed("camera village.obj --quiet").err, IsEmpty());
}

TEST_F(Framing, OthersAreFramedAsIfTheyWereAlone) {
  for (const std::string view : {"", " --view front", " --camera-azimuth-angle 20", " --camera-focal-point 0,1,0",
                                 " --camera-direction -1,-1,-1 --camera-view-angle 50"}) {
    const json alone = camera("houses.obj" + view), with = camera("village.obj" + view);
    EXPECT_EQ(alone["look_at"]["eye"], with["look_at"]["eye"]) << view;
    EXPECT_EQ(alone["sides"], with["sides"]) << view;
    EXPECT_NE(alone["look_at"]["eye"], camera("village.obj --frame all" + view)["look_at"]["eye"]) << view;
    EXPECT_EQ(alone, camera("houses.obj --frame all" + view)) << view;
  }
}

TEST_F(Framing, NothingIsSaidWhereNothingIsFitted) {
  for (const std::string view : {"--frame all", "--camera-position 0,0,9 --camera-focal-point 0,0,0"})
    EXPECT_THAT(succeed("render village.obj -o x.png --resolution 16,16 " + view).err, IsEmpty()) << view;
  EXPECT_THAT(succeed("render houses.obj -o x.png --resolution 16,16").err, IsEmpty());
}

// Drawings are fitted to all objects, as nobody would notice a missing one.
TEST_F(Framing, DrawingsHoldEverything) {
  EXPECT_THAT(succeed("lines village.obj --view front -o a.svg").err, IsEmpty());
  EXPECT_NE(read("a.svg"), (succeed("lines houses.obj --view front -o b.svg"), read("b.svg")));
}

TEST_F(Framing, WhatContradictsItIsRefused) {
  expect_failure("camera village.obj --frame subject --camera-position 0,0,9", cli::exit_usage,
                 "--frame and --camera-position exclude each other");
  expect_failure("render a.stl --stream --frame subject -o x.png", cli::exit_usage,
                 "--stream always fits all objects into the picture; it excludes --frame subject");
  write("views.json", R"({"views": [{"view": "front"}, {"frame": "subject"}], "outputs": {"output": "{view}.png"}})");
  expect_failure("render a.stl --stream --batch views.json", cli::exit_usage,
                 "views[1]: --stream always fits all objects into the picture; it excludes --frame subject");
}

/// A cone whose base lies in the plane of two axes.
std::string cone(const std::string& order) {
  constexpr int sides = 16;
  std::ostringstream text;
  const auto vertex = [&](double across, double along, double up) {
    text << 'v';
    for (const char axis : order) text << ' ' << (axis == 'a' ? across : axis == 'b' ? along : up);
    text << '\n';
  };
  for (int i = 0; i < sides; ++i) vertex(std::cos(i * 6.283185307 / sides), std::sin(i * 6.283185307 / sides), 0);
  vertex(0, 0, 2);
  text << 'f';
  for (int i = sides; i > 0; --i) text << ' ' << i;
  for (int i = 0; i < sides; ++i) text << "\nf " << i + 1 << ' ' << (i + 1) % sides + 1 << ' ' << sides + 1;
  text << '\n';
  return text.str();
}

TEST_F(Framing, AModelThatLiesOnItsBackIsToldHowToStand) {
  constexpr const char* lies =
      "the model may lie on its back: its only flat side faces -z, but its up axis is y; --up +z";
  write("lying.obj", cone("abu"));
  write("standing.obj", cone("bua"));
  for (const std::string command :
       {"camera lying.obj", "report lying.obj --resolution 16,16", "visible lying.obj --resolution 16,16",
        "lines lying.obj -o a.svg", "render lying.obj -o a.png --resolution 16,16"})
    EXPECT_THAT(succeed(command).err, HasSubstr(lies)) << command;
  const json told = succeed("render lying.obj -o a.png --resolution 16,16 --json").json();
  EXPECT_THAT(told["warnings"].dump(), HasSubstr(lies));
  for (const std::string command : {"camera lying.obj --up z", "camera standing.obj",
                                    "camera lying.obj --camera-position 0,0,9 --camera-direction 0,0,-1"})
    EXPECT_THAT(succeed(command).err, IsEmpty()) << command;
  EXPECT_THAT(succeed("camera standing.obj --up y").err, IsEmpty());
}

TEST_F(Framing, AThreadOfPixelsIsSaidToBeOne) {
  const std::string bar = "v 0 0 0\nv 90 0 0\nv 90 1 0\nv 0 1 0\nf 1 2 3 4\n";
  write("bar.obj", bar);
  const std::string view = " --view front --camera-orthographic -o a.png --resolution ";
  EXPECT_THAT(succeed("render bar.obj" + view + "100,100").err,
              HasSubstr("warning: the visible part of the model is a thread, 90 pixels long and 1.0 wide on average; "
                        "try another --view or a larger --resolution"));
  EXPECT_THAT(succeed("render bar.obj --json" + view + "100,100").json()["warnings"].dump(), HasSubstr("a thread"));
  EXPECT_THAT(succeed("render bar.obj" + view + "600,100").err, IsEmpty());
  EXPECT_THAT(succeed("render bar.obj" + view + "30,30").err, Not(HasSubstr("thread"))) << "as short as a dot";
}

}  // namespace
}  // namespace frontmost::test
