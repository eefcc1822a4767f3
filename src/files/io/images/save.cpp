// SPDX-License-Identifier: Apache-2.0
// Chooses the format of an image file and writes it whole.

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/parallel.h"
#include "image/srgb_pixels.h"
#include "io/images/formats.h"
#include "io/input_file.h"

namespace frontmost {
namespace {

ImageFormat format_of(const std::string& path, const SaveOptions& options) {
  if (options.format) return *options.format;
  if (path == "-") throw Error(ErrorCode::bad_argument, "standard output", "", "give the image format");
  const std::string suffix = lower_suffix(path);
  if (suffix == ".png") return ImageFormat::png;
  if (suffix == ".exr") return ImageFormat::exr;
  if (suffix == ".pfm") return ImageFormat::pfm;
  if (suffix == ".npy") return ImageFormat::npy;
  if (suffix == ".jpg" || suffix == ".jpeg") return ImageFormat::jpeg;
  if (suffix == ".webp") return ImageFormat::webp;
  throw Error(ErrorCode::unsupported, path, "",
              "an image file ends in .png, .exr, .pfm, .npy, .jpg or .webp, not in \"" + suffix + "\"");
}

/// Returns options.quality. \throws Error bad_argument unless it is 1 to 100. Precondition: the format has a quality.
int checked_quality(const SaveOptions& options, const std::string& name) {
  if (options.quality < 1 || options.quality > 100)
    throw Error(ErrorCode::bad_argument, name, "", "the quality is 1 to 100, not " + std::to_string(options.quality));
  return options.quality;
}

detail::PictureRows lossy_rows(const Image& image, const char* format, const std::string& name) {
  if (std::optional<detail::PictureRows> rows = detail::picture_rows(image)) return std::move(*rows);
  throw Error(ErrorCode::unsupported, name, "",
              std::string(format) + " holds pictures, of R, G, B and A, not " + channel_list(image) +
                  "; write EXR, NPY or PNG");
}

template <class Write>
void write_file(const std::string& path, const Execution& execution, const Write& write) {
  report_progress(execution, "save", 0);
  // The file is opened before the pixels are compressed, so that a folder without write access is reported at once.
  OutputFile file(path);
  write(file);
  // Cancellation is checked once more before the file gets its name, because a cancelled call must leave no new file.
  check_cancelled(execution);
  file.commit();
  report_progress(execution, "save", 1);
}

}  // namespace

namespace detail {

std::optional<PictureRows> picture_rows(const Image& image) {
  const std::optional<ColorPlanes> planes = color_planes(image);
  if (!planes || image.channels.size() != (planes->alpha ? 4u : 3u)) return std::nullopt;
  const bool with_alpha = !planes->is_opaque();
  return PictureRows{image.width, image.height, with_alpha, [planes = *planes, with_alpha](int y, std::uint8_t* row) {
                       srgb8_row(planes, y, with_alpha, row);
                     }};
}

void check_sides(const PictureRows& picture, int most, const char* format, const OutputFile& file) {
  const int side = std::max(picture.width, picture.height);
  if (side > most)
    throw Error(ErrorCode::limit_exceeded, file.name(), "",
                std::string(format) + " holds at most " + std::to_string(most) + " pixels on a side, not " +
                    std::to_string(side));
}

PictureRows picture_rows(const Bitmap& bitmap) {
  constexpr std::size_t bytes = 4;  // bytes per pixel
  const std::size_t size = bitmap.rgba.size();
  std::uint8_t least = 255;
  // The loop has no branches and no early exit, which is faster than stopping at the first transparent pixel.
  for (std::size_t i = bytes - 1; i < size; i += bytes) least = std::min(least, bitmap.rgba[i]);
  const bool with_alpha = least < 255;
  return {bitmap.width, bitmap.height, with_alpha, [&bitmap, with_alpha](int y, std::uint8_t* row) {
            const std::size_t width = std::size_t(bitmap.width);
            const std::uint8_t* in = bitmap.rgba.data() + bytes * width * std::size_t(y);
            if (with_alpha) {
              std::copy_n(in, bytes * width, row);
            } else {
              // Four bytes are one store; the next pixel overwrites the last of them.
              for (std::size_t x = 0; x + 1 < width; ++x) std::memcpy(row + 3 * x, in + bytes * x, bytes);
              std::copy_n(in + bytes * (width - 1), 3, row + 3 * (width - 1));
            }
          }};
}

}  // namespace detail

void save(const Image& image, const std::string& path, const SaveOptions& options, const Execution& execution) {
  const ImageFormat format = format_of(path, options);
  validate(image);
  write_file(path, execution, [&](OutputFile& file) {
    switch (format) {
      case ImageFormat::png: return detail::save_png(image, options, file, execution);
      case ImageFormat::exr: return detail::save_exr(image, file, execution);
      case ImageFormat::pfm: return detail::save_pfm(image, file);
      case ImageFormat::npy: return detail::save_npy(image, file);
      case ImageFormat::jpeg:
        return detail::save_jpeg(lossy_rows(image, "JPEG", file.name()), checked_quality(options, file.name()), file,
                                 execution);
      case ImageFormat::webp:
        return detail::save_webp(lossy_rows(image, "WebP", file.name()), checked_quality(options, file.name()), file,
                                 execution);
    }
  });
}

void save(const Bitmap& bitmap, const std::string& path, const SaveOptions& options, const Execution& execution) {
  const ImageFormat format = format_of(path, options);
  if (format != ImageFormat::png && format != ImageFormat::jpeg && format != ImageFormat::webp)
    throw Error(ErrorCode::unsupported, path, "", "only PNG, JPEG and WebP hold the 8 bits of a bitmap");
  validate(bitmap);
  write_file(path, execution, [&](OutputFile& file) {
    if (format == ImageFormat::png) return detail::save_png(bitmap, file, execution);
    const int quality = checked_quality(options, file.name());
    const auto save_lossy = format == ImageFormat::jpeg ? detail::save_jpeg : detail::save_webp;
    save_lossy(detail::picture_rows(bitmap), quality, file, execution);
  });
}

void save(const DeepImage& image, const std::string& path, const Execution& execution) {
  validate(image);
  write_file(path, execution, [&](OutputFile& file) { detail::save_deep_exr(image, file, execution); });
}

}  // namespace frontmost
