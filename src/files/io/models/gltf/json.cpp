// SPDX-License-Identifier: Apache-2.0
// A library parses the document. The library's recursion and memory grow with the text, so the depth and the number of
// values are counted first.
#include "io/models/gltf/json.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace frontmost::gltf {
namespace {

// glTF needs a depth of about ten. A value costs up to a hundred bytes of memory, so a text of empty brackets would
// take thirty times its size.
constexpr int max_depth = 256;
constexpr std::size_t max_values = std::size_t(1) << 23;
// Beyond 2^53 a double skips integers, so a number with a point or an exponent has lost its last digits.
constexpr double max_exact_integer = 9007199254740992.0;  // 2^53

/// Counts brackets and commas outside of strings before the parser allocates objects for them. Broken JSON may be
/// counted wrongly here; the parser refuses it afterwards.
void check_shape(std::string_view text, const ModelSource& source) {
  int depth = 0;
  std::size_t values = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    switch (text[i]) {
      case '"':
        while (++i < text.size() && text[i] != '"') i += text[i] == '\\';
        break;
      case '[':
      case '{':
        ++values;
        if (++depth > max_depth) source.fail_limit("byte " + std::to_string(i), "JSON nested deeper than 256");
        break;
      case ']':
      case '}': --depth; break;
      case ',': ++values; break;
      default: break;
    }
  }
  if (values > max_values) source.fail_limit("JSON", "more than " + std::to_string(max_values) + " values");
}

std::string reason_of(const nlohmann::json::exception& error) {
  // The message looks like "[json.exception.parse_error.101] parse error at line 1, column 2: ...". Its number does not
  // help users.
  const std::string_view what = error.what();
  const std::size_t start = what.find("] ");
  return printable(start == std::string_view::npos ? what : what.substr(start + 2));
}

}  // namespace

JsonDocument::JsonDocument(std::string_view text, const ModelSource& source) {
  check_shape(text, source);
  try {
    root_ = std::make_unique<const nlohmann::json>(nlohmann::json::parse(text.begin(), text.end()));
  } catch (const nlohmann::json::exception& error) {
    source.fail("JSON", reason_of(error));
  }
  if (!root_->is_object()) source.fail("JSON", std::string("an object is expected, not ") + root_->type_name());
}

JsonDocument::~JsonDocument() = default;

void JsonValue::fail(const std::string& reason) const { source_->fail(place_.empty() ? "JSON" : place_, reason); }

std::optional<JsonValue> JsonValue::find(const char* key) const {
  if (!value_->is_object()) fail(std::string("an object is expected, not ") + value_->type_name());
  const auto found = value_->find(key);
  if (found == value_->end()) return std::nullopt;
  return JsonValue(*found, place_.empty() ? std::string(key) : place_ + "." + key, *source_);
}

JsonValue JsonValue::require(const char* key) const {
  if (std::optional<JsonValue> found = find(key)) return *std::move(found);
  fail(std::string("'") + key + "' is missing");
}

std::optional<JsonValue> JsonValue::extension(const char* name) const {
  const std::optional<JsonValue> extensions = find("extensions");
  return extensions ? extensions->find(name) : std::nullopt;
}

std::vector<std::string> JsonValue::keys() const {
  if (!value_->is_object()) fail(std::string("an object is expected, not ") + value_->type_name());
  std::vector<std::string> keys;
  for (const auto& member : value_->items()) keys.push_back(member.key());
  return keys;
}

bool JsonValue::is_string() const { return value_->is_string(); }

bool JsonValue::is_number() const { return value_->is_number(); }

std::size_t JsonValue::size() const {
  if (!value_->is_array()) fail(std::string("an array is expected, not ") + value_->type_name());
  return value_->size();
}

JsonValue JsonValue::operator[](std::size_t i) const {
  return {(*value_)[i], place_ + "[" + std::to_string(i) + "]", *source_};
}

bool JsonValue::to_bool() const {
  if (!value_->is_boolean()) fail(std::string("true or false is expected, not ") + value_->type_name());
  return value_->get<bool>();
}

double JsonValue::to_number() const {
  if (!value_->is_number()) fail(std::string("a number is expected, not ") + value_->type_name());
  return value_->get<double>();
}

std::string JsonValue::to_string() const {
  if (!value_->is_string()) fail(std::string("a string is expected, not ") + value_->type_name());
  return value_->get<std::string>();
}

std::uint64_t JsonValue::to_unsigned() const {
  if (value_->is_number_unsigned()) return value_->get<std::uint64_t>();
  const double number = to_number();
  if (!(number >= 0 && number <= max_exact_integer) || number != std::floor(number))
    fail("a whole number from 0 on is expected, not " + printable(value_->dump()));
  return static_cast<std::uint64_t>(number);
}

std::uint32_t JsonValue::to_index(std::size_t count) const {
  const std::uint64_t index = to_unsigned();
  // no_index means "none" elsewhere, so that number is refused even if a file has so many elements.
  if (index >= count || index >= no_index)
    fail(std::to_string(index) + " does not exist, there are " + std::to_string(count));
  return static_cast<std::uint32_t>(index);
}

void JsonValue::to_numbers(std::span<double> out) const {
  if (size() != out.size()) fail(std::to_string(out.size()) + " numbers are expected, not " + std::to_string(size()));
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = (*this)[i].to_number();
}

std::uint32_t JsonValue::index_or_none(const char* key, std::size_t count) const {
  const std::optional<JsonValue> found = find(key);
  return found ? found->to_index(count) : no_index;
}

std::size_t JsonValue::count(const char* key) const {
  const std::optional<JsonValue> array = find(key);
  return array ? array->size() : 0;
}

bool JsonValue::read_numbers(const char* key, std::span<double> out) const {
  const std::optional<JsonValue> found = find(key);
  if (found) found->to_numbers(out);
  return found.has_value();
}

}  // namespace frontmost::gltf
