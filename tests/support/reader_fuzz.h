// SPDX-License-Identifier: Apache-2.0
// Promises that every reader keeps for any bytes. The fuzz targets and the tests over their corpus share them.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>

#include "frontmost/files.h"
#include "io/models/obj/mtl.h"
#include "support/threemf_maker.h"

namespace frontmost {

/// Reads a copy of exactly the given size, so that a sanitizer detects every access beyond it. \returns whether it was
/// read. The program ends on an Error whose message does not start with the name, on an invalid scene (load()
/// validates), and on any other exception.
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

/// Reads a material library through a file, as none is read from memory.
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

/// Reads a file of categories likewise.
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

/// Reads any bytes as 3MF: an archive unchanged, or else the texts of its parts, which are packed into an archive,
/// because mutations would never pass its checksums. Zeros separate the parts of such an input: the model, then
/// "/a.model".
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
