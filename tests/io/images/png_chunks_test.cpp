// SPDX-License-Identifier: Apache-2.0
// PNG files taken apart into chunks and reassembled otherwise: changes that may not alter a pixel, and changes that are
// errors.
#include <zlib.h>

#include "support/scratch_folder.h"
#include "support/test_images.h"

namespace frontmost::test {
namespace {

constexpr std::size_t signature_size = 8;

struct Chunk {
  std::string type, data;
};

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

std::string word(std::uint32_t value) {
  return {char(value >> 24), char(value >> 16 & 0xFF), char(value >> 8 & 0xFF), char(value & 0xFF)};
}

std::vector<Chunk> chunks_of(const std::string& png) {
  std::vector<Chunk> chunks;
  for (std::size_t at = signature_size; at < png.size();) {
    const std::size_t length = big_endian(png, at);
    chunks.push_back({png.substr(at + 4, 4), png.substr(at + 8, length)});
    at += 12 + length;
  }
  return chunks;
}

std::string png_of(const std::vector<Chunk>& chunks) {
  std::string png = "\x89PNG\r\n\x1a\n";
  for (const Chunk& chunk : chunks) {
    const std::string checked = chunk.type + chunk.data;
    png += word(std::uint32_t(chunk.data.size())) + checked;
    png += word(std::uint32_t(::crc32(0, reinterpret_cast<const Bytef*>(checked.data()), uInt(checked.size()))));
  }
  return png;
}

std::vector<Chunk> saved(const Image& image, const SaveOptions& options = {}) {
  const ScratchFolder folder;
  save(image, folder.file("a.png"), options);
  return chunks_of(read_text(folder.file("a.png")));
}

Image read(const std::vector<Chunk>& chunks) {
  const std::string png = png_of(chunks);
  return load_image(std::as_bytes(std::span(png)), "m");
}

std::string error_in(const std::vector<Chunk>& chunks) {
  std::string message = "read";
  try {
    (void)read(chunks);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::file_malformed);
    message = error.what();
  }
  return message;
}

std::size_t place_of(const std::vector<Chunk>& chunks, const std::string& type) {
  for (std::size_t i = 0; i < chunks.size(); ++i)
    if (chunks[i].type == type) return i;
  ADD_FAILURE() << "no " << type;
  return 0;
}

/// The text chunk with this keyword.
Chunk& text_of(std::vector<Chunk>& chunks, const std::string& keyword) {
  for (Chunk& chunk : chunks)
    if (chunk.type == "tEXt" && chunk.data.substr(0, keyword.size() + 1) == keyword + '\0') return chunk;
  ADD_FAILURE() << "no text " << keyword;
  return chunks[0];
}

std::string keyword_of(const Chunk& chunk) { return chunk.data.substr(0, chunk.data.find('\0')); }

TEST(PngChunks, EveryFileEndsWithIendAndHasGoodChecksums) {
  const Image image = random_floats(300, 200, {"R", "G", "B"});
  const std::vector<Chunk> chunks = saved(image);
  EXPECT_EQ(chunks.front().type, "IHDR");
  EXPECT_EQ(chunks.front().data.size(), 13u);
  EXPECT_EQ(big_endian(chunks.front().data, 0), 300u);
  EXPECT_EQ(big_endian(chunks.front().data, 4), 200u);
  EXPECT_EQ(chunks.back().type, "IEND");
  EXPECT_EQ(chunks.back().data, "");
  const ScratchFolder folder;
  save(image, folder.file("a.png"));
  EXPECT_TRUE(png_of(chunks) == read_text(folder.file("a.png"))) << "the checksums are those of zlib";
}

// Strips that threads compress separately form one zlib stream: 78 01, deflate, Adler-32 of all rows.
TEST(PngChunks, StripsMakeOneStream) {
  const Image image = random_floats(1000, 700, {"R", "G", "B"});  // eight strips
  std::string stream;
  for (const Chunk& chunk : saved(image))
    if (chunk.type == "IDAT") stream += chunk.data;
  EXPECT_EQ(stream.substr(0, 2), "\x78\x01");
  std::vector<Bytef> rows(700 * (1 + 3 * 1000));
  uLongf size = uLongf(rows.size());
  ASSERT_EQ(::uncompress(rows.data(), &size, reinterpret_cast<const Bytef*>(stream.data()), uLong(stream.size())),
            Z_OK);
  EXPECT_EQ(size, rows.size());
  EXPECT_EQ(big_endian(stream, stream.size() - 4), std::uint32_t(::adler32(1, rows.data(), uInt(rows.size()))));
}

TEST(PngChunks, PixelsMayBeCutAnywhere) {
  const Image image = random_floats(40, 30, {"R", "G", "B", "A"});
  const std::vector<Chunk> chunks = saved(image);
  std::vector<Chunk> pieces;
  for (const Chunk& chunk : chunks) {
    if (chunk.type != "IDAT") {
      pieces.push_back(chunk);
      continue;
    }
    for (std::size_t at = 0; at < chunk.data.size(); at += 7) pieces.push_back({"IDAT", chunk.data.substr(at, 7)});
    pieces.push_back({"IDAT", ""});
  }
  EXPECT_GT(pieces.size(), chunks.size() + 100);
  expect_same_bits(read(pieces), read(chunks));
}

// glTF says to ignore gamma and profiles, so unreadable or huge ones must not matter either.
TEST(PngChunks, NothingButPixelsDecidesAboutColours) {
  const Image image = random_floats(20, 10, {"R", "G", "B"});
  const std::vector<Chunk> chunks = saved(image);
  const Image plain = read(chunks);
  const Chunk others[] = {{"gAMA", word(100000)},
                          {"gAMA", word(22727)},
                          {"gAMA", ""},
                          {"cHRM", std::string(32, '\1')},
                          {"iCCP", std::string("profile\0\0not deflate", 20)},
                          {"zTXt", std::string("Comment\0\0not deflate", 20)},
                          {"iTXt", "no zero at all"},
                          {"eXIf", "MM"},
                          {"tEXt", "no zero at all"},
                          {"tIME", "short"},
                          {"abCd", "anybody's"}};
  for (const Chunk& other : others) {
    std::vector<Chunk> more = chunks;
    more.insert(more.begin() + std::ptrdiff_t(place_of(more, "IDAT")), other);
    expect_same_bits(read(more), plain);
  }
}

TEST(PngChunks, UnknownChunksThatMatterAreErrors) {
  std::vector<Chunk> chunks = saved(random_floats(3, 2, {"R", "G", "B"}));
  chunks.insert(chunks.begin() + 1, {"ABCD", "critical"});
  EXPECT_EQ(error_in(chunks).substr(0, 8), "m: PNG: ");
}

TEST(PngChunks, WhatIsMissingIsAnError) {
  const std::vector<Chunk> chunks = saved(random_floats(30, 20, {"R", "G", "B"}));
  for (const char* type : {"IHDR", "IDAT", "IEND"}) {
    std::vector<Chunk> fewer;
    for (const Chunk& chunk : chunks)
      if (chunk.type != type) fewer.push_back(chunk);
    EXPECT_EQ(error_in(fewer).substr(0, 8), "m: PNG: ") << "without " << type;
  }
  std::vector<Chunk> no_end = chunks;
  no_end.pop_back();
  EXPECT_EQ(error_in(no_end), "m: PNG: ends too early");
}

TEST(PngChunks, LengthsAreHeldAgainstTheFile) {
  std::string png = png_of(saved(random_floats(3, 2, {"R", "G", "B"})));
  const std::size_t last = png.size() - 12;
  for (const std::uint32_t length : {1u, 0x7FFFFFFFu, 0xFFFFFFFFu}) {
    png.replace(last, 4, word(length));
    std::string message;
    EXPECT_EQ(error_of([&] { (void)load_image(std::as_bytes(std::span(png)), "m"); }, &message),
              ErrorCode::file_malformed);
    EXPECT_EQ(message, "m: PNG: ends too early") << length;
  }
}

TEST(PngChunks, ABrokenByteOfPixelsIsNoticed) {
  const std::vector<Chunk> chunks = saved(random_floats(50, 40, {"R", "G", "B"}));
  const std::string png = png_of(chunks);
  const std::size_t pixels = png.find("IDAT") + 20;
  std::string broken = png;
  broken[pixels] = char(broken[pixels] ^ 1);  // the chunk's checksum no longer fits
  EXPECT_EQ(error_of([&] { (void)load_image(std::as_bytes(std::span(broken)), "m"); }), ErrorCode::file_malformed);
}

TEST(PngTexts, ScaleAndOffsetOfADepthMap) {
  Image depth{2, 1, {}};
  depth.channels.push_back(float_channel("Z", {2, 3}));
  SaveOptions options;
  options.depth_scale = 100;
  const std::vector<Chunk> chunks = saved(depth, options);
  std::vector<std::string> keywords;
  for (const Chunk& chunk : chunks)
    if (chunk.type == "tEXt") keywords.push_back(keyword_of(chunk));
  ASSERT_EQ(keywords.size(), 3u);
  const std::string scale = keywords[1], offset = keywords[2];

  const auto with = [&](const std::string& key, const std::string& value) {
    std::vector<Chunk> changed = chunks;
    text_of(changed, key).data = key + '\0' + value;
    return changed;
  };
  // 200 and 300 are stored: stored = depth * scale + offset.
  EXPECT_EQ(read(with(scale, "50")).channels[0].floats()[0], 4.0f);
  EXPECT_EQ(read(with(offset, "100")).channels[0].floats()[1], 2.0f);
  EXPECT_EQ(read(with(scale, "1e2")).channels[0].floats()[1], 3.0f);
  EXPECT_EQ(error_in(with(scale, "0")), "m: PNG: the depth scale is 0");
  for (const char* value : {"", "x", "inf", "nan", "1e999"}) {
    EXPECT_EQ(error_in(with(scale, value)), "m: PNG: text " + scale + " is not a number") << value;
    EXPECT_EQ(error_in(with(offset, value)), "m: PNG: text " + offset + " is not a number") << value;
  }
  std::vector<Chunk> without = chunks;
  text_of(without, scale).data = "Comment" + std::string(1, '\0');
  EXPECT_EQ(error_in(without), "m: PNG: text " + scale + " is not a number");
}

TEST(PngTexts, AChannelsNameIsKeptForMapsAlone) {
  Image ids{3, 1, {}};
  ids.channels.push_back(id_channel("material", {0, 7, no_index}));
  std::vector<Chunk> chunks = saved(ids);
  EXPECT_EQ(read(chunks).channels[0].name, "material");
  const std::string key = keyword_of(chunks[place_of(chunks, "tEXt")]);
  text_of(chunks, key).data = key + '\0' + "part";
  const Image renamed = read(chunks);
  EXPECT_EQ(renamed.channels[0].name, "part");
  EXPECT_EQ(renamed.channels[0].integers()[1], 7u);
  // In a colour picture the same text has no effect: the values are colours, whatever the text says.
  std::vector<Chunk> colours = saved(random_floats(2, 2, {"R", "G", "B"}));
  const Image plain = read(colours);
  colours.insert(colours.begin() + 1, {"tEXt", key + '\0' + "Z"});
  expect_same_bits(read(colours), plain);
}

TEST(PngSave, WhatDoesNotFitIsSaidInFull) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.png");
  const auto error = [&](const Image& image, const SaveOptions& options = {}) {
    std::string message;
    (void)error_of([&] { save(image, path, options); }, &message);
    EXPECT_EQ(message.substr(0, path.size()), path);
    return message.substr(std::min(message.size(), path.size()));
  };
  const Image depth = random_floats(2, 2, {"Z"}, 4, 4.0001f), colours = random_floats(2, 2, {"R", "G", "B"});
  for (const int bits : {0, 1, 7, 12, 32})
    EXPECT_EQ(error(colours, {{}, bits, {}}), ": PNG has 8 or 16 bits, not " + std::to_string(bits));
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double scale : {0.0, -1.0, infinity, -infinity, std::nan("")})
    EXPECT_EQ(error(depth, {{}, 8, scale}), ": the depth scale must be a positive number");
  Image far = depth;
  far.channels[0].floats()[3] = 1024;
  EXPECT_EQ(error(far, {{}, 8, 64.0}), ": depth 1024 times scale 64 is over 65535, the most that a PNG can hold");
  EXPECT_EQ(error(random_ids(9, 9, {"object"}, no_index)).substr(0, 5), ": id ");
  Image ids{1, 1, {}};
  ids.channels.push_back(id_channel("object", {65535}));
  EXPECT_EQ(error(ids), ": id 65535 is over 65534, the most that a PNG can hold; write EXR or NPY");
  EXPECT_EQ(error(random_floats(2, 2, {"R", "G"})),
            ": PNG holds R, G, B and A, or N.X, N.Y, N.Z, or one channel, not R, G");
  EXPECT_EQ(folder.entry_count(), 0u);
}

// The greatest depths of a scale are stored as 65535, missing ones as 0, and depths below half a step as 1.
TEST(PngSave, TheEndsOfADepthScale) {
  const float infinity = std::numeric_limits<float>::infinity();
  Image image{6, 1, {}};
  image.channels.push_back(float_channel("Z", {65535, 65535.49f, 0.4f, 1e-30f, infinity, std::nanf("")}));
  SaveOptions options;
  options.depth_scale = 1;
  const Image back = read(saved(image, options));
  const Buffer<float>& depths = back.channels[0].floats();
  EXPECT_THAT(std::vector<float>(depths.begin(), depths.end()),
              testing::ElementsAre(65535, 65535, 1, 1, infinity, infinity));
  image.channels[0].floats()[0] = 65535.5f;
  const ScratchFolder folder;
  EXPECT_EQ(error_of([&] { save(image, folder.file("a.png"), options); }), ErrorCode::limit_exceeded);
}

}  // namespace
}  // namespace frontmost::test
