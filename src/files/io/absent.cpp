// SPDX-License-Identifier: Apache-2.0
// Replaces the code of formats whose library this build lacks. CMake defines FRONTMOST_NO_<FORMAT> for each such
// format.
#include "io/images/formats.h"
#include "io/models/reader.h"
#if defined(FRONTMOST_NO_DRACO) || defined(FRONTMOST_NO_MESHOPT)
#include "io/models/gltf/data.h"
#endif

namespace frontmost {
namespace {

[[noreturn, maybe_unused]] void refuse_format(const std::string& name, const char* lack, const char* place = "") {
  throw Error(ErrorCode::unsupported, name, place, std::string("this Frontmost was built without ") + lack);
}

}  // namespace

namespace detail {

#if defined(FRONTMOST_NO_PNG)
constexpr const char* no_png = "libpng (FRONTMOST_PNG)";
void save_png(const Image&, const SaveOptions&, OutputFile& file, const Execution&) {
  refuse_format(file.name(), no_png);
}
void save_png(const Bitmap&, OutputFile& file, const Execution&) { refuse_format(file.name(), no_png); }
Image load_png(std::span<const std::byte>, const std::string& name) { refuse_format(name, no_png); }
Texture decode_png(std::span<const std::byte>, const std::string& name, ImagePart) { refuse_format(name, no_png); }
std::string png_bytes(const Texture& texture) { refuse_format("texture " + texture.name, no_png); }
#endif

#if defined(FRONTMOST_NO_JPEG)
constexpr const char* no_jpeg = "libjpeg (FRONTMOST_JPEG)";
void save_jpeg(const PictureRows&, int, OutputFile& file, const Execution&) { refuse_format(file.name(), no_jpeg); }
Texture decode_jpeg(std::span<const std::byte>, const std::string& name, ImagePart) { refuse_format(name, no_jpeg); }
#endif

#if defined(FRONTMOST_NO_WEBP)
constexpr const char* no_webp = "libwebp (Debian package libwebp-dev, FRONTMOST_WEBP)";
bool has_webp() { return false; }
void save_webp(const PictureRows&, int, OutputFile& file, const Execution&) {
  refuse_format(file.name(), no_webp, "WebP");
}
Texture decode_webp(std::span<const std::byte>, const std::string& name, ImagePart) {
  refuse_format(name, no_webp, "WebP");
}
#endif

#if defined(FRONTMOST_NO_OPENEXR)
constexpr const char* no_exr = "OpenEXR (FRONTMOST_OPENEXR)";
void save_exr(const Image&, OutputFile& file, const Execution&) { refuse_format(file.name(), no_exr); }
void save_deep_exr(const DeepImage&, OutputFile& file, const Execution&) { refuse_format(file.name(), no_exr); }
Image load_exr(std::span<const std::byte>, const std::string& name) { refuse_format(name, no_exr); }
#endif

}  // namespace detail

#if defined(FRONTMOST_NO_3MF)
Scene read_3mf(Bytes, const ModelSource& source) { refuse_format(source.name(), "3MF (FRONTMOST_3MF)"); }
#endif

#if defined(FRONTMOST_NO_IMPORT)
Scene read_imported(ModelFormat, Bytes bytes, const ModelSource& source) { refuse_import(bytes, source); }
#endif

#if defined(FRONTMOST_NO_SCENE_FILES)
Scene read_scene_file(Bytes, const ModelSource& source) {
  refuse_format(source.name(), "scene files (FRONTMOST_SCENE_FILES)");
}
#endif

}  // namespace frontmost

namespace frontmost::gltf {

#if defined(FRONTMOST_NO_DRACO)
bool has_draco() { return false; }
std::optional<DecodedPrimitive> DracoPrimitives::decode(const JsonValue&) { return std::nullopt; }
#endif

#if defined(FRONTMOST_NO_MESHOPT)
bool has_meshopt() { return false; }
std::vector<std::byte> decode_meshopt(const JsonValue&, Bytes, std::uint64_t) { return {}; }
#endif

}  // namespace frontmost::gltf
