// SPDX-License-Identifier: Apache-2.0
// The faces that meet each of the largest cells, and the order in which they are examined.
//
//   ListedFace   bit 63      32 31     0
//                    | order  | face   |     nearer faces have lesser numbers
#pragma once

#include <span>
#include <vector>

#include "report/faces/viewed_faces.h"

namespace frontmost::faces_detail {

using ListedFace = std::uint64_t;

[[nodiscard]] inline std::uint32_t face_of(ListedFace listed) { return std::uint32_t(listed); }
/// The order of a key: greater keys have lesser orders, or the same.
[[nodiscard]] std::uint32_t order_of(double key);
/// A key that no key of this order, or of a greater one, exceeds.
[[nodiscard]] double key_before(std::uint32_t order);

/// The faces whose boxes meet each of the largest cells, with the nearest key of each whole face.
class CellLists {
 public:
  /// Number of parts along each side of a cell, unless the picture ends before.
  static constexpr std::uint32_t parts_along = 4;
  static constexpr std::size_t parts_of_cell = std::size_t(parts_along) * parts_along;

  CellLists(const ViewedFaces& screen, const View& view);

  [[nodiscard]] std::size_t size() const { return std::size_t(columns_) * std::size_t(rows_); }
  [[nodiscard]] std::span<const ListedFace> operator[](std::size_t cell) const {
    const std::size_t begin = cell == 0 ? 0 : ends_[cell - 1];
    return {listed_.data() + begin, ends_[cell] - begin};
  }
  [[nodiscard]] CellBox box(std::size_t cell, const View& view) const;
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
  [[nodiscard]] CellBox box_of_part(std::size_t cell, std::size_t part, const View& view) const;
  /// Faces that reach out of the picture.
  [[nodiscard]] const std::vector<std::uint32_t>& beyond_picture() const { return beyond_picture_; }

 private:
  /// A rectangle of parts of cells, inclusive.
  struct Span {
    std::uint32_t left, right, top, bottom;
  };

  void find_spans(const ViewedFaces& screen, const View& view);

  int columns_, rows_;
  std::vector<std::size_t> ends_;  ///< by cell: end of its faces
  Buffer<Span> spans_;             ///< by face
  Buffer<std::uint32_t> orders_;   ///< by face
  Buffer<ListedFace> listed_;
  std::vector<std::uint32_t> beyond_picture_;
};

/// Faces in buckets by their order, unordered within each bucket, in linear time.
class RoughOrder {
 public:
  void sort(std::span<const ListedFace> listed);

  /// Number of buckets. None of them is empty.
  [[nodiscard]] std::size_t size() const { return ends_.size(); }
  /// The least order in a bucket, and so in it and all later ones.
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
