// SPDX-License-Identifier: Apache-2.0
// Which format a file is to have, and writing it whole.

#include <algorithm>
#include <cctype>

#include "base/parallel.h"
#include "io/images/formats.h"

namespace frontmost {
namespace {

ImageFormat format_of(const std::string& path, const SaveOptions& options) {
  if (options.format) return *options.format;
  if (path == "-") throw Error(ErrorCode::bad_argument, "standard output: the image format must be given");
  std::string suffix = std::filesystem::path(path).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix == ".png") return ImageFormat::png;
  if (suffix == ".exr") return ImageFormat::exr;
  if (suffix == ".pfm") return ImageFormat::pfm;
  if (suffix == ".npy") return ImageFormat::npy;
  throw Error(ErrorCode::unsupported,
              path + ": an image file ends in .png, .exr, .pfm or .npy, not in \"" + suffix + "\"");
}

template <class Write>
void write_file(const std::string& path, const Execution& execution, const Write& write) {
  report_progress(execution, "save", 0);
  // Before the pixels are compressed: a folder that cannot be written to is told of at once.
  OutputFile file(path);
  write(file);
  // Once more before the file gets its name: whoever ended the work does not expect a new one.
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
    }
  });
}

void save(const Bitmap& bitmap, const std::string& path, const SaveOptions& options, const Execution& execution) {
  if (format_of(path, options) != ImageFormat::png)
    throw Error(ErrorCode::unsupported, path + ": only PNG holds the 8 bits of a bitmap");
  validate(bitmap);
  write_file(path, execution, [&](OutputFile& file) { detail::save_png(bitmap, file, execution); });
}

void save(const DeepImage& image, const std::string& path, const Execution& execution) {
  validate(image);
  write_file(path, execution, [&](OutputFile& file) { detail::save_deep_exr(image, file, execution); });
}

}  // namespace frontmost
