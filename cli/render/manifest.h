// SPDX-License-Identifier: Apache-2.0
// Manifests: which views of a batch are finished, with their files. JSON, an object a line.
//
//   {"frontmost": "0.1.0", "batch": "5c0e...", "views": 2000, "shard": [3, 16]}
//   {"view": 2, "name": "eye-2", "key": "81fa...", "files": [{"path": "eye-2.png", "bytes": 8123, "hash": "03bb..."}]}
//   {"view": 18, ...
//
// A line is written when all files of its view are whole. So whatever ends a run, what is noted is finished, and a line
// that was cut short is none.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/render/file_hash.h"
#include "cli/settings.h"

namespace frontmost::cli {

struct FinishedFile {
  std::string path;  ///< as from the folder that the manifest lies in
  FileHash hash;
};

struct FinishedView {
  std::size_t number = 0;  ///< in the batch file, from 0
  std::string name;
  std::uint64_t key = 0;  ///< of all that decides its files; see hash_of_view()
  std::vector<FinishedFile> files;
};

struct Manifest {
  std::uint64_t batch = 0;  ///< the keys of all views
  std::size_t view_count = 0;
  Shard shard;
  std::vector<FinishedView> finished;
};

/// "engine.views.3-of-16.jsonl" for engine.glb and views.json.
[[nodiscard]] std::string manifest_name(const std::string& stem, const Shard& shard);
/// "engine.views.3-of-16" without the part that counts; none where it is not the name of a manifest.
[[nodiscard]] std::optional<std::string> stem_of_manifest(const std::string& file_name);

/// Views whose lines are broken are not among the finished ones. \throws Error file_malformed where the file does not
/// begin as a manifest does, so that nobody's own file is replaced; file_unreadable.
[[nodiscard]] Manifest read_manifest(const std::string& path);
/// \throws Error file_unwritable.
void write_manifest(const Manifest& manifest, const std::string& path);
/// At the end of a manifest that is there. \throws Error file_unwritable.
void append_to_manifest(const FinishedView& view, const std::string& path);

/// Whether all its files are in `folder`, byte by byte as they were; otherwise the name of one that is not.
[[nodiscard]] std::optional<std::string> changed_file(const FinishedView& view, const std::string& folder);

}  // namespace frontmost::cli
