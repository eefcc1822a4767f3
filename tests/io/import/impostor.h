// SPDX-License-Identifier: Apache-2.0
// Importers for tests: frontmost-import, and shell scripts in its place.
#pragma once

#include <gmock/gmock.h>
#include <stdlib.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "frontmost/files.h"
#include "support/scratch_folder.h"

namespace frontmost::test {

namespace fs = std::filesystem;

/// Names the importer while it lives, and gives it a cache of its own.
class Importer {
 public:
  explicit Importer(const std::string& path) {
    setenv("FRONTMOST_IMPORT", path.c_str(), 1);
    setenv("XDG_CACHE_HOME", cache_.file("cache").c_str(), 1);
  }
  ~Importer() {
    unsetenv("FRONTMOST_IMPORT");
    setenv("XDG_CACHE_HOME", "/dev/null", 1);  // never the user's own
  }
  /// Entries of the cache.
  [[nodiscard]] std::vector<fs::path> entries() const {
    std::vector<fs::path> found;
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder(), none)) found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    return found;
  }
  [[nodiscard]] fs::path folder() const { return cache_.path() / "cache" / "frontmost" / "import"; }

 private:
  ScratchFolder cache_;
};

inline std::string error_of(const std::string& path, const LoadOptions& options = {}, const Execution& execution = {}) {
  try {
    (void)load(path, options, execution);
    return "read";
  } catch (const Error& error) {
    return error.what();
  }
}

/// A shell script in the place of frontmost-import.
class Impostor {
 public:
  /// `text`: what the shell does in place of importing.
  explicit Impostor(const std::string& text) : importer_(folder_.file("import")) {
    std::ofstream(folder_.file("import")) << "#!/bin/sh\n" << text << "\n";
    fs::permissions(folder_.file("import"), fs::perms::owner_all);
    std::ofstream(part()) << "ISO-10303-21;";
  }
  [[nodiscard]] std::string part() const { return folder_.file("part.step"); }
  [[nodiscard]] std::string error(const LoadOptions& options = {}, const Execution& execution = {}) const {
    const std::string text = error_of(part(), options, execution);
    EXPECT_THAT(text, testing::StartsWith(part() + ": "));
    return text.substr(std::min(text.size(), part().size() + 2));
  }
  [[nodiscard]] const Importer& importer() const { return importer_; }
  [[nodiscard]] std::string operator/(const std::string& name) const { return folder_.file(name); }

 private:
  ScratchFolder folder_;
  Importer importer_;
};

/// A frame as a shell prints it.
inline std::string frame_of(char kind, const std::string& payload) {
  std::string text = "printf '";
  text += kind;
  for (int i = 0; i < 8; ++i) {
    char octal[8];
    std::snprintf(octal, sizeof octal, "\\%03o", unsigned(payload.size() >> 8 * i & 255));
    text += octal;
  }
  return text + payload + "'\n";
}

}  // namespace frontmost::test
