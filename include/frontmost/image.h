// SPDX-License-Identifier: Apache-2.0
// Image: named planes of pixels, the one type that is written to and read from image files.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "frontmost/base.h"
#include "frontmost/visible.h"

namespace frontmost {

/// One plane, rows top to bottom. Floats for colours, depths and directions; integers for ids.
struct Channel {
  std::string name;
  std::variant<Buffer<float>, Buffer<std::uint32_t>> values;

  [[nodiscard]] const Buffer<float>& floats() const { return std::get<Buffer<float>>(values); }
  [[nodiscard]] Buffer<float>& floats() { return std::get<Buffer<float>>(values); }
  [[nodiscard]] const Buffer<std::uint32_t>& integers() const { return std::get<Buffer<std::uint32_t>>(values); }
  [[nodiscard]] Buffer<std::uint32_t>& integers() { return std::get<Buffer<std::uint32_t>>(values); }
  [[nodiscard]] bool is_integer() const { return values.index() == 1; }
};

/// Channel names follow OpenEXR: R, G, B (linear light, premultiplied by A), A (0 to 1), Z (planar depth),
/// N.X, N.Y, N.Z (world space), and for ids "primitive", "object", "material".
struct Image {
  int width = 0, height = 0;
  std::vector<Channel> channels;

  /// The channel of that name, or null.
  [[nodiscard]] const Channel* find(std::string_view name) const;
  [[nodiscard]] Channel* find(std::string_view name);
};

/// Maps of a Visible's first sample (sample 0 of views with more samples than one), one channel each.
/// "Z": planar depth; +inf, or `background`, where nothing is seen.
[[nodiscard]] Image depth_image(const Visible& visible, float background = std::numeric_limits<float>::infinity());
/// "distance": along the ray from the eye to the sample (perspective), or as depth_image (parallel).
[[nodiscard]] Image ray_distance_image(const Visible& visible,
                                       float background = std::numeric_limits<float>::infinity());

enum class IdKind : std::uint8_t { primitive, object, material };
/// One integer channel named "primitive", "object" (instance number) or "material"; no_index where nothing is seen
/// or no material is set.
[[nodiscard]] Image id_image(const Surfaces& surfaces, const Visible& visible, IdKind kind);

/// A hash of size, channel names and values; equal for equal images on every machine.
[[nodiscard]] std::uint64_t content_hash(const Image& image);

}  // namespace frontmost
