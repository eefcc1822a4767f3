// SPDX-License-Identifier: Apache-2.0
// Ctrl-C, --timeout, and terminals.
#include <gmock/gmock.h>
#include <signal.h>

#include "program.h"

namespace frontmost::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class Interruption : public ProgramTest {
 protected:
  Interruption() { write("cube.stl", cube_stl()); }
};

TEST_F(Interruption, CtrlCLeavesNothingAndReturns130) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Outcome outcome = run(Call{
        .words = {"render", "cube.stl", "-o", "a.png", "--depth", "d.exr", "--repeat", "1000000"}, .signal = signal});
    EXPECT_EQ(outcome.status, 130);
    EXPECT_THAT(outcome.err, IsEmpty());
    EXPECT_THAT(files(), ElementsAre("cube.stl"));
  }
}

TEST_F(Interruption, CtrlCWhileManyFilesAreWrittenLeavesWholeOnes) {
  std::string views;
  for (int i = 0; i < 400; ++i) views += i ? ",{}" : "{}";
  write("many.json", R"({"outputs": {"output": "v{view}.png"}, "views": [)" + views + "]}");
  const Outcome outcome = run(Call{.words = {"render", "cube.stl", "--batch", "many.json", "--resolution", "300,300"},
                                   .signal = SIGINT,
                                   .signal_after = 0.6});
  EXPECT_EQ(outcome.status, 130);
  for (const std::string& name : files()) {
    if (name[0] != 'v') {
      EXPECT_THAT(name, testing::AnyOf("cube.stl", "many.json"));
      continue;
    }
    const std::string content = read(name);
    EXPECT_EQ(content.substr(content.size() - 8, 4), "IEND") << name;
  }
}

TEST_F(Interruption, AReaderThatWaitsForeverIsInterruptedToo) {
  const Outcome outcome =
      run(Call{.words = {"info", "-"}, .input = "solid", .keep_input_open = true, .signal = SIGINT});
  EXPECT_EQ(outcome.status, 130);
}

TEST_F(Interruption, TimeoutGivesUpWithAMessage) {
  expect_failure("render cube.stl -o a.png --repeat 1000000 --timeout 0.3", 1, "gave up after 0.3 s (--timeout)");
  const Outcome waiting =
      run(Call{.words = {"info", "-", "--timeout", "0.2"}, .input = "solid", .keep_input_open = true});
  EXPECT_EQ(waiting.status, 1);
  EXPECT_THAT(files(), ElementsAre("cube.stl"));
}

TEST_F(Interruption, ATimeoutThatIsNotReachedChangesNothing) {
  EXPECT_THAT(succeed("render cube.stl -o a.png --resolution 16,16 --timeout 100").err, IsEmpty());
}

class Terminal : public ProgramTest {
 protected:
  Terminal() { write("cube.stl", cube_stl()); }
};

TEST_F(Terminal, WithoutOutputsThePictureIsShown) {
  const Outcome outcome =
      run(Call{.words = {"render", "cube.stl"}, .terminal = true, .environment = {"COLORTERM=truecolor"}});
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("\033["));
  EXPECT_THAT(outcome.out, HasSubstr("▀"));
  const auto lines = std::count(outcome.out.begin(), outcome.out.end(), '\n');
  EXPECT_GT(lines, 10);
  EXPECT_LE(lines, 23);
  EXPECT_THAT(files(), ElementsAre("cube.stl"));
}

TEST_F(Terminal, LongWorkShowsProgressThatGoesAway) {
  const Outcome outcome = run(Call{.words = {"render", "cube.stl", "-o", "a.png", "--repeat", "1000000"},
                                   .signal = SIGINT,
                                   .signal_after = 1.5,
                                   .terminal = true});
  EXPECT_EQ(outcome.status, 130);
  EXPECT_THAT(outcome.out, HasSubstr(" %"));
  EXPECT_EQ(outcome.out.substr(outcome.out.size() - 4), "\r\033[K");
}

TEST_F(Terminal, QuietAndPipedShowNone) {
  const Outcome outcome = run(Call{.words = {"render", "cube.stl", "-o", "a.png", "--repeat", "1000000", "--quiet"},
                                   .signal = SIGINT,
                                   .signal_after = 1.0,
                                   .terminal = true});
  EXPECT_THAT(outcome.out, Not(HasSubstr("%")));
}

}  // namespace
}  // namespace frontmost::test
