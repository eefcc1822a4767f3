// SPDX-License-Identifier: Apache-2.0
// G. Turk. The PLY Polygon File Format. 1994.
#include "io/models/ply/ply_header.h"

#include <algorithm>
#include <optional>

#include "io/models/text/text_scanner.h"

namespace frontmost {
namespace {

std::optional<PlyType> type_of(std::string_view name) {
  constexpr struct {
    std::string_view name;
    PlyType type;
  } types[] = {{"char", PlyType::int8},      {"uchar", PlyType::uint8},    {"short", PlyType::int16},
               {"ushort", PlyType::uint16},  {"int", PlyType::int32},      {"uint", PlyType::uint32},
               {"float", PlyType::float32},  {"double", PlyType::float64}, {"int8", PlyType::int8},
               {"uint8", PlyType::uint8},    {"int16", PlyType::int16},    {"uint16", PlyType::uint16},
               {"int32", PlyType::int32},    {"uint32", PlyType::uint32},  {"float32", PlyType::float32},
               {"float64", PlyType::float64}};
  for (const auto& type : types)
    if (type.name == name) return type.type;
  return std::nullopt;
}

class HeaderReader {
 public:
  HeaderReader(Bytes bytes, std::uint64_t file_size, const ModelSource& source)
      : bytes_(bytes), file_size_(file_size), text_(bytes, source) {}

  PlyHeader read() {
    if (text_.word() != "ply") text_.fail("a PLY file starts with \"ply\"");
    bool ended = false;
    while (!ended) {
      if (!text_.next_line()) text_.fail("the file ends within the header, before \"end_header\"");
      ended = statement(text_.word());
    }
    if (!has_format_) text_.fail("the header names no format");
    end_header();
    for (const PlyElement& element : header_.elements) check_room(element);
    return std::move(header_);
  }

 private:
  bool statement(std::string_view word) {
    if (word == "end_header") return true;
    if (word == "format") {
      format();
    } else if (word == "element") {
      element();
    } else if (word == "property") {
      property();
    } else if (word == "comment") {
      if (text_.word() == "TextureFile") header_.texture_files.emplace_back(text_.rest());
    } else if (word != "obj_info" && !word.empty() && header_.warnings.empty()) {
      // Some exporters forget the word "comment".
      header_.warnings.push_back(text_.place() + ": not a PLY header statement, passed over");
    }
    return false;
  }

  void format() {
    const std::string_view name = text_.word(), version = text_.word();
    if (name == "ascii") {
      header_.encoding = PlyEncoding::ascii;
    } else if (name == "binary_little_endian") {
      header_.encoding = PlyEncoding::little;
    } else if (name == "binary_big_endian") {
      header_.encoding = PlyEncoding::big;
    } else {
      text_.fail("unknown format " + in_quotes(name));
    }
    if (version != "1.0") text_.fail("only version 1.0 is known");
    has_format_ = true;
  }

  void element() {
    PlyElement element;
    element.name = text_.word();
    std::int64_t count = 0;
    if (element.name.empty() || !text_.integer(count) || count < 0) text_.fail("an element needs a name and a count");
    element.count = std::uint64_t(count);
    header_.elements.push_back(std::move(element));
  }

  void property() {
    if (header_.elements.empty()) text_.fail("a property before the first element");
    PlyProperty property;
    std::string_view type = text_.word();
    if (type == "list") {
      property.is_list = true;
      property.count_type = known_type(text_.word());
      if (!is_integer(property.count_type)) text_.fail("the length of a list must be an integer");
      type = text_.word();
    }
    property.type = known_type(type);
    property.name = text_.word();
    if (property.name.empty()) text_.fail("a property without a name");
    header_.elements.back().properties.push_back(std::move(property));
  }

  PlyType known_type(std::string_view name) {
    const auto type = type_of(name);
    if (!type) text_.fail("unknown type " + in_quotes(name));
    return *type;
  }

  /// Skips the end of the last line. A single \r ends the line only in files whose lines all end so. In other files, a
  /// \n behind the \r could not be told from the first byte of binary rows.
  void end_header() {
    text_.rest();
    const std::string_view text = text_of(bytes_);
    std::size_t at = text.size() - text_.bytes_left();
    const bool bare_returns = text.size() > 4 && text[3] == '\r' && text[4] != '\n';
    if (at < text.size() && text[at] == '\r') ++at;
    if (at < text.size() && text[at] == '\n' && !bare_returns) ++at;
    header_.size = bytes_.size() - text.size() + at;
    header_.line_count = text_.line();
  }

  /// Checks, before memory is allocated, that the rest of the file has room for the rows.
  void check_room(const PlyElement& element) const {
    const std::uint64_t room = file_size_ - header_.size;
    // A text value takes a digit and a separator, which the last value may lack.
    const std::uint64_t least =
        header_.encoding == PlyEncoding::ascii ? 2 * element.properties.size() : element.least_row_size();
    // Rows without properties take no room. Any number of them is allowed, and nothing is read for them.
    if (least == 0 || element.count <= (room + 1) / least) return;
    text_.source().fail("header", std::to_string(element.count) + " rows of element " + in_quotes(element.name) +
                                      " do not fit into the " + std::to_string(room) + " bytes that follow");
  }

  Bytes bytes_;
  std::uint64_t file_size_;
  TextScanner text_;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

std::size_t PlyElement::least_row_size() const {
  std::size_t size = 0;
  for (const PlyProperty& property : properties)
    size += size_of(property.is_list ? property.count_type : property.type);
  return size;
}

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(), [](const PlyProperty& p) { return p.is_list; });
}

PlyHeader read_ply_header(Bytes bytes, std::uint64_t file_size, const ModelSource& source) {
  return HeaderReader(bytes, file_size, source).read();
}

}  // namespace frontmost
