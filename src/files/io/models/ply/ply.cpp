// SPDX-License-Identifier: Apache-2.0
// PLY: vertices, polygons and triangle strips become one mesh; other elements are skipped.
#include "base/parallel.h"
#include "io/models/ply/ply_header.h"
#include "io/models/ply/ply_mesh.h"
#include "io/models/textures.h"

namespace frontmost {
namespace {

using namespace ply;

/// Reads the rows of all elements.
template <class Rows>
class PlyBody {
 public:
  PlyBody(Rows rows, const PlyHeader& header, const ModelSource& source, Coordinates& coordinates, Scene& scene)
      : rows_(std::move(rows)),
        header_(header),
        source_(source),
        coordinates_(coordinates),
        scene_(scene),
        mesh_(add_object(scene, "", source, "header")),
        faces_(rows_, {}, header, source, mesh_) {}

  void read() {
    for (const PlyElement& element : header_.elements) read(element);
    if (faces_.skipped_count() > 0) scene_.warnings.push_back(skipped_faces_warning(faces_.skipped_count()));
    faces_.finish();
  }

 private:
  void read(const PlyElement& element) {
    const Columns columns(element);
    const bool has_corners = columns.has(Role::corners);
    if (element.name == "vertex") {
      read_vertices(element);
    } else if (element.name == "face" && has_corners) {
      faces_.read_faces(element, columns, 0, element.count);
    } else if (element.name == "tristrips" && has_corners) {
      faces_.read_strips(element, columns);
    } else {
      skip(element);
    }
  }

  void read_vertices(const PlyElement& element) {
    const VertexReader vertices(element, source_);
    if (element.count + mesh_.positions.size() >= no_index) source_.fail_limit("header", "too many vertices");
    vertices.reserve(std::size_t(element.count), mesh_);
    vertices.read(rows_, 0, element.count, coordinates_, mesh_);
  }

  void skip(const PlyElement& element) {
    // Elements without properties are skipped at once: a header of a hundred bytes could ask for 2^64 empty rows.
    if (element.properties.empty()) return;
    for (std::uint64_t row = 0; row < element.count; ++row) {
      rows_.begin_row(element, row);
      for (const PlyProperty& property : element.properties) skip_value(rows_, property);
    }
  }

  Rows rows_;
  const PlyHeader& header_;
  const ModelSource& source_;
  Coordinates& coordinates_;
  Scene& scene_;
  Mesh& mesh_;
  FaceReader<Rows, AllVertices> faces_;
};

}  // namespace

std::string skipped_faces_warning(std::uint64_t count) {
  return "faces: " + std::to_string(count) + " with fewer than three corners were passed over";
}

void add_texture_materials(const PlyHeader& header, const ModelSource& source, Scene& scene) {
  if (header.texture_files.empty()) return;
  TextureFiles textures(source, scene);
  for (const std::string& file : header.texture_files) {
    Material& material = scene.materials.emplace_back();
    material.name = std::filesystem::path(file).stem().string();
    material.base_color_texture.texture = textures.get({.color = file}, "header").texture;
  }
  if (scene.meshes[0].material_ids.empty()) scene.meshes[0].material_ids = {0};
}

void PlyBinaryRows::release() {
  source_.release({released_, std::size_t(at_ - released_)});
  released_ = at_;
  check_cancelled(source_.execution());
}

Scene read_ply(Bytes bytes, const ModelSource& source) {
  const PlyHeader header = read_ply_header(bytes, source);
  const Bytes rows = bytes.subspan(header.size);
  Scene scene = read_about_origin([&](Coordinates& coordinates) {
    Scene read;
    read.warnings = header.warnings;
    if (header.encoding == PlyEncoding::ascii) {
      PlyBody(PlyAsciiRows(rows, header.line_count, source), header, source, coordinates, read).read();
    } else {
      PlyBody(PlyBinaryRows(rows, endian_of(header), source), header, source, coordinates, read).read();
    }
    return read;
  });
  add_texture_materials(header, source, scene);
  return scene;
}

}  // namespace frontmost
