// SPDX-License-Identifier: Apache-2.0
// What a reader is handed beside a model's bytes: its name, the files beside it, and how to run.
#pragma once

#include <filesystem>
#include <optional>

#include "frontmost/base.h"
#include "io/input_file.h"

namespace frontmost {

/// A model being read.
class ModelSource {
 public:
  /// From memory or a stream: files named inside the model cannot be read.
  ModelSource(std::string name, const Execution& execution) : name_(std::move(name)), execution_(execution) {}
  /// From `file`, which is borrowed, at `path`.
  ModelSource(std::string name, const Execution& execution, const InputFile& file, std::filesystem::path path);

  /// Stands for the file in messages.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// The name without folder and suffix.
  [[nodiscard]] std::string stem() const;
  [[nodiscard]] const Execution& execution() const { return execution_; }

  /// Whether files named inside the model can be read at all.
  [[nodiscard]] bool has_folder() const { return !path_.empty(); }
  /// Opens a file that the model names relative to its own folder; both kinds of slashes are taken.
  /// \throws Error file_unreadable: missing, not an ordinary file, or outside the model's folder (by its name or
  /// through links); limit_exceeded. what() starts with the name of the model and `reference`.
  [[nodiscard]] InputFile open(const std::string& reference, std::uint64_t max_bytes) const;

  /// Says that `part` of the model's bytes was read for the last time. Keeps the memory in use low.
  void release(std::span<const std::byte> part) const {
    if (file_ != nullptr) file_->release(part);
  }

  /// The words of an error without the model's name at their start, for Scene::warnings.
  [[nodiscard]] std::string without_name(const Error& error) const;

  /// Throws Error file_malformed "name: place: reason".
  [[noreturn]] void fail(const std::string& place, const std::string& reason) const;
  [[noreturn]] void fail_limit(const std::string& place, const std::string& reason) const;

 private:
  [[nodiscard]] std::filesystem::path confined(const std::string& reference) const;

  std::string name_;
  Execution execution_;
  const InputFile* file_ = nullptr;
  std::filesystem::path path_;
};

}  // namespace frontmost
