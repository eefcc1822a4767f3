// SPDX-License-Identifier: Apache-2.0
// Composes and saves the files of a view, one after the other. Then compares the picture with a reference, or shows it
// on the terminal.
//
// Maps are made one at a time, when a file needs them, because each takes as much memory as the visible surfaces. A
// picture that goes only into a PNG file is never converted to floats.
#include "cli/render/output_writer.h"

#include <frontmost/files.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "cli/console.h"
#include "cli/failure.h"
#include "cli/stopwatch.h"

namespace frontmost::cli {
namespace {

bool is_picture_alone(const FileToWrite& file) {
  return file.kinds.size() == 1 && file.kinds.front() == OutputKind::picture;
}

/// Returns the picture without alpha, because PFM holds three channels.
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
  options.quality = settings.quality;
  options.depth_scale = settings.depth_scale;
  return options;
}

void note(const Image& part, OutputKind kind, const FileToWrite& file, const OutputSource& source, ViewResult& result) {
  Result& one = result.results.emplace_back(Result{std::string(kind_name(kind)), file.path, {}});
  if (source.job.output.hash) one.hash = content_hash(part);
}

/// Returns the channels of all kinds that the file holds.
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
  // A picture on its own is saved without a copy, which would take as long as finding visibility.
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

/// Compares two pictures. Errors about different sizes or channels name the reference.
Comparison compared(const Image& picture, const Image& reference, const Job& job, const Execution& execution) {
  try {
    return compare(picture, reference, job.output.reference_threshold, execution);
  } catch (const Error& error) {
    throw error.within(*job.output.reference);
  }
}

// Rows kept free below the picture for the next prompt.
constexpr int rows_kept = 2;

glm::ivec2 room(const glm::ivec2& terminal) { return {std::max(terminal.x, 1), std::max(terminal.y - rows_kept, 1)}; }

/// Whether the terminal announces true colour in COLORTERM. Other terminals get the 256-colour palette, which all
/// support.
bool has_true_color() {
  const char* const value = std::getenv("COLORTERM");
  return value && (std::string_view(value) == "truecolor" || std::string_view(value) == "24bit");
}

}  // namespace

bool writes_colors(const Job& job) {
  const auto is_colored = [](const FileToWrite& file) {
    return std::any_of(file.kinds.begin(), file.kinds.end(),
                       [](OutputKind kind) { return kind == OutputKind::picture || kind == OutputKind::deep; });
  };
  return !job.figures.empty() || std::any_of(job.files.begin(), job.files.end(), is_colored) ||
         std::any_of(job.layer_files.begin(), job.layer_files.end(), is_colored);
}

bool wants(const Job& job, OutputKind kind) {
  for (const FileToWrite& file : job.files) {
    if (std::find(file.kinds.begin(), file.kinds.end(), kind) != file.kinds.end()) return true;
  }
  return false;
}

bool needs_only_bitmap(const Job& job) {
  if (job.output.reference || job.output.hash || job.output.bits != 8 || job.output.edges) return false;
  return std::all_of(job.files.begin(), job.files.end(), [](const FileToWrite& file) {
    if (is_picture_alone(file)) return file.format == ImageFormat::png || holds_pictures_alone(file.format);
    return std::find(file.kinds.begin(), file.kinds.end(), OutputKind::picture) == file.kinds.end();
  });
}

void write_files(const OutputSource& source, ViewResult& result) {
  for (const FileToWrite& file : source.job.files) {
    stop_if_interrupted();
    write(file, source, result);
  }
}

void read_references(std::vector<Job>& jobs) {
  constexpr std::size_t most_pixels = std::size_t(1) << 26;
  std::size_t pixels = 0;
  for (Job& job : jobs) {
    if (!job.output.reference) continue;
    stop_if_interrupted();
    auto reference = std::make_shared<const Image>(load_image(*job.output.reference));
    pixels += std::size_t(reference->width) * std::size_t(reference->height);
    if (pixels <= most_pixels) job.reference = std::move(reference);
  }
}

ReferenceResult compare_with_reference(const Image& picture, const Job& job, const Execution& execution) {
  const auto kept = job.reference ? job.reference : std::make_shared<const Image>(load_image(*job.output.reference));
  const Image& reference = *kept;
  const Comparison comparison = compared(picture, reference, job, execution);
  ReferenceResult result{*job.output.reference, {}, comparison.error, comparison.mean, comparison.differing, true};
  if (comparison.differing == 0) return result;
  result.passed = false;
  result.difference_path = job.difference;
  const Image difference = difference_image(picture, reference, job.output.reference_threshold, execution);
  const WritingFiles writing;
  save(difference, job.difference, {}, execution);
  return result;
}

void prepare_for_terminal(Job& job, const glm::ivec2& terminal) {
  // A character shows two pixels; supersampling smooths them.
  if (!job.view.resolution && !job.view.intrinsics) job.view.resolution = room(terminal) * glm::ivec2(1, 2);
  if (!job.output.background_given) job.output.background = std::nullopt;
}

void show_on_terminal(const Image& picture) {
  const glm::ivec2 size = room(output_terminal().value_or(glm::ivec2(80, 24)));
  print(terminal_picture(picture, size.x, size.y, has_true_color()));
}

}  // namespace frontmost::cli
