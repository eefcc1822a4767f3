// SPDX-License-Identifier: Apache-2.0
// The header of a PLY file, which describes its rows.
//
//   ply
//   format binary_little_endian 1.0
//   element vertex 8                       an element: a number of rows; rows are in the order of the elements
//   property float x                       a property: one number of each row
//   ...
//   element face 12
//   property list uchar int vertex_indices a list: the count, then so many numbers
//   end_header
//
// The rows become one mesh: all rows for read_ply(), some at a time for streams.
//
//   property float x      -> Role::x          a place in FloatRow, in which a row is gathered
//   property uchar red    -> Role::red        likewise, divided by the range of its type
//   property list ...     -> Role::corners    the polygon
//   property float curvature -> Role::none    skipped
//
// The readers are templates over the kind of rows (text, binary) and over the source of vertices. So the same code
// serves whole files and streams, without a test at each number.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "io/binary.h"
#include "io/models/coordinates.h"
#include "io/models/mesh_building.h"
#include "io/models/text.h"

namespace frontmost {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

[[nodiscard]] constexpr std::size_t size_of(PlyType type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[std::size_t(type)];
}
[[nodiscard]] constexpr bool is_integer(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  bool is_list = false;
  PlyType count_type = PlyType::uint8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// Returns the size of a row whose lists are empty. If there are no lists, each row has this size.
  [[nodiscard]] std::size_t least_row_size() const {
    std::size_t size = 0;
    for (const PlyProperty& property : properties)
      size += size_of(property.is_list ? property.count_type : property.type);
    return size;
  }
  [[nodiscard]] bool has_lists() const {
    return std::any_of(properties.begin(), properties.end(), [](const PlyProperty& p) { return p.is_list; });
  }
};

enum class PlyEncoding : std::uint8_t { ascii, little, big };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> texture_files;  ///< from "comment TextureFile NAME", as MeshLab writes them
  std::vector<std::string> warnings;
  std::size_t size = 0;        ///< bytes before the first row
  std::size_t line_count = 0;  ///< lines before the first row
};

/// Returns the byte order of a binary file's rows.
[[nodiscard]] inline Endian endian_of(const PlyHeader& header) {
  return header.encoding == PlyEncoding::big ? Endian::big : Endian::little;
}

/// Reads the header. `bytes` start the file and hold at least its header. The whole file has `file_size` bytes. \throws
/// Error file_malformed, also when the file is too short for the rows that the header promises.
[[nodiscard]] PlyHeader read_ply_header(Bytes bytes, std::uint64_t file_size, const ModelSource& source);

/// Adds materials for the texture files that the header names. The scene's first mesh uses them.
void add_texture_materials(const PlyHeader& header, const ModelSource& source, Scene& scene);

}  // namespace frontmost

namespace frontmost::ply {

/// Reads binary values in place, in either byte order. Rows of both kinds check that a value exists before they read
/// it, and name the element and the row in errors. Their interface:
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
    exact = next_as<double>(type);
    return float(exact);
  }
  float number(PlyType type) { return next_as<float>(type); }
  std::int64_t integer(PlyType type) { return next_as<std::int64_t>(type); }
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
  template <class Out>
  Out next_as(PlyType type) {
    switch (type) {
      case PlyType::int8: return Out(next<std::int8_t>());
      case PlyType::uint8: return Out(next<std::uint8_t>());
      case PlyType::int16: return Out(next<std::int16_t>());
      case PlyType::uint16: return Out(next<std::uint16_t>());
      case PlyType::int32: return Out(next<std::int32_t>());
      case PlyType::uint32: return Out(next<std::uint32_t>());
      case PlyType::float32: return Out(next<float>());
      case PlyType::float64: return Out(next<double>());
    }
    return 0;
  }
  template <class T>
  T next() {
    if (std::size_t(end_ - at_) < sizeof(T)) fail("the file ends within the row");
    const T value = read_value<T>(at_, endian_);
    at_ += sizeof(T);
    return value;
  }
  void release() {
    source_.release({released_, std::size_t(at_ - released_)});
    released_ = at_;
    check_cancelled(source_.execution());
  }

  static constexpr std::ptrdiff_t release_step = 1 << 20;
  const std::byte* at_;
  const std::byte* end_;
  const std::byte* released_;
  Endian endian_;
  const ModelSource& source_;
  const PlyElement* element_ = nullptr;
  std::uint64_t row_ = 0;
};

/// Reads text, in which each row is a line of its own.
class PlyAsciiRows {
 public:
  PlyAsciiRows(Bytes rows, std::size_t lines_before, const ModelSource& source)
      : text_(rows, source), lines_before_(lines_before) {}

  void begin_row(const PlyElement& element, std::uint64_t row) {
    element_ = &element;
    row_ = row;
    if (started_) text_.next_line();
    started_ = true;
    if (!text_.to_word()) fail("the file ends before this row");
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

/// The meaning of a property. The first twelve roles are places in a row of floats.
enum class Role : std::uint8_t { x, y, z, nx, ny, nz, u, v, red, green, blue, alpha, corners, wedge_uv, texture, none };
inline constexpr std::size_t float_roles = 12;

/// The names that programs use for each role but `none`, with a blank on both sides.
inline constexpr std::string_view role_names[] = {" x ",
                                                  " y ",
                                                  " z ",
                                                  " nx ",
                                                  " ny ",
                                                  " nz ",
                                                  " s u texture_u ",
                                                  " t v texture_v ",
                                                  " red r diffuse_red ",
                                                  " green g diffuse_green ",
                                                  " blue b diffuse_blue ",
                                                  " alpha a ",
                                                  " vertex_indices vertex_index ",
                                                  " texcoord ",
                                                  " texnumber "};

inline Role role_of(const PlyProperty& property) {
  const std::string name = " " + property.name + " ";
  for (std::size_t i = 0; i < std::size(role_names); ++i) {
    const bool is_list = Role(i) == Role::corners || Role(i) == Role::wedge_uv;
    if (is_list == property.is_list && role_names[i].find(name) != std::string_view::npos) return Role(i);
  }
  return Role::none;
}

/// A property, its role, and the greatest value of its type if it is a colour.
struct Column {
  PlyProperty property;
  Role role;
  float color_range;
};

struct Columns {
  std::vector<Column> list;

  explicit Columns(const PlyElement& element) {
    for (const PlyProperty& property : element.properties) {
      constexpr float ranges[] = {127, 255, 32767, 65535, 1, 1, 1, 1};
      list.push_back({property, role_of(property), ranges[std::size_t(property.type)]});
    }
  }
  [[nodiscard]] bool has(Role role) const {
    for (const Column& column : list)
      if (column.role == role) return true;
    return false;
  }
  [[nodiscard]] bool has_all(std::initializer_list<Role> roles) const {
    for (const Role role : roles)
      if (!has(role)) return false;
    return true;
  }
};

using FloatRow = std::array<float, float_roles>;

inline float& at(FloatRow& row, Role role) { return row[std::size_t(role)]; }
inline glm::vec3 three(const FloatRow& row, Role first) {
  const auto i = std::size_t(first);
  return {row[i], row[i + 1], row[i + 2]};
}
/// Returns texture coordinates, converted from those of PLY, in which v points up.
inline glm::vec2 texcoord(float u, float v) { return {u, 1.0f - v}; }
inline glm::vec4 color(const FloatRow& row) {
  return linear_color(glm::vec4(three(row, Role::red), row[std::size_t(Role::alpha)]));
}

/// Reads a value into `row` if its role has a place there. \returns false if it has none.
template <class Rows>
bool read_float(Rows& rows, const Column& column, FloatRow& row) {
  if (column.property.is_list || std::size_t(column.role) >= float_roles) return false;
  const bool is_color = column.role >= Role::red;
  row[std::size_t(column.role)] = rows.number(column.property.type) / (is_color ? column.color_range : 1.0f);
  return true;
}

template <class Rows>
std::uint64_t list_size(Rows& rows, const PlyProperty& property) {
  const std::int64_t size = rows.integer(property.count_type);
  if (size < 0) rows.fail("the length of a list is negative");
  rows.room_for(property.type, std::uint64_t(size));
  return std::uint64_t(size);
}

template <class Rows>
void skip_value(Rows& rows, const PlyProperty& property) {
  rows.skip(property.type, property.is_list ? list_size(rows, property) : 1);
}

/// Reads rows of one vertex element.
class VertexReader {
 public:
  VertexReader(const PlyElement& element, const ModelSource& source) : element_(element), columns_(element) {
    has_normals_ = columns_.has_all({Role::nx, Role::ny, Role::nz});
    has_texcoords_ = columns_.has_all({Role::u, Role::v});
    has_colors_ = columns_.has_all({Role::red, Role::green, Role::blue});
    if (!columns_.has_all({Role::x, Role::y, Role::z}))
      source.fail("header", "vertices need the properties x, y and z");
    if (element.count >= no_index) source.fail_limit("header", "too many vertices");
  }

  void reserve(std::size_t count, Mesh& mesh) const {
    mesh.positions.reserve(count);
    if (has_normals_) mesh.normals.values.reserve(count);
    if (has_texcoords_) mesh.texcoords.values.reserve(count);
    if (has_colors_) mesh.colors.values.reserve(count);
  }

  /// Appends rows [begin, end), which come next in `rows`.
  template <class Rows>
  void read(Rows& rows, std::uint64_t begin, std::uint64_t end, Coordinates& coordinates, Mesh& mesh) const {
    FloatRow row{};
    at(row, Role::alpha) = 1;
    glm::dvec3 exact(0);
    for (std::uint64_t i = begin; i < end; ++i) {
      rows.begin_row(element_, i);
      for (const Column& column : columns_.list)
        if (!read_coordinate(rows, column, row, exact) && !read_float(rows, column, row))
          skip_value(rows, column.property);
      mesh.positions.push_back(coordinates(three(row, Role::x), exact));
      if (has_normals_) mesh.normals.values.push_back(three(row, Role::nx));
      if (has_texcoords_) mesh.texcoords.values.push_back(texcoord(at(row, Role::u), at(row, Role::v)));
      if (has_colors_) mesh.colors.values.push_back(color(row));
    }
  }

 private:
  /// Reads a value into `row` and `exact` if it is a coordinate. \returns whether it is one.
  template <class Rows>
  static bool read_coordinate(Rows& rows, const Column& column, FloatRow& row, glm::dvec3& exact) {
    if (column.role > Role::z) return false;
    const auto axis = std::size_t(column.role);
    row[axis] = rows.number(column.property.type, exact[int(axis)]);
    return true;
  }

  const PlyElement& element_;
  Columns columns_;
  bool has_normals_ = false, has_texcoords_ = false, has_colors_ = false;
};

/// The vertices of a whole file, which have the same numbers in the mesh.
struct AllVertices {
  [[nodiscard]] std::uint64_t count(const Mesh& mesh) const { return mesh.positions.size(); }
  std::uint32_t operator()(std::uint64_t index, Mesh&) { return std::uint32_t(index); }
};

inline void check_index_type(const PlyElement& element, const Columns& columns, const ModelSource& source) {
  for (const Column& column : columns.list)
    if (column.role == Role::corners && !is_integer(column.property.type))
      source.fail("header", "the corners of element " + in_quotes(element.name) + " must be integers");
}

/// Reads faces and strips. `Rows` reads the rows of an element, as text or binary. `Vertices` tells the file's number
/// of vertices and converts their numbers to those of the mesh.
template <class Rows, class Vertices>
class FaceReader {
 public:
  FaceReader(Rows& rows, Vertices vertices, const PlyHeader& header, const ModelSource& source, Mesh& mesh)
      : rows_(rows), vertices_(std::move(vertices)), header_(header), source_(source), mesh_(mesh) {}

  void read_faces(const PlyElement& element, const Columns& columns, std::uint64_t begin, std::uint64_t end) {
    check_index_type(element, columns, source_);
    // Memory is reserved only once: each reserve() allocates the exact size, so thousands of elements would copy all
    // data each time.
    if (mesh_.triangles.empty()) mesh_.triangles.reserve(std::size_t(end - begin));
    FloatRow row{};
    at(row, Role::alpha) = 1;
    for (std::uint64_t i = begin; i < end; ++i) {
      rows_.begin_row(element, i);
      read_face(columns, row);
      finish_face(polygons_.add(corners_, mesh_.positions, mesh_), columns, row);
    }
  }

  void read_strips(const PlyElement& element, const Columns& columns) {
    check_index_type(element, columns, source_);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      rows_.begin_row(element, i);
      for (const Column& column : columns.list) {
        if (column.role != Role::corners) {
          skip_value(rows_, column.property);
          continue;
        }
        read_corners(column.property, true);
        add_strip();
      }
    }
  }

  /// Completes the mesh. Colours of vertices have precedence over those of faces. Strips behind the faces get default
  /// values.
  void finish() {
    if (mesh_.colors.empty()) mesh_.colors = std::move(face_colors_);
    const std::size_t count = mesh_.triangles.size();
    if (!mesh_.colors.triangles.empty()) mesh_.colors.triangles.resize(count);
    if (!mesh_.texcoords.triangles.empty()) mesh_.texcoords.triangles.resize(count);
    if (!mesh_.material_ids.empty()) mesh_.material_ids.resize(count, no_index);
  }
  [[nodiscard]] std::uint64_t skipped_count() const { return polygons_.skipped_count(); }

 private:
  void read_face(const Columns& columns, FloatRow& row) {
    wedges_.clear();
    for (const Column& column : columns.list) {
      if (column.role == Role::corners) {
        read_corners(column.property, false);
      } else if (column.role == Role::wedge_uv) {
        wedges_.resize(list_size(rows_, column.property));
        for (float& value : wedges_) value = rows_.number(column.property.type);
      } else if (column.role == Role::texture && is_integer(column.property.type)) {
        texture_ = std::uint32_t(rows_.integer(column.property.type));
      } else if (!read_float(rows_, column, row)) {
        skip_value(rows_, column.property);
      }
    }
  }

  void read_corners(const PlyProperty& property, bool strips) {
    corners_.resize(list_size(rows_, property));
    const std::uint64_t count = vertices_.count(mesh_);
    for (std::uint32_t& corner : corners_) {
      const std::int64_t index = rows_.integer(property.type);
      const bool restart = strips && index == -1;
      if (!restart && (index < 0 || std::uint64_t(index) >= count))
        rows_.fail("vertex " + std::to_string(index) + " is out of range, there are " + std::to_string(count) +
                   (count == 0 ? " before the faces" : ""));
      corner = restart ? no_index : vertices_(std::uint64_t(index), mesh_);
    }
  }

  void add_strip() {
    std::size_t begin = 0;
    for (std::size_t k = 0; k < corners_.size(); ++k) {
      if (corners_[k] == no_index) begin = k + 1;
      if (k < begin + 2) continue;
      const bool odd = ((k - begin) & 1) != 0;
      const std::uint32_t triangle[3] = {corners_[odd ? k - 1 : k - 2], corners_[odd ? k - 2 : k - 1], corners_[k]};
      polygons_.add(triangle, mesh_.positions, mesh_);
    }
  }

  void add_wedges(std::span<const glm::uvec3> triangles) {
    auto& uvs = mesh_.texcoords;
    const bool usable = wedges_.size() == 2 * corners_.size();
    const auto first = std::uint32_t(uvs.values.size());
    for (std::size_t i = 0; i < corners_.size(); ++i)
      uvs.values.push_back(usable ? texcoord(wedges_[2 * i], wedges_[2 * i + 1]) : glm::vec2(0));
    // Strips before the faces have no texture coordinates.
    uvs.triangles.resize(mesh_.triangles.size() - triangles.size());
    for (const glm::uvec3& t : triangles) uvs.triangles.push_back(first + t);
  }

  void finish_face(std::span<const glm::uvec3> triangles, const Columns& columns, const FloatRow& row) {
    if (columns.has(Role::wedge_uv)) add_wedges(triangles);
    if (columns.has(Role::red) && !triangles.empty()) {
      const auto number = std::uint32_t(face_colors_.values.size());
      face_colors_.values.push_back(color(row));
      face_colors_.triangles.resize(mesh_.triangles.size(), glm::uvec3(number));
    }
    if (header_.texture_files.size() > 1)
      mesh_.material_ids.resize(mesh_.triangles.size(), texture_ < header_.texture_files.size() ? texture_ : no_index);
  }

  Rows& rows_;
  Vertices vertices_;
  const PlyHeader& header_;
  const ModelSource& source_;
  Mesh& mesh_;
  PolygonWriter polygons_;
  Attribute<glm::vec4> face_colors_;
  std::vector<std::uint32_t> corners_;
  std::vector<float> wedges_;
  std::uint32_t texture_ = no_index;
};

}  // namespace frontmost::ply
