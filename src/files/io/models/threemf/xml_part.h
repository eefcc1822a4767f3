// SPDX-License-Identifier: Apache-2.0
// Reads one XML part of a package tag by tag, from front to back. Also parsers of attribute values: blanks around a
// value are skipped, anything else makes the value invalid.
#pragma once

#include <cstdint>
#include <exception>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>

#include "io/models/model_source.h"
#include "io/models/threemf/package.h"

struct XML_ParserStruct;

namespace frontmost::threemf {

/// The attributes of a tag. Names outside the tag's own namespace are "namespace|name".
class Attributes {
 public:
  explicit Attributes(const char** pairs) : pairs_(pairs) {}
  /// The value of an attribute, or null.
  [[nodiscard]] const char* find(std::string_view name) const {
    for (const char** p = pairs_; *p != nullptr; p += 2)
      if (name == *p) return p[1];
    return nullptr;
  }
  [[nodiscard]] const char** begin() const { return pairs_; }

 private:
  const char** pairs_;
};

/// Base of readers of XML parts; derived classes interpret the tags. Text between tags is skipped.
///
/// Memory is bounded for any part: document types (and so all custom entities) are refused, and so are tags of more
/// than a megabyte, more than 256 levels, and more than 4096 different names.
class XmlPart {
 public:
  XmlPart(std::string name, const ModelSource& source);
  virtual ~XmlPart();
  XmlPart(const XmlPart&) = delete;
  XmlPart& operator=(const XmlPart&) = delete;

  /// \throws Error "file: part: line N: reason", and as Package::unpack() does.
  void read(Package& package);

 protected:
  /// `name` is "namespace|name".
  virtual void start(std::string_view name, const Attributes& attributes) = 0;
  virtual void end() = 0;
  /// Called for each namespace that the next tag declares.
  virtual void declare(std::string_view prefix, std::string_view space) { (void)prefix, (void)space; }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const ModelSource& source() const { return source_; }
  [[nodiscard]] std::size_t line() const;
  /// The part and its current line.
  [[nodiscard]] std::string place() const;
  [[noreturn]] void fail(const std::string& reason) const { source_.fail(place(), reason); }

 private:
  struct Callbacks;
  struct Free {
    void operator()(XML_ParserStruct* parser) const;
  };
  void feed(std::string_view text, bool is_last);
  void note_names(std::string_view element, const char** attributes);
  void note(std::string_view name);

  std::string name_;
  const ModelSource& source_;
  std::unique_ptr<XML_ParserStruct, Free> parser_;
  std::exception_ptr failure_;  ///< thrown by a callback, which must not throw through the parser
  std::size_t since_event_ = 0;
  int depth_ = 0;
  struct Hash : std::hash<std::string_view> {
    using is_transparent = void;
  };
  std::unordered_set<std::string, Hash, std::equal_to<>> names_;
};

/// A number, which may be infinite or NaN: such vertices are kept, as in all formats.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);
/// A whole number below no_index.
[[nodiscard]] std::optional<std::uint32_t> parse_index(std::string_view text);
/// A colour #RRGGBB or #RRGGBBAA in sRGB, converted to linear light.
[[nodiscard]] std::optional<glm::vec4> parse_color(std::string_view text);
/// Twelve finite numbers: the rows of a matrix for row vectors, without its last column.
[[nodiscard]] std::optional<glm::dmat4> parse_transform(std::string_view text);

}  // namespace frontmost::threemf
