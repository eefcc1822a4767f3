// SPDX-License-Identifier: Apache-2.0
// What every reader promises for any bytes at all. Shared by the fuzz targets and the tests over their corpus.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>

#include "frontmost/io.h"
#include "io/models/obj/mtl.h"

namespace frontmost {

/// Reads a copy of exactly the given size, so that a sanitizer sees every step beyond it.
/// \returns whether it was read; an Error whose words do not start with the name ends the program, as does an invalid
/// scene (load() validates) or another exception.
inline bool fuzz_reader(ModelFormat format, std::span<const std::byte> bytes) {
  const std::unique_ptr<std::byte[]> copy(new std::byte[bytes.size()]);
  std::copy(bytes.begin(), bytes.end(), copy.get());
  try {
    (void)load(std::span<const std::byte>(copy.get(), bytes.size()), "fuzz", {.format = format, .up = {}},
               {.threads = 1});
    return true;
  } catch (const Error& error) {
    if (!std::string_view(error.what()).starts_with("fuzz: ")) std::abort();
    return false;
  }
}

/// The same for a material library, which is not reached from memory.
inline bool fuzz_mtl(std::span<const std::byte> bytes) {
  const ModelSource source("fuzz", {});
  Scene scene;
  TextureFiles textures(source, scene);
  NamedMaterials materials(source, scene);
  try {
    read_mtl(bytes, source, "", textures, materials);
    validate(scene);
    return true;
  } catch (const Error& error) {
    if (!std::string_view(error.what()).starts_with("fuzz: ")) std::abort();
    return false;
  }
}

}  // namespace frontmost
