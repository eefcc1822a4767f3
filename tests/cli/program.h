// SPDX-License-Identifier: Apache-2.0
// Runs the real program, as a user would, in a folder of its own.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/failure.h"

namespace frontmost::test {

struct Outcome {
  int status = -1;  ///< exit status; 128 + signal if a signal ended the program
  std::string out, err;

  /// Standard output as JSON; fails the test if it is not JSON.
  [[nodiscard]] nlohmann::json json() const;
};

struct Call {
  std::vector<std::string> words{};
  std::string input{};           ///< standard input
  bool keep_input_open = false;  ///< like a pipe whose writer is slow
  std::optional<int> signal{};   ///< sent `signal_after` seconds after the program has a handler for it
  double signal_after = 0.3;
  bool terminal = false;                       ///< standard output and error are one terminal; both arrive in `out`
  std::vector<std::string> environment{};      ///< NAME=VALUE, added
  std::optional<std::size_t> address_space{};  ///< bytes, as `ulimit -v`
  std::optional<std::size_t> file_size{};      ///< bytes, as `ulimit -f`
  /// Most processes, as `ulimit -u`. Root has no such limit, so root runs the program as nobody; input files must then
  /// be readable by all.
  std::optional<std::size_t> processes{};
};

/// A temporary folder for one test; programs run inside it.
class ProgramTest : public testing::Test {
 protected:
  ProgramTest();
  ~ProgramTest() override;

  [[nodiscard]] Outcome run(std::vector<std::string> words) const { return run(Call{.words = std::move(words)}); }
  [[nodiscard]] Outcome run(const Call& call) const;
  /// Runs a line split at blanks; the test fails unless the exit status is 0.
  Outcome succeed(const std::string& line) const;
  /// Fails the test unless the exit status is `status` and standard error contains `message`.
  void expect_failure(const std::string& line, int status, const std::string& message) const;

  /// Lets everybody write into the folder and read its files.
  void open_to_all() const;
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  [[nodiscard]] std::string read(const std::string& name) const;
  void write(const std::string& name, const std::string& content) const;
  /// Names of all files, sorted.
  [[nodiscard]] std::vector<std::string> files() const;

 private:
  std::filesystem::path folder_;
};

/// Message of the exception that `work` throws; "none" if it throws none.
template <class Work>
std::string complaint(const Work& work) {
  try {
    (void)work();
  } catch (const cli::UsageError& error) {
    return error.what();
  }
  return "none";
}

/// A binary STL of the unit cube, 12 triangles, with its lower corner at (low, low, low).
[[nodiscard]] std::string cube_stl(float low = 0);
/// Renders cube_stl() along +y from 10 before its near side, where 1 unit is 10 pixels wide.
inline const std::string render_cube =
    "render cube.stl --camera-position 0.5,-10,0.5 --camera-direction y "
    "--intrinsics 100,100,32,32 --pixel-center half --resolution 64,64 ";
/// A binary STL of one triangle in the plane z = 0, counter-clockwise seen from +z.
[[nodiscard]] std::string triangle_stl();

}  // namespace frontmost::test
