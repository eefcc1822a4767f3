// SPDX-License-Identifier: Apache-2.0
// Seeds of the fuzz targets, with the expected outcome of each.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "frontmost/files.h"
#include "io/images/formats.h"
#include "io/models/gltf/data.h"

namespace frontmost {
namespace {

namespace fs = std::filesystem;

std::vector<std::byte> bytes_of_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

TEST(GltfCorpus, SeedsOfTheReader) {
  std::map<std::string, std::uint64_t> readable = {{"copies.gltf", 3}, {"layers.gltf", 3},  {"lights.gltf", 0},
                                                   {"posed.gltf", 2},  {"textured.glb", 1}, {"webp.glb", 2}};
  if (gltf::has_draco())
    readable.insert({{"draco.glb", 12}, {"draco_edgebreaker.glb", 24}, {"draco_sequential.glb", 24}});
  if (gltf::has_meshopt()) readable.insert({{"meshopt.glb", 12}, {"meshopt_filters.glb", 24}});
  std::size_t refused = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(FRONTMOST_CORPUS) / "gltf")) {
    const std::string name = entry.path().filename().string();
    const auto known = readable.find(name);
    try {
      const Scene scene = load(bytes_of_file(entry.path()), name, {.format = ModelFormat::gltf, .up = {}});
      if (known == readable.end())
        ADD_FAILURE() << name << " was read";
      else
        EXPECT_EQ(triangle_count(scene), known->second) << name;
    } catch (const Error& error) {
      EXPECT_TRUE(known == readable.end()) << error.what();
      ++refused;
    }
  }
  EXPECT_GE(refused, 3u);
}

TEST(GltfCorpus, SeedsOfTheImageDecoder) {
  std::size_t decoded = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(FRONTMOST_CORPUS) / "texture")) {
    const std::vector<std::byte> bytes = bytes_of_file(entry.path());
    if (entry.path().extension() == ".webp" && !decodes_webp(nullptr)) continue;
    const Texture texture = decode_texture(bytes, entry.path().filename().string());
    EXPECT_EQ(texture_size(bytes, "t"), glm::ivec2(texture.width, texture.height));
    ++decoded;
  }
  EXPECT_GE(decoded, 6u);
}

}  // namespace
}  // namespace frontmost
