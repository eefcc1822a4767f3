// SPDX-License-Identifier: Apache-2.0
// Reads a JSON document value by value. Each value knows its place for messages, such as
// "meshes[2].primitives[0].attributes.POSITION". Unexpected contents throw an Error that names the place.
//
//   root["meshes"] --[2]--> "meshes[2]" --require("primitives")--> "meshes[2].primitives" --> ...
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/models/reader.h"

namespace frontmost::gltf {

/// Owns a parsed document.
class JsonDocument {
 public:
  /// \throws Error file_malformed with line and column, limit_exceeded for depth or number of values.
  JsonDocument(std::string_view text, const ModelSource& source);
  ~JsonDocument();
  JsonDocument(const JsonDocument&) = delete;
  JsonDocument& operator=(const JsonDocument&) = delete;
  [[nodiscard]] const nlohmann::json& root() const { return *root_; }

 private:
  std::unique_ptr<const nlohmann::json> root_;
};

/// A value of a document, which is borrowed.
class JsonValue {
 public:
  JsonValue(const JsonDocument& document, const ModelSource& source) : JsonValue(document.root(), {}, source) {}

  [[nodiscard]] const std::string& place() const { return place_; }
  [[nodiscard]] const ModelSource& source() const { return *source_; }
  [[noreturn]] void fail(const std::string& reason) const;

  /// Returns a member of an object, or nothing.
  [[nodiscard]] std::optional<JsonValue> find(const char* key) const;
  [[nodiscard]] JsonValue require(const char* key) const;
  /// Returns the object `extensions.NAME`, or nothing.
  [[nodiscard]] std::optional<JsonValue> extension(const char* name) const;
  /// Returns the names of the members. \throws Error unless this is an object.
  [[nodiscard]] std::vector<std::string> keys() const;
  [[nodiscard]] bool is_string() const;
  [[nodiscard]] bool is_number() const;
  /// Returns the number of elements. \throws Error unless this is an array.
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] JsonValue operator[](std::size_t i) const;

  [[nodiscard]] bool to_bool() const;
  [[nodiscard]] double to_number() const;
  [[nodiscard]] std::string to_string() const;
  /// Returns a whole number, which may be written as 3.0. \throws Error for negative numbers.
  [[nodiscard]] std::uint64_t to_unsigned() const;
  /// Returns an index. \throws Error unless it is below `count`.
  [[nodiscard]] std::uint32_t to_index(std::size_t count) const;
  /// Reads an array of exactly out.size() numbers.
  void to_numbers(std::span<double> out) const;

  // The functions below read a member, and return a default value if it is absent.
  [[nodiscard]] bool bool_or(const char* key, bool absent) const { return read_or(key, absent, &JsonValue::to_bool); }
  [[nodiscard]] double number_or(const char* key, double absent) const {
    return read_or(key, absent, &JsonValue::to_number);
  }
  [[nodiscard]] std::string string_or_empty(const char* key) const { return read_or(key, {}, &JsonValue::to_string); }
  /// Returns the member "name", or an empty text if it is absent.
  [[nodiscard]] std::string name() const { return name_of(string_or_empty("name")); }
  [[nodiscard]] std::uint64_t unsigned_or(const char* key, std::uint64_t absent) const {
    return read_or(key, absent, &JsonValue::to_unsigned);
  }
  [[nodiscard]] std::uint32_t index_or_none(const char* key, std::size_t count) const;
  /// Reads a member that is an array of numbers. \returns false, and leaves `out` unchanged, if the member is absent.
  bool read_numbers(const char* key, std::span<double> out) const;
  /// Reads a vector of floats or doubles. Leaves `out` unchanged if the member is absent.
  template <class Vector>
  void read_vector(const char* key, Vector& out) const {
    double numbers[std::size_t(Vector::length())];
    if (!read_numbers(key, numbers)) return;
    for (int k = 0; k < Vector::length(); ++k) out[k] = typename Vector::value_type(numbers[k]);
  }

  // The functions below read a member that is an array. An absent array counts as empty.
  [[nodiscard]] std::size_t count(const char* key) const;
  /// Calls read(JsonValue) with each element.
  template <class Read>
  void each(const char* key, const Read& read) const {
    const std::optional<JsonValue> array = find(key);
    for (std::size_t i = 0; array && i < array->size(); ++i) read((*array)[i]);
  }

 private:
  JsonValue(const nlohmann::json& value, std::string place, const ModelSource& source)
      : value_(&value), place_(std::move(place)), source_(&source) {}
  template <class T>
  [[nodiscard]] T read_or(const char* key, std::type_identity_t<T> absent, T (JsonValue::*read)() const) const {
    const std::optional<JsonValue> found = find(key);
    return found ? ((*found).*read)() : absent;
  }

  const nlohmann::json* value_;
  std::string place_;
  const ModelSource* source_;
};

}  // namespace frontmost::gltf
