// SPDX-License-Identifier: Apache-2.0
// Stands for webp.cpp and decode_webp.cpp in builds without libwebp.
#include "io/images/decode.h"
#include "io/images/lossy/lossy.h"

namespace frontmost::detail {
namespace {

[[noreturn]] void refuse_webp(const std::string& name) {
  throw Error(ErrorCode::unsupported, name, "WebP",
              "this Frontmost was built without libwebp (Debian package libwebp-dev, FRONTMOST_WEBP)");
}

}  // namespace

bool has_webp() { return false; }
void save_webp(const PictureRows&, int, OutputFile& file, const Execution&) { refuse_webp(file.name()); }
Texture decode_webp(std::span<const std::byte>, const std::string& name, ImagePart) { refuse_webp(name); }

}  // namespace frontmost::detail
