// SPDX-License-Identifier: Apache-2.0
// The image formats behind save() and load_image().
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "base/output_file.h"
#include "frontmost/files.h"

namespace frontmost::detail {

/// Writers get images whose planes have the right sizes. \throws Error unsupported, before anything is written, naming
/// the file and what the format cannot hold.
void save_png(const Image& image, const SaveOptions& options, OutputFile& file, const Execution& execution);
void save_png(const Bitmap& bitmap, OutputFile& file, const Execution& execution);
void save_exr(const Image& image, OutputFile& file, const Execution& execution);
void save_deep_exr(const DeepImage& image, OutputFile& file, const Execution& execution);
void save_pfm(const Image& image, OutputFile& file);
void save_npy(const Image& image, OutputFile& file);
/// Header of a NumPy array file. `type` is written as in Python; `shape` holds numbers with commas.
[[nodiscard]] std::string npy_header(const std::string& type, const std::string& shape);

/// Readers check each size against the file's size before they allocate memory. `name` begins every message.
[[nodiscard]] Image load_png(std::span<const std::byte> bytes, const std::string& name);
[[nodiscard]] Image load_exr(std::span<const std::byte> bytes, const std::string& name);
[[nodiscard]] Image load_pfm(std::span<const std::byte> bytes, const std::string& name);
[[nodiscard]] Image load_radiance(std::span<const std::byte> bytes, const std::string& name);
[[nodiscard]] Image load_npy(std::span<const std::byte> bytes, const std::string& name);

/// Channel names for formats that store none: see load_image().
[[nodiscard]] std::vector<std::string> default_channel_names(std::size_t count, bool integers);

/// The image's channel names as "R, G, B", for messages.
[[nodiscard]] std::string channel_list(const Image& image);

}  // namespace frontmost::detail
