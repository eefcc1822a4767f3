// SPDX-License-Identifier: Apache-2.0
// ParameterValues and results of calls whose values are named by an enum, such as glLight and glGetLight, in every
// type.
//
// Integers stand for colors, normals and depths by their fraction of the greatest integer, and for others by their
// value.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "state/state.h"

namespace frontmost::gl_detail {

/// The number that a component of a color or normal stands for: the greatest integer is 1.
template <class T>
[[nodiscard]] constexpr float normalized(T v) {
  constexpr double most = std::is_integral_v<T> ? double(std::numeric_limits<T>::max()) : 1;
  if constexpr (!std::is_integral_v<T>) return float(v);
  return std::is_unsigned_v<T> ? float(double(v) / most) : float((2 * double(v) + 1) / (2 * most + 1));
}

template <class... Enums>
[[nodiscard]] constexpr bool is_one_of(GLenum value, Enums... enums) {
  return ((value == GLenum(enums)) || ...);
}

[[nodiscard]] constexpr bool is_color(GLenum pname) {
  return is_one_of(pname, GL_AMBIENT, GL_DIFFUSE, GL_SPECULAR, GL_EMISSION, GL_AMBIENT_AND_DIFFUSE,
                   GL_LIGHT_MODEL_AMBIENT, GL_FOG_COLOR, GL_TEXTURE_ENV_COLOR);
}

/// How many values a parameter has.
[[nodiscard]] constexpr int count_of(GLenum pname) {
  if (is_color(pname) || is_one_of(pname, GL_POSITION, GL_OBJECT_PLANE, GL_EYE_PLANE)) return 4;
  return is_one_of(pname, GL_SPOT_DIRECTION, GL_COLOR_INDEXES, GL_POINT_DISTANCE_ATTENUATION) ? 3 : 1;
}

/// What a call such as glLightfv sets a parameter to.
struct ParameterValues {
  std::array<float, 4> v{};
  int count = 1;  ///< how many values the call gave

  explicit ParameterValues(double value) : v{float(value)} {}
  template <class T>
  ParameterValues(GLenum pname, const T* values) : count(values ? count_of(pname) : 0) {
    for (int i = 0; i < count; ++i) v[std::size_t(i)] = is_color(pname) ? normalized(values[i]) : float(values[i]);
  }

  [[nodiscard]] bool fits(GLenum pname) const { return count == count_of(pname); }
  /// The first value as an enum; GL_INVALID_INDEX if it cannot be one.
  [[nodiscard]] GLenum name() const { return v[0] >= 0 && v[0] <= 65535 ? GLenum(v[0]) : GL_INVALID_INDEX; }
};

/// What a call such as glGetLightfv returns.
struct Results {
  int count = -1;  ///< -1 if there is no such parameter
  bool is_normalized = false;
  std::array<double, 16> v{};

  Results() = default;
  template <class... T>
  explicit Results(T... values) : count(int(sizeof...(T))), v{double(values)...} {}
  template <class T>
  static Results of(const T* values, int n) {
    Results r;
    r.count = n;
    for (int i = 0; i < n; ++i) r.v[std::size_t(i)] = double(values[i]);
    return r;
  }
  [[nodiscard]] Results as_normalized() const {
    Results r = *this;
    r.is_normalized = true;
    return r;
  }

  template <class T>
  [[nodiscard]] T at(int i) const {
    const double value = v[std::size_t(i)];
    if constexpr (std::is_floating_point_v<T>) return T(value);
    if constexpr (std::is_same_v<T, GLboolean>) return value != 0;
    const double whole = std::floor((is_normalized ? (4294967295.0 * value - 1) / 2 : value) + 0.5);
    return T(whole >= 2147483647 ? 2147483647 : whole > -2147483648.0 ? whole : -2147483648.0);
  }
  /// Writes all values to the client's memory.
  template <class T>
  void write(T* to) const {
    for (int i = 0; to && i < count; ++i) to[i] = at<T>(i);
  }
};

/// Where a parameter is stored, if it consists of count_of(pname) floats, or null.
[[nodiscard]] float* parameter_of(LightState& light, GLenum pname);
[[nodiscard]] float* parameter_of(MaterialState& material, GLenum pname);
[[nodiscard]] float* parameter_of(FogState& fog, GLenum pname);
[[nodiscard]] float* parameter_of(PointState& point, GLenum pname);
/// Where a parameter of glTexEnv that is an enum is stored, or null, and whether it may be `to`.
[[nodiscard]] std::pair<GLenum*, bool> environment_value(TextureUnitState& unit, GLenum pname, GLenum to);

/// Gives the current color to the materials that glColorMaterial chose, if GL_COLOR_MATERIAL is enabled.
void apply_color_material(State& state);

}  // namespace frontmost::gl_detail
