// SPDX-License-Identifier: Apache-2.0
// Environments: images of light from all directions, converted to the one layout that lighting expects.
#include <algorithm>
#include <limits>
#include <utility>

#include "io/images/formats.h"

namespace frontmost {
namespace {

/// Replaces values out of range as load_environment() documents.
float usable_light(float value) {
  constexpr float infinity = std::numeric_limits<float>::infinity(), greatest_half = 65504;
  if (!(value > 0)) return 0;  // NaN too
  return value == infinity ? greatest_half : std::min(value, max_environment_value);
}

/// Moves the plane `name` out of `image`, or copies the grey plane.
Buffer<float> take_light(Image& image, const char* name, const std::string& file) {
  Channel* channel = image.find(name);
  const bool is_grey = channel == nullptr;
  if (is_grey) channel = image.find("Y");
  if (channel == nullptr || channel->is_integer())
    throw Error(ErrorCode::unsupported, file, "",
                "an environment has channels R, G and B, or Y, not " + detail::channel_list(image));
  return is_grey ? channel->floats() : std::move(channel->floats());
}

Image environment_of(Image image, const std::string& file) {
  if (image.width != 2 * image.height)
    throw Error(ErrorCode::unsupported, file, "",
                "an environment is twice as wide as high (equirectangular), not " + std::to_string(image.width) +
                    " x " + std::to_string(image.height));
  Image environment{image.width, image.height, {}};
  for (const char* name : {"R", "G", "B"}) {
    environment.channels.push_back({name, take_light(image, name, file)});
    for (float& value : environment.channels.back().floats()) value = usable_light(value);
  }
  return environment;
}

}  // namespace

Image load_environment(const std::string& path) {
  return environment_of(load_image(path), path == "-" ? "standard input" : path);
}

Image load_environment(std::span<const std::byte> bytes, const std::string& name) {
  return environment_of(load_image(bytes, name), name);
}

}  // namespace frontmost
