// SPDX-License-Identifier: Apache-2.0
// Test models outside the repository, and the list of those that must load.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "support/effort.h"

namespace frontmost::test {

inline std::filesystem::path models_folder() { return FRONTMOST_MODELS; }
inline bool have_models() { return std::filesystem::is_directory(models_folder()); }
inline std::string model(const std::string& relative) { return (models_folder() / relative).string(); }

inline bool is_model(const std::filesystem::path& path) {
  const std::string suffix = path.extension().string();
  for (const char* known : {".stl", ".ply", ".obj", ".off", ".gltf", ".glb"})
    if (suffix == known) return true;
  return false;
}

/// Files that must load; `loader` holds broken ones, which the readers' own tests take one by one. Under a sanitizer,
/// files above a megabyte are left out: they have more triangles, but exercise no other code.
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

/// Skips the rest of a test, visibly, if the models are absent.
#define FRONTMOST_NEEDS_MODELS() \
  if (!frontmost::test::have_models()) GTEST_SKIP() << "no models at " << frontmost::test::models_folder()
