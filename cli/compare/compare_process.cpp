// SPDX-License-Identifier: Apache-2.0
// The child process runs a method and sends the result through a pipe: first how the run ended, then numbers and planes
// as they lie in memory.
#include <fmt/format.h>
#include <frontmost/files.h>
#include <malloc.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <system_error>
#include <type_traits>

#include "cli/compare/compare_methods.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/inputs.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

static_assert(std::is_trivially_copyable_v<View>);

enum class Ending : std::uint64_t { done, usage, error };

/// The writing end of the pipe.
class Sender {
 public:
  explicit Sender(int file) : file_(file) {}

  void send(const void* data, std::size_t size) const {
    for (auto* at = static_cast<const char*>(data); size > 0;) {
      const ssize_t written = write(file_, at, size);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) _exit(exit_could_not);  // the parent is gone
      at += written;
      size -= std::size_t(written);
    }
  }
  void send(std::uint64_t value) const { send(&value, sizeof value); }
  void send(std::string_view text) const {
    send(text.size());
    send(text.data(), text.size());
  }
  void send(const Visible& visible) const {
    send(&visible.view, sizeof visible.view);
    send(visible.primitives.data(), visible.primitives.size() * sizeof(PrimitiveId));
    send(visible.keys.data(), visible.keys.size() * sizeof(float));
  }
  void send(const Stage& stage) const {
    send(stage.name);
    send(stage.times.size());
    send(stage.times.data(), stage.times.size() * sizeof(double));
  }

 private:
  int file_;
};

/// The reading end of the pipe. \throws Error if the child ends before it has sent everything.
class Receiver {
 public:
  Receiver(int file, std::string_view method) : file_(file), method_(method) {}

  void receive(void* data, std::size_t size) const {
    for (auto* at = static_cast<char*>(data); size > 0;) {
      const ssize_t got = read(file_, at, size);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) throw Error(ErrorCode::unsupported, "compare", fmt::format("{}: its process ended early", method_));
      at += got;
      size -= std::size_t(got);
    }
  }
  [[nodiscard]] std::uint64_t number() const {
    std::uint64_t value = 0;
    receive(&value, sizeof value);
    return value;
  }
  [[nodiscard]] std::string text() const {
    std::string text(number(), '\0');
    receive(text.data(), text.size());
    return text;
  }
  [[nodiscard]] Visible visible() const {
    Visible visible;
    receive(&visible.view, sizeof visible.view);
    visible.primitives = Buffer<PrimitiveId>(visible.view.sample_count());
    visible.keys = Buffer<float>(visible.view.sample_count());
    receive(visible.primitives.data(), visible.primitives.size() * sizeof(PrimitiveId));
    receive(visible.keys.data(), visible.keys.size() * sizeof(float));
    return visible;
  }
  [[nodiscard]] Stage stage() const {
    Stage stage{text(), {}};
    stage.times.resize(number());
    receive(stage.times.data(), stage.times.size() * sizeof(double));
    return stage;
  }

 private:
  int file_;
  std::string_view method_;
};

/// Returns a field of /proc/self/status, such as VmRSS, in bytes, or 0 if the field is missing.
std::uint64_t status_bytes(std::string_view field) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.size() > field.size() && line.compare(0, field.size(), field) == 0 && line[field.size()] == ':')
      return std::strtoull(line.c_str() + field.size() + 1, nullptr, 10) * 1024;
  return 0;
}

/// Starts the measurement: gives free memory back to the system, and resets the high-water mark. \returns the current
/// use.
std::uint64_t start_counting_memory() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;
  return status_bytes("VmRSS");
}

MethodRun run_here(const ComparedMethod& method, const Settings& settings) {
  Progress progress(settings.run.quiet);
  progress.set_prefix(fmt::format("{}: ", method.name));
  const Execution execution = execution_for(settings.run, progress);
  StageClock clock;
  const Scene scene = clock.time("load", [&] { return load(settings.model, settings.load, execution); });
  std::optional<Surfaces> surfaces(clock.time("surfaces", [&] { return Surfaces(scene, execution); }));
  View view = resolve_view(settings.view, *surfaces);
  view.samples = settings.view.samples.value_or(1);
  const std::optional<Scene> cut = tessellated(scene, settings.view, view);
  if (cut) surfaces.emplace(*cut, execution);
  MethodRun run;
  const std::uint64_t before = start_counting_memory();
  for (int i = 0; i < settings.compare.most_runs(); ++i) {
    run.answer = {};  // so that each run begins in the same state
    const Stopwatch watch;
    run.answer = method.answer(*surfaces, view, execution, clock);
    if (i == 0) run.peak_bytes = std::max(status_bytes("VmHWM"), before) - before;
    if (!settings.compare.runs && watch.milliseconds() > CompareSettings::longest_repeated) break;
  }
  if (method.lists) run.lists = method.lists(*surfaces, view, execution);
  run.stages = clock.stages();
  return run;
}

void send_run(const Sender& sender, const MethodRun& run) {
  sender.send(std::uint64_t(Ending::done));
  sender.send(run.stages.size());
  for (const Stage& stage : run.stages) sender.send(stage);
  sender.send(run.peak_bytes);
  sender.send(run.answer.primitives);
  sender.send(run.answer.visible);
  sender.send(std::uint64_t(run.answer.behind.has_value()));
  if (run.answer.behind) sender.send(*run.answer.behind);
  sender.send(std::uint64_t(run.lists.has_value()));
  if (run.lists) sender.send(&*run.lists, sizeof *run.lists);
}

[[noreturn]] void be_child(const ComparedMethod& method, const Settings& settings, int file) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const Sender sender(file);
  const auto fail = [&](Ending ending, const Error& error) {
    sender.send(std::uint64_t(ending));
    sender.send(std::uint64_t(error.code()));
    for (const std::string& text : {error.file(), error.place(), error.reason()}) sender.send(std::string_view(text));
  };
  try {
    send_run(sender, run_here(method, settings));
  } catch (const UsageError& error) {
    fail(Ending::usage, {ErrorCode::bad_argument, error.what()});
  } catch (const Error& error) {
    fail(Ending::error, error);
  } catch (const std::bad_alloc&) {
    fail(Ending::error, {ErrorCode::limit_exceeded, "out of memory"});
  } catch (const std::exception& error) {
    fail(Ending::error, {ErrorCode::unsupported, error.what()});
  }
  _exit(exit_done);
}

MethodRun receive_run(const Receiver& receiver) {
  const auto ending = Ending(receiver.number());
  if (ending != Ending::done) {
    const auto code = ErrorCode(receiver.number());
    const std::string file = receiver.text(), place = receiver.text(), reason = receiver.text();
    if (ending == Ending::usage) throw UsageError(reason);
    throw Error(code, file, place, reason);
  }
  MethodRun run;
  run.stages.resize(receiver.number());
  for (Stage& stage : run.stages) stage = receiver.stage();
  run.peak_bytes = receiver.number();
  run.answer.primitives = receiver.number();
  run.answer.visible = receiver.visible();
  if (receiver.number() != 0) run.answer.behind = receiver.visible();
  if (receiver.number() != 0) receiver.receive(&run.lists.emplace(), sizeof(KeptLists));
  return run;
}

/// The child and the pipe from it. The destructor ends both.
class Child {
 public:
  Child(const ComparedMethod& method, const Settings& settings) {
    int files[2];
    if (pipe(files) != 0) throw Error(ErrorCode::unsupported, "compare", "no pipe");
    process_ = fork();
    if (process_ == 0) {
      close(files[0]);
      be_child(method, settings, files[1]);
    }
    const int code = errno;
    close(files[1]);
    file_ = files[0];
    if (process_ >= 0) return;
    close(file_);  // no destructor runs if the constructor throws
    throw Error(ErrorCode::unsupported, "compare", "no process for a method: " + std::generic_category().message(code));
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    close(file_);
    if (process_ > 0) waitpid(process_, nullptr, 0);
  }
  [[nodiscard]] int file() const { return file_; }

 private:
  pid_t process_ = -1;
  int file_ = -1;
};

}  // namespace

std::optional<double> MethodRun::median_of(std::string_view stage) const {
  for (const Stage& one : stages)
    if (one.name == stage) return median(one.times);
  return std::nullopt;
}

MethodRun run_alone(const ComparedMethod& method, const Settings& settings) {
  const Child child(method, settings);
  MethodRun run = receive_run({child.file(), method.name});
  run.method = &method;
  return run;
}

}  // namespace frontmost::cli
