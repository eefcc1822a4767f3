// SPDX-License-Identifier: Apache-2.0
// Meaning of the properties of a PLY file.
//
//   property float x      -> Role::x          a place in FloatRow, in which a row is gathered
//   property uchar red    -> Role::red        likewise, divided by the range of its type
//   property list ...     -> Role::corners    the polygon
//   property float curvature -> Role::none    skipped
//
// Programs use different names (s, u and texture_u mean the same), so a table lists them.
#pragma once

#include <array>

#include "io/models/mesh_building.h"
#include "io/models/ply/ply_header.h"

namespace frontmost::ply {

/// Meaning of a property. The first twelve roles are places in a row of floats.
enum class Role : std::uint8_t { x, y, z, nx, ny, nz, u, v, red, green, blue, alpha, corners, wedge_uv, texture, none };
inline constexpr std::size_t float_roles = 12;

struct RoleName {
  std::string_view name;
  Role role;
};

inline constexpr RoleName scalar_names[] = {{"x", Role::x},
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
inline constexpr RoleName list_names[] = {
    {"vertex_indices", Role::corners}, {"vertex_index", Role::corners}, {"texcoord", Role::wedge_uv}};

inline Role role_of(const PlyProperty& property) {
  const auto find = [&](const auto& names) {
    for (const RoleName& name : names)
      if (name.name == property.name) return name.role;
    return Role::none;
  };
  return property.is_list ? find(list_names) : find(scalar_names);
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
/// Texture coordinates, converted from PLY, where v points up.
inline glm::vec2 texcoord(float u, float v) { return {u, 1.0f - v}; }
inline glm::vec4 color(const FloatRow& row) {
  return linear_color(glm::vec4(three(row, Role::red), row[std::size_t(Role::alpha)]));
}

}  // namespace frontmost::ply
