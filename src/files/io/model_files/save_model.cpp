// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>

#include "frontmost/files.h"
#include "io/model_files/model_files.h"

namespace frontmost {
namespace {

enum class ModelFile { ply, stl, glb };

ModelFile model_file_of(const std::string& path) {
  std::string suffix = std::filesystem::path(path).extension().string();
  for (char& c : suffix) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  if (suffix == ".ply") return ModelFile::ply;
  if (suffix == ".stl") return ModelFile::stl;
  if (suffix == ".glb") return ModelFile::glb;
  throw Error(ErrorCode::unsupported, path, "", "models are written as .ply, .stl or .glb");
}

}  // namespace

void save(const Scene& scene, const std::string& path, const Table& of_triangles) {
  const ModelFile kind = model_file_of(path);
  validate(scene);
  if (!of_triangles.columns.empty() && kind != ModelFile::ply)
    throw Error(ErrorCode::unsupported, path, "", "only PLY holds numbers of triangles");
  validate(of_triangles);
  if (!of_triangles.columns.empty() && of_triangles.row_count() != triangle_count(scene))
    throw Error(ErrorCode::bad_argument, path, "",
                std::to_string(of_triangles.row_count()) + " rows are given for " +
                    std::to_string(triangle_count(scene)) + " triangles");
  OutputFile file(path);
  switch (kind) {
    case ModelFile::ply: detail::write_ply(scene, of_triangles, file); break;
    case ModelFile::stl: detail::write_stl(scene, file); break;
    case ModelFile::glb: detail::write_glb(scene, file); break;
  }
  file.commit();
}

}  // namespace frontmost
