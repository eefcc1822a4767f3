// SPDX-License-Identifier: Apache-2.0
#include "web/images.h"

#include <cstring>

namespace frontmost::web {

const Texture& GivenImages::find(std::span<const std::byte> file) const {
  const std::lock_guard lock(mutex_);
  const auto [entry, is_new] =
      images_.try_emplace(std::string(reinterpret_cast<const char*>(file.data()), file.size()));
  if (is_new) wanted_.push_back(&entry->first);
  if (!entry->second.problem.empty()) throw Error(ErrorCode::unsupported, entry->second.problem);
  return entry->second.texture;
}

glm::ivec2 GivenImages::size(std::span<const std::byte> file) const {
  const Texture& texture = find(file);
  return {texture.width, texture.height};
}

Texture GivenImages::pixels(std::span<const std::byte> file) const { return find(file); }

void GivenImages::give(std::size_t number, int width, int height, std::span<const std::byte> rgba) {
  if (number >= wanted_.size() || width < 1 || height < 1 ||
      rgba.size() != 4 * std::uint64_t(width) * std::uint64_t(height))
    throw Error(ErrorCode::bad_argument, "image", "not four bytes for each pixel of an image that is wanted");
  Image& image = images_.at(*wanted_[number]);
  image.texture.width = width, image.texture.height = height;
  image.texture.pixels.resize(rgba.size() / 4);
  std::memcpy(image.texture.pixels.data(), rgba.data(), rgba.size());
  image.problem.clear();
}

void GivenImages::refuse(std::size_t number, const std::string& reason) {
  if (number >= wanted_.size()) throw Error(ErrorCode::bad_argument, "image", "there is no such image");
  images_.at(*wanted_[number]).problem = reason;
}

}  // namespace frontmost::web
