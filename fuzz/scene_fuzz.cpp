// SPDX-License-Identifier: Apache-2.0
// Reads any bytes as a scene file, whose models can only be built-in ones, and as a file of categories: the result is
// valid or an Error.
#include "support/reader_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span bytes(reinterpret_cast<const std::byte*>(data), size);
  frontmost::fuzz_reader(frontmost::ModelFormat::scene, bytes);
  frontmost::fuzz_categories(bytes);
  return 0;
}
