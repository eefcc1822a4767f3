// SPDX-License-Identifier: Apache-2.0
// PNG, JPEG and WebP textures, which the browser decodes: the module holds no libraries for them.
//
//   load() -- asks for pixels --> GivenImages: not there, noted --> the page decodes what was noted --> load() again
#pragma once

#include <frontmost/files.h>

#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace frontmost::web {

/// Images by their files' bytes. Loading asks from several threads.
class GivenImages : public ImageDecoder {
 public:
  [[nodiscard]] glm::ivec2 size(std::span<const std::byte> file) const override;
  [[nodiscard]] Texture pixels(std::span<const std::byte> file) const override;

  /// Files that were asked for and are not there, in the order of asking.
  [[nodiscard]] const std::vector<const std::string*>& wanted() const { return wanted_; }
  /// The pixels of a wanted file: four bytes each. \throws Error bad_argument for a number of bytes that does not fit.
  void give(std::size_t number, int width, int height, std::span<const std::byte> rgba);
  /// Why a wanted file is none; it is not asked for again.
  void refuse(std::size_t number, const std::string& reason);
  /// Before loading again: the list begins anew.
  void forget_wanted() { wanted_.clear(); }

 private:
  struct Image {
    Texture texture;
    std::string problem = "is decoded later";
  };
  [[nodiscard]] const Texture& find(std::span<const std::byte> file) const;

  // What is asked for is noted while the library only looks.
  mutable std::mutex mutex_;
  mutable std::map<std::string, Image> images_;
  mutable std::vector<const std::string*> wanted_;
};

}  // namespace frontmost::web
