// SPDX-License-Identifier: Apache-2.0
// Which files a view makes: names filled in, formats known, and everything that can be refused refused before any
// work is done.
#pragma once

#include <frontmost/files.h>

#include <optional>
#include <string>
#include <vector>

#include "cli/inputs.h"
#include "cli/settings.h"

namespace frontmost::cli {

/// A file to write. Several kinds share one only as channels of an OpenEXR file.
struct FileToWrite {
  std::string path;  ///< "-" is standard output
  ImageFormat format;
  std::vector<OutputKind> kinds;
  std::optional<int> layer = std::nullopt;  ///< of --layers
};

/// None where the suffix names no format of images.
[[nodiscard]] std::optional<ImageFormat> format_by_suffix(const std::string& path);
/// Whether it is a format for looking at, which has no place for depths, ids and directions: JPEG and WebP.
[[nodiscard]] bool holds_pictures_alone(ImageFormat format);

/// "picture", "depth", "ray_distance", "normals", "primitive_ids", ...: as reports and hashes name them.
[[nodiscard]] std::string_view kind_name(OutputKind kind);

/// What {model} stands for: the file's name without folder and suffix.
[[nodiscard]] std::string model_name(const std::string& model);
/// Replaces {model} and {view}, and {layer} where there is one; {{ and }} are braces.
/// \throws UsageError on any other name in braces.
[[nodiscard]] std::string fill_template(std::string_view text, const std::string& model, const std::string& view,
                                        std::optional<int> layer = std::nullopt);

/// --format is for files whose names do not say one: where all names do, one of another format contradicts it.
/// `formats` are those that names may say, separated by '|', the given one by its place among them.
/// \throws UsageError
void check_given_format(const std::vector<std::string>& paths, int given, std::string_view formats);

/// The files of one view. Names with {layer} make one for every layer.
/// \throws UsageError for an unknown suffix, a format that cannot hold the kind, and a name taken twice
[[nodiscard]] std::vector<FileToWrite> plan_outputs(const OutputSettings& settings, const std::string& model,
                                                    const std::string& view);

/// \throws UsageError when a file is one of the inputs or is written twice; Error file_unwritable when its folder is
/// missing or not writable, or it is not a regular file.
void check_outputs(const std::vector<std::string>& paths, const InputFiles& inputs);

/// \throws UsageError when a reference is one of the outputs, even where neither is there yet.
void check_references(const std::vector<std::string>& references, const std::vector<std::string>& outputs);

/// Where the difference to a reference goes.
[[nodiscard]] std::string difference_path(const OutputSettings& settings, const std::vector<FileToWrite>& files);

}  // namespace frontmost::cli
