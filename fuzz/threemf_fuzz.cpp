// SPDX-License-Identifier: Apache-2.0
// Any bytes read as 3MF: a valid scene or an Error.
#include "support/reader_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  frontmost::fuzz_3mf({reinterpret_cast<const char*>(data), size});
  return 0;
}
