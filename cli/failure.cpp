// SPDX-License-Identifier: Apache-2.0
// Signal handlers may run at any instruction, so they only store to lock-free atomics and call write() and _exit().
//
// Leaving at once is safe, because only saving makes files. A reader stuck on a slow pipe, or a kernel in the middle of
// a huge picture, has nothing to clean up, so no library call has to react quickly.
//
//   signal --while no file is written--> a line on the terminal, and _exit()
//          --while a WritingFiles lives--> noted: the library is asked to stop, and removes the unfinished file
//          --a second time--> _exit() at once
#include "cli/failure.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <cmath>

#include "cli/console.h"

namespace frontmost::cli {
namespace {

std::atomic<bool> writing{false}, line_shown{false}, line_begun{false}, waiting{false};
std::atomic<int> caught{0};

/// Text formatted beforehand, because handlers must not format.
struct PreparedLine {
  char text[128] = "";
  std::size_t length = 0;
};
PreparedLine timeout_line, timeout_line_of_ranks;

static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

constexpr std::string_view kClear = "\r\033[K";

int status_of(int signal) { return signal == SIGALRM ? exit_could_not : exit_interrupted; }

void put(std::string_view text) {
  const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
  (void)written;  // errors cannot be handled here
}

void say(int signal) {
  while (line_begun) {  // show_line() runs on another thread, because it blocks the signals of its own
  }
  if (line_shown) put(kClear);
  const PreparedLine& line = waiting ? timeout_line_of_ranks : timeout_line;
  if (signal == SIGALRM) put({line.text, line.length});
}

void on_signal(int signal) {
  // A second signal ends the program at once.
  const bool again = caught.exchange(signal) != 0;
  if (writing && !again) return;
  say(signal);
  _exit(status_of(signal));
}

void prepare(PreparedLine& line, double seconds, std::string_view rest) {
  line.length =
      fmt::format_to_n(line.text, sizeof line.text, "frontmost: gave up after {} s (--timeout){}\n", seconds, rest)
          .size;
}

void start_clock(double seconds) {
  prepare(timeout_line, seconds, "");
  prepare(timeout_line_of_ranks, seconds, ", waiting for other ranks");
  itimerval timer{};
  timer.it_value.tv_sec = time_t(std::floor(seconds));
  timer.it_value.tv_usec = suseconds_t(std::floor((seconds - std::floor(seconds)) * 1e6));
  setitimer(ITIMER_REAL, &timer, nullptr);
}

}  // namespace

bool names_culprit(const Error& error) {
  const std::string_view what = error.what();
  return !error.file().empty() || what.starts_with("-") || what.starts_with("standard ");
}

Error with_culprit(const Error& error, const Settings& settings) {
  if (names_culprit(error) || settings.model.empty()) return error;
  const bool is_of_pose = error.place() == "pose" && settings.view.pose;
  return error.within(!is_of_pose               ? settings.model
                      : settings.view.pose_file ? *settings.view.pose_file
                                                : std::string("--pose"));
}

void catch_interruptions(std::optional<double> timeout_seconds) {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // A signal that a parent such as nohup ignores stays ignored.
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  // If the reader of the output goes away, a write fails with a message, and the program does not die silently. The
  // same holds for a file that grows beyond the limit of `ulimit -f`.
  for (const int signal : {SIGPIPE, SIGXFSZ}) ::signal(signal, SIG_IGN);
  if (timeout_seconds) {
    sigaction(SIGALRM, &action, nullptr);
    start_clock(*timeout_seconds);
  }
}

WritingFiles::WritingFiles() {
  writing = true;
  stop_if_interrupted();
}

WritingFiles::~WritingFiles() { writing = false; }

WaitingForRanks::WaitingForRanks() { waiting = true; }

WaitingForRanks::~WaitingForRanks() { waiting = false; }

void show_line(std::string_view line) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  line_begun = true;
  if (!is_interrupted()) {
    line_shown = true;
    put(std::string(kClear).append(line));
  }
  line_begun = false;
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void clear_line() {
  if (line_shown.exchange(false)) put(kClear);
}

bool is_interrupted() { return caught != 0; }

void stop_if_interrupted() {
  if (is_interrupted()) throw Error(ErrorCode::cancelled, "interrupted");
}

int report_interruption() {
  say(caught);
  return status_of(caught);
}

}  // namespace frontmost::cli
