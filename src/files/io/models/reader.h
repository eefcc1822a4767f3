// SPDX-License-Identifier: Apache-2.0
// The readers, one per format, and what they need beside a model's bytes: its name, the files next to it, the
// execution. Texts of a file are turned into names in a scene and parts of messages here.
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
  /// Returns the paths in the form of SceneSource::files.
  [[nodiscard]] std::vector<std::filesystem::path> paths() const { return {paths_.begin(), paths_.end()}; }

 private:
  std::mutex mutex_;
  std::set<std::filesystem::path> paths_;
};

/// A model being read.
class ModelSource {
 public:
  /// A model from memory or a stream: files named inside the model cannot be read. `decoder` may be null.
  ModelSource(std::string name, const Execution& execution, const ImageDecoder* decoder = nullptr)
      : name_(std::move(name)), execution_(execution), image_decoder_(decoder) {}
  /// A model from `file`, which is borrowed, at `path`. Files opened beside it are added to `opened`.
  ModelSource(std::string name, const Execution& execution, const InputFile& file, std::filesystem::path path,
              std::shared_ptr<OpenedFiles> opened, const ImageDecoder* decoder = nullptr);

  /// Returns the name of the file in messages.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Returns where the model lies; empty for memory and streams.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Returns the name without folder and suffix.
  [[nodiscard]] std::string stem() const;
  [[nodiscard]] const Execution& execution() const { return execution_; }
  /// Returns the decoder of images from LoadOptions, which may be null.
  [[nodiscard]] const ImageDecoder* image_decoder() const { return image_decoder_; }
  /// Returns LoadOptions::import.
  [[nodiscard]] const ImportOptions& import_options() const { return import_options_; }
  void set_import_options(const ImportOptions& options) { import_options_ = options; }
  /// Allows files named inside a scene file to lie in these, too. \throws Error file_unreadable if one is no folder.
  void allow_outside(const std::vector<std::string>& folders);

  /// Whether files named inside the model can be read at all.
  [[nodiscard]] bool has_folder() const { return !path_.empty(); }
  /// Opens a file that the model names relative to its own folder, with either kind of slashes. \throws Error
  /// file_unreadable if the file is missing, is no ordinary file, or lies (by name or through links) in neither the
  /// model's folder nor an allowed folder; limit_exceeded if the file is larger than `max_bytes`. what() starts with
  /// the model's name and `reference`.
  [[nodiscard]] InputFile open(const std::string& reference, std::uint64_t max_bytes) const;
  /// Returns the real path of such a file, without links. \throws Error as open() does.
  [[nodiscard]] std::filesystem::path path_of(const std::string& reference) const;

  /// Tells that `part` of the model's bytes was read for the last time, which keeps memory in use low.
  void release(std::span<const std::byte> part) const {
    if (file_ != nullptr) file_->release(part);
  }

  /// Returns the error's text without the model's name at its start, for a reader's warnings.
  [[nodiscard]] std::string without_name(const Error& error) const;

  /// Returns a reader's warning "place: reason" with the model's name before it, as in Scene::warnings.
  [[nodiscard]] std::string with_name(const std::string& warning) const { return name_ + ": " + warning; }

  /// Throws Error file_malformed "name: place: reason".
  [[noreturn]] void fail(const std::string& place, const std::string& reason) const;
  [[noreturn]] void fail_limit(const std::string& place, const std::string& reason) const;

 private:
  std::string name_;
  Execution execution_;
  const ImageDecoder* image_decoder_ = nullptr;
  ImportOptions import_options_;
  std::optional<std::vector<std::filesystem::path>>
      allowed_;  ///< folders from which a scene file may load, without links
  const InputFile* file_ = nullptr;
  std::filesystem::path path_;
  std::shared_ptr<OpenedFiles> opened_;
};

/// Limit of the memory and time that a small file may cause. Files can repeat, share and omit elements: one-byte
/// indices name a vertex again and again, a mesh of two triangles is placed a million times. Each reader that can
/// multiply elements charges a budget first, which is several times what an honest file of that size needs.
class Budget {
 public:
  explicit Budget(std::uint64_t file_bytes) : left_(base + factor * file_bytes) {}
  /// Takes `count` elements of `size` bytes from the budget. \throws Error limit_exceeded.
  void charge(std::uint64_t count, std::uint64_t size, const std::string& place, const ModelSource& source) {
    if (count > left_ / size)
      source.fail_limit(place, std::to_string(count) + " elements are far more than a file of this size can hold");
    left_ -= count * size;
  }
  /// Charges triangles that are placed again: code that transforms them to the world needs ten times this amount.
  void charge_placed(std::uint64_t triangles, const std::string& place, const ModelSource& source) {
    charge(triangles, 4, place, source);
  }

 private:
  // An honest byte becomes at most 16 bytes, because a one-byte index makes a triangle of a strip. Four times that
  // leaves room for posed copies of a mesh; the base lets tiny files repeat their contents.
  static constexpr std::uint64_t base = std::uint64_t(1) << 28, factor = 64;
  std::uint64_t left_;
};

/// Greatest length of a name in bytes. One name may occur in many objects (instances of a mesh, groups of an object)
/// and warnings, so a name of a megabyte could take gigabytes.
inline constexpr std::size_t longest_name = 1024;

/// Returns `text` as a name: cut to `longest_name` bytes, between UTF-8 characters.
[[nodiscard]] std::string name_of(std::string_view text);

/// Returns a text of the file for messages: short, and escaped as printable_text() does.
[[nodiscard]] std::string printable(std::string_view text);

/// Returns a word of a file for messages: in quotes, and not longer than a line.
[[nodiscard]] std::string in_quotes(std::string_view word);

// Each reader turns bytes into a scene that frontmost::validate() accepts, keeps order and number of the file's
// triangles (degenerate ones too), and keeps the file's units. load() validates, and adds the scene's name and up axis.
// Bad bytes cause an Error "name: place: reason". Tolerable faults go to Scene::warnings as "place: reason"; load()
// prepends the file's name.

[[nodiscard]] Scene read_stl(Bytes bytes, const ModelSource& source);
[[nodiscard]] Scene read_ply(Bytes bytes, const ModelSource& source);
[[nodiscard]] Scene read_obj(Bytes bytes, const ModelSource& source);
[[nodiscard]] Scene read_off(Bytes bytes, const ModelSource& source);
/// The next two readers also set SceneSource::metres_per_unit.
[[nodiscard]] Scene read_gltf(Bytes bytes, const ModelSource& source);
[[nodiscard]] Scene read_3mf(Bytes bytes, const ModelSource& source);
/// Reads a scene file (io/scenes), which names models. Sets SceneSource::metres_per_unit and the up axis.
[[nodiscard]] Scene read_scene_file(Bytes bytes, const ModelSource& source);

/// Reads a model by the program frontmost-import. Sets SceneSource::metres_per_unit and the up axis.
/// \throws Error unsupported, with advice, where the program is not there; limit_exceeded for too much time or memory.
[[nodiscard]] Scene read_imported(ModelFormat format, Bytes bytes, const ModelSource& source);
/// \throws Error unsupported, with advice for a model that frontmost-import would read.
[[noreturn]] void refuse_import(Bytes bytes, const ModelSource& source);

/// Loads the model that a scene file names, a built-in scene or a file beside it, as load() does.
/// \throws Error as load() does, and unsupported if the model is a scene file itself.
[[nodiscard]] Scene load_named(const std::string& reference, const ModelSource& scene_file);

/// The warning about a model without triangles, whole or streamed.
inline constexpr const char* no_triangles_warning = "the file holds no triangles";

/// Returns the format that a file's suffix stands for, or nothing if there is no reader for it.
[[nodiscard]] std::optional<ModelFormat> format_of_suffix(const std::string& path);
/// Returns the up axis of files in a format, unless the user says otherwise. Precondition: not a scene file, which may
/// state its own.
[[nodiscard]] Axis default_up(ModelFormat format);
/// Returns the format that the contents look like, or nothing if there is no reader for it.
[[nodiscard]] std::optional<ModelFormat> format_of_content(Bytes bytes);

enum class StlEncoding : std::uint8_t { binary, ascii, neither };

/// Returns the encoding of a file of `file_size` bytes. `start` holds its first 1024 bytes, or all. The word "solid" at
/// the start proves nothing, since many binary files have it:
/// - binary: the size fits the triangle count exactly, or bytes that are no text exceed the count's size;
/// - ascii: text that starts with "solid";
/// - neither: anything else. At least 84 bytes that are no text may be a broken binary file, but only the caller knows
///   whether the file's name says STL.
[[nodiscard]] StlEncoding stl_encoding(Bytes start, std::uint64_t file_size);
/// The encoding of a file that should be STL; binary for one that may be broken. \throws Error if it is neither.
[[nodiscard]] StlEncoding known_stl_encoding(Bytes start, std::uint64_t file_size, const ModelSource& source);

// Formats that are not read, or only by frontmost-import, and programs that convert them.

/// Returns the format that frontmost-import reads by the suffix of `path`, or nothing.
[[nodiscard]] std::optional<ModelFormat> imported_by_suffix(const std::string& path);
/// Returns the format that frontmost-import reads, by the first bytes, or nothing.
[[nodiscard]] std::optional<ModelFormat> imported_by_content(Bytes bytes);
/// The suffix that stands for a foreign file's format, without its point: of `path`, or by the first bytes.
[[nodiscard]] std::string foreign_suffix(const std::string& path, Bytes bytes);
[[nodiscard]] inline bool is_imported(ModelFormat format) { return format >= ModelFormat::step; }

/// Advice for a file of a known format, by the suffix of `path`, with the command that converts it; else empty.
[[nodiscard]] std::optional<std::string> conversion_by_suffix(const std::string& path);
/// Returns such advice by the first bytes, for input without a suffix such as standard input.
[[nodiscard]] std::optional<std::string> conversion_by_content(Bytes bytes);
/// Advice for the glTF file `path`, by extensions that it requires or uses. Empty if no program is known for any.
[[nodiscard]] std::optional<std::string> conversion_of_extensions(const std::vector<std::string>& names,
                                                                  const std::string& path);

}  // namespace frontmost
