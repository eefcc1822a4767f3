// SPDX-License-Identifier: Apache-2.0
// Files of a data set on their way: written into a hidden folder first, and moved when all of them are whole.
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

/// Whether a file has a name as files of a data set have: numbers of six digits, and for masks also which part.
bool is_numbered_name(std::string_view name) {
  if (!name.ends_with(".png")) return false;
  name.remove_suffix(4);
  for (std::size_t count = 0;; ++count) {
    const std::size_t end = std::min(name.find('_'), name.size());
    const std::string_view part = name.substr(0, end);
    if (!is_six_digits(part)) return count > 0 && end == name.size() && (part == "visible" || part == "amodal");
    if (end == name.size()) return true;
    name.remove_prefix(end + 1);
  }
}

/// Removes files of an earlier data set from folders that hold files of this one: readers would take them for this
/// one's.
void remove_stale(const fs::path& folder, const std::vector<std::string>& names) {
  std::set<fs::path> written, folders;
  for (const std::string& name : names) {
    written.insert(folder / name);
    if (is_numbered_name(fs::path(name).filename().string())) folders.insert((folder / name).parent_path());
  }
  std::error_code ignored;
  for (const fs::path& place : folders) {
    std::vector<fs::path> stale;
    for (const fs::directory_entry& entry : fs::directory_iterator(place, ignored))
      if (is_numbered_name(entry.path().filename().string()) && !written.contains(entry.path()))
        stale.push_back(entry.path());
    for (const fs::path& path : stale) fs::remove(path, ignored);
  }
}

}  // namespace

Image mask_image(const PixelMask& mask, MaskPart part, const View& view) {
  Buffer<float> values(view.pixel_count(), 0.0f);
  for (int y = mask.box.y; y < mask.box.y + mask.box.height; ++y)
    for (int x = mask.box.x; x < mask.box.x + mask.box.width; ++x) {
      const MaskPixel pixel = mask.at(x, y);
      if (pixel == MaskPixel::visible || (part == MaskPart::whole && pixel == MaskPixel::hidden))
        values[std::size_t(y) * std::size_t(view.width) + std::size_t(x)] = 1;
    }
  Image image{view.width, view.height, {}};
  image.channels.push_back({"Y", std::move(values)});
  return image;
}

std::string six_digits(std::size_t number) {
  const std::string digits = std::to_string(number);
  return std::string(6 - std::min<std::size_t>(6, digits.size()), '0') + digits;
}

DatasetFolder::DatasetFolder(const std::string& folder, std::initializer_list<const char*> within)
    : folder_(folder), made_(folder), staged_(folder), within_(within.begin(), within.end()) {
  for (const std::string& made : within_) fs::create_directory(staged_.path(made));
}

template <class Write>
void DatasetFolder::write(const std::string& name, const Write& write) {
  try {
    write(staged_.path(name));
  } catch (const Error& error) {
    throw Error(error.code(), staged_.told(error.what()));
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
  for (const std::string& made : within_)
    if (const fs::path path = fs::path(folder_) / made; fs::exists(path) && !fs::is_directory(path))
      throw Error(ErrorCode::file_unwritable, path.string() + ": is no folder");
  for (const std::string& made : within_) fs::create_directories(fs::path(folder_) / made);
  staged_.commit(names_);
  remove_stale(folder_, names_);
  for (std::string& name : names_) name = (fs::path(folder_) / name).string();
  return std::move(names_);
}

}  // namespace frontmost::datasets
