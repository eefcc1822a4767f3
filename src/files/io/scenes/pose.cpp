// SPDX-License-Identifier: Apache-2.0
// The pose of an object of a scene file: a matrix by rows, as in pose files of cameras, or the separate parts that glTF
// and data sets use.
//
//   "pose": 16 or 12 numbers, or rows of four, or the name of a file that holds them
//   "translation": 3 numbers    "rotation": 4 (a quaternion x, y, z, w) or 9 (a matrix by rows)    "scale": 1 or 3
#include <cmath>

#include "io/models/gltf/nodes.h"
#include "io/models/text/number.h"
#include "io/scenes/scene_file.h"

namespace frontmost {
namespace {

using gltf::JsonValue;

/// Limit of numbers: beyond it, placed vertices do not fit into floats.
constexpr double largest = 1e30;

void append_number(const JsonValue& value, std::vector<double>& numbers) {
  const double number = value.to_number();
  if (!(std::abs(number) <= largest)) value.fail("the number is not between -1e30 and 1e30");
  numbers.push_back(number);
}

/// The numbers of a list, or of a list of rows.
std::vector<double> numbers_in(const JsonValue& value) {
  constexpr std::size_t most = 16;
  std::vector<double> numbers;
  if (value.size() > most) value.fail("more than 16 numbers");
  for (std::size_t i = 0; i < value.size(); ++i) {
    const JsonValue row = value[i];
    if (row.is_number()) {
      append_number(row, numbers);
      continue;
    }
    if (row.size() > most) row.fail("more than 16 numbers");
    for (std::size_t k = 0; k < row.size(); ++k) append_number(row[k], numbers);
  }
  return numbers;
}

/// The numbers in the file `name`, with any of the separators that pose files of cameras allow.
std::vector<double> numbers_in_file(const JsonValue& name) {
  constexpr std::uint64_t most_bytes = 1 << 16;
  constexpr std::string_view separators = " \t\r\n,;[]()";
  const InputFile file = name.source().open(name.to_string(), most_bytes);
  std::string_view text = text_of(file.bytes());
  std::vector<double> numbers;
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(separators), text.size()));
    if (text.empty()) return numbers;
    const std::string_view word = text.substr(0, text.find_first_of(separators));
    double number = 0;
    const char* const end = word.data() + word.size();
    if (parse_double(word.data(), end, number) != end || !(std::abs(number) <= largest))
      name.fail(in_quotes(word) + " in that file is not a number between -1e30 and 1e30");
    numbers.push_back(number);
    text.remove_prefix(word.size());
  }
}

glm::dmat4 matrix_by_rows(const JsonValue& place, const std::vector<double>& numbers) {
  if (numbers.size() != 12 && numbers.size() != 16)
    place.fail(std::to_string(numbers.size()) + " numbers; a pose is 16 (or 12), row by row");
  glm::dmat4 matrix(1.0);
  for (std::size_t i = 0; i < numbers.size(); ++i) matrix[int(i % 4)][int(i / 4)] = numbers[i];
  for (int column = 0; column < 4; ++column)
    if (matrix[column][3] != (column == 3 ? 1 : 0)) place.fail("the last row is not 0 0 0 1");
  return matrix;
}

void refuse_singular(const JsonValue& place, const glm::dmat4& pose) {
  const double volume = glm::determinant(glm::dmat3(pose));
  if (!(std::abs(volume) > 0 && std::isfinite(volume))) place.fail("the pose flattens what it places, or is too large");
}

glm::dmat4 inverse_of(const JsonValue& place, const glm::dmat4& pose) {
  const glm::dmat3 turned = glm::inverse(glm::dmat3(pose));
  glm::dmat4 inverse(turned);
  inverse[3] = glm::dvec4(-(turned * glm::dvec3(pose[3])), 1);
  refuse_singular(place, inverse);
  if (!is_finite(glm::dvec3(inverse[3]))) place.fail("its inverse is too large");
  return inverse;
}

glm::dmat4 read_matrix(const JsonValue& object, const JsonValue& value) {
  const glm::dmat4 pose = matrix_by_rows(value, value.is_string() ? numbers_in_file(value) : numbers_in(value));
  refuse_singular(value, pose);
  const std::string convention = object.string_or_empty("pose_convention");
  if (convention.empty() || convention == "model-to-world") return pose;
  if (convention == "world-to-model") return inverse_of(value, pose);
  object.require("pose_convention").fail("must be model-to-world or world-to-model");
}

/// A rotation by nine numbers, orthonormal within the rounding errors of data sets.
glm::dmat4 rotation_by_rows(const JsonValue& place, const std::vector<double>& numbers) {
  constexpr double tolerance = 1e-4;
  glm::dmat3 rotation;
  for (std::size_t i = 0; i < 9; ++i) rotation[int(i % 3)][int(i / 3)] = numbers[i];
  const glm::dmat3 square = glm::transpose(rotation) * rotation;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(square[i][k] - (i == k ? 1 : 0)) <= tolerance)) place.fail("is not a rotation");
  if (!(glm::determinant(rotation) > 0)) place.fail("is a rotation and a mirror");
  return glm::dmat4(rotation);
}

glm::dmat4 read_rotation(const JsonValue& value) {
  const std::vector<double> numbers = numbers_in(value);
  if (numbers.size() == 9) return rotation_by_rows(value, numbers);
  if (numbers.size() != 4)
    value.fail(std::to_string(numbers.size()) + " numbers; a rotation is 4 (x, y, z, w) or 9, row by row");
  const glm::dvec4 quaternion(numbers[0], numbers[1], numbers[2], numbers[3]);
  const double length = glm::length(quaternion);
  if (!(length > 0 && std::isfinite(length))) value.fail("the quaternion has no length");
  return gltf::compose(glm::dvec3(0), quaternion, glm::dvec3(1));
}

}  // namespace

glm::dmat4 read_pose(const JsonValue& object) {
  if (const std::optional<JsonValue> pose = object.find("pose")) {
    for (const char* const other : {"translation", "rotation", "scale"})
      if (has(object, other)) pose->fail(std::string("is given beside ") + other + "; give only one of them");
    return read_matrix(object, *pose);
  }
  if (const auto convention = object.find("pose_convention")) convention->fail("there is no pose");
  glm::dmat4 moved(1.0), scaled(1.0);
  if (const std::optional<JsonValue> value = object.find("translation")) {
    const std::vector<double> by = numbers_in(*value);
    if (by.size() != 3) value->fail("3 numbers are expected, not " + std::to_string(by.size()));
    moved[3] = {by[0], by[1], by[2], 1};
  }
  if (const std::optional<JsonValue> value = object.find("scale")) {
    std::vector<double> by;
    if (value->is_number())
      append_number(*value, by);
    else
      by = numbers_in(*value);
    if (by.size() == 1) by.resize(3, by[0]);
    if (by.size() != 3) value->fail("1 or 3 numbers are expected, not " + std::to_string(by.size()));
    for (int axis = 0; axis < 3; ++axis) scaled[axis][axis] = by[std::size_t(axis)];
    refuse_singular(*value, scaled);
  }
  const std::optional<JsonValue> rotation = object.find("rotation");
  return moved * (rotation ? read_rotation(*rotation) : glm::dmat4(1.0)) * scaled;
}

}  // namespace frontmost
