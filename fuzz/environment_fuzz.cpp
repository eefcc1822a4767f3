// SPDX-License-Identifier: Apache-2.0
// Reads any bytes as an environment: lighting can rely on the result, or an Error names the file.
#include <cstdlib>

#include "frontmost/files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace frontmost;
  try {
    const Image environment = load_environment({reinterpret_cast<const std::byte*>(data), size}, "fuzz");
    validate(environment);
    if (environment.width != 2 * environment.height || environment.channels.size() != 3) std::abort();
    for (const Channel& channel : environment.channels)
      for (const float value : channel.floats())
        if (!(value >= 0 && value <= max_environment_value)) std::abort();
  } catch (const Error& error) {
    if (!std::string_view(error.what()).starts_with("fuzz: ")) std::abort();
  }
  return 0;
}
