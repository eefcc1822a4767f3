// SPDX-License-Identifier: Apache-2.0
// Turns the rows of a PLY file into one mesh: all rows for read_ply(), some at a time for streams.
//
// The readers are templates over the kind of rows (text, binary) and over the source of vertices. So the same code
// serves whole files and streams, without a test at each number.
#pragma once

#include "io/models/coordinates.h"
#include "io/models/ply/ply_columns.h"
#include "io/models/ply/ply_rows.h"

namespace frontmost::ply {

/// Reads a value into `row` if its role has a place there. \returns whether it has one.
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
  if (size < 0) rows.fail("a list of negative length");
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

/// Vertices are numbered as in the file.
struct AllVertices {
  [[nodiscard]] std::uint64_t count(const Mesh& mesh) const { return mesh.positions.size(); }
  std::uint32_t operator()(std::uint64_t index, Mesh&) { return std::uint32_t(index); }
};

inline void check_index_type(const PlyElement& element, const Columns& columns, const ModelSource& source) {
  for (const Column& column : columns.list)
    if (column.role == Role::corners && !is_integer(column.property.type))
      source.fail("header", "the corners of element " + in_quotes(element.name) + " must be integers");
}

/// Reads faces and strips. `Rows` is a class of ply_rows.h. `Vertices` tells the file's number of vertices and converts
/// their numbers to those of the mesh.
template <class Rows, class Vertices>
class FaceReader {
 public:
  FaceReader(Rows& rows, Vertices vertices, const PlyHeader& header, const ModelSource& source, Mesh& mesh)
      : rows_(rows), vertices_(std::move(vertices)), header_(header), source_(source), mesh_(mesh) {}

  void read_faces(const PlyElement& element, const Columns& columns, std::uint64_t begin, std::uint64_t end);
  void read_strips(const PlyElement& element, const Columns& columns);
  /// Completes the mesh. Colours of vertices have precedence over those of faces. Strips behind the faces get default
  /// values.
  void finish();
  [[nodiscard]] std::uint64_t skipped_count() const { return polygons_.skipped_count(); }

 private:
  void read_face(const Columns& columns, FloatRow& row);
  void read_corners(const PlyProperty& property, bool strips);
  void add_strip();
  void add_wedges(std::span<const glm::uvec3> triangles);
  void finish_face(std::span<const glm::uvec3> triangles, const Columns& columns, const FloatRow& row);

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

template <class Rows, class Vertices>
void FaceReader<Rows, Vertices>::read_faces(const PlyElement& element, const Columns& columns, std::uint64_t begin,
                                            std::uint64_t end) {
  check_index_type(element, columns, source_);
  // Memory is reserved only once: each reserve() allocates the exact size, so thousands of elements would copy all data
  // each time.
  if (mesh_.triangles.empty()) mesh_.triangles.reserve(std::size_t(end - begin));
  FloatRow row{};
  at(row, Role::alpha) = 1;
  for (std::uint64_t i = begin; i < end; ++i) {
    rows_.begin_row(element, i);
    read_face(columns, row);
    finish_face(polygons_.add(corners_, mesh_.positions, mesh_), columns, row);
  }
}

template <class Rows, class Vertices>
void FaceReader<Rows, Vertices>::read_face(const Columns& columns, FloatRow& row) {
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

template <class Rows, class Vertices>
void FaceReader<Rows, Vertices>::read_corners(const PlyProperty& property, bool strips) {
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

template <class Rows, class Vertices>
void FaceReader<Rows, Vertices>::add_wedges(std::span<const glm::uvec3> triangles) {
  auto& uvs = mesh_.texcoords;
  const bool usable = wedges_.size() == 2 * corners_.size();
  const auto first = std::uint32_t(uvs.values.size());
  for (std::size_t i = 0; i < corners_.size(); ++i)
    uvs.values.push_back(usable ? texcoord(wedges_[2 * i], wedges_[2 * i + 1]) : glm::vec2(0));
  // Strips before the faces have no texture coordinates.
  uvs.triangles.resize(mesh_.triangles.size() - triangles.size());
  for (const glm::uvec3& t : triangles) uvs.triangles.push_back(first + t);
}

template <class Rows, class Vertices>
void FaceReader<Rows, Vertices>::finish_face(std::span<const glm::uvec3> triangles, const Columns& columns,
                                             const FloatRow& row) {
  if (columns.has(Role::wedge_uv)) add_wedges(triangles);
  if (columns.has(Role::red) && !triangles.empty()) {
    const auto number = std::uint32_t(face_colors_.values.size());
    face_colors_.values.push_back(color(row));
    face_colors_.triangles.resize(mesh_.triangles.size(), glm::uvec3(number));
  }
  if (header_.texture_files.size() > 1)
    mesh_.material_ids.resize(mesh_.triangles.size(), texture_ < header_.texture_files.size() ? texture_ : no_index);
}

template <class Rows, class Vertices>
void FaceReader<Rows, Vertices>::finish() {
  if (mesh_.colors.empty()) mesh_.colors = std::move(face_colors_);
  const std::size_t count = mesh_.triangles.size();
  if (!mesh_.colors.triangles.empty()) mesh_.colors.triangles.resize(count);
  if (!mesh_.texcoords.triangles.empty()) mesh_.texcoords.triangles.resize(count);
  if (!mesh_.material_ids.empty()) mesh_.material_ids.resize(count, no_index);
}

template <class Rows, class Vertices>
void FaceReader<Rows, Vertices>::read_strips(const PlyElement& element, const Columns& columns) {
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

/// Adds a strip. Every second triangle has its first two corners swapped, so that all have the same winding.
template <class Rows, class Vertices>
void FaceReader<Rows, Vertices>::add_strip() {
  std::size_t begin = 0;
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    if (corners_[k] == no_index) begin = k + 1;
    if (k < begin + 2) continue;
    const bool odd = ((k - begin) & 1) != 0;
    const std::uint32_t triangle[3] = {corners_[odd ? k - 1 : k - 2], corners_[odd ? k - 2 : k - 1], corners_[k]};
    polygons_.add(triangle, mesh_.positions, mesh_);
  }
}

}  // namespace frontmost::ply
