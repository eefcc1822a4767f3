// SPDX-License-Identifier: Apache-2.0
// Context of a reader beside a model's bytes: name, neighbouring files, execution. Also conversions of texts of the
// file to names in a scene and to parts of messages.
//
// A model is untrusted: it may name any file, and hold any bytes as a name. So files beside it are opened here only,
// within the model's folder. Texts pass through name_of(), printable() and in_quotes(), which shorten them and remove
// control characters that a terminal would obey.
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

/// Files that were opened, sorted by path. Several threads may add to it.
class OpenedFiles {
 public:
  /// Starts with the model's own file.
  explicit OpenedFiles(const std::filesystem::path& model) {
    std::error_code error;
    std::filesystem::path path = std::filesystem::canonical(model, error);
    if (!error) paths_.insert(std::move(path));
  }
  void add(std::filesystem::path path) {
    const std::lock_guard lock(mutex_);
    paths_.insert(std::move(path));
  }
  /// The paths in the form of SceneSource::files.
  [[nodiscard]] std::vector<std::filesystem::path> paths() const { return {paths_.begin(), paths_.end()}; }

 private:
  std::mutex mutex_;
  std::set<std::filesystem::path> paths_;
};

/// A model being read.
class ModelSource {
 public:
  /// A model from memory or a stream: files named inside the model cannot be read.
  ModelSource(std::string name, const Execution& execution) : name_(std::move(name)), execution_(execution) {}
  /// A model from `file`, which is borrowed, at `path`. Files opened beside it are added to `opened`, unless that is
  /// null.
  ModelSource(std::string name, const Execution& execution, const InputFile& file, std::filesystem::path path,
              std::shared_ptr<OpenedFiles> opened = nullptr);

  /// The name of the file in messages.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// The name without folder and suffix.
  [[nodiscard]] std::string stem() const;
  [[nodiscard]] const Execution& execution() const { return execution_; }
  /// LoadOptions's decoder of images; may be null.
  [[nodiscard]] const ImageDecoder* image_decoder() const { return image_decoder_; }
  void decode_images_by(const ImageDecoder* decoder) { image_decoder_ = decoder; }
  /// Allows files named inside a scene file to lie in these folders, too. \throws Error file_unreadable if one is no
  /// folder.
  void allow_outside(const std::vector<std::string>& folders);

  /// Whether files named inside the model can be read at all.
  [[nodiscard]] bool has_folder() const { return !path_.empty(); }
  /// Opens a file that the model names relative to its own folder, with either kind of slashes. \throws Error
  /// file_unreadable if it is missing, no ordinary file, or outside the model's folder (by name or through links) and
  /// the allowed folders; limit_exceeded. what() starts with the model's name and `reference`.
  [[nodiscard]] InputFile open(const std::string& reference, std::uint64_t max_bytes) const;
  /// The real path of that file, without links. \throws Error as open() does.
  [[nodiscard]] std::filesystem::path path_of(const std::string& reference) const;

  /// Tells that `part` of the model's bytes was read for the last time, which keeps memory in use low.
  void release(std::span<const std::byte> part) const {
    if (file_ != nullptr) file_->release(part);
  }

  /// The error's text without the model's name at its start, for a reader's warnings.
  [[nodiscard]] std::string without_name(const Error& error) const;

  /// A reader's warning "place: reason" with the model's name before it, as in Scene::warnings.
  [[nodiscard]] std::string with_name(const std::string& warning) const { return name_ + ": " + warning; }

  /// Throws Error file_malformed "name: place: reason".
  [[noreturn]] void fail(const std::string& place, const std::string& reason) const;
  [[noreturn]] void fail_limit(const std::string& place, const std::string& reason) const;

 private:
  std::string name_;
  Execution execution_;
  const ImageDecoder* image_decoder_ = nullptr;
  std::optional<std::vector<std::filesystem::path>> allowed_;  ///< of scene files: allowed folders, without links
  const InputFile* file_ = nullptr;
  std::filesystem::path path_;
  std::shared_ptr<OpenedFiles> opened_;
};

/// Greatest length of a name in bytes. One name may occur in many objects (instances of a mesh, groups of an object)
/// and warnings, so a name of a megabyte could take gigabytes.
inline constexpr std::size_t longest_name = 1024;

/// `text` as a name: cut to `longest_name` bytes, between UTF-8 characters.
[[nodiscard]] std::string name_of(std::string_view text);

/// A text of the file for messages: short, and escaped as printable_text() does.
[[nodiscard]] std::string printable(std::string_view text);

/// A word of a file for messages: in quotes, and not longer than a line.
[[nodiscard]] std::string in_quotes(std::string_view word);

}  // namespace frontmost
