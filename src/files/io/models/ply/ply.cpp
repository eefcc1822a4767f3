// SPDX-License-Identifier: Apache-2.0
// PLY: its header, and whole files. Vertices, polygons and triangle strips become one mesh; other elements are skipped.
//
// G. Turk. The PLY Polygon File Format. 1994.
#include <algorithm>
#include <optional>

#include "io/models/ply/ply_mesh.h"
#include "io/models/textures.h"

namespace frontmost {
namespace {

using namespace ply;

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

class PlyHeaderReader {
 public:
  PlyHeaderReader(Bytes bytes, std::uint64_t file_size, const ModelSource& source)
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
    if (version != "1.0") text_.fail("only PLY version 1.0 is supported");
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

/// Reads the rows of all elements into a mesh of the scene.
template <class Rows>
void read_rows(Rows rows, const PlyHeader& header, const ModelSource& source, Coordinates& coordinates, Scene& scene) {
  Mesh& mesh = add_object(scene, "", source, "header");
  FaceReader<Rows, AllVertices> faces(rows, {}, header, source, mesh);
  for (const PlyElement& element : header.elements) {
    const Columns columns(element);
    if (element.name == "vertex") {
      const VertexReader vertices(element, source);
      if (element.count + mesh.positions.size() >= no_index) source.fail_limit("header", "too many vertices");
      vertices.reserve(std::size_t(element.count), mesh);
      vertices.read(rows, 0, element.count, coordinates, mesh);
    } else if (element.name == "face" && columns.has(Role::corners)) {
      faces.read_faces(element, columns, 0, element.count);
    } else if (element.name == "tristrips" && columns.has(Role::corners)) {
      faces.read_strips(element, columns);
    } else if (!element.properties.empty()) {
      // Elements without properties are skipped at once: a header of a hundred bytes could ask for 2^64 empty rows.
      for (std::uint64_t row = 0; row < element.count; ++row) {
        rows.begin_row(element, row);
        for (const PlyProperty& property : element.properties) skip_value(rows, property);
      }
    }
  }
  if (faces.skipped_count() > 0) scene.warnings.push_back(skipped_faces_warning(faces.skipped_count()));
  faces.finish();
}

}  // namespace

PlyHeader read_ply_header(Bytes bytes, std::uint64_t file_size, const ModelSource& source) {
  return PlyHeaderReader(bytes, file_size, source).read();
}

void add_texture_materials(const PlyHeader& header, const ModelSource& source, Scene& scene) {
  if (header.texture_files.empty()) return;
  TextureFiles textures(source, scene);
  for (const std::string& file : header.texture_files) {
    Material& material = scene.materials.emplace_back();
    material.name = std::filesystem::path(file).stem().string();
    material.base_color_texture.texture = textures.get({.color = file}, "header").texture;
  }
  if (scene.meshes[0].material_ids.empty()) scene.meshes[0].material_ids = {0};
}

Scene read_ply(Bytes bytes, const ModelSource& source) {
  const PlyHeader header = read_ply_header(bytes, bytes.size(), source);
  const Bytes rows = bytes.subspan(header.size);
  Scene scene = read_about_origin([&](Coordinates& coordinates) {
    Scene read;
    read.warnings = header.warnings;
    if (header.encoding == PlyEncoding::ascii) {
      read_rows(PlyAsciiRows(rows, header.line_count, source), header, source, coordinates, read);
    } else {
      read_rows(PlyBinaryRows(rows, endian_of(header), source), header, source, coordinates, read);
    }
    return read;
  });
  add_texture_materials(header, source, scene);
  return scene;
}

}  // namespace frontmost
