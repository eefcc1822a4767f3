// SPDX-License-Identifier: Apache-2.0
// Several files cannot be replaced at once. This code comes as near to it as a file system allows: all files are first
// written beside their places, where a full disk is found out, and are then only renamed.
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "frontmost/base.h"

namespace frontmost {
namespace {

namespace fs = std::filesystem;

}  // namespace

MadeFolder::MadeFolder(const std::string& folder) {
  std::error_code error;
  for (fs::path path = fs::path(folder).lexically_normal(); !path.empty() && !fs::exists(path, error);
       path = path.parent_path())
    made_.insert(made_.begin(), path);
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder, error))
    throw Error(ErrorCode::file_unwritable, folder, "", "cannot be made into a folder");
}

MadeFolder::~MadeFolder() {
  std::error_code ignored;
  std::for_each(made_.rbegin(), made_.rend(), [&](const fs::path& path) { fs::remove(path, ignored); });
}

StagedFolder::StagedFolder(const std::string& folder) : folder_(folder) {
  std::string name = (folder_ / ".frontmost-XXXXXX").string();
  if (!::mkdtemp(name.data())) {
    const int code = errno;  // read before strings are made, which may change it
    throw Error(ErrorCode::file_unwritable, folder, "", "cannot write: " + std::generic_category().message(code));
  }
  staged_ = name;
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  fs::remove_all(staged_, ignored);
}

std::string StagedFolder::told(const std::string& path) const {
  const std::string staged = staged_.string();
  return path.starts_with(staged) ? folder_.string() + path.substr(staged.size()) : path;
}

void StagedFolder::commit(const std::vector<std::string>& names) const {
  const auto fail = [](const fs::path& place, const std::string& why) {
    throw Error(ErrorCode::file_unwritable, place.string(), "", "cannot replace: " + why);
  };
  std::error_code unknown;
  for (const std::string& name : names)
    if (fs::is_directory(folder_ / name, unknown)) fail(folder_ / name, "it is a folder");
  for (const std::string& name : names) {
    std::error_code error;
    const fs::path place = folder_ / name, linked = fs::canonical(place, error);
    const fs::path target = error ? place : linked;
    if (!error) fs::permissions(staged_ / name, fs::status(target).permissions(), error);
    fs::rename(staged_ / name, target, error);
    if (error) fail(place, error.message());
  }
}

}  // namespace frontmost
