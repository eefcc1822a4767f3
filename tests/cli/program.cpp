// SPDX-License-Identifier: Apache-2.0
#include "program.h"

#include <fcntl.h>
#include <grp.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <fstream>
#include <sstream>
#include <thread>

namespace frontmost::test {
namespace {

struct Pipe {
  int read_end = -1, write_end = -1;
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) == 0) read_end = ends[0], write_end = ends[1];
  }
};

void close_once(int& file) {
  if (file >= 0) close(file);
  file = -1;
}

std::string drain(int file) {
  std::string text;
  char block[65536];
  for (;;) {
    const ssize_t count = ::read(file, block, sizeof block);
    if (count <= 0) return text;  // a terminal whose program has ended gives an error, not an end
    text.append(block, std::size_t(count));
  }
}

void limit(__rlimit_resource resource, const std::optional<std::size_t>& most) {
  const rlimit both{most.value_or(0), most.value_or(0)};
  if (most && setrlimit(resource, &both) != 0) _exit(126);
}

[[noreturn]] void become_program(const Call& call, const std::string& folder) {
  std::vector<std::string> words = {FRONTMOST_PROGRAM};
  words.insert(words.end(), call.words.begin(), call.words.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  for (const std::string& setting : call.environment) putenv(strdup(setting.c_str()));
  for (const int one : {SIGINT, SIGTERM, SIGALRM, SIGPIPE, SIGXFSZ}) signal(one, SIG_DFL);
  if (chdir(folder.c_str()) != 0) _exit(126);
  limit(RLIMIT_AS, call.address_space);
  limit(RLIMIT_FSIZE, call.file_size);
  if (call.processes && geteuid() == 0) {
    constexpr uid_t nobody = 65534;
    if (setgroups(0, nullptr) != 0 || setgid(nobody) != 0 || setuid(nobody) != 0) _exit(126);
  }
  limit(RLIMIT_NPROC, call.processes);
  execv(FRONTMOST_PROGRAM, pointers.data());
  _exit(127);
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Whether the program has a handler for a signal, by the mask in its status file; false before it has started.
bool catches(pid_t child, int signal) {
  std::ifstream status("/proc/" + std::to_string(child) + "/status");
  for (std::string word; status >> word;) {
    std::uint64_t mask = 0;
    if (word == "SigCgt:" && status >> std::hex >> mask) return (mask >> (signal - 1) & 1) != 0;
  }
  return false;
}

/// Sends the call's signal, `signal_after` seconds after the program is ready for it; a busy machine takes a while.
void interrupt(pid_t child, const Call& call) {
  using std::chrono::steady_clock;
  constexpr std::chrono::seconds kMostWait(900);
  const auto start = steady_clock::now();
  while (!catches(child, *call.signal) && steady_clock::now() - start < kMostWait)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  std::this_thread::sleep_for(std::chrono::duration<double>(call.signal_after));
  kill(child, *call.signal);
}

Outcome run_on_terminal(const Call& call, const std::string& folder) {
  int master = -1;
  winsize size{24, 80, 0, 0};
  const pid_t child = forkpty(&master, nullptr, nullptr, &size);
  if (child == 0) become_program(call, folder);
  std::thread interrupter;
  if (call.signal) {
    interrupter = std::thread([&] { interrupt(child, call); });
  }
  Outcome outcome;
  outcome.out = drain(master);
  outcome.status = wait_for(child);
  if (interrupter.joinable()) interrupter.join();
  close(master);
  return outcome;
}

Outcome run_on_pipes(const Call& call, const std::string& folder) {
  Pipe in, out, err;
  const pid_t child = fork();
  if (child == 0) {
    dup2(in.read_end, STDIN_FILENO);
    dup2(out.write_end, STDOUT_FILENO);
    dup2(err.write_end, STDERR_FILENO);
    become_program(call, folder);
  }
  for (int* const end : {&in.read_end, &out.write_end, &err.write_end}) close_once(*end);
  Outcome outcome;
  std::thread reader([&] { outcome.err = drain(err.read_end); });
  std::thread writer([&] {
    (void)!::write(in.write_end, call.input.data(), call.input.size());
    if (!call.keep_input_open) close_once(in.write_end);
    if (call.signal) interrupt(child, call);
  });
  outcome.out = drain(out.read_end);
  outcome.status = wait_for(child);
  reader.join();
  writer.join();
  for (int* const end : {&in.write_end, &out.read_end, &err.read_end}) close_once(*end);
  return outcome;
}

std::string folder_template() { return (std::filesystem::temp_directory_path() / "frontmost-test-XXXXXX").string(); }

void append_triangle(std::string& stl, const std::array<std::array<float, 3>, 3>& corners) {
  const std::array<float, 3> normal{};
  stl.append(reinterpret_cast<const char*>(normal.data()), 12);
  stl.append(reinterpret_cast<const char*>(corners.data()), 36);
  stl.append(2, '\0');
}

std::string stl_header(std::uint32_t triangles) {
  std::string stl(80, ' ');
  stl.append(reinterpret_cast<const char*>(&triangles), 4);
  return stl;
}

}  // namespace

nlohmann::json Outcome::json() const {
  const nlohmann::json parsed = nlohmann::json::parse(out, nullptr, false);
  EXPECT_FALSE(parsed.is_discarded()) << "not JSON: " << out;
  return parsed.is_discarded() ? nlohmann::json() : parsed;
}

ProgramTest::ProgramTest() {
  std::string name = folder_template();
  folder_ = mkdtemp(name.data());
  signal(SIGPIPE, SIG_IGN);
}

ProgramTest::~ProgramTest() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

Outcome ProgramTest::run(const Call& call) const {
  return call.terminal ? run_on_terminal(call, folder_.string()) : run_on_pipes(call, folder_.string());
}

Outcome ProgramTest::succeed(const std::string& line) const {
  std::istringstream words(line);
  std::vector<std::string> list{std::istream_iterator<std::string>(words), {}};
  const Outcome outcome = run(list);
  EXPECT_EQ(outcome.status, 0) << line << "\n" << outcome.err;
  return outcome;
}

void ProgramTest::expect_failure(const std::string& line, int status, const std::string& message) const {
  std::istringstream words(line);
  const Outcome outcome = run(std::vector<std::string>{std::istream_iterator<std::string>(words), {}});
  EXPECT_EQ(outcome.status, status) << line << "\n" << outcome.err;
  EXPECT_NE(outcome.err.find(message), std::string::npos) << line << "\nsays: " << outcome.err;
  EXPECT_EQ(outcome.err.rfind("frontmost: ", 0), 0u) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << "not one line: " << outcome.err;
  EXPECT_EQ(outcome.out, "") << line;
}

void ProgramTest::open_to_all() const {
  std::filesystem::permissions(folder_, std::filesystem::perms::all);
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    std::filesystem::permissions(entry.path(), std::filesystem::perms(0644));
}

std::string ProgramTest::read(const std::string& name) const {
  std::ifstream file(folder_ / name, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void ProgramTest::write(const std::string& name, const std::string& content) const {
  std::ofstream(folder_ / name, std::ios::binary) << content;
}

std::vector<std::string> ProgramTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

std::string cube_stl(float low) {
  // Vertices by bits x, y, z; each side as four vertices, counter-clockwise from outside.
  constexpr int sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  const auto corner = [&](int bits) {
    return std::array<float, 3>{low + float(bits & 1), low + float(bits >> 1 & 1), low + float(bits >> 2 & 1)};
  };
  std::string stl = stl_header(12);
  for (const auto& side : sides) {
    append_triangle(stl, {corner(side[0]), corner(side[1]), corner(side[2])});
    append_triangle(stl, {corner(side[0]), corner(side[2]), corner(side[3])});
  }
  return stl;
}

std::string triangle_stl() {
  std::string stl = stl_header(1);
  append_triangle(stl, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
  return stl;
}

}  // namespace frontmost::test
