// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/parallel.h"
#include "image/srgb_pixels.h"

namespace frontmost {
namespace {

bool is_color(std::string_view name) { return name == "R" || name == "G" || name == "B" || name == "A"; }

std::string names_of(const Image& image) {
  std::string list;
  for (const Channel& channel : image.channels) list += (list.empty() ? "" : ", ") + channel.name;
  return list;
}

/// The difference of two values; 0 for equal values and for two NaNs. Equal infinities are tested first, because their
/// difference would be NaN.
double difference(float a, float b) {
  if (a == b || (a != a && b != b)) return 0;
  const double result = std::fabs(double(a) - double(b));
  // A number and NaN are infinitely far apart.
  return result == result ? result : std::numeric_limits<double>::infinity();
}

/// Two images that can be compared, and the difference of their pixels.
class ImagePair {
 public:
  ImagePair(const Image& image, const Image& reference) : width_(image.width), height_(image.height) {
    validate(image);
    validate(reference);
    if (image.width != reference.width || image.height != reference.height)
      throw Error(ErrorCode::bad_argument, "comparison",
                  "the image has " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                      " pixels, the reference " + std::to_string(reference.width) + " x " +
                      std::to_string(reference.height));
    colors_[0] = color_planes(image);
    colors_[1] = color_planes(reference);
    if (!pair_maps(image, reference) || !pair_maps(reference, image) ||
        colors_[0].has_value() != colors_[1].has_value())
      throw Error(ErrorCode::bad_argument, "comparison",
                  "the image has channels " + names_of(image) + ", the reference " + names_of(reference));
    maps_.resize(maps_.size() / 2);  // each pair was found from both sides
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const std::optional<ColorPlanes>& reference_colors() const { return colors_[1]; }

  /// The difference of every pixel in row y.
  [[nodiscard]] std::vector<double> row(int y) const {
    std::vector<double> differences(std::size_t(width_), 0.0);
    if (colors_[0]) add_colors(y, differences);
    for (const auto& [channel, reference] : maps_) add_map(*channel, *reference, y, differences);
    return differences;
  }

 private:
  /// Finds the partner in `other` of each channel of `one` that is no colour. \returns false if a channel has none.
  bool pair_maps(const Image& one, const Image& other) {
    for (const Channel& channel : one.channels) {
      if (colors_[0] && colors_[1] && is_color(channel.name)) continue;
      const Channel* partner = other.find(channel.name);
      if (!partner || partner->is_integer() != channel.is_integer()) return false;
      maps_.emplace_back(&channel, partner);
    }
    return true;
  }

  void add_colors(int y, std::vector<double>& differences) const {
    std::vector<std::uint8_t> a(differences.size() * 4), b(a.size());
    srgb8_row(*colors_[0], y, true, a.data());
    srgb8_row(*colors_[1], y, true, b.data());
    for (std::size_t i = 0; i < a.size(); ++i)
      differences[i / 4] = std::max(differences[i / 4], std::abs(int(a[i]) - int(b[i])) / 255.0);
  }

  void add_map(const Channel& channel, const Channel& reference, int y, std::vector<double>& differences) const {
    const std::size_t first = std::size_t(y) * std::size_t(width_);
    for (std::size_t x = 0; x < differences.size(); ++x) {
      const std::size_t i = first + x;
      const double apart = channel.is_integer() ? double(channel.integers()[i] != reference.integers()[i])
                                                : difference(channel.floats()[i], reference.floats()[i]);
      differences[x] = std::max(differences[x], apart);
    }
  }

  int width_, height_;
  std::optional<ColorPlanes> colors_[2];
  std::vector<std::pair<const Channel*, const Channel*>> maps_;
};

/// The comparison of one row; `mean` holds the sum of differences.
Comparison compare_row(const ImagePair& pair, int y, double threshold) {
  Comparison result;
  result.y = y;
  const std::vector<double> differences = pair.row(y);
  for (std::size_t x = 0; x < differences.size(); ++x) {
    result.mean += differences[x];
    if (differences[x] > threshold) ++result.differing;
    if (differences[x] > result.error) {
      result.error = differences[x];
      result.x = int(x);
    }
  }
  return result;
}

constexpr std::size_t rows_at_a_time = 16;

/// Differing pixels go from red to yellow; other pixels show the reference, dimmed and grey.
void paint(const ColorPlanes* reference, std::size_t i, double strength, float* const* planes) {
  float grey = 0;
  if (reference) {
    const float* const* color = reference->color;
    grey = 0.25f * (0.2126f * color[0][i] + 0.7152f * color[1][i] + 0.0722f * color[2][i]);
    grey = grey > 0 ? std::min(grey, 0.25f) : 0.0f;  // false for NaN
  }
  const bool differs = strength >= 0;
  planes[0][i] = differs ? 1.0f : grey;
  planes[1][i] = differs ? float(strength * strength) : grey;
  planes[2][i] = differs ? 0.0f : grey;
  planes[3][i] = 1.0f;
}

}  // namespace

Comparison compare(const Image& image, const Image& reference, double threshold, const Execution& execution) {
  if (!(threshold >= 0)) throw Error(ErrorCode::bad_argument, "comparison", "the threshold must not be negative");
  const ImagePair pair(image, reference);
  std::vector<Comparison> rows(std::size_t(pair.height()));
  parallel_for(execution, rows.size(), rows_at_a_time, [&](std::size_t first, std::size_t end) {
    for (std::size_t y = first; y < end; ++y) rows[y] = compare_row(pair, int(y), threshold);
  });
  Comparison result;
  for (const Comparison& row : rows) {  // in order, so that the sum is the same for any number of threads
    result.mean += row.mean;
    result.differing += row.differing;
    if (row.error > result.error) {
      result.error = row.error;
      result.x = row.x;
      result.y = row.y;
    }
  }
  result.mean /= std::max(1.0, double(pair.width()) * double(pair.height()));
  return result;
}

Image difference_image(const Image& image, const Image& reference, double threshold, const Execution& execution) {
  const ImagePair pair(image, reference);
  const double greatest = compare(image, reference, threshold, execution).error;
  Image picture{pair.width(), pair.height(), {}};
  float* planes[4];
  picture.channels.reserve(4);
  for (int c = 0; c < 4; ++c) {
    Buffer<float> values(std::size_t(pair.width()) * std::size_t(pair.height()));
    planes[c] = values.data();
    picture.channels.push_back({std::string(1, "RGBA"[c]), std::move(values)});
  }
  const ColorPlanes* colors = pair.reference_colors() ? &*pair.reference_colors() : nullptr;
  parallel_for(execution, std::size_t(pair.height()), rows_at_a_time, [&](std::size_t first, std::size_t end) {
    for (std::size_t y = first; y < end; ++y) {
      const std::vector<double> differences = pair.row(int(y));
      for (std::size_t x = 0; x < differences.size(); ++x) {
        const double part = std::isinf(differences[x]) ? 1.0 : differences[x] / greatest;  // 0 if greatest is infinite
        paint(colors, y * differences.size() + x, differences[x] > threshold ? part : -1, planes);
      }
    }
  });
  return picture;
}

}  // namespace frontmost
