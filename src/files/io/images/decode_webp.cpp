// SPDX-License-Identifier: Apache-2.0
// Textures from WebP, lossy or not, by libwebp.
#include <webp/decode.h>

#include "io/images/decode.h"

namespace frontmost::detail {
namespace {

/// The pixels of a picture of one colour take no bits at all, so only the callers' limits of pixels hold.
constexpr double any_density = double(max_image_pixels);

const char* reason_of(VP8StatusCode status) {
  switch (status) {
    case VP8_STATUS_NOT_ENOUGH_DATA: return "ends too early";
    case VP8_STATUS_UNSUPPORTED_FEATURE: return "uses a feature that libwebp does not have";
    default: return "is damaged";
  }
}

}  // namespace

bool has_webp() { return true; }

Texture decode_webp(std::span<const std::byte> bytes, const std::string& name, ImagePart part) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  WebPBitstreamFeatures features;
  const VP8StatusCode header = WebPGetFeatures(data, bytes.size(), &features);
  if (header != VP8_STATUS_OK) throw Error(ErrorCode::file_malformed, name, "WebP", reason_of(header));
  if (features.has_animation) throw Error(ErrorCode::unsupported, name, "WebP", "animations are not supported");
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
