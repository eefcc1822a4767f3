// SPDX-License-Identifier: Apache-2.0
// Masks of objects as pictures, black and white: what of each is visible, and all of it that lies within the frame.
//
//    000003_visible.png  000003_amodal.png        of object 3
#include <fmt/format.h>
#include <frontmost/io.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "cli/console.h"
#include "cli/failure.h"
#include "cli/report/report_files.h"

namespace frontmost::cli {

namespace fs = std::filesystem;

namespace {

/// Whether a file has a name that a mask may have: six digits, an underscore, and digits or what of the object it is.
bool is_mask_name(const std::string& name) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (name.size() < 12 || !name.ends_with(".png") || name[6] != '_') return false;
  if (!std::all_of(name.begin(), name.begin() + 6, is_digit)) return false;
  const std::string part = name.substr(7, name.size() - 11);
  return part == "visible" || part == "amodal" || (part.size() == 6 && std::all_of(part.begin(), part.end(), is_digit));
}

/// Masks of an earlier report in folders that have masks of this one: who reads a folder would take them for objects.
void remove_stale(const std::string& folder, const std::vector<std::string>& names) {
  std::set<fs::path> written, folders;
  for (const std::string& name : names) {
    written.insert(fs::path(folder) / name);
    if (is_mask_name(fs::path(name).filename().string())) folders.insert((fs::path(folder) / name).parent_path());
  }
  std::error_code ignored;
  for (const fs::path& place : folders) {
    std::vector<fs::path> stale;
    for (const fs::directory_entry& entry : fs::directory_iterator(place, ignored))
      if (is_mask_name(entry.path().filename().string()) && !written.contains(entry.path()))
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

std::vector<std::string> write_folder(const std::string& folder, std::initializer_list<const char*> within,
                                      const std::function<std::vector<std::string>(const StagedFolder&)>& write) {
  const WritingFiles writing;
  const StagedFolder staged(folder);
  std::vector<std::string> names;
  try {
    for (const char* made : within) fs::create_directory(staged.path(made));
    names = write(staged);
  } catch (const Error& error) {
    throw Error(error.code(), staged.told(error.what()));
  }
  for (const char* made : within)
    if (const fs::path path = fs::path(folder) / made; fs::exists(path) && !fs::is_directory(path))
      throw Error(ErrorCode::file_unwritable, path.string() + ": is no folder");
  for (const char* made : within) fs::create_directories(fs::path(folder) / made);
  staged.commit(names);
  remove_stale(folder, names);
  for (std::string& name : names) name = (fs::path(folder) / name).string();
  return names;
}

std::vector<std::string> write_masks(const ReportRun& run, const std::string& folder, const Execution& execution) {
  return write_folder(folder, {}, [&](const StagedFolder& staged) {
    std::vector<std::string> names;
    PixelMasks masks(run.surfaces, run.visible, execution);
    for (std::uint32_t i = 0; i < run.accounts.objects.size(); ++i) {
      if (run.accounts.objects[i].in_frame.count == 0) continue;
      const PixelMask mask = masks.of(i);
      for (const auto& [part, word] : {std::pair(MaskPart::visible, "visible"), {MaskPart::whole, "amodal"}}) {
        names.push_back(fmt::format("{:06}_{}.png", i, word));
        save(mask_image(mask, part, run.view()), staged.path(names.back()), {}, execution);
      }
      stop_if_interrupted();
    }
    return names;
  });
}

}  // namespace frontmost::cli
