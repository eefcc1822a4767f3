// SPDX-License-Identifier: Apache-2.0
// What a reader is handed beside a model's bytes (its name, the files beside it, and how to run), and texts of the file
// on their way out of it, as names in a scene and as parts of messages.
//
// A model is somebody else's: it may name any file, and hold any bytes as a name. So files beside it are opened here
// alone, which keeps them within the model's folder, and texts leave through name_of(), printable() and in_quotes(),
// which keep them short and free of control characters where a terminal would obey them.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "frontmost/files.h"
#include "io/input_file.h"

namespace frontmost {

using Bytes = std::span<const std::byte>;

/// Files that were opened, in the order of their names. Safe to add to from several threads.
class OpenedFiles {
 public:
  /// With the model's own.
  explicit OpenedFiles(const std::filesystem::path& model) {
    std::error_code error;
    std::filesystem::path path = std::filesystem::canonical(model, error);
    if (!error) paths_.insert(std::move(path));
  }
  void add(std::filesystem::path path) {
    const std::lock_guard lock(mutex_);
    paths_.insert(std::move(path));
  }
  /// As SceneSource::files has them.
  [[nodiscard]] std::vector<std::filesystem::path> paths() const { return {paths_.begin(), paths_.end()}; }

 private:
  std::mutex mutex_;
  std::set<std::filesystem::path> paths_;
};

/// A model being read.
class ModelSource {
 public:
  /// From memory or a stream: files named inside the model cannot be read.
  ModelSource(std::string name, const Execution& execution) : name_(std::move(name)), execution_(execution) {}
  /// From `file`, which is borrowed, at `path`. What is opened beside it is added to `opened`, where that is given.
  ModelSource(std::string name, const Execution& execution, const InputFile& file, std::filesystem::path path,
              std::shared_ptr<OpenedFiles> opened = nullptr);

  /// Stands for the file in messages.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// The name without folder and suffix.
  [[nodiscard]] std::string stem() const;
  [[nodiscard]] const Execution& execution() const { return execution_; }
  /// As LoadOptions has it.
  [[nodiscard]] const ImageDecoder* image_decoder() const { return image_decoder_; }
  void decode_images_by(const ImageDecoder* decoder) { image_decoder_ = decoder; }
  /// Lets files named inside a scene file lie in these folders, too. \throws Error file_unreadable where one is none.
  void allow_outside(const std::vector<std::string>& folders);

  /// Whether files named inside the model can be read at all.
  [[nodiscard]] bool has_folder() const { return !path_.empty(); }
  /// Opens a file that the model names relative to its own folder; both kinds of slashes are taken.
  /// \throws Error file_unreadable: missing, not an ordinary file, or outside the model's folder (by its name or
  /// through links) and those that are allowed; limit_exceeded. what() starts with the name of the model and
  /// `reference`.
  [[nodiscard]] InputFile open(const std::string& reference, std::uint64_t max_bytes) const;
  /// Where that file lies, without links. \throws Error as open() does.
  [[nodiscard]] std::filesystem::path path_of(const std::string& reference) const;

  /// Says that `part` of the model's bytes was read for the last time. Keeps the memory in use low.
  void release(std::span<const std::byte> part) const {
    if (file_ != nullptr) file_->release(part);
  }

  /// The words of an error without the model's name at their start, for a reader's warnings.
  [[nodiscard]] std::string without_name(const Error& error) const;

  /// What Scene::warnings holds of a reader's "place: reason": the same with the name before it.
  [[nodiscard]] std::string with_name(const std::string& warning) const { return name_ + ": " + warning; }

  /// Throws Error file_malformed "name: place: reason".
  [[noreturn]] void fail(const std::string& place, const std::string& reason) const;
  [[noreturn]] void fail_limit(const std::string& place, const std::string& reason) const;

 private:
  std::string name_;
  Execution execution_;
  const ImageDecoder* image_decoder_ = nullptr;
  std::optional<std::vector<std::filesystem::path>> allowed_;  ///< of scene files: folders, without links
  const InputFile* file_ = nullptr;
  std::filesystem::path path_;
  std::shared_ptr<OpenedFiles> opened_;
};

/// Bytes that a name keeps. One name stands for many objects (instances of a mesh, groups of an object) and begins many
/// warnings, so that a file of a megabyte with one name as long would take gigabytes.
inline constexpr std::size_t longest_name = 1024;

/// `text` as a name: cut at `longest_name`, not within a UTF-8 character.
[[nodiscard]] std::string name_of(std::string_view text);

/// A text of the file as it may stand in a message: short, and as printable_text() writes it.
[[nodiscard]] std::string printable(std::string_view text);

/// A word of a file for a message: in quotes, and not longer than a line.
[[nodiscard]] std::string in_quotes(std::string_view word);

}  // namespace frontmost
