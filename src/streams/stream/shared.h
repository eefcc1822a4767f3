// SPDX-License-Identifier: Apache-2.0
// Merges the results of ranks that stream a model together, after each pass.
//
//   rank 0   pieces of its own --> planes, copies of triangles --+
//   rank 1   pieces of its own --> planes, copies of triangles --+--> planes of the whole, on all ranks
//   ...                                                          +--> copies of the triangles seen there, on rank 0
//
// All ranks call each function at the same point.
#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "frontmost/streams.h"
#include "stream/kept_triangles.h"
#include "stream/piece_loop.h"

namespace frontmost::streaming {

/// Messages are values and lists of values in sequence, as they lie in memory. All ranks must run the same program on
/// machines of one kind.
class MessageWriter {
 public:
  /// Reserves about this many bytes, so that a growing message is not moved.
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  template <class T>
  void put(const T& value) {
    append(&value, 1);
  }
  template <class T>
  void put_list(const std::vector<T>& values) {
    put(std::uint64_t(values.size()));
    append(values.data(), values.size());
  }
  void put_text(const std::string& text) {
    put(std::uint64_t(text.size()));
    append(text.data(), text.size());
  }
  [[nodiscard]] Ranks::Message take() { return std::move(bytes_); }

 private:
  template <class T>
  void append(const T* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* first = reinterpret_cast<const std::byte*>(values);
    bytes_.insert(bytes_.end(), first, first + count * sizeof(T));
  }

  Ranks::Message bytes_;
};

/// Reads a message. Throws an Error if the message does not fit, which happens if ranks read different files.
class MessageReader {
 public:
  explicit MessageReader(const Ranks::Message& bytes) : bytes_(bytes) {}

  [[nodiscard]] bool is_at_end() const { return at_ == bytes_.size(); }
  template <class T>
  [[nodiscard]] T get() {
    T value;
    copy(&value, 1);
    return value;
  }
  template <class T>
  [[nodiscard]] std::vector<T> get_list() {
    std::vector<T> values(count_of(sizeof(T)));
    copy(values.data(), values.size());
    return values;
  }
  [[nodiscard]] std::string get_text() {
    std::string text(count_of(1), '\0');
    copy(text.data(), text.size());
    return text;
  }

 private:
  [[noreturn]] static void fail() {
    throw Error(ErrorCode::file_malformed, "stream", "the ranks do not read the same files");
  }
  [[nodiscard]] std::size_t count_of(std::size_t size) {
    const auto count = get<std::uint64_t>();
    if (count > (bytes_.size() - at_) / size) fail();
    return std::size_t(count);
  }
  template <class T>
  void copy(T* to, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count * sizeof(T) > bytes_.size() - at_) fail();
    if (count > 0) std::memcpy(static_cast<void*>(to), bytes_.data() + at_, count * sizeof(T));
    at_ += count * sizeof(T);
  }

  const Ranks::Message& bytes_;
  std::size_t at_ = 0;
};

/// Results of a pass besides the visible triangles.
struct PassFacts {
  std::vector<std::uint64_t> triangle_counts;  ///< by file
  std::vector<FileWarning> warnings;           ///< in the order of files
  Box bounds;
};
/// \returns on all ranks the facts of all ranks together.
[[nodiscard]] PassFacts share(Ranks& ranks, const PassFacts& mine);

/// \returns on all ranks the lists of all ranks, joined.
[[nodiscard]] std::vector<glm::vec3> share(Ranks& ranks, const std::vector<glm::vec3>& mine);

/// Merges the planes of all ranks, so that every rank gets the merged planes. Ids are those of the whole model.
void share(Ranks& ranks, Visible& visible, const Execution& execution);

/// \returns on rank 0 the kept triangles of all ranks, and nothing on other ranks. Ids are those of the whole model.
[[nodiscard]] KeptPieces gather(Ranks& ranks, KeptPieces mine);

/// Maps ids of a pass, in which only this rank's files were counted, to ids of the whole model.
class IdShift {
 public:
  /// `from` and `to` have each file's first id, `counts` its number of ids in the pass: 0 for a file that was not read.
  IdShift(const std::vector<PrimitiveId>& from, const std::vector<std::uint64_t>& counts,
          const std::vector<PrimitiveId>& to);

  /// Precondition: `id` is an id of the pass.
  [[nodiscard]] PrimitiveId operator()(PrimitiveId id) const;
  /// Replaces all ids but no_primitive.
  void apply(std::span<PrimitiveId> ids, const Execution& execution) const;

 private:
  struct File {
    PrimitiveId from, shift;
  };
  std::vector<File> files_;  ///< ascending by `from`
};

}  // namespace frontmost::streaming
