// SPDX-License-Identifier: Apache-2.0
// Writer of PLY: all objects as one mesh, with further properties of its faces.
#include "io/model_files/file_bytes.h"
#include "io/model_files/model_files.h"

namespace frontmost::detail {
namespace {

std::string ply_header(const Scene& scene, const Table& of_triangles) {
  std::uint64_t vertices = 0;
  for (const Instance& instance : scene.instances) vertices += scene.meshes[instance.mesh].positions.size();
  if (vertices >= no_index) throw Error(ErrorCode::limit_exceeded, "PLY", "more than 4294967294 vertices");
  // Floats suffice for a scene about zero; a scene far from zero needs doubles.
  const std::string real = scene.origin == glm::dvec3(0) ? "float" : "double";
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) + "\n";
  for (const char* const axis : {" x\n", " y\n", " z\n"}) text += "property " + real + axis;
  text += "element face " + std::to_string(triangle_count(scene)) + "\nproperty list uchar uint vertex_indices\n";
  constexpr const char* types[] = {"uchar ", "uint ", "double "};
  for (const TableColumn& column : of_triangles.columns)
    text += std::string("property ") + types[column.values.index()] + column.name + "\n";
  return text + "end_header\n";
}

}  // namespace

void write_ply(const Scene& scene, const Table& of_triangles, OutputFile& file) {
  FileBytes sink(file);
  sink.bytes() = ply_header(scene, of_triangles);
  for (const Instance& instance : scene.instances) {
    const PlacedMesh mesh(scene, instance);
    for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
      const glm::dvec3 at = mesh.vertex(i);
      for (int axis = 0; axis < 3; ++axis) {
        if (scene.origin == glm::dvec3(0))
          append_bytes(sink.bytes(), float(at[axis]));
        else
          append_bytes(sink.bytes(), at[axis]);
      }
      sink.pass_on();
    }
  }
  std::uint32_t first = 0;
  std::size_t row = 0;
  for (const Instance& instance : scene.instances) {
    const PlacedMesh mesh(scene, instance);
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i, ++row) {
      const glm::uvec3 corners = mesh.corners(i);
      sink.bytes() += '\3';
      for (int k = 0; k < 3; ++k) append_bytes(sink.bytes(), first + corners[k]);
      for (const TableColumn& column : of_triangles.columns) append_bytes(sink.bytes(), column, row);
      sink.pass_on();
    }
    first += std::uint32_t(mesh.vertex_count());
  }
  sink.finish();
}

}  // namespace frontmost::detail
