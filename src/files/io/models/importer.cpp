// SPDX-License-Identifier: Apache-2.0
// Runs frontmost-import, which reads STEP and other formats by large libraries, and takes its answer: a binary glTF
// file, which the reader of glTF checks as any other.
//
//   bytes of the model --> memory file --> standard input | frontmost-import | standard output --> frames --> glTF
//                    \-------------------------- cache of answers ---------------------------/
//
// The importer may crash, hang, fill memory or send anything. It limits its own memory; its time is limited here. It is
// killed, and waited for, however this function ends.
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "base/parallel.h"
#include "io/descriptor.h"
#include "io/models/import_cache.h"

extern char** environ;  // NOLINT: of the system

namespace frontmost {
namespace {

namespace fs = std::filesystem;

constexpr int kPollMilliseconds = 50;
constexpr std::size_t kReadBytes = 1 << 16;

std::string program_path() {
  std::error_code ignored;
  if (const char* const given = std::getenv("FRONTMOST_IMPORT")) return given;
  const fs::path self = fs::read_symlink("/proc/self/exe", ignored), beside = self.parent_path() / "frontmost-import";
  const bool is_beside = !self.empty() && fs::exists(beside, ignored);
  return (is_beside ? beside : fs::path(FRONTMOST_IMPORT_PROGRAM)).string();
}

[[noreturn]] void fail_to_start(const ModelSource& source, const std::string& what) {
  throw Error(ErrorCode::file_unreadable, source.name(), "", "frontmost-import: " + what + ": " + std::strerror(errno));
}

/// The model as a file without a name, at its beginning.
void fill(Descriptor& file, Bytes bytes, const ModelSource& source) {
  file.reset(memfd_create("model", MFD_CLOEXEC));
  if (file.number() < 0) fail_to_start(source, "no memory file");
  while (!bytes.empty()) {
    const ssize_t written = write(file.number(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_to_start(source, "the model cannot be copied");
    bytes = bytes.subspan(std::size_t(written));
  }
  lseek(file.number(), 0, SEEK_SET);
}

/// A running importer, which ends with this object.
class Process {
 public:
  Process(const std::vector<std::string>& words, const Descriptor& input, const ModelSource& source) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) fail_to_start(source, "no pipe");
    output_.reset(ends[0]);
    const Descriptor their_end(ends[1]);
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, input.number(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, their_end.number(), STDOUT_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    // A group of its own, because a terminal's Ctrl-C is for this process, which then ends the importer.
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    sigset_t all, none;
    sigfillset(&all);
    sigemptyset(&none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setsigmask(&attributes, &none);
    const int code = posix_spawn(&id_, arguments[0], &files, &attributes, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    if (code == 0) return;
    id_ = -1;
    errno = code;
    fail_to_start(source, printable(words[0]) + " cannot be started");
  }
  ~Process() {
    if (id_ <= 0) return;
    kill(-id_, SIGKILL);  // its whole group
    while (waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  [[nodiscard]] int output() const { return output_.number(); }
  /// Why the importer has ended; none while it runs. It stays a process, without which its group could be another's.
  [[nodiscard]] std::optional<std::string> end() const {
    siginfo_t info{};
    if (waitid(P_PID, id_t(id_), &info, WEXITED | WNOHANG | WNOWAIT) != 0) return "it cannot be waited for";
    if (info.si_pid == 0) return std::nullopt;
    if (info.si_code == CLD_EXITED) return "frontmost-import ended without an answer";
    return std::string("frontmost-import crashed (") + strsignal(info.si_status) + ")";
  }

 private:
  pid_t id_ = -1;
  Descriptor output_;
};

/// As the importer reads numbers, whatever this program's locale.
std::string text_of_number(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

ImportAnswer receive(const Process& process, const ImportOptions& options, const ModelSource& source) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(options.seconds);
  ImportReceiver receiver(source, options.bytes);
  std::vector<std::byte> bytes;
  bool is_closed = false;
  while (!receiver.answer.has_ended) {
    check_cancelled(source.execution());
    if (Clock::now() >= end)
      throw Error(ErrorCode::limit_exceeded, source.name(), "",
                  "could not be read within " + text_of_number(options.seconds) + " seconds (--import-seconds)");
    if (is_closed) {
      if (const auto reason = process.end()) source.fail("", "could not be read: " + *reason);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    pollfd event{process.output(), POLLIN, 0};
    if (poll(&event, 1, kPollMilliseconds) <= 0) continue;
    const std::size_t before = bytes.size();
    bytes.resize(before + kReadBytes);
    const ssize_t count = read(process.output(), bytes.data() + before, kReadBytes);
    if (count < 0 && errno != EINTR) fail_to_read_by_errno(source.name(), "reading from frontmost-import");
    bytes.resize(before + std::size_t(std::max<ssize_t>(count, 0)));
    receiver.take(bytes);
    is_closed = count == 0;
  }
  return std::move(receiver.answer);
}

std::string word_of(ModelFormat format) {
  return format == ModelFormat::step ? "step" : format == ModelFormat::iges ? "iges" : "brep";
}

void check(const ImportOptions& options) {
  const auto fail = [](const char* name, const char* range) {
    throw Error(ErrorCode::bad_argument, name, std::string("must be ") + range);
  };
  if (!(options.tolerance >= 0) || !std::isfinite(options.tolerance)) fail("tolerance", "finite, and not below 0");
  if (!(options.angle > 0.001 && options.angle <= 1.6)) fail("angle", "above 0.001 and at most 1.6 radians");
  if (!(options.seconds > 0 && options.seconds <= 1e6)) fail("seconds", "above 0 and at most 1000000");
  if (options.bytes < std::uint64_t(1) << 20) fail("bytes", "at least 1048576");
}

/// The words without the number of threads, which changes no answer. The limit of memory does: OpenCASCADE leaves out
/// faces for which it finds no memory.
std::vector<std::string> question_of(std::vector<std::string> words) {
  words.erase(words.end() - 2);
  return words;
}

bool is_valid(const Scene& scene) {
  try {
    validate(scene);
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// The scene of a kept answer. An entry that is broken, whoever wrote it, is as good as none.
std::optional<Scene> scene_of_kept(const ImportCache& cache, const ModelSource& source) {
  std::optional<std::vector<std::byte>> frames = cache.find();
  if (!frames) return std::nullopt;
  try {
    ImportReceiver receiver(source, source.import_options().bytes);
    receiver.take(*frames);
    if (!receiver.answer.has_ended) return std::nullopt;
    Scene scene = scene_of(receiver.answer, source);
    return is_valid(scene) ? std::optional(std::move(scene)) : std::nullopt;
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    return std::nullopt;
  }
}

}  // namespace

Scene read_imported(ModelFormat format, Bytes bytes, const ModelSource& source) {
  const ImportOptions& import = source.import_options();
  check(import);
  std::vector<std::string> words{program_path()};
  if (access(words[0].c_str(), X_OK) != 0) refuse_import(bytes, source);
  words.push_back(format == ModelFormat::foreign ? foreign_suffix(source.name(), bytes) : word_of(format));
  words.push_back(text_of_number(import.tolerance));
  words.push_back(text_of_number(import.angle));
  words.push_back(std::to_string(source.execution().threads));
  words.push_back(std::to_string(import.bytes));
  // Meshes are read about as fast as answers.
  const bool is_kept = import.cache && format != ModelFormat::foreign;
  const ImportCache cache(is_kept ? ImportCache::folder_of_user() : "", question_of(words), bytes);
  if (std::optional<Scene> scene = scene_of_kept(cache, source)) return *std::move(scene);
  ImportAnswer answer;
  {
    Descriptor input;
    fill(input, bytes, source);
    const Process process(words, input, source);
    answer = receive(process, import, source);
  }
  Scene scene = scene_of(answer, source);
  if (is_kept && is_valid(scene)) cache.keep(answer);
  return scene;
}

}  // namespace frontmost
