// SPDX-License-Identifier: Apache-2.0
// --stream: the same files, to the byte, as without it.
#include "program.h"

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

TEST_F(StreamedProgram, RefusesWhatItCannotDo) {
  expect_failure("render builtin:cubes --stream -o p.png", 1, "cannot be streamed");
  expect_failure("render a.stl --stream --repeat 3 -o p.png", 2, "exclude each other");
  expect_failure("render a.stl --stream --shadows rays -o p.png", 2, "exclude each other");
  expect_failure("info a.stl b.stl", 2, "one model at a time");
}

}  // namespace
}  // namespace frontmost::test
