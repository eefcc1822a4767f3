// SPDX-License-Identifier: Apache-2.0
// Files of a data set: they are written into a hidden folder first, and moved when all of them are complete.
#include <algorithm>
#include <filesystem>
#include <set>

#include "datasets/dataset_files.h"

namespace frontmost::datasets {

namespace fs = std::filesystem;

namespace {

bool is_six_digits(std::string_view text) {
  return text.size() == 6 && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool has_name(std::string_view name, FileNames names) {
  if (!name.ends_with(".png")) return false;
  name.remove_suffix(4);
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = name.find('_');
    parts.push_back(name.substr(0, end));
    if (end == name.npos) break;
    name.remove_prefix(end + 1);
  }
  std::size_t numbers = parts.size();
  if (names == FileNames::parts_of_masks) {
    if (parts.back() != "visible" && parts.back() != "amodal") return false;
    --numbers;
  }
  const std::size_t most = names == FileNames::one_number ? 1 : 2, least = names == FileNames::two_numbers ? 2 : 1;
  return numbers >= least && numbers <= most &&
         std::all_of(parts.begin(), parts.begin() + std::ptrdiff_t(numbers), is_six_digits);
}

/// Removes numbered files of an earlier data set, which readers would take for files of this one.
void remove_stale(const fs::path& folder, const std::vector<DatasetFolder::Within>& within,
                  const std::vector<std::string>& names) {
  std::set<fs::path> written;
  for (const std::string& name : names) written.insert(folder / name);
  std::error_code ignored;
  for (const auto& [name, files] : within) {
    const fs::path place = name.empty() ? folder : folder / name;
    std::vector<fs::path> stale;
    for (const fs::directory_entry& entry : fs::directory_iterator(place, ignored))
      if (has_name(entry.path().filename().string(), files) && !written.contains(entry.path()))
        stale.push_back(entry.path());
    for (const fs::path& path : stale) fs::remove(path, ignored);
  }
}

}  // namespace

std::string six_digits(std::size_t number) {
  const std::string digits = std::to_string(number);
  return std::string(6 - std::min<std::size_t>(6, digits.size()), '0') + digits;
}

DatasetFolder::DatasetFolder(const std::string& folder, std::vector<Within> within)
    : folder_(folder), made_(folder), staged_(folder), within_(std::move(within)) {
  for (const Within& made : within_)
    if (!made.name.empty()) fs::create_directory(staged_.path(made.name));
}

template <class Write>
void DatasetFolder::write(const std::string& name, const Write& write) {
  try {
    write(staged_.path(name));
  } catch (const Error& error) {
    throw Error(error.code(), staged_.told(error.file()), error.place(), error.reason());
  }
  names_.push_back(name);
}

void DatasetFolder::add(const std::string& name, const Image& image, const SaveOptions& options,
                        const Execution& execution) {
  write(name, [&](const std::string& path) { save(image, path, options, execution); });
}

void DatasetFolder::add(const std::string& name, const std::string& text) {
  write(name, [&](const std::string& path) { save_text(text, path); });
}

std::vector<std::string> DatasetFolder::finish() {
  for (const Within& made : within_)
    if (const fs::path path = fs::path(folder_) / made.name; fs::exists(path) && !fs::is_directory(path))
      throw Error(ErrorCode::file_unwritable, path.string(), "", "not a folder");
  for (const Within& made : within_) fs::create_directories(fs::path(folder_) / made.name);
  staged_.commit(names_);
  remove_stale(folder_, within_, names_);
  for (std::string& name : names_) name = (fs::path(folder_) / name).string();
  return std::move(names_);
}

}  // namespace frontmost::datasets
