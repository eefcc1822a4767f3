// SPDX-License-Identifier: Apache-2.0
// Truncated, mutated and lying image files: the result is an error or an image, never a crash, and never takes much
// memory.
#include <functional>

#include "support/radiance_maker.h"
#include "support/scratch_folder.h"
#include "support/seeds.h"
#include "support/test_images.h"

namespace frontmost::test {
namespace {

struct Sample {
  std::string name;
  std::string bytes;
};

std::string encoded(const Image& image, const std::string& name, const SaveOptions& options = {}) {
  const ScratchFolder folder;
  save(image, folder.file(name), options);
  return read_text(folder.file(name));
}

std::vector<Sample> samples() {
  SaveOptions deep;
  deep.bits = 16;
  const Image colors = random_floats(7, 5, {"R", "G", "B", "A"}), depth = random_floats(7, 5, {"Z"});
  RadianceRows radiance(4, std::vector<RadiancePixel>(9, {90, 80, 70, 130}));
  radiance[2][3] = radiance[3][8] = {10, 20, 30, 127};
  std::vector<Sample> all = {
      {"colours", encoded(colors, "a.png")},
      {"16-bit colours", encoded(colors, "a.png", deep)},
      {"depth", encoded(depth, "a.png")},
      {"ids", encoded(random_ids(7, 5, {"object"}, 100), "a.png")},
      {"normals", encoded(random_floats(7, 5, {"N.X", "N.Y", "N.Z"}), "a.png")},
      {"PFM", encoded(depth, "a.pfm")},
      {"NPY", encoded(colors, "a.npy")},
      {"plain Radiance", plain_radiance(radiance)},
      {"repeating Radiance", repeating_radiance(radiance)},
      {"packed Radiance", packed_radiance(radiance)},
  };
#ifdef FRONTMOST_HAS_OPENEXR
  Image many = colors;
  many.channels.push_back(std::move(random_ids(7, 5, {"object"}).channels[0]));
  all.push_back({"EXR", encoded(many, "a.exr")});
#endif
  return all;
}

/// Reads from memory of exactly that size, so that AddressSanitizer detects every byte read beyond it. \returns whether
/// it was read.
bool survives(const std::string& bytes) {
  const std::vector<std::byte> exact(reinterpret_cast<const std::byte*>(bytes.data()),
                                     reinterpret_cast<const std::byte*>(bytes.data()) + bytes.size());
  try {
    const Image image = load_image(exact, "memory");
    validate(image);
    EXPECT_LE(std::size_t(image.width) * std::size_t(image.height), std::size_t(1) << 20);
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).rfind("memory: ", 0), 0u) << error.what();
    return false;
  }
}

TEST(HostileImages, EveryPrefixIsAnError) {
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    EXPECT_TRUE(survives(sample.bytes));
    // The pixels of a PNG are complete without its last bytes, but libpng asks for these all the same.
    for (std::size_t size = 0; size < sample.bytes.size(); ++size)
      EXPECT_FALSE(survives(sample.bytes.substr(0, size))) << size << " bytes";
  }
}

TEST(HostileImages, MutationsEndInAnErrorOrAnImage) {
  std::mt19937 random(test::noted_seed(7));
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    int read = 0;
    for (int i = 0; i < 1500; ++i) {
      std::string bytes = sample.bytes;
      for (unsigned k = 0; k <= random() % 4; ++k) {
        // Half of the mutations hit the header, which holds the sizes.
        const std::size_t place = random() % (random() % 2 ? bytes.size() : std::min<std::size_t>(bytes.size(), 160));
        bytes[place] = random() % 3 == 0 ? '\xff' : char(random());
      }
      read += survives(bytes);
    }
    EXPECT_LT(read, 1500);
  }
}

TEST(HostileImages, SizesThatTheBytesCannotHoldGetNoMemory) {
  std::string npy = encoded(random_floats(7, 5, {"Z"}), "a.npy");
  npy.replace(npy.find("(5, 7)"), 6, "(16384, 16384)");
  EXPECT_FALSE(survives(npy));
  EXPECT_FALSE(survives("PF\n16384 16384\n-1.0\n1234"));
  EXPECT_FALSE(survives("PF\n99999999999999999999 1\n-1.0\n1234"));
  EXPECT_FALSE(survives("Pf\n-1 1\n-1.0\n1234"));
#ifdef FRONTMOST_HAS_OPENEXR
  const std::string exr = encoded(random_floats(7, 5, {"Z"}), "a.exr");
  for (const std::int32_t corner : {16383, 16384, 0x7FFFFFFF, -2, -0x7FFFFFFF}) {
    std::string lying = exr;
    const std::size_t window = lying.find("dataWindow") + std::string("dataWindow\0box2i\0", 17).size() + 4;
    std::memcpy(&lying[window + 8], &corner, 4);
    std::memcpy(&lying[window + 12], &corner, 4);
    EXPECT_FALSE(survives(lying)) << corner;
  }
  // A channel list ends early; its remaining bytes must not become attributes.
  std::string early = exr;
  early[early.find(std::string("chlist\0", 7)) + 7] += 1;
  EXPECT_FALSE(survives(early));
  std::string wrong_size = exr;
  wrong_size[wrong_size.find(std::string("v2f\0", 4)) + 4] = 4;
  EXPECT_FALSE(survives(wrong_size));
#endif
}

TEST(HostileImages, OtherFilesAreNamedAsSuch) {
  std::string message;
  const std::string text = "solid teapot";
  EXPECT_EQ(error_of([&] { (void)load_image(std::as_bytes(std::span(text)), "a.png"); }, &message),
            ErrorCode::file_malformed);
  EXPECT_EQ(message, "a.png: neither PNG nor OpenEXR, Radiance, PFM or NPY");
}

}  // namespace
}  // namespace frontmost::test
