// SPDX-License-Identifier: Apache-2.0
// WebP by libwebp. Lossy and lossless files are read; lossy files with exact alpha are written. Method 2 of 6 takes
// half the time of the library's default; files are 0 to 5 % larger.
#include <webp/decode.h>
#include <webp/encode.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <vector>

#include "base/parallel.h"
#include "io/images/formats.h"

namespace frontmost::detail {
namespace {

constexpr int most_webp_side = 16383;

/// Callbacks for the library. Exceptions must not pass through the library, so the first one is kept and thrown later.
struct WebpCalls {
  const Execution& execution;
  std::vector<std::byte> bytes;
  std::exception_ptr error = nullptr;

  template <class Action>
  [[nodiscard]] static int run(void* place, const Action& action) {
    WebpCalls& calls = *static_cast<WebpCalls*>(place);
    try {
      action(calls);
      return 1;
    } catch (...) {
      calls.error = std::current_exception();
      return 0;
    }
  }
};

int keep_webp_bytes(const std::uint8_t* data, std::size_t size, const WebPPicture* picture) {
  return WebpCalls::run(picture->custom_ptr, [&](WebpCalls& calls) {
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    calls.bytes.insert(calls.bytes.end(), bytes, bytes + size);
  });
}

int poll_webp(int, const WebPPicture* picture) {
  return WebpCalls::run(picture->user_data, [](WebpCalls& calls) { check_cancelled(calls.execution); });
}

/// Copies the rows into `picture`. The intermediate bytes are freed before the encoding begins.
void import_rows(const PictureRows& rows, WebPPicture& picture, const Execution& execution) {
  Buffer<std::uint8_t> pixels(rows.row_bytes() * std::size_t(rows.height));
  constexpr std::size_t grain = 16;
  parallel_for(execution, std::size_t(rows.height), grain, [&](std::size_t first, std::size_t end) {
    for (std::size_t y = first; y < end; ++y) rows.row(int(y), pixels.data() + y * rows.row_bytes());
  });
  picture.width = rows.width;
  picture.height = rows.height;
  const auto import = rows.with_alpha ? WebPPictureImportRGBA : WebPPictureImportRGB;
  if (!import(&picture, pixels.data(), int(rows.row_bytes()))) throw std::bad_alloc();
}

[[noreturn]] void fail_webp(const WebPPicture& picture, const std::string& name) {
  if (picture.error_code == VP8_ENC_ERROR_OUT_OF_MEMORY || picture.error_code == VP8_ENC_ERROR_BITSTREAM_OUT_OF_MEMORY)
    throw std::bad_alloc();
  throw Error(ErrorCode::limit_exceeded, name, "WebP",
              "the picture has more detail than the format holds at this quality (error " +
                  std::to_string(int(picture.error_code)) + ")");
}

const char* reason_of(VP8StatusCode status) {
  switch (status) {
    case VP8_STATUS_NOT_ENOUGH_DATA: return "ends too early";
    case VP8_STATUS_UNSUPPORTED_FEATURE: return "uses a feature that libwebp does not support";
    default: return "is damaged";
  }
}

}  // namespace

bool has_webp() { return true; }

void save_webp(const PictureRows& picture, int quality, OutputFile& file, const Execution& execution) {
  if (std::max(picture.width, picture.height) > most_webp_side)
    throw Error(
        ErrorCode::limit_exceeded, file.name(), "",
        "WebP holds at most 16383 pixels on a side, not " + std::to_string(std::max(picture.width, picture.height)));
  WebPConfig config;
  if (!WebPConfigInit(&config)) throw Error(ErrorCode::unsupported, file.name(), "WebP", "another version of libwebp");
  config.quality = float(quality);
  config.method = 2;
  WebpCalls calls{execution, {}};
  WebPPicture held;
  if (!WebPPictureInit(&held)) throw std::bad_alloc();
  const std::unique_ptr<WebPPicture, decltype(&WebPPictureFree)> owner(&held, WebPPictureFree);
  import_rows(picture, held, execution);
  held.writer = keep_webp_bytes;
  held.custom_ptr = &calls;
  held.progress_hook = poll_webp;
  held.user_data = &calls;
  const bool done = WebPEncode(&config, &held) != 0;
  if (calls.error) std::rethrow_exception(calls.error);
  if (!done) fail_webp(held, file.name());
  file.write(calls.bytes);
}

Texture decode_webp(std::span<const std::byte> bytes, const std::string& name, ImagePart part) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  WebPBitstreamFeatures features;
  const VP8StatusCode header = WebPGetFeatures(data, bytes.size(), &features);
  if (header != VP8_STATUS_OK) throw Error(ErrorCode::file_malformed, name, "WebP", reason_of(header));
  if (features.has_animation) throw Error(ErrorCode::unsupported, name, "WebP", "animations are not supported");
  // The pixels of a picture of one colour take no bits at all, so only the limits that check_image_size() knows apply.
  constexpr double any_density = double(max_image_pixels);
  check_image_size(name, std::uint64_t(features.width), std::uint64_t(features.height), bytes.size(), any_density);

  Texture texture;
  texture.name = name;
  texture.width = features.width;
  texture.height = features.height;
  if (part == ImagePart::size) return texture;
  texture.pixels.resize(std::size_t(texture.width) * std::size_t(texture.height));
  WebPDecoderConfig config;
  if (!WebPInitDecoderConfig(&config)) throw Error(ErrorCode::unsupported, name, "WebP", "another version of libwebp");
  config.output.colorspace = MODE_RGBA;
  config.output.is_external_memory = 1;
  config.output.u.RGBA = {reinterpret_cast<std::uint8_t*>(texture.pixels.data()), texture.width * 4,
                          texture.pixels.size() * sizeof(glm::u8vec4)};
  const VP8StatusCode status = WebPDecode(data, bytes.size(), &config);
  if (status == VP8_STATUS_OUT_OF_MEMORY) throw std::bad_alloc();
  if (status != VP8_STATUS_OK) throw Error(ErrorCode::file_malformed, name, "WebP", reason_of(status));
  return texture;
}

}  // namespace frontmost::detail
