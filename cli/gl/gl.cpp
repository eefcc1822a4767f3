// SPDX-License-Identifier: Apache-2.0
// frontmost gl: runs a program with Frontmost's libraries in place of OpenGL, GLUT and OSMesa.
//
//   LD_LIBRARY_PATH   the folder in which these libraries have the names that programs ask for
//   LD_PRELOAD        OpenGL comes first, so that libraries such as GLU call it, too
//   FRONTMOST_GL_...  what the libraries are to do: OUTPUT, SIZE, SCRIPT, EXPLAIN, VERBOSE
#include <fcntl.h>
#include <fmt/format.h>
#include <frontmost/files.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/inputs.h"
#include "cli/option.h"
#include "cli/outputs.h"

namespace frontmost::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* gl_library = "libGL.so.1";  // the name in the folder of libraries

glm::ivec2 window_size_from(std::string_view text) {
  const std::vector<std::string_view> sides = split(text, 'x');
  constexpr NumberLimits limits{1, 16384};
  if (sides.size() != 2) throw UsageError(fmt::format("{} is not WxH, such as 640x480", quoted(text)));
  return {parse_integer(sides[0], limits), parse_integer(sides[1], limits)};
}

glm::ivec2 pixel_from(std::string_view text) {
  const std::vector<std::string_view> places = split(text, ',');
  constexpr NumberLimits limits{0, 16383};
  if (places.size() != 2) throw UsageError(fmt::format("{} is not X,Y, such as 100,50", quoted(text)));
  return {parse_integer(places[0], limits), parse_integer(places[1], limits)};
}

constexpr Option gl_options[] = {
    {"size", 0, "WxH", "Size of the program's windows, in pixels; by default as the program asks.", Group::program,
     for_gl, [](Settings& s, const Given& g) { s.program.size = window_size_from(g.text); }},
    {"frames", 0, "N", "Draw N frames, 1 by default; the picture is the last one.", Group::program, for_gl,
     [](Settings& s, const Given& g) {
       s.program.frames = g.integer({1, 1'000'000});
     }},
    {"script", 0, "FILE",
     "Events and frames for programs that use GLUT, one a line: frames N; key CHARACTER; special F1 or left; mouse "
     "left down X Y; motion X Y; pointer enters; menu LABEL; reshape WIDTH HEIGHT; write FILE.",
     Group::program, for_gl, [](Settings& s, const Given& g) { s.program.script = g.file_name(); }},
    {"explain", 0, "X,Y",
     "Print every fragment that came to a pixel since the colors were last cleared, and what became of it: culled, "
     "clipped, failed by which test with which values, or drawn. X and Y count from the upper left corner.",
     Group::program, for_gl, [](Settings& s, const Given& g) { s.program.explained = pixel_from(g.text); }},
    {"verbose", 0, "", "Print calls of OpenGL that have no effect here.", Group::program, for_gl,
     [](Settings& s, const Given&) { s.program.verbose = true; }},
    {"output", 'o', "FILE", "The last frame: .png, .jpg or .webp; by default PROGRAM.png.", Group::output, for_gl,
     [](Settings& s, const Given& g) { s.program.output = g.file_name(); }},
};

void check_program_settings(const ProgramSettings& program) {
  if (program.frames && program.script)
    throw UsageError("--frames excludes --script, which draws frames by its lines 'frames N'");
  std::error_code ignored;
  if (program.script && !fs::is_regular_file(*program.script, ignored))
    throw Error(ErrorCode::file_unreadable, *program.script, "", "the script is not a file");
  if (!program.output) return;
  const std::optional<ImageFormat> format = format_by_suffix(*program.output);
  if (*program.output == "-" || !format || (*format != ImageFormat::png && !holds_pictures_alone(*format)))
    throw UsageError(*program.output + ": the picture must be a .png, .jpg or .webp file");
  check_outputs({*program.output}, {});
}

/// Returns the folder of the libraries: of this build, or as installed.
std::string library_folder() {
  std::error_code ignored;
  const fs::path beside = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  const char* const given = std::getenv("FRONTMOST_GL_LIBRARIES");
  const fs::path installed = (beside / FRONTMOST_GL_FOLDER).lexically_normal();
  for (const fs::path& folder : {given ? fs::path(given) : beside / "src/gl/private", installed})
    if (fs::exists(folder / gl_library, ignored)) return fs::absolute(folder, ignored).string();
  throw Error(ErrorCode::unsupported,
              fmt::format("gl: {} is missing; install the package frontmost-gl, or build with -DFRONTMOST_GL=ON",
                          ((given ? fs::path(given) : installed) / gl_library).string()));
}

/// Sets a variable of the environment. `separator`: put the value before the variable's old one.
void set_variable(const char* name, std::string value, std::string_view separator = "") {
  const char* const old = std::getenv(name);
  if (!separator.empty() && old && *old) value.append(separator).append(old);
  setenv(name, value.c_str(), 1);
}

void set_environment(const ProgramSettings& program) {
  std::error_code ignored;
  set_variable("LD_LIBRARY_PATH", library_folder(), ":");
  set_variable("LD_PRELOAD", gl_library, ":");
  // A program may change its folder.
  if (program.output) set_variable("FRONTMOST_GL_OUTPUT", fs::absolute(*program.output, ignored).string());
  if (program.script) set_variable("FRONTMOST_GL_SCRIPT", fs::absolute(*program.script, ignored).string());
  if (program.frames) set_variable("FRONTMOST_GL_SCRIPT", fmt::format(":frames {}", *program.frames));
  if (program.size) set_variable("FRONTMOST_GL_SIZE", fmt::format("{}x{}", program.size->x, program.size->y));
  if (program.explained)
    set_variable("FRONTMOST_GL_EXPLAIN", fmt::format("{},{}", program.explained->x, program.explained->y));
  if (program.verbose) set_variable("FRONTMOST_GL_VERBOSE", "1");
}

/// Identifies the contents of a file: a written file is another one, with another time.
struct FileStamp {
  ino_t number = 0;
  time_t seconds = 0;
  long nanoseconds = 0;

  explicit FileStamp(const std::string& path) {
    struct stat status {};
    if (stat(path.c_str(), &status) != 0) return;
    number = status.st_ino;
    seconds = status.st_mtim.tv_sec;
    nanoseconds = status.st_mtim.tv_nsec;
  }
  bool operator==(const FileStamp&) const = default;
};

/// Runs the program in the child process. If it cannot start, sends the reason's number through the pipe.
[[noreturn]] void become_program(const std::vector<std::string>& words, int file) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  for (const int signal : {SIGPIPE, SIGXFSZ}) ::signal(signal, SIG_DFL);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  const int code = errno;
  const ssize_t written = write(file, &code, sizeof code);
  (void)written;  // the parent is gone
  _exit(exit_could_not);
}

[[noreturn]] void complain_of_start(const std::string& program, int code) {
  std::error_code ignored;
  std::string reason = std::generic_category().message(code);
  if (code == ENOENT && program.find('/') == std::string::npos)
    reason = fs::exists(program, ignored) ? fmt::format("not in PATH; did you mean ./{}?", program) : "not in PATH";
  throw Error(ErrorCode::file_unreadable, program, "", "cannot be started: " + reason);
}

/// Runs a program to its end. \returns its exit status, or 128 and the number of the signal that ended it.
int run_program(const std::vector<std::string>& words) {
  int files[2];
  if (pipe2(files, O_CLOEXEC) != 0) throw Error(ErrorCode::unsupported, "gl", "no pipe");
  const pid_t process = fork();
  if (process == 0) become_program(words, files[1]);
  int code = errno;
  close(files[1]);
  if (process < 0) {
    close(files[0]);
    complain_of_start(words[0], code);
  }
  ssize_t got = 0;
  while ((got = read(files[0], &code, sizeof code)) < 0 && errno == EINTR) {
  }
  close(files[0]);
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (got == sizeof code) complain_of_start(words[0], code);
  if (!WIFSIGNALED(status)) return WEXITSTATUS(status);
  complain(fmt::format("{}: ended by signal {} ({})", words[0], WTERMSIG(status), strsignal(WTERMSIG(status))));
  return 128 + WTERMSIG(status);
}

}  // namespace

std::span<const Option> gl_option_table() { return gl_options; }

int run_gl(const Settings& settings) {
  const ProgramSettings& program = settings.program;
  check_program_settings(program);
  std::vector<std::string> words = {settings.model};
  words.insert(words.end(), settings.more_models.begin(), settings.more_models.end());
  const FileStamp before(program.output.value_or(""));
  set_environment(program);
  const int status = run_program(words);
  const bool is_missing = program.output && FileStamp(*program.output) == before;
  if (status != exit_done || !is_missing) return status;
  throw Error(ErrorCode::unsupported, settings.model, "",
              "ended without drawing a frame; -o is for programs that use GLUT");
}

}  // namespace frontmost::cli
