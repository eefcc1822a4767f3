// SPDX-License-Identifier: Apache-2.0
// All files beside a model are opened here. Names inside a model are untrusted: "../../etc/passwd", absolute paths and
// links that lead out of the folder are refused, by comparing real paths. Scene files are written by users for their
// own folders of models, so users may allow such folders.
#include <algorithm>

#include "frontmost/base.h"
#include "io/models/reader.h"

namespace frontmost {
namespace {

namespace fs = std::filesystem;

/// Whether `path` is `folder` or lies below it. Precondition: both are canonical.
bool is_within(const fs::path& path, const fs::path& folder) {
  const auto [folder_end, path_end] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  (void)path_end;
  return folder_end == folder.end();
}

/// Whether the text of a file name shows that it leaves its folder, on any system.
bool leaves_folder(const std::string& reference) {
  const fs::path path(reference);
  if (path.is_absolute() || (reference.size() > 1 && reference[1] == ':')) return true;
  const fs::path normal = path.lexically_normal();
  return !normal.empty() && *normal.begin() == "..";
}

/// Returns the start of `text`, at most `longest` bytes, cut between UTF-8 characters.
std::string_view start_of(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return text;
  const auto continues = [&](std::size_t i) { return (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80; };
  std::size_t end = longest;
  while (end > longest - 3 && continues(end)) --end;
  return text.substr(0, end);
}

}  // namespace

ModelSource::ModelSource(std::string name, const Execution& execution, const InputFile& file, fs::path path,
                         std::shared_ptr<OpenedFiles> opened)
    : name_(std::move(name)), execution_(execution), file_(&file), path_(std::move(path)), opened_(std::move(opened)) {}

std::string ModelSource::stem() const { return fs::path(name_).stem().string(); }

std::string ModelSource::without_name(const Error& error) const {
  const std::string what = error.what(), start = name_ + ": ";
  return what.starts_with(start) ? what.substr(start.size()) : what;
}

void ModelSource::fail(const std::string& place, const std::string& reason) const {
  throw Error(ErrorCode::file_malformed, name_, place, reason);
}

void ModelSource::fail_limit(const std::string& place, const std::string& reason) const {
  throw Error(ErrorCode::limit_exceeded, name_, place, reason);
}

void ModelSource::allow_outside(const std::vector<std::string>& folders) {
  allowed_.emplace();
  for (const std::string& folder : folders) {
    std::error_code error;
    allowed_->push_back(fs::canonical(folder, error));
    if (error || !fs::is_directory(allowed_->back(), error))
      throw Error(ErrorCode::file_unreadable, folder, "",
                  "not a folder; --allow-outside (LoadOptions::allow_outside) takes folders");
  }
}

fs::path ModelSource::path_of(const std::string& reference) const {
  const auto refuse = [&](const std::string& reason) -> void {
    throw Error(ErrorCode::file_unreadable, name_, printable(reference), reason);
  };
  constexpr std::size_t longest = 4096;  // as on Linux; splitting a longer path costs many times its size
  if (!has_folder()) refuse("files named inside a model are not read when it comes from memory or a stream");
  std::string slashed = reference;
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  if (slashed.empty() || slashed.size() > longest || slashed.find('\0') != std::string::npos) refuse("not a file name");
  const bool leaves = leaves_folder(slashed);
  const std::string is_outside =
      std::string(leaves ? "lies outside" : "is a link to a place outside") +
      (allowed_ ? " the scene file's folder, so it is not read unless --allow-outside names the folder that it is in"
                : " the model's folder, so it is not read");
  if (leaves && (!allowed_ || allowed_->empty())) refuse(is_outside);

  std::error_code error;
  const fs::path folder = path_.has_parent_path() ? path_.parent_path() : fs::path(".");
  const fs::path found = fs::canonical(folder / slashed, error);
  if (error) refuse("cannot be found");
  // If the model itself is a link into a store, the files beside it are links to the same place.
  const bool is_inside =
      is_within(found, fs::canonical(folder, error)) || is_within(found, fs::canonical(path_, error).parent_path());
  const bool is_allowed = allowed_ && std::any_of(allowed_->begin(), allowed_->end(),
                                                  [&](const fs::path& other) { return is_within(found, other); });
  if (error || !(is_inside || is_allowed)) refuse(is_outside);
  // Pipes and devices are refused, because they could block forever.
  if (!fs::is_regular_file(found, error)) refuse("is not an ordinary file");
  return found;
}

InputFile ModelSource::open(const std::string& reference, std::uint64_t max_bytes) const {
  const fs::path found = path_of(reference);
  if (opened_) opened_->add(found);
  try {
    return InputFile::open(found, printable(reference), max_bytes);
  } catch (const Error& error) {
    throw error.within(name_);
  }
}

std::string name_of(std::string_view text) { return std::string(start_of(text, longest_name)); }

std::string printable(std::string_view text) {
  constexpr std::size_t longest = 160;
  const std::string out = printable_text(start_of(text, longest));
  return text.size() > longest ? out + "..." : out;
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t longest = 40;
  return '"' + printable(word.substr(0, longest)) + (word.size() > longest ? "...\"" : "\"");
}

}  // namespace frontmost
