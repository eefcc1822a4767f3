// SPDX-License-Identifier: Apache-2.0
// PNG, JPEG and WebP textures. The browser decodes them, because the module contains no libraries for these formats.
//
//   load() -- asks for pixels --> GivenImages: missing, noted --> the page decodes noted files --> load() again
#pragma once

#include <frontmost/files.h>

#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace frontmost::web {

/// Images by their files' bytes. Several threads may ask during loading.
class GivenImages : public ImageDecoder {
 public:
  [[nodiscard]] glm::ivec2 size(std::span<const std::byte> file) const override;
  [[nodiscard]] Texture pixels(std::span<const std::byte> file) const override;

  /// Files that were asked for and are missing, in the order of the requests.
  [[nodiscard]] const std::vector<const std::string*>& wanted() const { return wanted_; }
  /// Stores the pixels of a wanted file, four bytes each. \throws Error bad_argument if the number of bytes does not
  /// fit.
  void give(std::size_t number, int width, int height, std::span<const std::byte> rgba);
  /// Stores the reason why a wanted file cannot be decoded; the file is not asked for again.
  void refuse(std::size_t number, const std::string& reason);
  /// Clears the list of wanted files. Call before loading again.
  void forget_wanted() { wanted_.clear(); }

 private:
  struct Image {
    Texture texture;
    std::string problem = "is decoded later";
  };
  [[nodiscard]] const Texture& find(std::span<const std::byte> file) const;

  // Members are mutable, because the library's const calls note wanted files.
  mutable std::mutex mutex_;
  mutable std::map<std::string, Image> images_;
  mutable std::vector<const std::string*> wanted_;
};

}  // namespace frontmost::web
