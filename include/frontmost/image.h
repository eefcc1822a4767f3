// SPDX-License-Identifier: Apache-2.0
// Image: named planes of pixels, the type that image files are read into and written from. Further down: maps of depths
// and ids, made from the visible samples of a view.
//
//   Image       a plane of width * height values for each channel: "R", "G", "B", "A"; "Z"; "object"; ...
//   DeepImage   any number of samples per pixel: `first` tells where each pixel's samples begin in every channel
//   Bitmap      R, G, B, A of each pixel side by side, as bytes, ready for a screen
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "frontmost/base.h"
#include "frontmost/view.h"

namespace frontmost {

/// One plane of values, with rows from top to bottom. Colours, depths and directions are floats; ids are integers.
struct Channel {
  std::string name;
  std::variant<Buffer<float>, Buffer<std::uint32_t>> values;

  [[nodiscard]] const Buffer<float>& floats() const { return std::get<Buffer<float>>(values); }
  [[nodiscard]] Buffer<float>& floats() { return std::get<Buffer<float>>(values); }
  [[nodiscard]] const Buffer<std::uint32_t>& integers() const { return std::get<Buffer<std::uint32_t>>(values); }
  [[nodiscard]] Buffer<std::uint32_t>& integers() { return std::get<Buffer<std::uint32_t>>(values); }
  [[nodiscard]] bool is_integer() const { return values.index() == 1; }
};

/// An image with any channels. Names follow OpenEXR: R, G, B (linear light, premultiplied by A), A (0 to 1), Z (planar
/// depth), N.X, N.Y, N.Z (world space); ids are in "primitive", "object", "material".
struct Image {
  int width = 0, height = 0;
  std::vector<Channel> channels;

  /// \returns the channel of this name, or null.
  [[nodiscard]] const Channel* find(std::string_view name) const;
  [[nodiscard]] Channel* find(std::string_view name);
};

/// A picture with any number of samples per pixel, one behind the other: a deep image, as OpenEXR calls it.
struct DeepImage {
  int width = 0, height = 0;
  /// Index of each pixel's first sample, rows top to bottom, and the total at the end. Nearer samples come first.
  Buffer<std::uint64_t> first;
  std::vector<Channel> channels;  ///< one value per sample
};

/// A picture in the format of screens and 8-bit PNG files: sRGB, straight alpha, four bytes per pixel (R, G, B, A),
/// rows top to bottom.
struct Bitmap {
  int width = 0, height = 0;
  Buffer<std::uint8_t> rgba;
};

/// \throws Error bad_argument unless width and height are 1 to 2^20, there is a channel, channel names differ, and each
/// plane has width * height values.
void validate(const Image& image);
/// \throws Error bad_argument unless width and height are 1 to 2^20, there is a channel, `first` has one entry per
/// pixel and one more and never decreases, and each channel has one value per sample.
void validate(const DeepImage& image);
/// \throws Error bad_argument unless width and height are 1 to 2^20 and there are four bytes per pixel.
void validate(const Bitmap& bitmap);

/// \returns the colours of an image in 8-bit sRGB, as save() writes them to a PNG file. Values out of range are
/// clamped, NaN gives 0, pixels with alpha 0 are black, and an image without A is opaque. \throws Error bad_argument
/// unless validate(image) passes and R, G, B are planes of floats.
[[nodiscard]] Bitmap bitmap_of(const Image& image);
/// The linear value of an 8-bit sRGB value.
[[nodiscard]] float linear_of_srgb(std::uint8_t srgb);

/// The greatest value of a pixel of an environment (pictures.h). Sums over all pixels stay far within a float's range.
inline constexpr float max_environment_value = 16777216.0f;

/// A map of sample 0 of each pixel, with one channel "Z": the planar depth, or `background` where nothing is seen.
[[nodiscard]] Image depth_image(const Visible& visible, float background = std::numeric_limits<float>::infinity());
/// A map of sample 0 with one channel "distance": in perspective the distance along the ray from the eye to the
/// surface, in parallel projection the planar depth.
[[nodiscard]] Image ray_distance_image(const Visible& visible,
                                       float background = std::numeric_limits<float>::infinity());

enum class IdKind : std::uint8_t { primitive, object, material };
/// \returns a map of ids, with one integer channel named "primitive", "object" (instance number) or "material". The id
/// is no_index where nothing is seen or no material is set.
[[nodiscard]] Image id_image(const Surfaces& surfaces, const Visible& visible, IdKind kind);
/// \returns a map of ids for any grid of primitives, such as that of a RangeScan, with the top row first.
/// \throws Error bad_argument unless there are width * height primitives.
[[nodiscard]] Image id_image(const Surfaces& surfaces, const glm::ivec2& size, std::span<const PrimitiveId> primitives,
                             IdKind kind);

/// \returns the number of pixels of an id_image() for each id below `count`; ids may be, for example, instance numbers.
/// O(pixels).
/// \throws Error bad_argument unless the image has one channel of integers.
[[nodiscard]] std::vector<std::uint64_t> count_pixels(const Image& ids, std::size_t count);

/// A hash of size, channel names and values. Equal images have equal hashes on every machine.
[[nodiscard]] std::uint64_t content_hash(const Image& image);
/// A hash of size, channel names, values, and the number of samples of every pixel.
[[nodiscard]] std::uint64_t content_hash(const DeepImage& image);

/// Differences of an image from a reference. The difference of two pixels is the greatest difference of any channel:
/// - R, G, B, A: the difference in 8-bit sRGB with straight alpha, divided by 255; an image without A is opaque;
/// - other floats (depths, directions): the absolute difference; equal infinities and two NaNs do not differ;
/// - ids: 1 if they differ.
struct Comparison {
  double error = 0;           ///< the greatest difference of any pixel: 0 to 1 for colours
  double mean = 0;            ///< mean difference of all pixels
  std::size_t differing = 0;  ///< pixels whose difference is over the threshold
  int x = 0, y = 0;           ///< first pixel, by rows, with the greatest difference
};

/// \throws Error bad_argument if size or channels differ, naming both, or if `threshold` is negative.
[[nodiscard]] Comparison compare(const Image& image, const Image& reference, double threshold = 0,
                                 const Execution& execution = {});

/// \returns a picture in which pixels that differ by more than `threshold` go from red (least) to yellow (most). Other
/// pixels show the reference in dim grey, or black for maps.
/// \throws Error as compare() does.
[[nodiscard]] Image difference_image(const Image& image, const Image& reference, double threshold = 0,
                                     const Execution& execution = {});

}  // namespace frontmost
