// SPDX-License-Identifier: Apache-2.0
// What every room shares: errors, how to run (threads, instruction set, watching long work), boxes, buffers, names as
// texts, and folders of files that are all there or not.
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

/// Why a public function could not do what it was asked.
enum class ErrorCode : std::uint8_t {
  bad_argument,     ///< a value outside its documented range
  file_unreadable,  ///< missing, a folder, no permission
  file_malformed,   ///< contents that break the format
  file_unwritable,  ///< output that could not be written whole; nothing is left behind
  unsupported,      ///< valid, but not something Frontmost can do
  limit_exceeded,   ///< larger than a documented limit
  singular_camera,  ///< a camera or transform that cannot be inverted
  cancelled,        ///< Watch::cancelled said so
};

/// Thrown by every public function that can be given bad input. what() is file, place and reason, as far as they are
/// known, with ": " between them: "engine.stl: triangle 41: its third corner is not a number".
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, std::string reason);
  Error(ErrorCode code, std::string place, std::string reason);
  Error(ErrorCode code, std::string file, std::string place, std::string reason);

  [[nodiscard]] ErrorCode code() const noexcept { return code_; }
  /// Whose contents or name is wrong: a path, "standard input", "builtin:..."; empty where no file is.
  [[nodiscard]] const std::string& file() const noexcept { return parts_->file; }
  /// Where in the file, or which argument or function: "line 7", "near"; may be empty.
  [[nodiscard]] const std::string& place() const noexcept { return parts_->place; }
  [[nodiscard]] const std::string& reason() const noexcept { return parts_->reason; }
  /// The same error as one of this file and place; what it named itself comes behind the place.
  [[nodiscard]] Error within(const std::string& file, const std::string& place = "") const;

 private:
  struct Parts {
    std::string file, place, reason;
  };
  ErrorCode code_;
  std::shared_ptr<const Parts> parts_;  // copies of an exception must not throw
};

/// Instruction sets that the kernels are compiled for. None changes any result.
enum class Isa : std::uint8_t { best, scalar, sse4, avx2, avx512, neon, wasm };

/// \returns "scalar", "sse4", ...; "best" is resolved to what this machine would run.
[[nodiscard]] std::string_view name(Isa isa);
/// The instruction sets that this build holds and this machine can run, slowest first, never `best`.
[[nodiscard]] std::span<const Isa> available_isas();

/// Watches long work. Both functions are called after every small piece of it, by several threads at a time, so they
/// must be quick and safe to call at once. What they throw ends the work and is thrown again.
struct Watch {
  /// What is being done ("load", "surfaces", ...), and how much of it is done, 0 to 1.
  std::function<void(std::string_view stage, double fraction)> progress;
  /// True ends the work soon, by Error with ErrorCode::cancelled.
  std::function<bool()> cancelled;
};

/// How to run; never what the result is.
struct Execution {
  int threads = 0;               ///< 0: one per core; at most 1024
  Isa isa = Isa::best;           ///< must be one of available_isas(), or best
  const Watch* watch = nullptr;  ///< borrowed; may be null
};

/// The running number of a triangle over all instances in scene order.
using PrimitiveId = std::uint32_t;
inline constexpr std::uint32_t no_primitive = 0xFFFFFFFFu;
/// "None" for materials, textures, objects and every other index.
inline constexpr std::uint32_t no_index = 0xFFFFFFFFu;

/// True unless a coordinate is NaN or infinite: those times 0 are NaN, and NaN is not 0.
[[nodiscard]] inline bool is_finite(const glm::vec3& p) {
  const glm::vec3 zero = p * 0.0f;
  return zero.x == 0 && zero.y == 0 && zero.z == 0;
}
[[nodiscard]] inline bool is_finite(const glm::dvec3& p) {
  const glm::dvec3 zero = p * 0.0;
  return zero.x == 0 && zero.y == 0 && zero.z == 0;
}

/// An axis-aligned box. Default: empty.
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
/// Uninitialised memory, aligned to 64 bytes; large pieces ask the system for large pages. \throws std::bad_alloc.
[[nodiscard]] void* allocate(std::size_t bytes);
void release(void* pointer) noexcept;
}  // namespace detail

/// A fixed-size array, aligned to 64 bytes, whose elements start uninitialised: for planes of pixels that are written
/// whole before they are read. Copies are deep.
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

// Names come from files, and may be any bytes.

/// `text` as UTF-8, whatever bytes it holds: one that is no part of a character is written as four, such as \xE9. For
/// JSON, which has its own way to write control characters. O(size).
[[nodiscard]] std::string utf8_text(std::string_view text);
/// The same for terminals and pages, with control characters written likewise: a line feed is \x0A.
[[nodiscard]] std::string printable_text(std::string_view text);

// Several files that belong together: all of them are there, or none.

/// Makes a folder and those that lead to it, where they are missing. The destructor removes the folders that this
/// object made, if they are empty.
class MadeFolder {
 public:
  /// \throws Error file_unwritable where the folder cannot be made or is something else.
  explicit MadeFolder(const std::string& folder);
  ~MadeFolder();
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;

 private:
  std::vector<std::filesystem::path> made_;  ///< the outermost first
};

/// A hidden folder within another, gone with this, for files on their way there.
class StagedFolder {
 public:
  /// \throws Error file_unwritable.
  explicit StagedFolder(const std::string& folder);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  /// Where the file of this name is to be written.
  [[nodiscard]] std::string path(const std::string& name) const { return (staged_ / name).string(); }
  /// The path that a file in here is to have, where it begins with this folder; other texts as they are.
  [[nodiscard]] std::string told(const std::string& path) const;
  /// Moves the files to their places, in this order; they need no more room there. Those that were there are replaced,
  /// those at the end of links too, and leave their permissions. \throws Error file_unwritable.
  void commit(const std::vector<std::string>& names) const;

 private:
  std::filesystem::path folder_, staged_;
};

}  // namespace frontmost
