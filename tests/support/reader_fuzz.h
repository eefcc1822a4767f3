// SPDX-License-Identifier: Apache-2.0
// What every reader promises for any bytes at all. Shared by the fuzz targets and the tests over their corpus.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>

#include "frontmost/files.h"
#include "io/models/obj/mtl.h"
#include "support/threemf_maker.h"

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

/// The same for a file of categories.
inline bool fuzz_categories(std::span<const std::byte> bytes) {
  Scene scene = builtin("cubes");
  scene.instances[1].name = "a";
  try {
    load_categories(bytes, "fuzz", scene);
    validate(scene);
    return true;
  } catch (const Error& error) {
    if (!std::string_view(error.what()).starts_with("fuzz: ")) std::abort();
    return false;
  }
}

/// Any bytes read as 3MF: an archive as it is, or else the texts of its parts, which get an archive around them,
/// because mutations would never get past its checksums. The parts of an input that is no archive are parted by zeros:
/// the model, then "/a.model".
inline bool fuzz_3mf(std::string_view input) {
  const auto read = [](std::string_view bytes) {
    return fuzz_reader(ModelFormat::threemf, {reinterpret_cast<const std::byte*>(bytes.data()), bytes.size()});
  };
  if (input.starts_with("PK")) return read(input);
  const std::size_t split = std::min(input.find('\0'), input.size());
  test::ZipMaker zip = test::package_of(std::string(input.substr(0, split)));
  if (split < input.size()) zip.add("a.model", std::string(input.substr(split + 1)));
  return read(zip.bytes());
}

}  // namespace frontmost
