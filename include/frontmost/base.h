// SPDX-License-Identifier: Apache-2.0
// Basics that all other headers use: errors, execution (threads, instruction set, progress), boxes, buffers, names as
// text, and folders whose files appear together or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace frontmost {

/// The kind of failure that an Error reports.
enum class ErrorCode : std::uint8_t {
  bad_argument,     ///< a value outside its documented range
  file_unreadable,  ///< the file is missing, is a folder, or may not be read
  file_malformed,   ///< the contents break the format
  file_unwritable,  ///< the output could not be written whole; nothing is left behind
  unsupported,      ///< valid input that Frontmost cannot process
  limit_exceeded,   ///< the input exceeds a documented limit
  singular_camera,  ///< a camera or transform that cannot be inverted
  cancelled,        ///< Watch::cancelled returned true
};

/// The exception thrown by every public function that can be given bad input. what() joins file, place and reason with
/// ": ", except empty ones: "engine.stl: triangle 41: its third corner is not a number".
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, std::string reason);
  Error(ErrorCode code, std::string place, std::string reason);
  Error(ErrorCode code, std::string file, std::string place, std::string reason);

  [[nodiscard]] ErrorCode code() const noexcept { return code_; }
  /// The file whose contents or name is wrong: a path, "standard input", "builtin:..."; empty if no file is involved.
  [[nodiscard]] const std::string& file() const noexcept { return parts_->file; }
  /// The place in the file, or the argument or function: "line 7", "near"; may be empty.
  [[nodiscard]] const std::string& place() const noexcept { return parts_->place; }
  [[nodiscard]] const std::string& reason() const noexcept { return parts_->reason; }
  /// \returns a copy with this file and place. The error's own file and place are appended to `place`.
  [[nodiscard]] Error within(const std::string& file, const std::string& place = "") const;

 private:
  struct Parts {
    std::string file, place, reason;
  };
  ErrorCode code_;
  std::shared_ptr<const Parts> parts_;  // copying an exception must not throw
};

/// Instruction sets that the kernels are compiled for. Results are the same with all of them.
enum class Isa : std::uint8_t { best, scalar, sse4, avx2, avx512, neon, wasm };

/// \returns "scalar", "sse4", ...; for `best`, the name of the set that this machine would run.
[[nodiscard]] std::string_view name(Isa isa);
/// Instruction sets that this build contains and this machine can run, slowest first, never `best`.
[[nodiscard]] std::span<const Isa> available_isas();

/// Callbacks that watch long work. `cancelled` is called before every small piece of work, and `progress` now and then.
/// Several threads call both at the same time, so they must be quick and thread-safe. An exception that a callback
/// throws ends the work and is thrown again.
struct Watch {
  /// Receives the name of the current stage ("load", "surfaces", ...) and the fraction of the stage that is done, 0 to
  /// 1.
  std::function<void(std::string_view stage, double fraction)> progress;
  /// If it returns true, the work soon ends with an Error of ErrorCode::cancelled.
  std::function<bool()> cancelled;
};

/// Settings for how the work is run. They never change a result.
struct Execution {
  int threads = 0;               ///< 0: one thread per core; at most 1024
  Isa isa = Isa::best;           ///< `best`, or one of available_isas()
  const Watch* watch = nullptr;  ///< borrowed; may be null
};

/// Number of a triangle, counted over all instances in scene order.
using PrimitiveId = std::uint32_t;
inline constexpr std::uint32_t no_primitive = 0xFFFFFFFFu;
/// Index that stands for "none", for materials, textures, objects and everything else.
inline constexpr std::uint32_t no_index = 0xFFFFFFFFu;

/// False if a coordinate is NaN or infinite: such a coordinate times 0 is NaN, and NaN is not 0.
[[nodiscard]] inline bool is_finite(const glm::vec3& p) {
  const glm::vec3 zero = p * 0.0f;
  return zero.x == 0 && zero.y == 0 && zero.z == 0;
}
[[nodiscard]] inline bool is_finite(const glm::dvec3& p) {
  const glm::dvec3 zero = p * 0.0;
  return zero.x == 0 && zero.y == 0 && zero.z == 0;
}

/// An axis-aligned box, empty by default.
struct Box {
  glm::vec3 low{std::numeric_limits<float>::infinity()};
  glm::vec3 high{-std::numeric_limits<float>::infinity()};

  [[nodiscard]] bool is_empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
  void include(const glm::vec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  void include(const Box& box) {
    low = glm::min(low, box.low);
    high = glm::max(high, box.high);
  }
  /// Precondition: not empty.
  [[nodiscard]] glm::vec3 centre() const { return low + (high - low) * 0.5f; }
  /// The length of the diagonal; 0 when empty.
  [[nodiscard]] float diagonal() const { return is_empty() ? 0.0f : glm::length(high - low); }
};

namespace detail {
/// Allocates uninitialised memory, aligned to 64 bytes; large blocks ask the system for large pages.
/// \throws std::bad_alloc.
[[nodiscard]] void* allocate(std::size_t bytes);
void release(void* pointer) noexcept;
}  // namespace detail

/// A fixed-size array, aligned to 64 bytes, with uninitialised elements. Its main use is planes of pixels that are
/// written whole before they are read. Copies are deep.
template <class T>
class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(std::size_t size) : data_(static_cast<T*>(detail::allocate(size * sizeof(T)))), size_(size) {}
  Buffer(std::size_t size, const T& value) : Buffer(size) {
    for (T& element : *this) element = value;
  }
  Buffer(const Buffer& other) : Buffer(other.size_) {
    for (std::size_t i = 0; i < size_; ++i) data_[i] = other.data_[i];
  }
  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(Buffer other) noexcept {
    swap(other);
    return *this;
  }
  ~Buffer() = default;

  void swap(Buffer& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] T* data() { return data_.get(); }
  [[nodiscard]] const T* data() const { return data_.get(); }
  [[nodiscard]] T* begin() { return data(); }
  [[nodiscard]] T* end() { return data() + size_; }
  [[nodiscard]] const T* begin() const { return data(); }
  [[nodiscard]] const T* end() const { return data() + size_; }
  [[nodiscard]] T& operator[](std::size_t i) { return data_[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const { return data_[i]; }

 private:
  static_assert(std::is_trivially_destructible_v<T> && std::is_trivially_copyable_v<T>);
  struct Release {
    void operator()(T* pointer) const { detail::release(pointer); }
  };
  std::unique_ptr<T[], Release> data_;
  std::size_t size_ = 0;
};

// Names come from files and may contain any bytes.

/// \returns `text` as valid UTF-8: a byte that belongs to no character becomes four characters, such as \xE9. Control
/// characters stay, because JSON has its own way to write them. O(size).
[[nodiscard]] std::string utf8_text(std::string_view text);
/// \returns `text` for terminals and web pages: like utf8_text(), but control characters are escaped as well. A line
/// feed becomes \x0A.
[[nodiscard]] std::string printable_text(std::string_view text);

// Output of several files that belong together: either all of them appear, or none.

/// Makes a folder, and missing folders on the path to it. The destructor removes the folders that this object made, if
/// they are empty.
class MadeFolder {
 public:
  /// \throws Error file_unwritable if the folder cannot be made or the path is not a folder.
  explicit MadeFolder(const std::string& folder);
  ~MadeFolder();
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;

 private:
  std::vector<std::filesystem::path> made_;  ///< outermost folder first
};

/// A hidden temporary folder inside `folder`, for files until commit() moves them. The destructor removes it.
class StagedFolder {
 public:
  /// \throws Error file_unwritable.
  explicit StagedFolder(const std::string& folder);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  /// Path at which the file of this name is to be written.
  [[nodiscard]] std::string path(const std::string& name) const { return (staged_ / name).string(); }
  /// Replaces the hidden folder at the beginning of `path` by the final folder; returns other texts unchanged.
  [[nodiscard]] std::string told(const std::string& path) const;
  /// Moves the files of these names to the final folder, in this order. Takes no further disk space. Existing files are
  /// replaced, even if `names` leads to them by a link; their permissions are kept.
  /// \throws Error file_unwritable.
  void commit(const std::vector<std::string>& names) const;

 private:
  std::filesystem::path folder_, staged_;
};

}  // namespace frontmost
