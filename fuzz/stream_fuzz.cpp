// SPDX-License-Identifier: Apache-2.0
// Reads any bytes as STL or PLY in pieces, from a file and from a pipe: the result is the triangles of load(), or an
// Error.
#include "support/stream_fuzz.h"

#include <filesystem>
#include <fstream>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string path =
      std::filesystem::temp_directory_path() / ("frontmost_stream_fuzz_" + std::to_string(::getpid()));
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(data), std::streamsize(size));
  const std::uint64_t triangles = size % 5 + 1;
  (void)frontmost::fuzz_stream(path, {reinterpret_cast<const std::byte*>(data), size}, triangles);
  std::filesystem::remove(path);
  return 0;
}
