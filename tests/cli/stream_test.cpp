// SPDX-License-Identifier: Apache-2.0
// --stream gives the same files as without it, to the byte.
#include <gmock/gmock.h>

#include <array>
#include <initializer_list>

#include "program.h"
#include "support/effort.h"

namespace frontmost::test {
namespace {

class StreamedProgram : public ProgramTest {
 protected:
  StreamedProgram() {
    write("a.stl", cube_stl());
    write("b.stl", cube_stl(1.5f));
  }
  void expect_same_bytes(const std::string& options) const {
    SCOPED_TRACE(options);
    const std::string end =
        " --resolution 96,64 --hash -o {}.png --depth {}.exr --ids primitive={}.exr "
        "--ids object={}.exr --normals {}.npy";
    const auto named = [&](const std::string& name) {
      std::string line = end;
      for (std::size_t at; (at = line.find("{}")) != std::string::npos;) line.replace(at, 2, name);
      return line;
    };
    succeed("render " + options + named("whole"));
    succeed("render " + options + named("stream") + " --stream");
    for (const char* suffix : {".png", ".exr", ".npy"})
      EXPECT_EQ(read(std::string("whole") + suffix), read(std::string("stream") + suffix)) << suffix;
  }
};

TEST_F(StreamedProgram, WritesTheSameBytes) {
  for (const char* options :
       {"a.stl", "a.stl b.stl", "a.stl b.stl --view iso --camera-orthographic", "b.stl --camera-direction=-1,2,-0.5",
        "a.stl b.stl --camera-position 4,5,6 --camera-focal-point 0,0,0 --near 1 --far 20 --samples 1",
        "a.stl --camera-azimuth-angle 33 --camera-elevation-angle 12 --camera-zoom-factor 2 --cull back",
        "b.stl a.stl --shading ids", "a.stl --shading flat --no-shadows", "a.stl --shading normals",
        "a.stl --intrinsics 60,60,48,32 --camera-focal-point 0,0,0"})
    expect_same_bytes(options);
}

TEST_F(StreamedProgram, ReadsOnlyAsOftenAsNeeded) {
  const auto passes = [&](const std::string& options) {
    return succeed("render a.stl --json --stream --resolution 32,32 " + options).json()["stream_passes"].get<int>();
  };
  const std::string placed = "--camera-position 4,5,6 --camera-focal-point 0,0,0 --near 1 --far 20 ";
  EXPECT_EQ(passes(placed + "--depth d.exr"), 1);
  EXPECT_EQ(passes(placed + "-o p.png --shading flat"), 1);
  EXPECT_EQ(passes(placed + "-o p.png"), 2);
  EXPECT_EQ(passes("--depth d.exr"), 2);
  EXPECT_EQ(passes("-o p.png"), 3);
}

TEST_F(StreamedProgram, StandardInputIsReadOnce) {
  const std::vector<std::string> words = {"render", "-", "--stream", "--resolution", "32,32", "-o", "p.png"};
  Call call{.words = words, .input = cube_stl()};
  EXPECT_EQ(run(call).status, 1);
  EXPECT_NE(run(call).err.find("only once"), std::string::npos);
  for (const char* word : {"--camera-position", "4,5,6", "--camera-focal-point", "0,0,0", "--near", "1", "--far", "20",
                           "--shading", "flat"})
    call.words.emplace_back(word);
  const Outcome outcome = run(call);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  succeed(
      "render a.stl --resolution 32,32 -o whole.png --camera-position 4,5,6 --camera-focal-point 0,0,0 "
      "--near 1 --far 20 --shading flat");
  EXPECT_EQ(read("p.png"), read("whole.png"));
}

TEST_F(StreamedProgram, SaysWhyNothingIsInView) {
  write("empty.stl", std::string(80, ' ') + std::string(4, '\0'));
  for (const char* options :
       {"empty.stl", "empty.stl empty.stl", "a.stl --camera-position 0,-5,0 --camera-direction -y",
        "a.stl b.stl --camera-position 0,-5,0 --camera-direction y --far 1", "a.stl --cull both",
        "a.stl b.stl --camera-position 0,-5,0 --camera-direction 1,0.3,0 --near 1 --far 20 --shading flat",
        "b.stl --camera-position 0.3,-90000,0.2 --camera-direction y"}) {
    const std::string line = std::string("render ") + options + " --resolution 32,32 -o p.png";
    const Outcome whole = succeed(line);
    EXPECT_NE(whole.err.find("nothing is in view: "), std::string::npos) << line;
    EXPECT_EQ(succeed(line + " --stream").err, whole.err) << line;
    EXPECT_EQ(succeed(line + " --json --quiet --stream").json()["warnings"],
              succeed(line + " --json --quiet").json()["warnings"]);
  }
}

TEST_F(StreamedProgram, WarningsNameTheModelThatTheyAreAbout) {
  write("empty.stl", std::string(80, ' ') + std::string(4, '\0'));
  write("rest.stl", read("a.stl") + std::string(7, '\0'));
  const std::string line = "render a.stl rest.stl empty.stl --resolution 32,32 -o p.png --json";
  for (const char* options : {"", " --stream", " --stream --threads 2"}) {
    const Outcome outcome = succeed(line + options);
    const auto warnings = outcome.json()["warnings"].get<std::vector<std::string>>();
    EXPECT_THAT(warnings, testing::UnorderedElementsAre(testing::StartsWith("rest.stl: byte "),
                                                        "empty.stl: the file holds no triangles"))
        << options;
    for (const std::string& warning : warnings)
      EXPECT_THAT(outcome.err, testing::HasSubstr("frontmost: warning: " + warning + "\n")) << options;
  }
}

/// An STL of a slightly bent sheet, two triangles for every square, from its near end to its far end.
std::string sheet_stl(std::uint32_t columns, std::uint32_t rows) {
  std::string stl(80, ' ');
  const std::uint32_t count = 2 * columns * rows;
  stl.append(reinterpret_cast<const char*>(&count), 4);
  stl.reserve(84 + 50 * std::size_t(count));
  const auto put = [&](std::initializer_list<std::array<std::uint32_t, 2>> corners) {
    float facet[12] = {};
    float* next = facet + 3;
    for (const auto& [i, j] : corners) {
      *next++ = float(i) / float(columns);
      *next++ = float(j) / float(rows);
      *next++ = float((i * 7 + j * 3) % 11) / 500;
    }
    stl.append(reinterpret_cast<const char*>(facet), sizeof facet);
    stl.append(2, '\0');
  };
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      put({{i, j}, {i + 1, j}, {i + 1, j + 1}});
      put({{i, j}, {i + 1, j + 1}, {i, j + 1}});
    }
  return stl;
}

// The triangles take 150 MB on disk; the model would take 150 MB in memory, and the mapped file its own size.
TEST_F(StreamedProgram, DrawsInMemoryThatTheModelDoesNotFitInto) {
  if (under_sanitizer) GTEST_SKIP() << "the sanitizer takes all addresses";
  write("sheet.stl", sheet_stl(1500, 1000));
  const auto call = [](const char* name, bool stream, std::optional<std::size_t> limit) {
    Call one{.words = {"render", "sheet.stl", "--resolution", "160,120", "--threads", "1", "-o", name}};
    if (stream) one.words.emplace_back("--stream");
    one.address_space = limit;
    return one;
  };
  constexpr std::size_t limit = std::size_t(250) << 20;
  const Outcome streamed = run(call("stream.png", true, limit));
  EXPECT_EQ(streamed.status, 0) << streamed.err;
  EXPECT_EQ(run(call("whole.png", false, limit)).status, 1);
  EXPECT_EQ(run(call("whole.png", false, std::nullopt)).status, 0);
  EXPECT_EQ(read("stream.png"), read("whole.png"));
}

TEST_F(StreamedProgram, RefusesWhatItCannotDo) {
  expect_failure("render builtin:cubes --stream -o p.png", 1, "cannot be streamed");
  expect_failure("render a.stl --stream --repeat 3 -o p.png", 2, "exclude each other");
  expect_failure("render a.stl --stream --shadows rays -o p.png", 2, "exclude each other");
  expect_failure("render a.stl --stream --opacity 0.5 -o p.png", 2, "excludes --opacity");
  expect_failure("info a.stl b.stl", 2, "one model at a time");
}

}  // namespace
}  // namespace frontmost::test
