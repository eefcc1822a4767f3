// SPDX-License-Identifier: Apache-2.0
// Plans the files of a view: fills in names, finds formats, and refuses whatever can be refused before work begins.
#pragma once

#include <frontmost/files.h>

#include <optional>
#include <string>
#include <vector>

#include "cli/inputs.h"
#include "cli/settings.h"

namespace frontmost::cli {

/// A file to write. Several kinds can share a file only as channels of OpenEXR.
struct FileToWrite {
  std::string path;  ///< "-" is standard output
  ImageFormat format;
  std::vector<OutputKind> kinds;
  std::optional<int> layer = std::nullopt;  ///< the layer of the file, with --layers
};

/// Returns the format that a suffix stands for, or nothing if it names no image format.
[[nodiscard]] std::optional<ImageFormat> format_by_suffix(const std::string& path);
/// Whether the format, JPEG or WebP, holds only pictures, and no depths, ids or directions.
[[nodiscard]] bool holds_pictures_alone(ImageFormat format);

/// Returns the name of a kind for reports and hashes: "picture", "depth", "ray_distance", "normals", "primitive_ids",
/// ...
[[nodiscard]] std::string_view kind_name(OutputKind kind);

/// Returns the text for {model}: the file's name without folder and suffix.
[[nodiscard]] std::string model_name(const std::string& model);
/// Replaces {model} and {view}, and {layer} if given. {{ and }} become single braces.
/// \throws UsageError on any other name in braces.
[[nodiscard]] std::string fill_template(std::string_view text, const std::string& model, const std::string& view,
                                        std::optional<int> layer = std::nullopt);

/// Checks --format, which is for names that state no format. It must not contradict the names if all of them state one.
/// `formats` lists the formats, separated by '|'; `given` is an index into it. \throws UsageError
void check_given_format(const std::vector<std::string>& paths, int given, std::string_view formats);

/// Returns the files of one view. A name with {layer} gives a file for each layer.
/// \throws UsageError for an unknown suffix, a format that cannot hold the kind, and a name taken twice
[[nodiscard]] std::vector<FileToWrite> plan_outputs(const OutputSettings& settings, const std::string& model,
                                                    const std::string& view);

/// Checks the files to write. \throws UsageError if a file is one of the inputs or is written twice; Error
/// file_unwritable if its folder is missing or not writable, or if it is no regular file.
void check_outputs(const std::vector<std::string>& paths, const InputFiles& inputs);

/// Checks the references. \throws UsageError if a reference is one of the outputs, even if neither exists yet.
void check_references(const std::vector<std::string>& references, const std::vector<std::string>& outputs);

/// Returns the path of the difference picture.
[[nodiscard]] std::string difference_path(const OutputSettings& settings, const std::vector<FileToWrite>& files);

}  // namespace frontmost::cli
