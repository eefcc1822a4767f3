// SPDX-License-Identifier: Apache-2.0
// Help, wrong usage, and texts about the options elsewhere.
#include <gmock/gmock.h>

#include "cli/command.h"
#include "cli/option.h"
#include "program.h"

namespace frontmost::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class Usage : public ProgramTest {};

TEST_F(Usage, HelpGoesToStandardOutput) {
  for (const char* line : {"--help", "-h", "help"}) {
    const Outcome outcome = succeed(line);
    EXPECT_THAT(outcome.out, HasSubstr("usage: frontmost COMMAND")) << line;
    EXPECT_THAT(outcome.err, IsEmpty());
  }
  for (const cli::Command& command : cli::commands()) {
    const Outcome outcome = succeed(std::string(command.name) + " --help");
    EXPECT_THAT(outcome.out, HasSubstr("usage: frontmost " + std::string(command.name)));
    EXPECT_THAT(outcome.out, HasSubstr("examples:"));
    EXPECT_EQ(succeed("help " + std::string(command.name)).out, outcome.out);
  }
  EXPECT_THAT(succeed("render --depth x.exr --help").out, HasSubstr("--ray-distance FILE"));
  EXPECT_THAT(succeed("--version").out, StartsWith("frontmost 0."));
}

TEST_F(Usage, HelpAndManualNameEveryOption) {
  std::string help;
  for (const cli::Command& command : cli::commands()) help += succeed(std::string(command.name) + " --help").out;
  const std::string manual = succeed("man").out;
  cli::for_each_option([&](const cli::Option& option) {
    EXPECT_THAT(help, HasSubstr("--" + std::string(option.name)));
    std::string escaped;
    for (const char c : std::string(option.name)) escaped += c == '-' ? std::string("\\-") : std::string(1, c);
    EXPECT_THAT(manual, HasSubstr("\\-\\-" + escaped + "\\fR"));
  });
}

TEST_F(Usage, LinesOfUsageAreSetWellAndSaySeveralModels) {
  EXPECT_THAT(succeed("render --help").out, HasSubstr("\nusage: frontmost render MODEL... [options]\n"));
  EXPECT_THAT(succeed("info --help").out, HasSubstr("\nusage: frontmost info MODEL [options]\n"));
  EXPECT_THAT(succeed("precision --help").out, HasSubstr("\nusage: frontmost precision [MODEL] [options]\n"));
  EXPECT_THAT(succeed("man --help").out, HasSubstr("\nusage: frontmost man\n"));
  EXPECT_THAT(succeed("--help").out, HasSubstr("usage: frontmost COMMAND [MODEL...] [options]"));
  const std::string manual = succeed("man").out;
  EXPECT_THAT(manual, HasSubstr(".B frontmost render\n\\fIMODEL...\\fR [options]\n.br\n"));
  // In the manual page, a line that begins with a blank breaks the line.
  EXPECT_THAT(manual, HasSubstr(".B frontmost precision\n\\fI[MODEL]\\fR [options]\n.br\n"));
  EXPECT_THAT(manual, testing::Not(HasSubstr("\n [options]")));
  EXPECT_THAT(manual, testing::Not(HasSubstr("\\fI\\fR")));
  expect_failure("render", 2, "no MODEL given; see frontmost render --help");
}

// A name may have different meanings in different commands, as --format does.
TEST_F(Usage, OptionNamesAreUniqueInEveryCommand) {
  std::size_t all = 0;
  for (const cli::Command& command : cli::commands()) {
    std::vector<std::string_view> names;
    cli::for_each_option([&](const cli::Option& option) {
      if (!(option.commands & command.bit)) return;
      EXPECT_EQ(std::count(names.begin(), names.end(), option.name), 0) << option.name;
      EXPECT_FALSE(option.help.empty()) << option.name;
      names.push_back(option.name);
    });
    all += names.size();
  }
  EXPECT_GT(all, 80u);
}

TEST_F(Usage, CompletionScriptsAreValidAndComplete) {
  const std::string bash = succeed("completion bash").out;
  write("frontmost.bash", bash);
  write("try.sh",
        "source ./frontmost.bash\nCOMP_WORDS=(frontmost render --camera-pos) COMP_CWORD=2\n_frontmost\n"
        "echo \"${COMPREPLY[@]}\"\nCOMP_WORDS=(frontmost render --cull b) COMP_CWORD=3\n_frontmost\n"
        "echo \"${COMPREPLY[@]}\"\nCOMP_WORDS=(frontmost precision --format D) COMP_CWORD=3\n_frontmost\n"
        "echo \"${COMPREPLY[@]}\"\nCOMP_WORDS=(frontmost render --format p) COMP_CWORD=3\n_frontmost\n"
        "echo \"${COMPREPLY[@]}\"\n");
  const std::string command = "cd '" + path("") + "' && bash try.sh > answer";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(read("answer"), "--camera-position\nback both\nD8 D16 D24\npng pfm\n");
  EXPECT_THAT(succeed("completion zsh").out, StartsWith("#compdef frontmost"));
  EXPECT_THAT(succeed("completion fish").out, HasSubstr("-l camera-position"));
  expect_failure("completion powershell", 2, "bash, zsh, fish");
}

TEST_F(Usage, WrongCommandsAreNamed) {
  EXPECT_EQ(run(std::vector<std::string>{}).status, 2);
  expect_failure("rendr", 2, "did you mean 'render'?");
  expect_failure("xyz", 2, "unknown command 'xyz'");
  expect_failure("builtin:teapot", 2, "did you mean 'frontmost render builtin:teapot'?");
  expect_failure("help nothing", 2, "unknown command");
}

TEST_F(Usage, WrongOptionsAreNamed) {
  write("cube.stl", cube_stl());
  expect_failure("camera", 2, "no MODEL given");
  expect_failure("camera cube.stl --camera-postion 1,2,3", 2, "did you mean --camera-position?");
  expect_failure("camera cube.stl --depth x.exr", 2, "--depth is not an option of 'frontmost camera'");
  expect_failure("camera cube.stl -x", 2, "unknown option -x");
  expect_failure("camera cube.stl cube.stl", 2, "one model at a time");
  expect_failure("camera cube.stl --resolution", 2, "--resolution needs a value");
  expect_failure("lines cube.stl --hidden", 2, "--hidden needs a value: none, dashed or thin");
  expect_failure("lines cube.stl --hidden --json", 2, "--hidden needs a value: none, dashed or thin, not --json");
  expect_failure("camera cube.stl --near --json", 2, "--near needs a value, not --json");
  expect_failure("camera cube.stl --near 1 --near 2", 2, "--near is given 2 times");
}

TEST_F(Usage, WrongValuesAreNamed) {
  write("cube.stl", cube_stl());
  const std::pair<const char*, const char*> cases[] = {
      {"--resolution 0,5", "--resolution: '0,5': width and height are whole numbers from 1 to 16384"},
      {"--resolution 5", "--resolution: '5' has 1 values, 2 are needed"},
      {"--resolution 1e9,1", "from 1 to 16384"},
      {"--resolution 10,10px", "--resolution: '10px' is not a number"},
      {"--threads -1", "--threads: -1 is not between 0 and 1024"},
      {"--threads 1.5", "--threads: 1.5 is not a whole number"},
      {"--near nan", "--near: nan is not a usable number"},
      {"--camera-position 1,2", "--camera-position: '1,2' has 2 values, 3 are needed"},
      {"--camera-view-angle 180", "--camera-view-angle: 180 is not between 0.001 and 179"},
      {"--camera-zoom-factor 0", "--camera-zoom-factor: 0 is not between"},
      {"--view sideways", "--view: 'sideways' is not one of front, back"},
      {"--up up", "--up: "},
      {"--intrinsics 0,1,2,3", "--intrinsics: focal lengths must be above 0"},
      {"--pose nothing.txt --pose-convention opencv-world-to-camera", "neither 16 numbers nor a file"},
      {"--pose 2,0,0,0,0,2,0,0,0,0,2,0 --pose-convention opencv-world-to-camera", "pose"},
      {"--input-format stp", "--input-format: 'stp' is not one of"},
      {"--timeout 0", "--timeout: 0 is not between"},
  };
  for (const auto& [words, message] : cases) {
    const std::string line = std::string("camera cube.stl ") + words;
    expect_failure(line, std::string(words).find("2,0,0,0") != std::string::npos ? 1 : 2, message);
  }
}

TEST_F(Usage, MissingAndBrokenModelsAreNamed) {
  expect_failure("camera missing.stl", 1, "missing.stl: ");
  write("broken.stl", cube_stl().substr(0, 200));
  expect_failure("info broken.stl", 1, "broken.stl: ");
  expect_failure("info builtin:nothing", 1, "builtin:nothing");
  expect_failure("info .", 1, ".: ");
}

TEST_F(Usage, NamesMayBeStrange) {
  for (const char* name : {"with space.stl", "größe 模型.stl", "-dash.stl", "{brace}.stl", "a'b\"c.stl"}) {
    write(name, cube_stl());
    EXPECT_EQ(run({"camera", "--json", "--", name}).status, 0) << name;
    EXPECT_EQ(run({"camera", std::string("./") + name}).status, 0) << name;
  }
}

TEST_F(Usage, AFullStandardOutputIsAnError) {
  write("cube.stl", cube_stl());
  const std::string command = "cd '" + path("") + "' && " FRONTMOST_PROGRAM " camera cube.stl > /dev/full 2> err";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
  EXPECT_THAT(read("err"), HasSubstr("standard output"));
}

}  // namespace
}  // namespace frontmost::test
