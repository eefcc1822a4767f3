// SPDX-License-Identifier: Apache-2.0
// A folder with models, and scene files beside them.
#pragma once

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "frontmost/files.h"
#include "support/scratch_folder.h"

namespace frontmost::test {

class SceneFolder {
 public:
  SceneFolder() {
    // A right-angled triangle with legs of 1 and 2.
    write("corner.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n");
    write("corner.stl",
          "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 2 0\nendloop\n"
          "endfacet\nendsolid s\n");
    write("pair.obj",
          "mtllib pair.mtl\nv 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 5\ng left\nusemtl steel\nf 1 2 3\n"
          "g right\nusemtl glass\nf 1 2 4\n");
    write("pair.mtl", "newmtl steel\nKd 0.5 0.5 0.5\nnewmtl glass\nKd 0 0 1\n");
    write("metre.gltf", R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "meshes": [{"primitives": [
                            {"attributes": {"POSITION": 0}}]}], "accessors": [{"bufferView": 0, "componentType": 5126,
                            "count": 3, "type": "VEC3"}], "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [
                            {"byteLength": 36, "uri": "data:application/octet-stream;base64,)"
                        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAA\"}]}");
  }

  void write(const std::string& name, const std::string& text) { write_text(folder_.file(name), text); }
  [[nodiscard]] std::string file(const std::string& name) const { return folder_.file(name); }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }

  /// Loads a scene file with this text.
  [[nodiscard]] Scene load_scene(const std::string& text) {
    write("scene.json", text);
    return load(file("scene.json"));
  }
  /// Loads a scene of these objects alone.
  [[nodiscard]] Scene load_objects(const std::string& objects) {
    return load_scene(R"({"objects": [)" + objects + "]}");
  }
  /// Error message of loading `text`, after the file's name; "read" if there is none.
  [[nodiscard]] std::string error_of(const std::string& text) {
    try {
      (void)load_scene(text);
      return "read";
    } catch (const Error& error) {
      const std::string start = file("scene.json") + ": ", what = error.what();
      EXPECT_TRUE(what.starts_with(start)) << what;
      return what.substr(std::min(start.size(), what.size()));
    }
  }
  [[nodiscard]] std::string error_of_object(const std::string& object) {
    return error_of(R"({"objects": [)" + object + "]}");
  }

 private:
  ScratchFolder folder_;
};

/// Vertices of all triangles in world space, object by object.
inline std::vector<glm::dvec3> world_corners(const Scene& scene) {
  std::vector<glm::dvec3> corners;
  for (const Instance& instance : scene.instances) {
    const bool is_mirrored = glm::determinant(glm::dmat3(instance.world_from_mesh)) < 0;
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (const glm::uvec3& t : mesh.triangles)
      for (const int k : {0, is_mirrored ? 2 : 1, is_mirrored ? 1 : 2})
        corners.emplace_back(scene.origin +
                             glm::dvec3(instance.world_from_mesh * glm::dvec4(glm::dvec3(mesh.positions[t[k]]), 1)));
  }
  return corners;
}

}  // namespace frontmost::test
