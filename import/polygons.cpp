// SPDX-License-Identifier: Apache-2.0
// Meshes in many formats, by assimp, which writes glTF as well.
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Exporter.hpp>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "import/answer.h"

namespace frontmost::import {
namespace {

/// The upward axis: FBX states it, and assimp turns the other formats so that y is up.
std::string up_of(const aiScene& scene, const std::string& suffix) {
  std::int32_t axis = 1, sign = 1;
  if (suffix == "fbx" && scene.mMetaData != nullptr) {
    scene.mMetaData->Get("UpAxis", axis);
    scene.mMetaData->Get("UpAxisSign", sign);
  }
  return (sign < 0 ? "-" : "") + std::string(1, "xyz"[std::clamp(axis, 0, 2)]);
}

/// Metres for one unit, 0 if unknown. An FBX file states centimetres; assimp scales COLLADA to metres.
double metres_of(const aiScene& scene, const std::string& suffix) {
  if (suffix == "dae" || suffix == "zae") return 1;
  float single = 0;
  double centimetres = 0;
  if (suffix != "fbx" || scene.mMetaData == nullptr) return 0;
  if (scene.mMetaData->Get("UnitScaleFactor", single)) {
    char text[32];  // the decimal number that the float stands for
    *std::to_chars(text, text + sizeof text - 1, single).ptr = 0;
    centimetres = std::strtod(text, nullptr);
  } else {
    scene.mMetaData->Get("UnitScaleFactor", centimetres);
  }
  return std::isfinite(centimetres) && centimetres > 0 ? centimetres / 100 : 0;
}

/// Opens no files that a model names: textures are left to the caller, and nothing else is read.
class NoFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

}  // namespace

std::string polygon_suffixes() {
  std::string suffixes;
  Assimp::Importer().GetExtensionList(suffixes);
  return suffixes;
}

void read_polygons(std::string_view bytes, const std::string& suffix, Answer& answer) {
  Assimp::Importer importer;
  importer.SetIOHandler(new NoFiles);  // which the importer deletes
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT);
  const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(),
                                                     aiProcess_Triangulate | aiProcess_SortByPType, suffix.c_str());
  if (scene == nullptr) throw Unreadable(importer.GetErrorString());
  // assimp invents names for files in memory and for roots.
  if (std::string_view(scene->mRootNode->mName.C_Str()).starts_with("$")) scene->mRootNode->mName = "";
  const auto turns = [&](const char* tag) { return bytes.find(tag) != std::string_view::npos; };
  if (suffix == "amf" && (turns("<rx>") || turns("<ry>") || turns("<rz>")))
    answer.warning("objects that the file turns stand at wrong places, because assimp does not turn those of AMF");
  answer.progress(0.7);
  answer.space(metres_of(*scene, suffix), up_of(*scene, suffix));
  Assimp::Exporter exporter;
  const aiExportDataBlob* glb = exporter.ExportToBlob(scene, "glb2");
  if (glb == nullptr) throw Unreadable(exporter.GetErrorString());
  answer.model({static_cast<const char*>(glb->data), glb->size});
}

}  // namespace frontmost::import
