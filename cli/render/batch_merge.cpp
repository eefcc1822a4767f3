// SPDX-License-Identifier: Apache-2.0
// frontmost batch-merge: checks that the shards of a batch are complete, and gathers them in one folder.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <frontmost/base.h>

#include <algorithm>
#include <filesystem>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/json.h"
#include "cli/option.h"
#include "cli/render/manifest.h"

namespace frontmost::cli {
namespace {

namespace fs = std::filesystem;

constexpr Option batch_merge_options[] = {
    {"output", 'o', "FOLDER", "Copy all files and one manifest into this folder; a missing folder is made.",
     Group::output, for_batch_merge, [](Settings& s, const Given& g) { s.merge_folder = g.file_name(); }},
};

/// A manifest and its folder.
struct ShardPart {
  std::string path, folder;
  Manifest manifest;
};

/// A view and the folder of its files.
struct FinishedSource {
  FinishedView view;
  std::string folder;
};

struct Merged {
  std::vector<FinishedSource> views;  ///< all views, in the order of the batch
  std::uint64_t file_count = 0, bytes = 0;
};

void add_part(const fs::path& path, std::vector<ShardPart>& parts) {
  const fs::path folder = path.parent_path();
  parts.push_back({path.string(), folder.empty() ? "." : folder.string(), read_manifest(path.string())});
}

/// Finds the manifests in the given folders, and manifests given by name. Manifests are sorted by name, so that
/// messages do not depend on the file system.
std::vector<ShardPart> find_parts(const std::vector<std::string>& places) {
  std::vector<ShardPart> parts;
  for (const std::string& place : places) {
    std::error_code error;
    if (!fs::is_directory(place, error)) {
      add_part(place, parts);
      continue;
    }
    std::vector<fs::path> found;
    for (fs::directory_iterator at(place, error), end; !error && at != end; at.increment(error))
      if (stem_of_manifest(at->path().filename().string())) found.push_back(at->path());
    if (error) throw Error(ErrorCode::file_unreadable, place, "", "cannot read: " + error.message());
    if (found.empty())
      throw Error(ErrorCode::file_unreadable, place, "",
                  "the folder has no manifest of a batch; give a folder in which frontmost render --shard ran");
    std::sort(found.begin(), found.end());
    for (const fs::path& path : found) add_part(path, parts);
  }
  return parts;
}

[[noreturn]] void refuse_missing(const std::vector<std::string>& missing, std::size_t count) {
  constexpr std::size_t named = 5;
  const std::vector<std::string> first(missing.begin(),
                                       missing.begin() + std::ptrdiff_t(std::min(named, missing.size())));
  const std::string more = missing.size() > named ? fmt::format(" and {} more", missing.size() - named) : "";
  throw Error(ErrorCode::file_unreadable, fmt::format("{} of {} views are not finished: {}{}", missing.size(), count,
                                                      fmt::join(first, ", "), more));
}

/// Collects each view once and checks its files.
Merged merge_parts(std::vector<ShardPart>& parts) {
  const Manifest& first = parts.front().manifest;
  Merged merged;
  std::vector<bool> has(first.view_count);
  std::vector<std::string> missing;
  for (ShardPart& part : parts) {
    if (part.manifest.batch != first.batch || part.manifest.view_count != first.view_count)
      throw Error(ErrorCode::file_malformed, part.path, "",
                  "has another model, batch file, version or other options than " + parts.front().path);
    for (FinishedView& view : part.manifest.finished) {
      if (view.number >= has.size() || has[view.number]) continue;
      stop_if_interrupted();
      if (const auto changed = changed_file(view, part.folder))
        throw Error(ErrorCode::file_malformed, *changed, "",
                    fmt::format("differs from its entry in {}; repeat that shard", part.path));
      has[view.number] = true;
      for (const FinishedFile& file : view.files) ++merged.file_count, merged.bytes += file.hash.bytes;
      merged.views.push_back({std::move(view), part.folder});
    }
  }
  for (std::size_t i = 0; i < has.size(); ++i)
    if (!has[i]) missing.push_back(fmt::format("views[{}]", i));
  if (!missing.empty()) refuse_missing(missing, has.size());
  std::sort(merged.views.begin(), merged.views.end(),
            [](const FinishedSource& a, const FinishedSource& b) { return a.view.number < b.view.number; });
  return merged;
}

/// Whether a name stays within its folder.
bool stays_within(const std::string& path) {
  const fs::path normal = fs::path(path).lexically_normal();
  return !normal.empty() && !normal.is_absolute() && *normal.begin() != "..";
}

void copy_file(const FinishedFile& file, const std::string& folder, const StagedFolder& staged) {
  if (!stays_within(file.path))
    throw Error(ErrorCode::unsupported, file.path, "", "lies outside the folder of its manifest; leave out --output");
  const fs::path from = fs::path(folder) / file.path, to = staged.path(file.path);
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  fs::copy_file(from, to, error);
  if (error) throw Error(ErrorCode::file_unwritable, from.string(), "", "cannot copy: " + error.message());
  if (hash_of_file(to.string()) != file.hash)
    throw Error(ErrorCode::file_malformed, from.string(), "", "changed while it was copied");
}

/// Copies the files into one folder. The manifest comes last, because it states that the rest exists.
void gather(const Merged& merged, const Manifest& like, const std::string& stem, const std::string& folder) {
  const WritingFiles writing;
  const MadeFolder made(folder);
  const StagedFolder staged(folder);
  Manifest whole{like.batch, like.view_count, {1, 1}, {}};
  std::vector<std::string> names;
  for (const FinishedSource& source : merged.views) {
    for (const FinishedFile& file : source.view.files) {
      stop_if_interrupted();
      copy_file(file, source.folder, staged);
      names.push_back(file.path);
    }
    whole.finished.push_back(source.view);
  }
  names.push_back(manifest_name(stem, whole.shard));
  write_manifest(whole, staged.path(names.back()));
  for (const std::string& name : names) fs::create_directories((fs::path(folder) / name).parent_path());
  staged.commit(names);
}

}  // namespace

std::span<const Option> batch_merge_option_table() { return batch_merge_options; }

int run_batch_merge(const Settings& settings) {
  std::vector<std::string> places = {settings.model};
  places.insert(places.end(), settings.more_models.begin(), settings.more_models.end());
  std::vector<ShardPart> parts = find_parts(places);
  const Merged merged = merge_parts(parts);
  if (settings.merge_folder) {
    const std::string file_name = fs::path(parts.front().path).filename().string();
    gather(merged, parts.front().manifest, stem_of_manifest(file_name).value_or(file_name), *settings.merge_folder);
  }
  if (settings.run.json) {
    Json manifests = Json::array();
    for (const ShardPart& part : parts) manifests.push_back(part.path);
    print(dump({{"views", merged.views.size()},
                {"files", merged.file_count},
                {"bytes", merged.bytes},
                {"manifests", std::move(manifests)}}));
  } else if (!settings.run.quiet) {
    print(fmt::format("{} views, {} files, {} bytes: complete\n", grouped(merged.views.size()),
                      grouped(merged.file_count), grouped(merged.bytes)));
  }
  return exit_done;
}

}  // namespace frontmost::cli
