// SPDX-License-Identifier: Apache-2.0
// Any bytes read as glTF or GLB: a valid scene (load() validates) or an Error that names the file.
#include <cstdint>
#include <cstdlib>

#include "frontmost/io.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    (void)frontmost::load({reinterpret_cast<const std::byte*>(data), size}, "fuzz",
                          {.format = frontmost::ModelFormat::gltf, .up = {}}, {.threads = 1});
  } catch (const frontmost::Error& error) {
    if (!std::string_view(error.what()).starts_with("fuzz: ")) std::abort();
  }
  return 0;
}
