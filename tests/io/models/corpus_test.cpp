// SPDX-License-Identifier: Apache-2.0
// The promise of the fuzz targets, checked without a fuzzer. Every input of the corpus, every prefix of it, and
// thousands of mutations end in a scene or in an Error.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>

#include "support/reader_fuzz.h"
#include "support/seeds.h"

namespace frontmost {
namespace {

struct Seed {
  ModelFormat format;
  std::string name, bytes;
};

std::vector<Seed> seeds() {
  std::vector<Seed> all;
  for (const auto& [folder, format] : {std::pair{"stl", ModelFormat::stl},
                                       {"ply", ModelFormat::ply},
                                       {"obj", ModelFormat::obj},
                                       {"off", ModelFormat::off},
                                       {"scene", ModelFormat::scene}})
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(FRONTMOST_CORPUS) / folder)) {
      std::ifstream in(entry.path(), std::ios::binary);
      all.push_back({format, entry.path().string(), {std::istreambuf_iterator<char>(in), {}}});
    }
  // Folders are listed in any order, and mutations depend on the order.
  std::sort(all.begin(), all.end(), [](const Seed& a, const Seed& b) { return a.name < b.name; });
  return all;
}

bool read(ModelFormat format, const std::string& text) {
  const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(text.data()), text.size());
  if (format == ModelFormat::scene && fuzz_categories(bytes)) return true;
  if (format != ModelFormat::obj) return fuzz_reader(format, bytes);
  const std::size_t split = std::min(text.find('\0'), text.size());
  const bool library = split == text.size() || fuzz_mtl(bytes.subspan(split + 1));
  return fuzz_reader(format, bytes.first(split)) && library;
}

TEST(Corpus, SeedsAreReadOrRefused) {
  std::size_t good = 0;
  const auto all = seeds();
  for (const Seed& seed : all) good += read(seed.format, seed.bytes);
  EXPECT_GE(all.size(), 20u);
  EXPECT_GE(good, all.size() / 3);  // most seeds get through a reader, and not only to its first check
}

TEST(Corpus, EveryPrefixIsReadOrRefused) {
  for (const Seed& seed : seeds()) {
    SCOPED_TRACE(seed.name);
    const std::size_t longest = std::min<std::size_t>(seed.bytes.size(), 4096);
    for (std::size_t size = 0; size < longest; ++size) (void)read(seed.format, seed.bytes.substr(0, size));
  }
}

// A truncated binary file must be an error; only its last byte may be missing unnoticed.
TEST(Corpus, TruncatedBinariesAreRefused) {
  for (const Seed& seed : seeds()) {
    const bool is_binary =
        seed.name.ends_with("stl/binary") || seed.name.ends_with("ply/little") || seed.name.ends_with("ply/big");
    if (!is_binary) continue;
    for (std::size_t size = 0; size < seed.bytes.size(); ++size)
      EXPECT_FALSE(read(seed.format, seed.bytes.substr(0, size))) << seed.name << " to " << size;
    EXPECT_TRUE(read(seed.format, seed.bytes)) << seed.name;
  }
}

TEST(Corpus, MutationsAreReadOrRefused) {
  std::mt19937 random(test::noted_seed(8));
  std::size_t good = 0, bad = 0;
  for (const Seed& seed : seeds()) {
    if (seed.bytes.size() > 4096) continue;
    for (int round = 0; round < 400; ++round) {
      std::string bytes = seed.bytes;
      for (auto changes = 1 + random() % 4; changes-- > 0 && !bytes.empty();) {
        const std::size_t at = random() % bytes.size();
        switch (random() % 4) {
          case 0: bytes[at] = char(random()); break;
          case 1: bytes.erase(at, 1 + random() % 8); break;
          case 2: bytes.insert(at, 1 + random() % 3, "09-.e/ \n\xFF"[random() % 9]); break;
          default: bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 20)); break;
        }
      }
      (read(seed.format, bytes) ? good : bad) += 1;
    }
  }
  EXPECT_GT(good, 1000u);
  EXPECT_GT(bad, 1000u);
}

}  // namespace
}  // namespace frontmost
