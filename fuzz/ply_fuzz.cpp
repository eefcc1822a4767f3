// SPDX-License-Identifier: Apache-2.0
// Reads any bytes as PLY: the result is a valid scene or an Error.
#include "support/reader_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  frontmost::fuzz_reader(frontmost::ModelFormat::ply, {reinterpret_cast<const std::byte*>(data), size});
  return 0;
}
