// SPDX-License-Identifier: Apache-2.0
// PLY: vertices, polygons and triangle strips become one mesh; other elements are passed over.
#include <array>

#include "base/parallel.h"
#include "io/models/mesh_building.h"
#include "io/models/ply_rows.h"
#include "io/models/texture_files.h"

namespace frontmost {
namespace {

/// What a property is to us. The first twelve are places in a row of floats.
enum class Role : std::uint8_t { x, y, z, nx, ny, nz, u, v, red, green, blue, alpha, corners, wedge_uv, texture, none };
constexpr std::size_t float_roles = 12;

struct RoleName {
  std::string_view name;
  Role role;
};

constexpr RoleName scalar_names[] = {{"x", Role::x},
                                     {"y", Role::y},
                                     {"z", Role::z},
                                     {"nx", Role::nx},
                                     {"ny", Role::ny},
                                     {"nz", Role::nz},
                                     {"s", Role::u},
                                     {"t", Role::v},
                                     {"u", Role::u},
                                     {"v", Role::v},
                                     {"texture_u", Role::u},
                                     {"texture_v", Role::v},
                                     {"red", Role::red},
                                     {"green", Role::green},
                                     {"blue", Role::blue},
                                     {"r", Role::red},
                                     {"g", Role::green},
                                     {"b", Role::blue},
                                     {"diffuse_red", Role::red},
                                     {"diffuse_green", Role::green},
                                     {"diffuse_blue", Role::blue},
                                     {"alpha", Role::alpha},
                                     {"a", Role::alpha},
                                     {"texnumber", Role::texture}};
constexpr RoleName list_names[] = {
    {"vertex_indices", Role::corners}, {"vertex_index", Role::corners}, {"texcoord", Role::wedge_uv}};

Role role_of(const PlyProperty& property) {
  const auto find = [&](const auto& names) {
    for (const RoleName& name : names)
      if (name.name == property.name) return name.role;
    return Role::none;
  };
  return property.is_list ? find(list_names) : find(scalar_names);
}

/// A property, its role, and what its greatest number is if it is a colour.
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

float& at(FloatRow& row, Role role) { return row[std::size_t(role)]; }
glm::vec3 three(const FloatRow& row, Role first) {
  const auto i = std::size_t(first);
  return {row[i], row[i + 1], row[i + 2]};
}
/// Texture coordinates of PLY have v going up.
glm::vec2 texcoord(float u, float v) { return {u, 1.0f - v}; }
glm::vec4 color(const FloatRow& row) {
  return linear_color(glm::vec4(three(row, Role::red), row[std::size_t(Role::alpha)]));
}

/// Reads the rows of all elements. `Rows` is one of the classes of ply_rows.h.
template <class Rows>
class PlyBody {
 public:
  PlyBody(Rows rows, const PlyHeader& header, const ModelSource& source, Scene& scene)
      : rows_(std::move(rows)),
        header_(header),
        source_(source),
        scene_(scene),
        mesh_(add_object(scene, "", source, "header")) {}

  void read() {
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else if (element.name == "tristrips") {
        read_strips(element);
      } else {
        skip(element);
      }
    }
    if (polygons_.skipped_count() > 0)
      scene_.warnings.push_back("faces: " + std::to_string(polygons_.skipped_count()) +
                                " with fewer than three corners were passed over");
    finish();
  }

 private:
  void read_vertices(const PlyElement& element);
  void read_faces(const PlyElement& element);
  void read_strips(const PlyElement& element);
  void skip(const PlyElement& element);

  /// Reads a scalar into `row` if its role has a place there. \returns whether it had one.
  bool read_float(const Column& column, FloatRow& row) {
    if (column.property.is_list || std::size_t(column.role) >= float_roles) return false;
    const bool is_color = column.role >= Role::red;
    row[std::size_t(column.role)] = rows_.number(column.property.type) / (is_color ? column.color_range : 1.0f);
    return true;
  }
  void skip_value(const PlyProperty& property) {
    rows_.skip(property.type, property.is_list ? list_size(property) : 1);
  }
  std::uint64_t list_size(const PlyProperty& property) {
    const std::int64_t size = rows_.integer(property.count_type);
    if (size < 0) rows_.fail("a list of negative length");
    rows_.room_for(property.type, std::uint64_t(size));
    return std::uint64_t(size);
  }
  void read_corners(const PlyProperty& property, bool strips);
  void check_index_type(const PlyElement& element, const Columns& columns) const;
  void add_wedges(std::span<const glm::uvec3> triangles);
  void finish_face(std::span<const glm::uvec3> triangles, const Columns& columns, const FloatRow& row);
  void finish();

  Rows rows_;
  const PlyHeader& header_;
  const ModelSource& source_;
  Scene& scene_;
  Mesh& mesh_;
  PolygonWriter polygons_;
  Attribute<glm::vec4> face_colors_;
  std::vector<std::uint32_t> corners_;
  std::vector<float> wedges_;
  std::uint32_t texture_ = no_index;
};

template <class Rows>
void PlyBody<Rows>::skip(const PlyElement& element) {
  if (element.properties.empty()) return;
  for (std::uint64_t row = 0; row < element.count; ++row) {
    rows_.begin_row(element, row);
    for (const PlyProperty& property : element.properties) skip_value(property);
  }
}

template <class Rows>
void PlyBody<Rows>::read_vertices(const PlyElement& element) {
  const Columns columns(element);
  const bool normals = columns.has_all({Role::nx, Role::ny, Role::nz}), uvs = columns.has_all({Role::u, Role::v}),
             colors = columns.has_all({Role::red, Role::green, Role::blue});
  if (!columns.has_all({Role::x, Role::y, Role::z})) source_.fail("header", "vertices need the properties x, y and z");
  if (element.count + mesh_.positions.size() >= no_index) source_.fail_limit("header", "too many vertices");
  const auto count = std::size_t(element.count);
  mesh_.positions.reserve(count);
  if (normals) mesh_.normals.values.reserve(count);
  if (uvs) mesh_.texcoords.values.reserve(count);
  if (colors) mesh_.colors.values.reserve(count);
  FloatRow row{};
  at(row, Role::alpha) = 1;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    rows_.begin_row(element, i);
    for (const Column& column : columns.list)
      if (!read_float(column, row)) skip_value(column.property);
    mesh_.positions.push_back(three(row, Role::x));
    if (normals) mesh_.normals.values.push_back(three(row, Role::nx));
    if (uvs) mesh_.texcoords.values.push_back(texcoord(at(row, Role::u), at(row, Role::v)));
    if (colors) mesh_.colors.values.push_back(color(row));
  }
}

template <class Rows>
void PlyBody<Rows>::check_index_type(const PlyElement& element, const Columns& columns) const {
  for (const Column& column : columns.list)
    if (column.role == Role::corners && !is_integer(column.property.type))
      source_.fail("header", "the corners of element " + in_quotes(element.name) + " must be integers");
}

template <class Rows>
void PlyBody<Rows>::read_faces(const PlyElement& element) {
  const Columns columns(element);
  if (!columns.has(Role::corners)) return skip(element);
  check_index_type(element, columns);
  // Only once: reserve() takes no more than is asked for, so that thousands of elements would move all each time.
  if (mesh_.triangles.empty()) mesh_.triangles.reserve(std::size_t(element.count));
  FloatRow row{};
  at(row, Role::alpha) = 1;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    rows_.begin_row(element, i);
    wedges_.clear();
    for (const Column& column : columns.list) {
      if (column.role == Role::corners) {
        read_corners(column.property, false);
      } else if (column.role == Role::wedge_uv) {
        wedges_.resize(list_size(column.property));
        for (float& value : wedges_) value = rows_.number(column.property.type);
      } else if (column.role == Role::texture && is_integer(column.property.type)) {
        texture_ = std::uint32_t(rows_.integer(column.property.type));
      } else if (!read_float(column, row)) {
        skip_value(column.property);
      }
    }
    finish_face(polygons_.add(corners_, mesh_.positions, mesh_), columns, row);
  }
}

template <class Rows>
void PlyBody<Rows>::read_corners(const PlyProperty& property, bool strips) {
  corners_.resize(list_size(property));
  for (std::uint32_t& corner : corners_) {
    const std::int64_t index = rows_.integer(property.type);
    const bool restart = strips && index == -1;
    if (!restart && (index < 0 || std::uint64_t(index) >= mesh_.positions.size()))
      rows_.fail("vertex " + std::to_string(index) + " is out of range, there are " +
                 std::to_string(mesh_.positions.size()) + (mesh_.positions.empty() ? " before the faces" : ""));
    corner = restart ? no_index : std::uint32_t(index);
  }
}

template <class Rows>
void PlyBody<Rows>::add_wedges(std::span<const glm::uvec3> triangles) {
  auto& uvs = mesh_.texcoords;
  const bool usable = wedges_.size() == 2 * corners_.size();
  const auto first = std::uint32_t(uvs.values.size());
  for (std::size_t i = 0; i < corners_.size(); ++i)
    uvs.values.push_back(usable ? texcoord(wedges_[2 * i], wedges_[2 * i + 1]) : glm::vec2(0));
  // Strips before the faces have none.
  uvs.triangles.resize(mesh_.triangles.size() - triangles.size());
  for (const glm::uvec3& t : triangles) uvs.triangles.push_back(first + t);
}

template <class Rows>
void PlyBody<Rows>::finish_face(std::span<const glm::uvec3> triangles, const Columns& columns, const FloatRow& row) {
  if (columns.has(Role::wedge_uv)) add_wedges(triangles);
  if (columns.has(Role::red) && !triangles.empty()) {
    const auto number = std::uint32_t(face_colors_.values.size());
    face_colors_.values.push_back(color(row));
    face_colors_.triangles.resize(mesh_.triangles.size(), glm::uvec3(number));
  }
  if (header_.texture_files.size() > 1)
    mesh_.material_ids.resize(mesh_.triangles.size(), texture_ < header_.texture_files.size() ? texture_ : no_index);
}

/// Colours of vertices go before those of faces. What strips after the faces lack is filled up.
template <class Rows>
void PlyBody<Rows>::finish() {
  if (mesh_.colors.empty()) mesh_.colors = std::move(face_colors_);
  const std::size_t count = mesh_.triangles.size();
  if (!mesh_.colors.triangles.empty()) mesh_.colors.triangles.resize(count);
  if (!mesh_.texcoords.triangles.empty()) mesh_.texcoords.triangles.resize(count);
  if (!mesh_.material_ids.empty()) mesh_.material_ids.resize(count, no_index);
}

template <class Rows>
void PlyBody<Rows>::read_strips(const PlyElement& element) {
  const Columns columns(element);
  if (!columns.has(Role::corners)) return skip(element);
  check_index_type(element, columns);
  for (std::uint64_t i = 0; i < element.count; ++i) {
    rows_.begin_row(element, i);
    for (const Column& column : columns.list) {
      if (column.role != Role::corners) {
        skip_value(column.property);
        continue;
      }
      read_corners(column.property, true);
      // Every second triangle of a strip has its first two corners swapped, so that all face the same way.
      std::size_t begin = 0;
      for (std::size_t k = 0; k < corners_.size(); ++k) {
        if (corners_[k] == no_index) begin = k + 1;
        if (k < begin + 2) continue;
        const bool odd = ((k - begin) & 1) != 0;
        const std::uint32_t triangle[3] = {corners_[odd ? k - 1 : k - 2], corners_[odd ? k - 2 : k - 1], corners_[k]};
        polygons_.add(triangle, mesh_.positions, mesh_);
      }
    }
  }
}

void add_texture_materials(const PlyHeader& header, const ModelSource& source, Scene& scene) {
  if (header.texture_files.empty()) return;
  TextureFiles textures(source, scene);
  for (const std::string& file : header.texture_files) {
    Material& material = scene.materials.emplace_back();
    material.name = std::filesystem::path(file).stem().string();
    material.base_color_texture.texture = textures.get(file, "header");
  }
  if (scene.meshes[0].material_ids.empty()) scene.meshes[0].material_ids = {0};
}

}  // namespace

void PlyBinaryRows::release() {
  source_.release({released_, std::size_t(at_ - released_)});
  released_ = at_;
  check_cancelled(source_.execution());
}

Scene read_ply(Bytes bytes, const ModelSource& source) {
  const PlyHeader header = read_ply_header(bytes, source);
  Scene scene;
  scene.warnings = header.warnings;
  const Bytes rows = bytes.subspan(header.size);
  if (header.encoding == PlyEncoding::ascii) {
    PlyBody(PlyAsciiRows(rows, header.line_count, source), header, source, scene).read();
  } else {
    const Endian endian = header.encoding == PlyEncoding::little ? Endian::little : Endian::big;
    PlyBody(PlyBinaryRows(rows, endian, source), header, source, scene).read();
  }
  add_texture_materials(header, source, scene);
  return scene;
}

}  // namespace frontmost
