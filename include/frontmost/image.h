// SPDX-License-Identifier: Apache-2.0
// Image: named planes of pixels, the one type that is written to and read from image files; and the maps of depths and
// ids that are made of what is visible.
//
//   Image       a plane of width * height values for each channel: "R", "G", "B", "A"; "Z"; "object"; ...
//   DeepImage   any number of samples a pixel: `first` says where those of each pixel begin in every channel
//   Bitmap      R, G, B, A of each pixel side by side, as bytes: what a screen wants
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "frontmost/base.h"
#include "frontmost/view.h"

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

/// A picture with any number of samples a pixel, one behind the other: what OpenEXR calls deep.
struct DeepImage {
  int width = 0, height = 0;
  /// By pixel, rows top to bottom, where its samples begin; and the end of the last. Nearer samples come first.
  Buffer<std::uint64_t> first;
  std::vector<Channel> channels;  ///< one value a sample
};

/// A picture as screens and 8-bit PNG want it: sRGB, straight alpha, four bytes a pixel (R, G, B, A), rows top to
/// bottom.
struct Bitmap {
  int width = 0, height = 0;
  Buffer<std::uint8_t> rgba;
};

/// \throws Error bad_argument for sizes that are not 1 to 2^20, no channels, two of one name, or planes that do not
/// have width * height values.
void validate(const Image& image);
/// \throws Error bad_argument for such sizes and channels, beginnings that are not one a pixel and one more or that
/// decrease, or channels that have not one value a sample.
void validate(const DeepImage& image);
/// \throws Error bad_argument for such sizes, or bytes that are not four a pixel.
void validate(const Bitmap& bitmap);

/// The greatest value of a pixel of an environment (pictures.h): sums over all pixels stay far within a float.
inline constexpr float max_environment_value = 16777216.0f;

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
/// The same of any grid of primitives, rows from the top, such as a RangeScan's.
/// \throws Error bad_argument where their number is not width * height.
[[nodiscard]] Image id_image(const Surfaces& surfaces, const glm::ivec2& size, std::span<const PrimitiveId> primitives,
                             IdKind kind);

/// How many pixels of an id_image() show each id below `count`, such as each object of Scene::instances. O(pixels).
/// \throws Error bad_argument unless the image has one channel of integers.
[[nodiscard]] std::vector<std::uint64_t> count_pixels(const Image& ids, std::size_t count);

/// A hash of size, channel names and values; equal for equal images on every machine.
[[nodiscard]] std::uint64_t content_hash(const Image& image);
/// The same, with the number of samples of every pixel.
[[nodiscard]] std::uint64_t content_hash(const DeepImage& image);

/// How far an image is from a reference. The difference of two pixels is the greatest of their channels':
/// - R, G, B, A: the step between them as 8-bit sRGB with straight alpha, over 255; an image without A is opaque;
/// - other floats (depths, directions): the absolute difference of the values; equal infinities and NaNs do not differ;
/// - ids: 1 where they are not the same.
struct Comparison {
  double error = 0;           ///< the greatest difference of any pixel: 0 to 1 for colours
  double mean = 0;            ///< of all pixels
  std::size_t differing = 0;  ///< pixels whose difference is over the threshold
  int x = 0, y = 0;           ///< the first pixel, by rows, with the greatest difference
};

/// \throws Error bad_argument where size or channels are not the same, saying both.
[[nodiscard]] Comparison compare(const Image& image, const Image& reference, double threshold = 0,
                                 const Execution& execution = {});

/// A picture of where they differ by more than `threshold`: red to yellow, the more the greater, over the reference in
/// dim grey (black for maps). \throws Error as compare() does.
[[nodiscard]] Image difference_image(const Image& image, const Image& reference, double threshold = 0,
                                     const Execution& execution = {});

}  // namespace frontmost
