// SPDX-License-Identifier: Apache-2.0
// Test models that are not part of the repository.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace frontmost::test {

inline std::filesystem::path models_folder() { return FRONTMOST_MODELS; }
inline bool have_models() { return std::filesystem::is_directory(models_folder()); }
inline std::string model(const std::string& relative) { return (models_folder() / relative).string(); }

}  // namespace frontmost::test

/// Skips the rest of a test, visibly, where the models are absent.
#define FRONTMOST_NEEDS_MODELS() \
  if (!frontmost::test::have_models()) GTEST_SKIP() << "no models at " << frontmost::test::models_folder()
