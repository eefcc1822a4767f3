// SPDX-License-Identifier: Apache-2.0
// Makes scenes and views from arbitrary bytes, for the fuzz targets that draw.
#pragma once

#include <frontmost/frontmost.h>

#include <algorithm>
#include <cstring>
#include <optional>

namespace frontmost::test {

/// The first bytes of an input; triangles of nine floats each follow. Floats are taken unchanged, so that NaN,
/// infinities, denormals and huge values all occur.
struct ViewBytes {
  std::uint8_t width, height, samples, culling, orthographic, fov, up, spare;
  float eye_x, eye_y;
};
inline constexpr std::size_t most_fuzzed_triangles = 256;

inline Scene scene_of(const std::uint8_t* data, std::size_t size, std::size_t most = most_fuzzed_triangles) {
  Scene scene;
  scene.meshes.emplace_back();
  scene.instances.emplace_back();
  Mesh& mesh = scene.meshes[0];
  const std::size_t count = std::min(size / sizeof(glm::vec3) / 3, most);
  mesh.positions.resize(3 * count);
  if (count > 0) std::memcpy(mesh.positions.data(), data, 3 * count * sizeof(glm::vec3));
  for (std::uint32_t i = 0; i < count; ++i) mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  return scene;
}

struct FuzzInput {
  ViewBytes bytes;
  Scene scene;
};

/// Empty if the input is too short.
inline std::optional<FuzzInput> read_input(const std::uint8_t* data, std::size_t size,
                                           std::size_t most = most_fuzzed_triangles) {
  FuzzInput input;
  if (size < sizeof(input.bytes)) return std::nullopt;
  std::memcpy(&input.bytes, data, sizeof(input.bytes));
  input.scene = scene_of(data + sizeof(input.bytes), size - sizeof(input.bytes), most);
  return input;
}

inline View view_of(const ViewBytes& bytes) {
  View view;
  view.width = 1 + bytes.width % 96;
  view.height = 1 + bytes.height % 96;
  view.samples = 1 << (bytes.samples % 5);
  view.culling = Culling(bytes.culling % 4);
  view.world_from_eye = look_at({bytes.eye_x, bytes.eye_y, 3}, {0, 0, 0}, {0, bytes.up % 2, 1});
  const double aspect = double(view.width) / view.height;
  if (bytes.orthographic % 2) {
    view.projection = make_orthographic(-aspect, aspect, -1, 1, {0.5, 100});
  } else {
    view.projection = make_projection(glm::radians(1.0 + bytes.fov % 170), aspect, {0.01, bytes.fov % 2 ? 1e6 : 10});
  }
  return view;
}

}  // namespace frontmost::test
