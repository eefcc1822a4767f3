// SPDX-License-Identifier: Apache-2.0
// Deep OpenEXR: any number of samples a pixel. Each row is compressed by itself (ZIPS).
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPartType.h>

#include "base/parallel.h"
#include "io/images/exr/output.h"
#include "io/images/formats.h"

namespace frontmost::detail {
namespace {

const char* values_of(const Channel& channel) {
  return channel.is_integer() ? reinterpret_cast<const char*>(channel.integers().data())
                              : reinterpret_cast<const char*>(channel.floats().data());
}

/// One row as the library expects it: the number of samples of each pixel, and for each channel their addresses.
class Row {
 public:
  explicit Row(const DeepImage& image)
      : image_(image),
        counts_(std::size_t(image.width)),
        pointers_(image.channels.size(), std::vector<const char*>(std::size_t(image.width))) {}

  /// The frame buffer serves all rows: each row fills the same memory anew.
  [[nodiscard]] Imf::DeepFrameBuffer frame_buffer() {
    Imf::DeepFrameBuffer frame;
    frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts_.data()), sizeof counts_[0], 0));
    for (std::size_t c = 0; c < pointers_.size(); ++c)
      frame.insert(image_.channels[c].name,
                   Imf::DeepSlice(type_of(image_.channels[c]), reinterpret_cast<char*>(pointers_[c].data()),
                                  sizeof(char*), 0, kValueSize));
    return frame;
  }
  void fill(int y) {
    const std::size_t width = std::size_t(image_.width), row = std::size_t(y) * width;
    for (std::size_t x = 0; x < width; ++x) {
      const std::uint64_t begin = image_.first[row + x];
      counts_[x] = std::uint32_t(image_.first[row + x + 1] - begin);
      for (std::size_t c = 0; c < pointers_.size(); ++c)
        pointers_[c][x] = values_of(image_.channels[c]) + begin * kValueSize;
    }
  }

 private:
  static constexpr std::size_t kValueSize = 4;
  const DeepImage& image_;
  std::vector<std::uint32_t> counts_;
  std::vector<std::vector<const char*>> pointers_;  ///< by channel
};

std::vector<std::byte> encode(const DeepImage& image, const std::string& name, const Execution& execution) {
  Imf::Header header(image.width, image.height);
  header.setType(Imf::DEEPSCANLINE);
  header.compression() = Imf::ZIPS_COMPRESSION;  // the smallest files among the methods for deep data
  for (const Channel& channel : image.channels) header.channels().insert(channel.name, Imf::Channel(type_of(channel)));
  MemoryOutput memory(name);
  {
    Row row(image);
    Imf::DeepScanLineOutputFile out(memory, header, 0);
    out.setFrameBuffer(row.frame_buffer());
    for (int y = 0; y < image.height; ++y) {
      check_cancelled(execution);
      row.fill(y);
      out.writePixels(1);
    }
  }
  return std::move(memory.bytes());
}

}  // namespace

void save_deep_exr(const DeepImage& image, OutputFile& file, const Execution& execution) {
  with_named_errors(file.name(), [&] { file.write(encode(image, file.name(), execution)); });
}

}  // namespace frontmost::detail
