// SPDX-License-Identifier: Apache-2.0
// Text is read line by line, and errors name the line's number. The size is limited, so that an endless file is found
// before it fills the memory.
#include "cli/rays/ray_files.h"

#include <fmt/format.h>
#include <frontmost/files.h>

#include <algorithm>
#include <cstring>

#include "cli/failure.h"
#include "cli/values.h"

namespace frontmost::cli {
namespace {

constexpr std::uint64_t largest_ray_file = std::uint64_t(1) << 30;
constexpr std::size_t most_lines = std::size_t(1) << 22;
constexpr std::string_view blanks = " \t\r\v\f,";

double number_at(std::string_view word, const std::string& path, std::size_t line) {
  try {
    return parse_number(word, {-3e38, 3e38});
  } catch (const UsageError& error) {
    throw Error(ErrorCode::file_malformed, path, fmt::format("line {}", line), error.what());
  }
}

std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

constexpr std::size_t bytes_of_point = 48;  // at most

void append(std::string& bytes, std::uint32_t word) {
  // PLY's little endian, whatever the machine's order.
  for (int shift = 0; shift < 32; shift += 8) bytes += char(word >> shift & 0xFF);
}

void append(std::string& bytes, float value) {
  std::uint32_t word;
  std::memcpy(&word, &value, sizeof word);
  append(bytes, word);
}

void append(std::string& bytes, double value) {
  std::uint64_t word;
  std::memcpy(&word, &value, sizeof word);
  append(bytes, std::uint32_t(word));
  append(bytes, std::uint32_t(word >> 32));
}

/// Appends a point: as floats near zero, and as doubles if floats would round its coordinates.
void append_place(std::string& bytes, const glm::dvec3& point, const glm::dvec3& origin) {
  for (int axis = 0; axis < 3; ++axis) {
    if (origin == glm::dvec3(0))
      append(bytes, float(point[axis]));
    else
      append(bytes, origin[axis] + point[axis]);
  }
}

void append_ids(std::string& bytes, const RangeScan& scan, const glm::ivec2& at, const PrimitiveSource& source) {
  append(bytes, scan.ranges[scan.index(at.x, at.y)]);
  for (const std::uint32_t id : {source.instance, source.triangle, std::uint32_t(at.y), std::uint32_t(at.x)})
    append(bytes, id);
}

}  // namespace

std::vector<double> read_number_lines(const std::string& path, const LineRule& rule) {
  const std::string text = load_text(path, largest_ray_file);
  std::vector<double> numbers;
  std::size_t lines = 0;
  std::string_view rest = text;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t length = rest.find('\n');
    std::string_view line = rest.substr(0, length);
    rest.remove_prefix(length == std::string_view::npos ? rest.size() : length + 1);
    line = line.substr(0, line.find('#'));
    std::size_t count = 0;
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line), ++count)
      if (count < rule.count) numbers.push_back(number_at(word, path, number));
    if (count == 0) continue;
    if (count != rule.count)
      throw Error(ErrorCode::file_malformed, path, fmt::format("line {}", number),
                  fmt::format("{}; there are {}", rule.text, count));
    if (++lines > most_lines)
      throw Error(ErrorCode::limit_exceeded, path, fmt::format("line {}", number),
                  fmt::format("more than the limit of {} lines", most_lines));
  }
  return numbers;
}

std::string points_ply(const ScanPoints& points) {
  const RangeScan& scan = points.scan;
  const RayScene& rays = points.rays;
  const auto missed = std::count(scan.primitives.begin(), scan.primitives.end(), no_primitive);
  const std::size_t count = scan.primitives.size() - std::size_t(missed);
  const glm::dvec3 origin = points.robot_axes ? glm::dvec3(0) : rays.scene().origin;
  const glm::dmat4 out_from_world =
      points.robot_axes ? pose_of(scan.camera.world_from_eye, PoseConvention::robot_world_to_camera) : glm::dmat4(1.0);
  const char* const type = origin == glm::dvec3(0) ? "float" : "double";
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment rays {} by {}\nelement vertex {}\n"
      "property {} x\nproperty {} y\nproperty {} z\nproperty float range\n"
      "property uint object\nproperty uint triangle\nproperty uint ring\nproperty uint step\nproperty float incidence\n"
      "end_header\n",
      scan.width, scan.height, count, type, type, type);
  bytes.reserve(bytes.size() + count * bytes_of_point);
  for (int y = 0; y < scan.height; ++y)
    for (int x = 0; x < scan.width; ++x) {
      const PrimitiveId id = scan.primitives[scan.index(x, y)];
      if (id == no_primitive) continue;
      append_place(bytes, glm::dvec3(out_from_world * glm::dvec4(point_of(scan, x, y), 1)), origin);
      append_ids(bytes, scan, {x, y}, rays.surfaces.source(id));
      append(bytes, points.incidences[scan.index(x, y)]);
    }
  return bytes;
}

}  // namespace frontmost::cli
