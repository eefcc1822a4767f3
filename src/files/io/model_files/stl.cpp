// SPDX-License-Identifier: Apache-2.0
// Writer of binary STL: triangles and their normals, nothing else.
#include <cmath>

#include "io/model_files/file_bytes.h"
#include "io/model_files/model_files.h"

namespace frontmost::detail {

void write_stl(const Scene& scene, OutputFile& file) {
  FileBytes sink(file);
  sink.bytes() = "Frontmost";  // anything but "solid", which begins the text form of STL
  sink.bytes().resize(80, ' ');
  append_bytes(sink.bytes(), std::uint32_t(triangle_count(scene)));
  for (const Instance& instance : scene.instances) {
    const PlacedMesh mesh(scene, instance);
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
      const glm::uvec3 corners = mesh.corners(i);
      const glm::dvec3 at[3] = {mesh.vertex(corners.x), mesh.vertex(corners.y), mesh.vertex(corners.z)};
      const glm::dvec3 normal = glm::cross(at[1] - at[0], at[2] - at[0]);
      const double length = glm::length(normal);
      const glm::dvec3 unit = length > 0 && std::isfinite(length) ? normal / length : glm::dvec3(0);
      for (const glm::dvec3& row : {unit, at[0], at[1], at[2]})
        for (int axis = 0; axis < 3; ++axis) append_bytes(sink.bytes(), float(row[axis]));
      sink.bytes() += {'\0', '\0'};
      sink.pass_on();
    }
  }
  sink.finish();
}

}  // namespace frontmost::detail
