// SPDX-License-Identifier: Apache-2.0
// Stands for jpeg.cpp and decode_jpeg.cpp in builds without libjpeg.
#include "io/images/decode.h"
#include "io/images/lossy/lossy.h"

namespace frontmost::detail {
namespace {

[[noreturn]] void refuse_jpeg(const std::string& name) {
  throw Error(ErrorCode::unsupported, name, "", "this Frontmost was built without libjpeg (FRONTMOST_JPEG)");
}

}  // namespace

void save_jpeg(const PictureRows&, int, OutputFile& file, const Execution&) { refuse_jpeg(file.name()); }
Texture decode_jpeg(std::span<const std::byte>, const std::string& name, ImagePart) { refuse_jpeg(name); }

}  // namespace frontmost::detail
