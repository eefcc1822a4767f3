// SPDX-License-Identifier: Apache-2.0
// Reading of a JSON document value by value, each of which knows its place for messages:
// "meshes[2].primitives[0].attributes.POSITION". Whatever is not as expected ends in an Error that names the place.
//
//   root["meshes"] --[2]--> "meshes[2]" --require("primitives")--> "meshes[2].primitives" --> ...
//
// Readers ask for what they need and are either given it or left by an exception, so they have no code for files that
// are wrong.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/models/model_source.h"

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

/// A borrowed value of a document.
class JsonValue {
 public:
  JsonValue(const JsonDocument& document, const ModelSource& source) : JsonValue(document.root(), {}, source) {}

  [[nodiscard]] const std::string& place() const { return place_; }
  [[nodiscard]] const ModelSource& source() const { return *source_; }
  [[noreturn]] void fail(const std::string& reason) const;

  /// A member of an object, if it is there.
  [[nodiscard]] std::optional<JsonValue> find(const char* key) const;
  [[nodiscard]] JsonValue require(const char* key) const;
  /// The object `extensions.NAME`, if it is there.
  [[nodiscard]] std::optional<JsonValue> extension(const char* name) const;
  /// The names of the members of an object, which this must be.
  [[nodiscard]] std::vector<std::string> keys() const;
  [[nodiscard]] bool is_string() const;
  [[nodiscard]] bool is_number() const;
  /// Number of elements of an array, which this must be.
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] JsonValue operator[](std::size_t i) const;

  [[nodiscard]] bool to_bool() const;
  [[nodiscard]] double to_number() const;
  [[nodiscard]] std::string to_string() const;
  /// Whole numbers may be written as 3.0. Negative ones are errors.
  [[nodiscard]] std::uint64_t to_unsigned() const;
  /// An index below `count`.
  [[nodiscard]] std::uint32_t to_index(std::size_t count) const;
  /// An array of exactly as many numbers.
  void to_numbers(std::span<double> out) const;

  // Members with a default for when they are absent.
  [[nodiscard]] bool bool_or(const char* key, bool absent) const;
  [[nodiscard]] double number_or(const char* key, double absent) const;
  [[nodiscard]] std::string string_or_empty(const char* key) const;
  /// The member "name", if it is there.
  [[nodiscard]] std::string name() const;
  [[nodiscard]] std::uint64_t unsigned_or(const char* key, std::uint64_t absent) const;
  [[nodiscard]] std::uint32_t index_or_none(const char* key, std::size_t count) const;
  /// False: absent, and `out` stays as it is.
  bool read_numbers(const char* key, std::span<double> out) const;

 private:
  JsonValue(const nlohmann::json& value, std::string place, const ModelSource& source)
      : value_(&value), place_(std::move(place)), source_(&source) {}
  [[nodiscard]] JsonValue member(const nlohmann::json& value, const char* key) const;

  const nlohmann::json* value_;
  std::string place_;
  const ModelSource* source_;
};

}  // namespace frontmost::gltf
