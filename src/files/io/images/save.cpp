// SPDX-License-Identifier: Apache-2.0
// Chooses the format of an image file and writes it whole.

#include <algorithm>
#include <cctype>
#include <utility>

#include "base/parallel.h"
#include "io/images/formats.h"
#include "io/images/lossy/lossy.h"

namespace frontmost {
namespace {

ImageFormat format_of(const std::string& path, const SaveOptions& options) {
  if (options.format) return *options.format;
  if (path == "-") throw Error(ErrorCode::bad_argument, "standard output", "", "the image format must be given");
  std::string suffix = std::filesystem::path(path).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
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
              std::string(format) + " holds pictures, of R, G, B and A, not " + detail::channel_list(image) +
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

std::string channel_list(const Image& image) {
  std::string list;
  for (const Channel& channel : image.channels) list += (list.empty() ? "" : ", ") + channel.name;
  return list;
}

std::vector<std::string> default_channel_names(std::size_t count, bool integers) {
  if (count == 1) return {integers ? "primitive" : "Z"};
  if (count == 3 && !integers) return {"R", "G", "B"};
  if (count == 4 && !integers) return {"R", "G", "B", "A"};
  std::vector<std::string> names(count);
  for (std::size_t i = 0; i < count; ++i) names[i] = std::to_string(i);
  return names;
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
