// SPDX-License-Identifier: Apache-2.0
// Manifests: the finished views of a batch, with their files. Each line is a JSON object.
//
//   {"frontmost": "0.1.0", "batch": "5c0e...", "views": 2000, "shard": [3, 16]}
//   {"view": 2, "name": "eye-2", "key": "81fa...", "files": [{"path": "eye-2.png", "bytes": 8123, "hash": "03bb..."}]}
//   {"view": 18, ...
//
// A line is written when all files of its view are complete. So the views in a manifest are finished, however the run
// has ended. A truncated line counts as none.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/render/file_hash.h"
#include "cli/settings.h"

namespace frontmost::cli {

struct FinishedFile {
  std::string path;  ///< relative to the manifest's folder
  FileHash hash;
};

struct FinishedView {
  std::size_t number = 0;  ///< in the batch file, from 0
  std::string name;
  std::uint64_t key = 0;  ///< hash of all that determines its files; see ViewHasher
  std::vector<FinishedFile> files;
};

struct Manifest {
  std::uint64_t batch = 0;  ///< hash of the keys of all views
  std::size_t view_count = 0;
  Shard shard;
  std::vector<FinishedView> finished;
};

/// Returns the manifest's name, as in "engine.views.3-of-16.jsonl" for engine.glb and views.json.
[[nodiscard]] std::string manifest_name(const std::string& stem, const Shard& shard);
/// Returns the stem of a manifest's name, without "3-of-16", or nothing if no manifest has such a name.
[[nodiscard]] std::optional<std::string> stem_of_manifest(const std::string& file_name);

/// Reads a manifest and skips malformed lines. \throws Error file_malformed if the file does not begin as a manifest
/// does, so that no other file is overwritten; file_unreadable.
[[nodiscard]] Manifest read_manifest(const std::string& path);
/// Writes a whole manifest. \throws Error file_unwritable.
void write_manifest(const Manifest& manifest, const std::string& path);
/// Appends a line to an existing manifest. \throws Error file_unwritable.
void append_to_manifest(const FinishedView& view, const std::string& path);

/// Returns nothing if all files of the view are unchanged in `folder`, otherwise the name of a changed file.
[[nodiscard]] std::optional<std::string> changed_file(const FinishedView& view, const std::string& folder);

}  // namespace frontmost::cli
