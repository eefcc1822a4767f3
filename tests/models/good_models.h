// SPDX-License-Identifier: Apache-2.0
// Which of the test models are to be read whole.
#pragma once

#include <algorithm>
#include <vector>

#include "support/effort.h"
#include "support/models.h"

namespace frontmost::test {

inline bool is_model(const std::filesystem::path& path) {
  const std::string suffix = path.extension().string();
  for (const char* known : {".stl", ".ply", ".obj", ".off", ".gltf", ".glb"})
    if (suffix == known) return true;
  return false;
}

/// Files that are to be read whole; `loader` holds broken ones, which the readers' own tests take one by one. Under a
/// sanitizer, those of more than a megabyte are left out: they have more triangles, but no other code.
inline std::vector<std::string> good_models() {
  namespace fs = std::filesystem;
  std::vector<std::string> names;
  if (!have_models()) return names;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(models_folder())) {
    const std::string name = fs::relative(entry.path(), models_folder()).generic_string();
    if (!entry.is_regular_file() || !is_model(entry.path()) || name.rfind("loader/", 0) == 0) continue;
    if (!under_sanitizer || entry.file_size() <= 1'000'000) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace frontmost::test
