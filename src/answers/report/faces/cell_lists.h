// SPDX-License-Identifier: Apache-2.0
// The faces that meet each of the largest cells, and the order in which they are examined.
//
//   ListedFace   bit 63      32 31     0
//                    | order  | face   |     nearer faces have lesser numbers
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "geometry/buckets.h"
#include "report/faces/viewed_faces.h"

namespace frontmost::faces_detail {

using ListedFace = std::uint64_t;

[[nodiscard]] inline std::uint32_t face_of(ListedFace listed) { return std::uint32_t(listed); }
/// A number by which keys are ordered: a greater key has a lesser or equal order.
[[nodiscard]] inline std::uint32_t order_of(double key) {
  const float rounded = float(key) + 0.0f;  // turns -0 into 0
  std::uint32_t bits;
  std::memcpy(&bits, &rounded, sizeof bits);
  return (bits >> 31) != 0 ? bits : ~bits & 0x7FFFFFFFu;
}

/// A key that is not exceeded by any key of this order or a greater one.
[[nodiscard]] inline double key_before(std::uint32_t order) {
  const std::uint32_t bits = (order >> 31) != 0 ? order : ~order & 0x7FFFFFFFu;
  float rounded;
  std::memcpy(&rounded, &bits, sizeof bits);
  return double(std::nextafter(rounded, std::numeric_limits<float>::infinity()));
}

/// The faces whose boxes meet each of the largest cells, with the nearest key of each whole face.
class CellLists {
 public:
  /// Number of parts along each side of a cell, unless the picture ends before.
  static constexpr std::uint32_t parts_along = 4;
  static constexpr std::size_t parts_of_cell = std::size_t(parts_along) * parts_along;

  CellLists(const ViewedFaces& screen, const View& view, const Execution& execution)
      : columns_((view.width + kLargestCell - 1) / kLargestCell),
        rows_((view.height + kLargestCell - 1) / kLargestCell),
        spans_(screen.faces.size()),
        orders_(screen.faces.size()) {
    find_spans(screen, view);
    const auto list = [&](std::size_t face, const auto& add) {
      const Span span = spans_[face];
      const std::size_t right = span.right / parts_along, bottom = span.bottom / parts_along;
      for (std::size_t row = span.top / parts_along; row <= bottom; ++row)
        for (std::size_t column = span.left / parts_along; column <= right; ++column)
          add(row * std::size_t(columns_) + column, ListedFace(orders_[face]) << 32 | face);
    };
    lists_ = Buckets<ListedFace>(size(), spans_.size(), list, execution);
  }

  [[nodiscard]] std::size_t size() const { return std::size_t(columns_) * std::size_t(rows_); }
  [[nodiscard]] std::span<const ListedFace> operator[](std::size_t cell) const { return lists_[cell]; }
  [[nodiscard]] CellBox box(std::size_t cell, const View& view) const {
    return square(int(cell % std::size_t(columns_)) * kLargestCell, int(cell / std::size_t(columns_)) * kLargestCell,
                  kLargestCell, view);
  }
  /// Parts of a cell that the face's box meets, as bits.
  [[nodiscard]] std::uint16_t parts_of(std::size_t cell, std::uint32_t face) const {
    const auto left = std::uint32_t(cell % std::size_t(columns_)) * parts_along,
               top = std::uint32_t(cell / std::size_t(columns_)) * parts_along;
    const Span& span = spans_[face];
    // Bits from the first to the last column, or row.
    const auto bits = [](std::uint32_t first, std::uint32_t last, std::uint32_t start) {
      const std::uint32_t from = std::max(first, start) - start, to = std::min(last - start, parts_along - 1);
      return (2u << to) - (1u << from);
    };
    const std::uint32_t columns = bits(span.left, span.right, left), rows = bits(span.top, span.bottom, top);
    // Each bit of the rows is expanded to four.
    return std::uint16_t(((rows & 1) | (rows & 2) << 3 | (rows & 4) << 6 | (rows & 8) << 9) * columns);
  }
  [[nodiscard]] CellBox box_of_part(std::size_t cell, std::size_t part, const View& view) const {
    return square(int(cell % std::size_t(columns_)) * kLargestCell + int(part % parts_along) * kPart,
                  int(cell / std::size_t(columns_)) * kLargestCell + int(part / parts_along) * kPart, kPart, view);
  }
  /// Faces that reach out of the picture.
  [[nodiscard]] const std::vector<std::uint32_t>& beyond_picture() const { return beyond_picture_; }

 private:
  /// Side length of the largest cells, in pixels.
  static constexpr int kLargestCell = 32;
  static constexpr int kPart = kLargestCell / int(parts_along);

  /// A rectangle of parts of cells: first and last column, first and last row.
  struct Span {
    std::uint32_t left, right, top, bottom;
  };

  /// The box from x, y to x + size, y + size, as far as it lies in the picture.
  static CellBox square(int x, int y, int size, const View& view) {
    return {double(x), double(y), double(std::min(x + size, view.width)), double(std::min(y + size, view.height))};
  }

  void find_spans(const ViewedFaces& screen, const View& view) {
    const auto part_at = [](double at, int size) {
      return std::uint32_t(std::clamp(int(at * (1.0 / kPart)), 0, (size - 1) / kPart));  // clamps to the picture
    };
    for (std::uint32_t i = 0; i < spans_.size(); ++i) {
      const auto& c = screen.faces[i].corners;
      const ScreenPoint &p = screen.points[c[0]], &q = screen.points[c[1]], &r = screen.points[c[2]];
      const Range x = range_of(p.x, q.x, r.x), y = range_of(p.y, q.y, r.y);
      spans_[i] = {part_at(x.low, view.width), part_at(x.high, view.width), part_at(y.low, view.height),
                   part_at(y.high, view.height)};
      orders_[i] = order_of(std::max({p.key, q.key, r.key}));
      if (x.low < 0 || x.high > view.width || y.low < 0 || y.high > view.height) beyond_picture_.push_back(i);
    }
  }

  int columns_, rows_;
  Buffer<Span> spans_;            ///< by face
  Buffer<std::uint32_t> orders_;  ///< by face
  Buckets<ListedFace> lists_;     ///< by cell
  std::vector<std::uint32_t> beyond_picture_;
};

/// Sorts faces into buckets by their order, in linear time. Faces within a bucket are unordered.
class RoughOrder {
 public:
  void sort(std::span<const ListedFace> listed) {
    constexpr std::size_t kMostBuckets = 128, kFacesInBucket = 4;
    sorted_.resize(listed.size());
    ends_.clear();
    least_.clear();
    if (listed.empty()) return;
    const auto [first, last] = std::minmax_element(listed.begin(), listed.end());
    const std::uint64_t least = *first >> 32, range = (*last >> 32) - least + 1;
    const std::size_t wanted = std::min(kMostBuckets, listed.size() / kFacesInBucket + 1);
    const int shift = std::bit_width((range - 1) / wanted);
    const std::size_t count = std::size_t((range - 1) >> shift) + 1;
    const auto bucket_of = [&](ListedFace face) { return std::size_t(((face >> 32) - least) >> shift); };
    std::array<std::uint32_t, kMostBuckets + 1> ends{};
    std::array<std::uint32_t, kMostBuckets> nearest;
    nearest.fill(~0u);
    for (const ListedFace face : listed) {
      const std::size_t bucket = bucket_of(face);
      ++ends[bucket + 1];
      nearest[bucket] = std::min(nearest[bucket], std::uint32_t(face >> 32));
    }
    for (std::size_t i = 1; i <= count; ++i) ends[i] += ends[i - 1];
    for (const ListedFace face : listed) sorted_[ends[bucket_of(face)]++] = face;
    for (std::size_t i = 0; i < count; ++i) {
      if (ends[i] == (i == 0 ? 0 : ends[i - 1])) continue;
      ends_.push_back(ends[i]);
      least_.push_back(nearest[i]);
    }
  }

  /// Number of buckets. None of them is empty.
  [[nodiscard]] std::size_t size() const { return ends_.size(); }
  /// The least order in a bucket. No later bucket has a lesser order.
  [[nodiscard]] std::uint32_t least(std::size_t bucket) const { return least_[bucket]; }
  /// The faces, bucket after bucket.
  [[nodiscard]] const std::vector<ListedFace>& faces() const { return sorted_; }
  /// Beginning of a bucket in faces().
  [[nodiscard]] std::size_t begin(std::size_t bucket) const { return bucket == 0 ? 0 : ends_[bucket - 1]; }
  [[nodiscard]] std::size_t end(std::size_t bucket) const { return ends_[bucket]; }

 private:
  std::vector<ListedFace> sorted_;
  std::vector<std::uint32_t> ends_, least_;  ///< by bucket
};

}  // namespace frontmost::faces_detail
