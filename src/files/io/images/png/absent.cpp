// SPDX-License-Identifier: Apache-2.0
// Stands for this folder in builds without libpng and zlib.
#include "io/images/decode.h"
#include "io/images/formats.h"
#include "io/images/png/texture_bytes.h"

namespace frontmost::detail {
namespace {

[[noreturn]] void refuse_png(const std::string& name) {
  throw Error(ErrorCode::unsupported, name, "", "this Frontmost was built without libpng (FRONTMOST_PNG)");
}

}  // namespace

void save_png(const Image&, const SaveOptions&, OutputFile& file, const Execution&) { refuse_png(file.name()); }
void save_png(const Bitmap&, OutputFile& file, const Execution&) { refuse_png(file.name()); }
Image load_png(std::span<const std::byte>, const std::string& name) { refuse_png(name); }
Texture decode_png(std::span<const std::byte>, const std::string& name, ImagePart) { refuse_png(name); }
std::string png_bytes(const Texture& texture) { refuse_png("texture " + texture.name); }

}  // namespace frontmost::detail
