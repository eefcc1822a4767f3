// SPDX-License-Identifier: Apache-2.0
// Threads, memory and file sizes that a system may refuse: the program manages with less, or names what is missing.
#include <gmock/gmock.h>
#include <signal.h>

#include "program.h"
#include "support/effort.h"

namespace frontmost::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SystemLimits : public ProgramTest {
 protected:
  SystemLimits() { write("cube.stl", cube_stl()); }

  [[nodiscard]] std::vector<std::string> words(const std::string& line) const {
    std::istringstream words(line);
    return {std::istream_iterator<std::string>(words), {}};
  }
};

TEST_F(SystemLimits, ThreadsThatCannotBeMadeAreDoneWithout) {
  if (under_sanitizer) GTEST_SKIP() << "a sanitizer's own thread cannot be made";
  open_to_all();
  const std::string line = "render builtin:city --resolution 640,360 --threads 16 --hash";
  const Outcome all = succeed(line);
  for (const std::size_t processes : {1, 2, 5, 14, 20}) {
    const Outcome outcome = run(Call{.words = words(line), .processes = processes});
    if (outcome.status == 127) GTEST_SKIP() << "another user cannot run the program where it lies";
    EXPECT_EQ(outcome.status, 0) << processes << " processes: " << outcome.err;
    EXPECT_EQ(outcome.out, all.out) << processes;
  }
  for (const char* other :
       {"info builtin:city --threads 16", "lines builtin:city --threads 16 -o a.svg", "camera builtin:city --threads 8",
        "render builtin:city --threads 16 --method raycast -o b.exr", "lidar builtin:city --from 0,2,0 --json -q",
        "render builtin:city --threads 16 --method abuffer --resolution 320,180 -o c.svg.png"}) {
    const Outcome outcome = run(Call{.words = words(other), .processes = 3});
    EXPECT_EQ(outcome.status, 0) << other << ": " << outcome.err;
  }
}

TEST_F(SystemLimits, ThreadsThatMemoryHasNoRoomForAreDoneWithout) {
  if (under_sanitizer) GTEST_SKIP() << "there is nothing to limit";
  const std::string line = "render builtin:cubes --resolution 320,180 --hash --threads ";
  const Outcome one = succeed(line + "1");
  for (const std::size_t mebibytes : {200, 300, 500, 900}) {
    const Outcome outcome = run(Call{.words = words(line + "256"), .address_space = mebibytes << 20});
    EXPECT_EQ(outcome.status, 0) << mebibytes << " MiB: " << outcome.err;
    EXPECT_EQ(outcome.out, one.out);
  }
}

TEST_F(SystemLimits, WhereMemoryEndsTheModelIsNamed) {
  if (under_sanitizer) GTEST_SKIP() << "there is nothing to limit";
  const Outcome outcome = run(Call{.words = words("render cube.stl -o a.png --resolution 16000,16000 --threads 1"),
                                   .address_space = std::size_t(400) << 20});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err, "frontmost: cube.stl: out of memory\n");
  EXPECT_THAT(files(), ElementsAre("cube.stl"));
}

TEST_F(SystemLimits, FilesThatGrowTooLargeAreNamed) {
  const std::pair<const char*, const char*> outputs[] = {
      {"render cube.stl --resolution 200,200 -o ", "a.png"},
      {"render cube.stl --resolution 200,200 -o ", "a.exr"},
      {"render cube.stl --resolution 200,200 --depth ", "a.pfm"},
      {"render cube.stl --resolution 200,200 --depth ", "a.npy"},
      {"render cube.stl --resolution 200,200 -o ", "a.svg"},
      {"render cube.stl --resolution 200,200 -o ", "a.pdf"},
      {"render cube.stl --method abuffer --resolution 200,200 --deep ", "a.exr"},
      {"lines cube.stl -o ", "a.svg"},
      {"lines cube.stl -o ", "a.dxf"},
      {"lines cube.stl -o ", "a.pdf"},
      {"lines cube.stl -o ", "a.json"},
      {"lidar cube.stl --from 0.5,0.5,0.5 -o ", "a.ply"},
      {"precision --near 1 --far 100 --plot ", "a.svg"}};
  for (const auto& [line, name] : outputs) {
    const Outcome outcome = run(Call{.words = words(std::string(line) + name + " --quiet"), .file_size = 500});
    EXPECT_EQ(outcome.status, 1) << line << name;
    EXPECT_EQ(outcome.err, std::string("frontmost: ") + name + ": cannot write: File too large\n") << line;
    EXPECT_THAT(files(), ElementsAre("cube.stl")) << line;
  }
}

TEST_F(SystemLimits, APageIsWrittenWholeOrNotAtAll) {
  const std::string line = "compare cube.stl --runs 1 --resolution 160,120 -o ";
  succeed(line + "whole");
  const auto size = [&](const char* name) { return std::filesystem::file_size(path(std::string("whole/") + name)); };
  // Every picture fits the limit, but not the page, which holds them all.
  const std::size_t most = 2 * std::max(size("zbuffer.png"), size("painter-centroid-differences.png"));
  ASSERT_LT(most, size("index.html"));
  const Outcome outcome = run(Call{.words = words(line + "new/page"), .file_size = most});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("new/page/index.html: cannot write: File too large"));
  EXPECT_THAT(files(), ElementsAre("cube.stl", "whole")) << "the folders that were made are gone too";
  const std::string before = read("whole/index.html") + read("whole/zbuffer.png");
  EXPECT_EQ(run(Call{.words = words(line + "whole --view front"), .file_size = most}).status, 1);
  EXPECT_EQ(read("whole/index.html") + read("whole/zbuffer.png"), before);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path("whole")), {}), 10);
}

}  // namespace
}  // namespace frontmost::test
