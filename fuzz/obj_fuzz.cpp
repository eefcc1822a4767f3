// SPDX-License-Identifier: Apache-2.0
// Reads any bytes as OBJ, and the bytes after the first zero as its material library: a valid scene or an Error.
#include <algorithm>

#include "support/reader_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(data), size);
  const auto split = std::size_t(std::find(bytes.begin(), bytes.end(), std::byte(0)) - bytes.begin());
  frontmost::fuzz_reader(frontmost::ModelFormat::obj, bytes.first(split));
  if (split < size) frontmost::fuzz_mtl(bytes.subspan(split + 1));
  return 0;
}
