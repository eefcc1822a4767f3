// SPDX-License-Identifier: Apache-2.0
#include "frontmost/io.h"
#include "io/input_file.h"

namespace frontmost {

std::string load_text(const std::string& path, std::uint64_t most_bytes) {
  const bool is_input = path == "-";
  const InputFile file =
      is_input ? InputFile::standard_input("standard input", most_bytes) : InputFile::open(path, path, most_bytes);
  const std::span<const std::byte> bytes = file.bytes();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace frontmost
