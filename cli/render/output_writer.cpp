// SPDX-License-Identifier: Apache-2.0
#include "cli/render/output_writer.h"

#include <algorithm>

#include "cli/interruption.h"
#include "cli/stopwatch.h"

namespace frontmost::cli {
namespace {

bool is_picture_alone(const FileToWrite& file) {
  return file.kinds.size() == 1 && file.kinds.front() == OutputKind::picture;
}

/// PFM holds three channels; there the picture is without its alpha.
Image without_alpha(const Image& picture) {
  Image copy = picture;
  if (copy.channels.size() == 4) copy.channels.pop_back();
  return copy;
}

void append(Image& image, Image part) {
  image.width = part.width;
  image.height = part.height;
  for (Channel& channel : part.channels) image.channels.push_back(std::move(channel));
}

SaveOptions save_options(const FileToWrite& file, const OutputSettings& settings) {
  SaveOptions options;
  options.format = file.format;
  options.bits = settings.bits;
  options.depth_scale = settings.depth_scale;
  return options;
}

void note(const Image& part, OutputKind kind, const FileToWrite& file, const OutputSource& source, ViewResult& result) {
  Result& one = result.results.emplace_back(Result{std::string(kind_name(kind)), file.path, {}});
  if (source.job.output.hash) one.hash = content_hash(part);
}

/// The channels of every kind that the file holds.
Image compose(const FileToWrite& file, const OutputSource& source, ViewResult& result) {
  Image image;
  for (const OutputKind kind : file.kinds) {
    Image part;
    if (kind != OutputKind::picture) {
      part = source.map(kind);
    } else {
      part = file.format == ImageFormat::pfm ? without_alpha(*source.picture) : *source.picture;
    }
    note(part, kind, file, source, result);
    append(image, std::move(part));
  }
  return image;
}

template <class Picture>
void save_image(const Picture& image, const FileToWrite& file, const OutputSource& source, ViewResult& result) {
  const Stopwatch watch;
  const WritingFiles writing;
  save(image, file.path, save_options(file, source.job.output), source.execution);
  result.timings.save += watch.milliseconds();
}

void write_deep(const FileToWrite& file, const OutputSource& source, ViewResult& result) {
  const DeepImage image = source.deep();
  Result& one = result.results.emplace_back(Result{std::string(kind_name(OutputKind::deep)), file.path, {}});
  if (source.job.output.hash) one.hash = content_hash(image);
  const Stopwatch watch;
  const WritingFiles writing;
  save(image, file.path, source.execution);
  result.timings.save += watch.milliseconds();
}

void write(const FileToWrite& file, const OutputSource& source, ViewResult& result) {
  if (file.kinds.front() == OutputKind::deep) return write_deep(file, source, result);
  // A picture on its own is saved as it is: copying one takes as long as finding what is visible.
  const bool as_it_is = is_picture_alone(file) && file.format != ImageFormat::pfm;
  if (as_it_is && source.bitmap) {
    result.results.push_back({std::string(kind_name(OutputKind::picture)), file.path, {}});
    save_image(*source.bitmap, file, source, result);
  } else if (as_it_is) {
    note(*source.picture, OutputKind::picture, file, source, result);
    save_image(*source.picture, file, source, result);
  } else {
    save_image(compose(file, source, result), file, source, result);
  }
}

}  // namespace

bool wants(const Job& job, OutputKind kind) {
  for (const FileToWrite& file : job.files) {
    if (std::find(file.kinds.begin(), file.kinds.end(), kind) != file.kinds.end()) return true;
  }
  return false;
}

bool needs_only_bitmap(const Job& job) {
  if (job.output.reference || job.output.hash || job.output.bits != 8) return false;
  return std::all_of(job.files.begin(), job.files.end(), [](const FileToWrite& file) {
    if (is_picture_alone(file)) return file.format == ImageFormat::png;
    return std::find(file.kinds.begin(), file.kinds.end(), OutputKind::picture) == file.kinds.end();
  });
}

void write_files(const OutputSource& source, ViewResult& result) {
  for (const FileToWrite& file : source.job.files) {
    stop_if_interrupted();
    write(file, source, result);
  }
}

}  // namespace frontmost::cli
