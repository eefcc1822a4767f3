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

/// Whether an AMF file has a turn (rx, ry or rz) that is not 0. `text`: of the whole file.
bool has_turns(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at + 1)) {
    std::string_view tag = text.substr(at);
    if (tag.starts_with("<!--")) {
      at = text.find("-->", at);
      if (at == std::string_view::npos) return false;
      continue;
    }
    if (!tag.starts_with("<rx") && !tag.starts_with("<ry") && !tag.starts_with("<rz")) continue;
    tag.remove_prefix(3);
    const std::size_t end = tag.find('>');
    if (end == std::string_view::npos || (end > 0 && blanks.find(tag[0]) == std::string_view::npos)) continue;
    tag.remove_prefix(std::min(tag.size(), tag.find_first_not_of(blanks, end + 1)));
    if (tag.starts_with('+')) tag.remove_prefix(1);
    double degrees = 0;
    std::from_chars(tag.data(), tag.data() + tag.size(), degrees);
    if (degrees != 0) return true;
  }
  return false;
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
  if (suffix == "amf" && has_turns(bytes))
    answer.warning("objects that the file turns stand at wrong places, because assimp does not turn those of AMF");
  answer.progress(0.7);
  answer.space(metres_of(*scene, suffix), up_of(*scene, suffix));
  Assimp::Exporter exporter;
  const aiExportDataBlob* glb = exporter.ExportToBlob(scene, "glb2");
  if (glb == nullptr) throw Unreadable(exporter.GetErrorString());
  answer.model({static_cast<const char*>(glb->data), glb->size});
}

}  // namespace frontmost::import
