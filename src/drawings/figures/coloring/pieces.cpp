// SPDX-License-Identifier: Apache-2.0
// The kinds of cut are tried in this order, and the first that applies is taken:
//
//    colours change evenly (a plane through them leaves a tenth)    the border of the middle band
//    texels are at least 4 pixels wide                              their border nearest to the middle
//    else: texture coordinates, eight directions, and the           the line that leaves the least sum of
//    direction in which the colours of the best cut differ          squared differences on both sides
//
// For the last kind, samples are sorted by their distance from a line of that direction, and running sums give the gain
// for every position of the line. Among equal gains the line that was tried first wins, regardless of rounding.
#include "figures/coloring/pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "frontmost/base.h"

namespace frontmost::shading {
namespace {

/// Up to this number of colours, all of them are tested one by one.
constexpr std::size_t kFewColors = 64;

std::uint64_t key_of(const glm::ivec4& cell) {
  std::uint64_t key = 0;
  for (int k = 0; k < 4; ++k) key = key << 16 | std::uint16_t(cell[k]);
  return key;
}

/// Area in square pixels and length in pixels: a piece below both has the colour of its middle.
constexpr double kLeastArea = 1.5, kLeastLength = 2;
constexpr double kAreaPerSample = 2;      // square pixels per sample of a usual piece
constexpr double kMostAreaPerSample = 9;  // square pixels per sample of a large piece
constexpr double kLengthPerSample = 1;    // pixels of length per sample of a sliver
constexpr double kFewSamples = 4;         // the fewest samples of a piece
constexpr double kManySamples = 64;       // a piece with more samples is large

constexpr std::size_t kMostSamples = 256;
constexpr int kDirections = 8;
/// Rounds in which the direction of change is derived from a cut, and a better cut from that direction.
constexpr int kRounds = 2;
/// Colours change evenly if a plane through them leaves at most this share of the squared differences.
constexpr double kEven = 0.1;
constexpr std::size_t kFewestOfChange = 4;
/// In texels: a cut this near to the border of two texels is moved to the border.
constexpr double kTexelReach = 0.25;
/// In pixels: texels of at least this size are separated one by one.
constexpr double kLargeTexel = 4;

/// The direction of the longest axis of the ellipse of a symmetric matrix.
glm::dvec2 main_axis(double xx, double xy, double yy) {
  const double half = (xx - yy) * 0.5, root = std::sqrt(half * half + xy * xy);
  const glm::dvec2 axis = half > 0 ? glm::dvec2(half + root, xy) : glm::dvec2(xy, root - half);
  const double length = glm::length(axis);
  return length > 0 ? axis / length : glm::dvec2(1, 0);
}

/// Colours as an affine function of the place.
struct EvenChange {
  glm::dvec4 by_x{0}, by_y{0};  ///< steps per pixel
  glm::dvec2 direction{1, 0};   ///< direction of the greatest change
  [[nodiscard]] double steps_per_pixel(const glm::dvec2& way) const {
    const glm::dvec4 change = glm::abs(by_x * way.x + by_y * way.y);
    return std::max({change.x, change.y, change.z, change.w});
  }
};

/// Fits an affine function by least squares; none if the samples differ much from the function.
std::optional<EvenChange> find_even_change(std::span<const ColorSample> samples) {
  const double count = double(samples.size());
  glm::dvec2 place(0);
  glm::dvec4 color(0);
  for (const ColorSample& sample : samples) {
    place += sample.at;
    color += glm::dvec4(sample.color);
  }
  place /= count;
  color /= count;
  double xx = 0, xy = 0, yy = 0, whole = 0;
  glm::dvec4 with_x(0), with_y(0);
  for (const ColorSample& sample : samples) {
    const glm::dvec2 p = sample.at - place;
    const glm::dvec4 c = glm::dvec4(sample.color) - color;
    xx += p.x * p.x;
    xy += p.x * p.y;
    yy += p.y * p.y;
    with_x += c * p.x;
    with_y += c * p.y;
    whole += glm::dot(c, c);
  }
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > 1e-9 * xx * yy)) return std::nullopt;
  EvenChange change{(with_x * yy - with_y * xy) / determinant, (with_y * xx - with_x * xy) / determinant};
  const double explained = glm::dot(change.by_x, with_x) + glm::dot(change.by_y, with_y);
  if (!(whole - explained <= kEven * whole)) return std::nullopt;
  change.direction = main_axis(glm::dot(change.by_x, change.by_x), glm::dot(change.by_x, change.by_y),
                               glm::dot(change.by_y, change.by_y));
  return change;
}

/// A division of samples in two, by a threshold on a function of their places.
struct Split {
  double gain = 0;               ///< decrease of the sum of squared differences
  double threshold = 0;          ///< value of the function at the cut
  glm::vec4 below{0}, above{0};  ///< mean colours
};

class CutFinder {
 public:
  CutFinder(const ColorPiece& piece, std::span<const TexcoordLines> texture) : piece_(piece), texture_(texture) {
    const std::size_t stride = std::max<std::size_t>((piece.samples.size() + kMostSamples - 1) / kMostSamples, 1);
    for (std::size_t i = 0; i < piece.samples.size(); i += stride) samples_.push_back(piece.samples[i]);
    for (const ColorSample& sample : samples_) total_ += sample.color;
  }

  [[nodiscard]] std::optional<ScreenLine> find() {
    if (const std::optional<ScreenLine> border = border_of_bands()) return border;
    if (const std::optional<ScreenLine> border = border_of_texels()) return border;
    for (const TexcoordLines& lines : texture_) try_texture(lines);
    for (int i = 0; i < kDirections; ++i) {
      const double angle = i * 3.14159265358979323846 / kDirections;
      try_direction({std::cos(angle), std::sin(angle)});
    }
    for (int i = 0; i < kRounds && line_; ++i)
      if (const std::optional<glm::dvec2> direction = direction_of_change()) try_direction(*direction);
    return line_;
  }

 private:
  struct Range {
    double least, greatest;
  };
  /// If colours change evenly, the border of the middle band. It runs across the direction in which the piece has the
  /// most steps of colour.
  [[nodiscard]] std::optional<ScreenLine> border_of_bands() const {
    if (samples_.size() < kFewestOfChange) return std::nullopt;
    const std::optional<EvenChange> change = find_even_change(samples_);
    if (!change) return std::nullopt;
    std::optional<ScreenLine> line;
    double most = 0;
    for (const glm::dvec2& way : {change->direction, glm::dvec2(-change->direction.y, change->direction.x)}) {
      const Range all = reach({way, 0});
      const double width = all.greatest - all.least, steps = width * change->steps_per_pixel(way);
      const double bands = std::max(std::ceil(steps / piece_.range), 2.0);
      if (steps <= most || !(width >= 2 * bands * piece_.least_width)) continue;
      most = steps;
      line = ScreenLine{way, all.least + width * std::floor(bands / 2) / bands};
    }
    return line;
  }

  /// If texels are large, the texel border nearest to the middle of the piece. No single cut separates the colours of a
  /// chessboard, and pieces of other shapes have ragged edges.
  [[nodiscard]] std::optional<ScreenLine> border_of_texels() const {
    std::optional<ScreenLine> line;
    double widest = 0;
    for (const TexcoordLines& lines : texture_) {
      double least = lines.at(piece_.corners[0]), greatest = least;
      for (const glm::dvec2& corner : piece_.corners) {
        least = std::min(least, lines.at(corner));
        greatest = std::max(greatest, lines.at(corner));
      }
      const double border = std::round((least + greatest) * 0.5);
      const std::optional<ScreenLine> found = lines.line(border);
      if (!found || !(border > least && border < greatest)) continue;
      const Range sides = reach(*found);
      const double texel = std::min(-sides.least / (border - least), sides.greatest / (greatest - border));
      const bool parts = -sides.least >= piece_.least_width && sides.greatest >= piece_.least_width;
      if (!parts || texel < kLargeTexel || sides.greatest - sides.least <= widest) continue;
      widest = sides.greatest - sides.least;
      line = found;
    }
    return line;
  }

  /// The extent of the piece on either side of a line.
  [[nodiscard]] Range reach(const ScreenLine& line) const {
    Range range{line.distance(piece_.corners[0]), line.distance(piece_.corners[0])};
    for (const glm::dvec2& corner : piece_.corners) {
      const double distance = line.distance(corner);
      range = {std::min(range.least, distance), std::max(range.greatest, distance)};
    }
    return range;
  }

  /// The best split by a function of the place, with a threshold in the range `allowed`.
  template <class Function>
  [[nodiscard]] Split split_by(const Function& function, const Range& allowed) {
    keys_.clear();
    for (std::uint32_t i = 0; i < samples_.size(); ++i) keys_.push_back({function(samples_[i].at), i});
    std::sort(keys_.begin(), keys_.end());
    Split best;
    glm::dvec4 below(0);
    const glm::dvec4 total(total_);
    const double count = double(samples_.size()), whole = glm::dot(total, total) / count;
    for (std::size_t i = 0; i + 1 < keys_.size(); ++i) {
      below += glm::dvec4(samples_[keys_[i].second].color);
      const double threshold = (keys_[i].first + keys_[i + 1].first) * 0.5;
      if (!(keys_[i].first < keys_[i + 1].first) || threshold < allowed.least || threshold > allowed.greatest) continue;
      const double n = double(i + 1);
      const glm::dvec4 above = total - below;
      const double gain = glm::dot(below, below) / n + glm::dot(above, above) / (count - n) - whole;
      if (gain <= best.gain * (1 + 1e-9)) continue;  // among equal gains the first wins, regardless of rounding
      best = {gain, threshold, glm::vec4(below / n), glm::vec4(above / (count - n))};
    }
    return best;
  }

  void take(const Split& split, const ScreenLine& line) {
    best_ = split;
    line_ = line;
  }
  [[nodiscard]] bool is_better(const Split& split) const { return split.gain > best_.gain * (1 + 1e-9) + 1e-9; }

  void try_direction(const glm::dvec2& normal) {
    const Range all = reach({normal, 0});
    const Split split = split_by([&](const glm::dvec2& p) { return glm::dot(normal, p); },
                                 {all.least + piece_.least_width, all.greatest - piece_.least_width});
    if (is_better(split)) take(split, {normal, split.threshold});
  }

  void try_texture(const TexcoordLines& lines) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    Split split = split_by([&](const glm::dvec2& p) { return lines.at(p); }, {-infinite, infinite});
    if (!is_better(split)) return;
    const double border = std::round(split.threshold);
    if (std::abs(split.threshold - border) < kTexelReach) split.threshold = border;
    const std::optional<ScreenLine> line = lines.line(split.threshold);
    if (!line) return;
    const Range sides = reach(*line);
    if (sides.least <= -piece_.least_width && sides.greatest >= piece_.least_width) take(split, *line);
  }

  /// The best split so far has two mean colours, and each sample is nearer to one of them. Returns the direction in the
  /// picture that best separates the two groups of samples.
  [[nodiscard]] std::optional<glm::dvec2> direction_of_change() const {
    const glm::vec4 way = best_.above - best_.below, middle = (best_.above + best_.below) * 0.5f;
    const double length = double(glm::dot(way, way));
    glm::dvec2 mean(0), covariance(0);
    double xx = 0, xy = 0, yy = 0;
    for (const ColorSample& sample : samples_) mean += sample.at;
    mean /= double(samples_.size());
    for (const ColorSample& sample : samples_) {
      const double side = std::clamp(double(glm::dot(sample.color - middle, way)) / length, -0.5, 0.5);
      const glm::dvec2 p = sample.at - mean;
      covariance += p * side;
      xx += p.x * p.x;
      xy += p.x * p.y;
      yy += p.y * p.y;
    }
    const glm::dvec2 direction(yy * covariance.x - xy * covariance.y, xx * covariance.y - xy * covariance.x);
    const double size = glm::length(direction);
    if (!(size > 0)) return std::nullopt;
    return direction / size;
  }

  const ColorPiece& piece_;
  std::span<const TexcoordLines> texture_;
  std::vector<ColorSample> samples_;
  std::vector<std::pair<double, std::uint32_t>> keys_;
  glm::vec4 total_{0};
  Split best_;
  std::optional<ScreenLine> line_;
};

}  // namespace

float difference(const glm::vec4& a, const glm::vec4& b) {
  const glm::vec4 d = glm::abs(a - b);
  return std::max({d.x, d.y, d.z, d.w});
}

std::uint32_t ColorGroups::find(const glm::ivec4& cell, const glm::vec4& color) const {
  if (colors_.size() <= kFewColors) {
    const auto same = std::find_if(colors_.begin(), colors_.end(),
                                   [&](const glm::vec4& c) { return double(difference(c, color)) <= reach_; });
    return same == colors_.end() ? no_index : std::uint32_t(same - colors_.begin());
  }
  std::uint32_t first = no_index;
  for (int i = 0; i < 81; ++i) {
    const glm::ivec4 beside(i % 3 - 1, i / 3 % 3 - 1, i / 9 % 3 - 1, i / 27 - 1);
    const auto found = cells_.find(key_of(cell + beside));
    if (found == cells_.end()) continue;
    for (const std::uint32_t number : found->second)
      if (number < first && double(difference(colors_[number], color)) <= reach_) first = number;
  }
  return first;
}

std::uint32_t ColorGroups::find_or_add(const glm::vec4& color) {
  const glm::ivec4 cell(glm::floor(glm::dvec4(color) / cell_size_));
  const std::uint32_t same = find(cell, color);
  if (same != no_index) return same;
  const auto number = std::uint32_t(colors_.size());
  colors_.push_back(color);
  cells_[key_of(cell)].push_back(number);
  return number;
}

PieceSize::PieceSize(std::span<const glm::dvec2> corners) {
  const glm::dvec2 from = corners[0];
  glm::dvec2 sum(0), before(0);
  for (const glm::dvec2& corner : corners) {
    const glm::dvec2 way = corner - from;
    area += before.x * way.y - before.y * way.x;
    length = std::max(length, glm::length(way));
    sum += way;
    before = way;
  }
  area = std::abs(area) * 0.5;
  middle = from + sum / double(corners.size());
}

bool PieceSize::is_small() const { return area < kLeastArea && length < kLeastLength; }

double PieceSize::sample_count() const {
  const double wanted = std::max(area / kAreaPerSample, length / kLengthPerSample);
  return std::max(std::clamp(wanted, kFewSamples, kManySamples), area / kMostAreaPerSample);
}

glm::dvec2 middle_across(std::span<const glm::dvec2> corners, const glm::dvec2& at, const glm::dvec2& along) {
  glm::dvec2 sum(0);
  int count = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 &p = corners[i], &q = corners[i + 1 == corners.size() ? 0 : i + 1];
    const double a = glm::dot(p - at, along), b = glm::dot(q - at, along);
    if ((a > 0) == (b > 0)) continue;
    sum += p + (q - p) * (a / (a - b));
    ++count;
  }
  return count > 0 ? sum / double(count) : at;
}

void cut_outline(std::span<const glm::dvec2> corners, const ScreenLine& line, std::vector<glm::dvec2>& below,
                 std::vector<glm::dvec2>& above) {
  const std::size_t count = corners.size();
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 &from = corners[i], &to = corners[i + 1 == count ? 0 : i + 1];
    const double a = line.distance(from), b = line.distance(to);
    (a > 0 ? above : below).push_back(from);
    if ((a > 0) == (b > 0)) continue;
    const glm::dvec2 at = from + (to - from) * (a / (a - b));
    below.push_back(at);
    above.push_back(at);
  }
}

std::optional<ScreenLine> best_cut(const ColorPiece& piece, std::span<const TexcoordLines> texture) {
  return CutFinder(piece, texture).find();
}

}  // namespace frontmost::shading
