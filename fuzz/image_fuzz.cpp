// SPDX-License-Identifier: Apache-2.0
// Reads any bytes as an image: the result is a valid image or an Error. A valid image can be compared, shown and
// hashed.
#include <cstdlib>

#include "frontmost/files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace frontmost;
  try {
    const Image image = load_image({reinterpret_cast<const std::byte*>(data), size}, "fuzz");
    try {
      validate(image);
    } catch (const Error&) {
      std::abort();  // readers promise consistent images
    }
    if (compare(image, image).differing != 0) std::abort();
    (void)content_hash(image);
    if (image.find("R") && image.find("G") && image.find("B")) (void)terminal_picture(image, 7, 5, false);
  } catch (const Error&) {
  }
  return 0;
}
