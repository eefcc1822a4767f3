// SPDX-License-Identifier: Apache-2.0
// Models drawn with --stream and without: time and peak memory of whole processes, as the length of the file grows.
//
//     stream_table [--millions N]... [--rounds N] [--folder DIR]
//     stream_table --write MILLIONS PATH     a ball as .stl or .ply; "-" is binary STL on standard output
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <vector>

#include "harness/table.h"
#include "stream/ball.h"

namespace frontmost::bench {
namespace {

struct Run {
  double seconds = 0, processor_seconds = 0, peak_mib = 0;
};

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

double seconds_of(const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); }

/// Replaces this process by the program with these words; `input` becomes its standard input.
[[noreturn]] void become(std::vector<std::string> words, int input) {
  if (input >= 0) dup2(input, STDIN_FILENO);
  dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), STDERR_FILENO);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(pointers.front(), pointers.data());
  _exit(127);
}

/// Measures one process from start to end. The next process overwrites its output files.
Run measured(const std::vector<std::string>& words, int input) {
  const auto start = std::chrono::steady_clock::now();
  const pid_t process = fork();
  if (process == 0) become(words, input);
  if (input >= 0) close(input);
  int status = 0;
  rusage usage{};
  wait4(process, &status, 0, &usage);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  if (status != 0) {
    std::fprintf(stderr, "stream_table: %s failed\n", words.front().c_str());
    std::exit(1);
  }
  return {time.count(), seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime), double(usage.ru_maxrss) / 1024};
}

/// Reading end of a pipe into which another process writes a ball.
int open_ball(double millions) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) std::exit(1);
  if (fork() == 0) {
    dup2(ends[1], STDOUT_FILENO);
    _exit(write_ball(std::uint64_t(millions * 1e6), false, "-") ? 0 : 1);
  }
  close(ends[1]);
  return ends[0];
}

struct Settings {
  std::vector<double> millions;
  int rounds = 3;
  std::string folder = std::filesystem::temp_directory_path();
};

/// A row of the table: a source and the options to draw it.
struct Case {
  const char* what;
  const char* source;  ///< "stl", "ply", "pipe"
  const char* options;
  double most_millions;  ///< larger models are left out
};

constexpr const char* placed = " --camera-position 3,2,4 --camera-focal-point 0,0,0 --near 1 --far 10";

const std::vector<Case> cases = {
    {"depth, in memory", "stl", "placed depth", 16},
    {"depth, streamed", "stl", "placed depth stream", 1e9},
    {"depth, streamed", "pipe", "placed depth stream", 1e9},
    {"depth, streamed", "ply", "placed depth stream", 64},
    {"lit, in memory", "stl", "lit", 16},
    {"lit, streamed", "stl", "lit stream", 1e9},
    {"lit, camera placed, streamed", "stl", "placed lit stream", 1e9},
};

std::string line_of(const Case& one, const std::string& model, const Settings& settings) {
  const std::string words = one.options, out = settings.folder + "/frontmost_stream";
  std::string line = std::string(FRONTMOST_PROGRAM) + " render " + model + " --resolution 1920,1080 --quiet";
  if (words.find("placed") != std::string::npos) line += placed;
  line += words.find("depth") != std::string::npos ? " --depth " + out + ".npy" : " -o " + out + ".png";
  return words.find("stream") != std::string::npos ? line + " --stream" : line;
}

/// The run with the median time.
Run median_of(const Case& one, double millions, const Settings& settings, const std::string& model) {
  std::vector<Run> runs;
  for (int i = 0; i < settings.rounds; ++i)
    runs.push_back(measured(words_of(line_of(one, model, settings)), model == "-" ? open_ball(millions) : -1));
  while (wait(nullptr) > 0) continue;  // waits for the processes that wrote into pipes
  std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.seconds < b.seconds; });
  return runs[runs.size() / 2];
}

/// Path of the model, which is written when first needed.
std::string model_of(const Case& one, double millions, const Settings& settings) {
  if (one.source == std::string("pipe")) return "-";
  std::ostringstream path;
  path << settings.folder << "/ball_" << millions << "m." << one.source;
  const bool ply = one.source == std::string("ply");
  if (!std::filesystem::exists(path.str()) && !write_ball(std::uint64_t(millions * 1e6), ply, path.str())) std::exit(1);
  return path.str();
}

void run(const Settings& settings) {
  Table table("stream", {"what", "source", "triangles", "s", "processor s", "peak MiB"});
  for (const double millions : settings.millions)
    for (const Case& one : cases) {
      if (millions > one.most_millions) continue;
      const Run median = median_of(one, millions, settings, model_of(one, millions, settings));
      table.add({one.what, one.source, Cell::whole(ball_triangle_count(std::uint64_t(millions * 1e6))), median.seconds,
                 median.processor_seconds, Cell(median.peak_mib, 0)});
    }
}

Settings settings_of(const std::vector<std::string>& words) {
  Settings settings;
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
    if (words[i] == "--millions") settings.millions.push_back(std::atof(words[i + 1].c_str()));
    if (words[i] == "--rounds") settings.rounds = std::max(1, std::atoi(words[i + 1].c_str()));
    if (words[i] == "--folder") settings.folder = words[i + 1];
  }
  if (settings.millions.empty()) settings.millions = {1, 4, 16};
  return settings;
}

}  // namespace
}  // namespace frontmost::bench

int main(int argc, char** argv) {
  using namespace frontmost::bench;
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() == 3 && words[0] == "--write") {
    const bool ply = words[2].ends_with(".ply");
    return write_ball(std::uint64_t(std::atof(words[1].c_str()) * 1e6), ply, words[2]) ? 0 : 1;
  }
  run(settings_of(words));
  return 0;
}
