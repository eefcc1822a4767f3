// SPDX-License-Identifier: Apache-2.0
// Opens a model from memory, or with the files that it names, which lie in an in-memory folder meanwhile. The page
// decodes textures.
#include <filesystem>

#include "web/workbench.h"

namespace frontmost::web {
namespace {

namespace fs = std::filesystem;

const fs::path& folder() {
  static const fs::path path = "/files";
  return path;
}

void forget_files() {
  std::error_code nothing_there;
  fs::current_path("/", nothing_there);
  fs::remove_all(folder(), nothing_there);
}

Scene load_opening(const std::string& name, std::span<const std::byte> bytes, const GivenImages& images) {
  LoadOptions options;
  options.image_decoder = &images;
  return bytes.empty() && fs::exists(folder() / name) ? load(name, options) : load(bytes, name, options);
}

}  // namespace

PlainJson Workbench::put_file(std::span<const std::byte> bytes, const PlainJson& question) {
  const fs::path name = fs::path(question.at("name").get<std::string>()).lexically_normal();
  if (name.empty() || name.is_absolute() || *name.begin() == ".." || name == "-")
    throw Error(ErrorCode::bad_argument, "file", "not a name below the model's folder");
  if (question.value("first", false)) forget_files();
  fs::create_directories((folder() / name).parent_path());
  fs::current_path(folder());  // so that messages show the page's file names
  save_text({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name);
  return PlainJson::object();
}

PlainJson Workbench::put_image(std::span<const std::byte> bytes, const PlainJson& question) {
  if (!opening_) throw Error(ErrorCode::bad_argument, "image", "no model is being opened");
  const std::size_t number = question.at("number");
  if (question.contains("problem"))
    opening_->images.refuse(number, question["problem"]);
  else
    opening_->images.give(number, question.at("width"), question.at("height"), bytes);
  return PlainJson::object();
}

PlainJson Workbench::open(std::vector<std::byte>&& bytes, const PlainJson& question) {
  if (!question.value("again", false)) {
    opening_ = std::make_unique<Opening>();
    opening_->name = question.at("name");
    opening_->bytes = std::move(bytes);
  }
  if (!opening_) throw Error(ErrorCode::bad_argument, "no model is being opened");
  opening_->images.forget_wanted();
  try {
    Scene scene = load_opening(opening_->name, opening_->bytes, opening_->images);
    PlainJson images = PlainJson::array();
    for (const std::string* file : opening_->images.wanted()) images.push_back(place_of(file->data(), file->size()));
    if (!images.empty()) return {{"images", std::move(images)}};
    opening_.reset();
    forget_files();
    return take(std::move(scene));
  } catch (...) {
    opening_.reset();
    forget_files();
    throw;
  }
}

}  // namespace frontmost::web
