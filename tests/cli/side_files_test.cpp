// SPDX-License-Identifier: Apache-2.0
// Files that a run needs beside its model. However long or odd, they lead to a result or to a message with file and
// place.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <ctime>

#include "cli/failure.h"
#include "cli/render/jobs.h"
#include "program.h"
#include "support/effort.h"

namespace frontmost::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Every option that names a side file, before the file's name.
const char* const side_files[] = {"render cube.stl -o a.png --resolution 8,8 --batch",
                                  "render cube.stl -o a.png --resolution 8,8 --reference",
                                  "camera cube.stl --pose-convention opencv-world-to-camera --pose",
                                  "lines cube.stl -o a.svg --pose-convention opencv-world-to-camera --pose",
                                  "sight cube.stl --pairs",
                                  "lidar cube.stl --from 0,0,9 --json --directions"};

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream words(line);
  return {std::istream_iterator<std::string>(words), {}};
}

class SideFiles : public ProgramTest {
 protected:
  SideFiles() { write("cube.stl", cube_stl()); }
};

TEST_F(SideFiles, DevicesWithoutAnEndAreRefused) {
  for (const char* line : side_files) {
    Call call{.words = words_of(line + std::string(" /dev/zero"))};
    if (!under_sanitizer) call.address_space = std::size_t(1) << 30;
    const Outcome outcome = run(call);
    EXPECT_EQ(outcome.status, 1) << line;
    EXPECT_THAT(outcome.err, HasSubstr("frontmost: /dev/zero: larger than the limit of")) << line;
  }
}

TEST_F(SideFiles, PipesThatNobodyWritesToAreGivenUp) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  for (const char* line : side_files) {
    const Outcome outcome = run(Call{.words = words_of(line + std::string(" pipe --timeout 0.3"))});
    EXPECT_EQ(outcome.status, 1) << line;
    EXPECT_EQ(outcome.err, "frontmost: gave up after 0.3 s (--timeout)\n") << line;
    const Outcome interrupted =
        run(Call{.words = words_of(line + std::string(" pipe")), .signal = SIGINT, .signal_after = 0.3});
    EXPECT_EQ(interrupted.status, 130) << line;
  }
}

TEST_F(SideFiles, ThoseOfABatchAreReadWithTheSameCare) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  write("pose.json", R"({"views":[{"pose":"pipe","pose-convention":"opencv-world-to-camera"}]})");
  expect_failure("render cube.stl --hash --batch pose.json --timeout 0.3", 1, "gave up after 0.3 s (--timeout)");
  write("zero.json", R"({"views":[{"pose":"/dev/zero","pose-convention":"opencv-world-to-camera"}]})");
  expect_failure("render cube.stl --hash --batch zero.json", 1, "/dev/zero: larger than the limit of 65536 bytes");
}

TEST_F(SideFiles, MissingOnesFoldersAndEmptyNamesAreNamed) {
  std::filesystem::create_directory(path("folder"));
  for (const char* line : side_files) {
    const Outcome missing = run(words_of(line + std::string(" none.txt")));
    EXPECT_NE(missing.status, 0) << line;
    EXPECT_THAT(missing.err, HasSubstr("none.txt")) << line;
    const Outcome folder = run(words_of(line + std::string(" folder")));
    EXPECT_EQ(folder.status, 1) << line;
    EXPECT_THAT(folder.err, HasSubstr("folder: is a folder")) << line;
    std::vector<std::string> words = words_of(line);
    words.emplace_back();
    EXPECT_THAT(run(words).err, HasSubstr(words[words.size() - 2] + ": the file name is empty")) << line;
  }
}

TEST_F(SideFiles, StandardInputIsReadForOneOfThem) {
  const Outcome outcome =
      run(Call{.words = {"sight", "cube.stl", "--pairs", "-", "--json"}, .input = "0.5 0.5 9 0.5 0.5 -9\n"});
  EXPECT_EQ(outcome.json()["clear"], 0);
  const Outcome twice = run(Call{.words = {"lidar", "-", "--from", "0,0,9", "--directions", "-", "-o", "a.ply"}});
  EXPECT_EQ(twice.status, 2);
  EXPECT_THAT(twice.err, HasSubstr("-: standard input is the model itself, and cannot be read twice"));
}

TEST_F(SideFiles, NumbersThatNoDoubleHoldsAreNamedWithTheirPlace) {
  write("pairs.txt", "0 0 0 1 1 1\n0 0 0 1 1 1e400\n");
  expect_failure("sight cube.stl --pairs pairs.txt", 1, "pairs.txt: line 2: 1e400 is not between -3e+38 and 3e+38");
  write("pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 1e400\n");
  expect_failure("camera cube.stl --pose pose.txt --pose-convention opencv-world-to-camera", 1,
                 "pose.txt: line 3: 1e400 is not between");
  write("words.txt", "1 0 0 0\n0 one 0 0\n");
  expect_failure("camera cube.stl --pose words.txt --pose-convention opencv-world-to-camera", 1,
                 "words.txt: line 2: 'one' is not a number");
  write("short.txt", "1 0 0 0\n");
  expect_failure("camera cube.stl --pose short.txt --pose-convention opencv-world-to-camera", 1,
                 "short.txt: 4 numbers; a pose is 16 (or 12), row by row");
  write("long.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n0 0 0 1\n");
  expect_failure("camera cube.stl --pose long.txt --pose-convention opencv-world-to-camera", 1,
                 "long.txt: line 5: more than 16 numbers");
  write("batch.json", "{\"views\": [{},\n {\"near\": 1e400}]}");
  expect_failure("render cube.stl --hash --batch batch.json", 2, "batch.json: line 2: 1e400 is not a usable number");
  // A number too small for a double counts as zero.
  write("tiny.txt", "0 0 0 1 1 1e-400\n");
  EXPECT_EQ(succeed("sight cube.stl --pairs tiny.txt").out, "clear\n");
}

TEST_F(SideFiles, APoseThatTheModelCannotBeSeenFromIsNamed) {
  write("far.txt", "1 0 0 1e39\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  expect_failure("render cube.stl -o a.png --pose far.txt --pose-convention opengl-camera-to-world", 1,
                 "far.txt: pose: the eye is farther from the origin than floats reach");
  expect_failure(
      "render cube.stl -o a.png --pose-convention opengl-camera-to-world --pose "
      "1,0,0,1e39,0,1,0,0,0,0,1,0",
      1, "--pose: pose: the eye is farther from the origin than floats reach");
  write("mirror.txt", "-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  expect_failure("render cube.stl -o a.png --pose mirror.txt --pose-convention opengl-camera-to-world", 1,
                 "mirror.txt: pose: must be a rotation and a translation");
  write("views.json", R"({"views":[{"name": "eye", "pose":"mirror.txt","pose-convention":"opengl-camera-to-world"}]})");
  expect_failure("render cube.stl --hash --batch views.json", 1, "views.json: view eye: pose: must be a rotation");
}

// ---- Batches, without a process ----

std::string batch_complaint(const std::string& text) {
  return complaint([&] { return cli::parse_batch(text, "b.json", {}); });
}

std::string repeated(const std::string& part, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += (i ? "," : "") + part;
  return text;
}

/// Processor time, so that other programs on the machine do not count.
template <class Work>
double seconds_of(const Work& work) {
  const std::clock_t start = std::clock();
  work();
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

TEST(BatchLimits, ViewsAreCountedBeforeTheyAreKept) {
  const std::string many = R"({"views":[)" + repeated("{}", 200'000) + "]}";
  // Comparing every view with all before it would take 17 s.
  EXPECT_LT(seconds_of([&] { EXPECT_EQ(batch_complaint(many), "b.json: views: more than 100000"); }), 2);
  EXPECT_EQ(batch_complaint(R"({"views":[)" + repeated("[]", 100'001) + "]}"), "b.json: views: more than 100000");
  EXPECT_EQ(batch_complaint(R"({"views":[)" + repeated("0", 100'001) + "]}"), "b.json: views: more than 100000");
}

TEST(BatchLimits, TimeIsLinearInTheViews) {
  const auto time_of = [](std::size_t views) {
    const std::string text = R"({"views":[)" + repeated(R"({"view":"front","near":1})", views) + "]}";
    return seconds_of([&] { EXPECT_EQ(cli::parse_batch(text, "b.json", {}).size(), views); });
  };
  (void)time_of(1000);
  const double some = time_of(4000), eight_times = time_of(32'000);
  EXPECT_LT(eight_times, 24 * some) << "quadratic would be 64 times";
}

TEST(BatchLimits, KeysAndValuesAreCounted) {
  std::string keys;
  for (int i = 0; i < 300; ++i) keys += (i ? ",\"k" : "\"k") + std::to_string(i) + "\":0";
  EXPECT_EQ(batch_complaint("{\"views\":[{" + keys + "}]}"), "b.json: an object has more than 256 keys");
  EXPECT_EQ(batch_complaint(R"({"views":[{"camera-position":[)" + repeated("0", 8'000'001) + "]}]}"),
            "b.json: more than 8000000 values");
}

TEST(BatchLimits, LongWordsAreShortenedAndNotCompared) {
  const std::string longest(1 << 22, 'x');
  std::string told;
  EXPECT_LT(seconds_of([&] { told = batch_complaint("{\"views\":[{\"" + longest + "\":0}]}"); }), 2);
  EXPECT_EQ(told, "b.json: views[0]." + std::string(80, 'x') + "...: is not known here");
  told = batch_complaint("{\"views\":[{\"near\":\"" + longest + "\"}]}");
  EXPECT_EQ(told, "b.json: views[0].near: '" + std::string(80, 'x') + "...' is not a number");
}

TEST(BatchLimits, NamesWithNulAreRefusedWhereverTheyStand) {
  for (const char* view : {R"({"name":"a\u0000b"})", R"({"outputs":{"output":"a\u0000.png"}})",
                           R"({"outputs":{"ids":{"object":"a\u0000.png"}}})", R"({"pose":"a\u0000"})"})
    EXPECT_THAT(batch_complaint(std::string(R"({"views":[)") + view + "]}"),
                HasSubstr(": must not hold a NUL character"))
        << view;
}

}  // namespace
}  // namespace frontmost::test
