// SPDX-License-Identifier: Apache-2.0
// Reads the values of a PLY file's rows, one after the other, in each of the three encodings.
//
// A TextScanner reads text; binary values are read in place, in either byte order. Both check that a value exists
// before they read it, and name the element and the row in errors.
#pragma once

#include <cmath>

#include "io/models/ply/ply_header.h"
#include "io/models/text/text_scanner.h"

namespace frontmost {

/// Interface of both kinds of rows:
///   begin_row(element, row)   before the values of a row
///   number(type)              the next value as a float
///   number(type, exact)       the next value as a float and as a double
///   integer(type)             the next value of an integer type
///   skip(type, count)         skips values
///   room_for(type, count)     fails unless that many values can follow
class PlyBinaryRows {
 public:
  PlyBinaryRows(Bytes rows, Endian endian, const ModelSource& source)
      : at_(rows.data()), end_(at_ + rows.size()), released_(at_), endian_(endian), source_(source) {}

  void begin_row(const PlyElement& element, std::uint64_t row) {
    element_ = &element;
    row_ = row;
    if (at_ - released_ > release_step) release();
  }
  float number(PlyType type, double& exact) {
    switch (type) {
      case PlyType::int32: exact = next<std::int32_t>(); break;
      case PlyType::uint32: exact = next<std::uint32_t>(); break;
      case PlyType::float64: exact = next<double>(); break;
      default: exact = double(number(type)); break;
    }
    return float(exact);
  }
  float number(PlyType type) {
    switch (type) {
      case PlyType::int8: return float(next<std::int8_t>());
      case PlyType::uint8: return float(next<std::uint8_t>());
      case PlyType::int16: return float(next<std::int16_t>());
      case PlyType::uint16: return float(next<std::uint16_t>());
      case PlyType::int32: return float(next<std::int32_t>());
      case PlyType::uint32: return float(next<std::uint32_t>());
      case PlyType::float32: return next<float>();
      case PlyType::float64: return float(next<double>());
    }
    return 0;
  }
  std::int64_t integer(PlyType type) {
    switch (type) {
      case PlyType::int8: return next<std::int8_t>();
      case PlyType::uint8: return next<std::uint8_t>();
      case PlyType::int16: return next<std::int16_t>();
      case PlyType::uint16: return next<std::uint16_t>();
      case PlyType::int32: return next<std::int32_t>();
      default: return next<std::uint32_t>();
    }
  }
  void room_for(PlyType type, std::uint64_t count) const {
    if (count > std::uint64_t(end_ - at_) / size_of(type)) fail("the file ends within the row");
  }
  void skip(PlyType type, std::uint64_t count) {
    room_for(type, count);
    at_ += count * size_of(type);
  }
  [[nodiscard]] std::string place() const { return element_->name + " " + std::to_string(row_); }
  [[noreturn]] void fail(const std::string& reason) const { source_.fail(place(), reason); }

 private:
  template <class T>
  T next() {
    if (std::size_t(end_ - at_) < sizeof(T)) fail("the file ends within the row");
    const T value = read_value<T>(at_, endian_);
    at_ += sizeof(T);
    return value;
  }
  void release();

  static constexpr std::ptrdiff_t release_step = 1 << 20;
  const std::byte* at_;
  const std::byte* end_;
  const std::byte* released_;
  Endian endian_;
  const ModelSource& source_;
  const PlyElement* element_ = nullptr;
  std::uint64_t row_ = 0;
};

/// Each row is a line of its own.
class PlyAsciiRows {
 public:
  PlyAsciiRows(Bytes rows, std::size_t lines_before, const ModelSource& source)
      : text_(rows, source), lines_before_(lines_before) {}

  void begin_row(const PlyElement& element, std::uint64_t row) {
    element_ = &element;
    row_ = row;
    if (started_) text_.next_line();
    started_ = true;
    if (!text_.to_word()) fail("the file ends before the row");
  }
  float number(PlyType) {
    float value = 0;
    if (!text_.number(value) || !text_.at_blank()) fail_value();
    return value;
  }
  float number(PlyType, double& exact) {
    float value = 0;
    if (!text_.number(value, exact) || !text_.at_blank()) fail_value();
    return value;
  }
  std::int64_t integer(PlyType) {
    std::int64_t value = 0;
    if (!text_.integer(value) || !text_.at_blank()) fail_value();
    return value;
  }
  void room_for(PlyType, std::uint64_t count) const {
    if (count > (text_.bytes_left() + 1) / 2) fail("the file ends within the row");
  }
  void skip(PlyType, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i)
      if (text_.word().empty()) fail_value();
  }
  [[nodiscard]] std::string place() const {
    return "line " + std::to_string(lines_before_ + text_.line()) + ": " + element_->name + " " + std::to_string(row_);
  }
  [[noreturn]] void fail(const std::string& reason) const { text_.source().fail(place(), reason); }

 private:
  [[noreturn]] void fail_value() {
    fail(text_.at_line_end() ? "the row has too few values" : "not a number that fits the property");
  }

  TextScanner text_;
  std::size_t lines_before_;
  bool started_ = false;
  const PlyElement* element_ = nullptr;
  std::uint64_t row_ = 0;
};

}  // namespace frontmost
