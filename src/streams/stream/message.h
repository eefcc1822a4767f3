// SPDX-License-Identifier: Apache-2.0
// Messages between ranks: values and lists of values in sequence, as they lie in memory. All ranks run the same program
// on machines of one kind; the caller sees to that. If ranks read different files, messages do not fit, which is an
// error.
#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "frontmost/streams.h"

namespace frontmost::streaming {

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

}  // namespace frontmost::streaming
