// SPDX-License-Identifier: Apache-2.0
#include "report/faces/cell_lists.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace frontmost::faces_detail {
namespace {

/// Side of the largest cells, in pixels.
constexpr int kLargestCell = 32;
constexpr int kPart = kLargestCell / int(CellLists::parts_along);

/// The box from x, y to x + size, y + size, as far as it lies in the picture.
CellBox square(int x, int y, int size, const View& view) {
  return {double(x), double(y), double(std::min(x + size, view.width)), double(std::min(y + size, view.height))};
}

}  // namespace

std::uint32_t order_of(double key) {
  const float rounded = float(key) + 0.0f;  // turns -0 into 0
  std::uint32_t bits;
  std::memcpy(&bits, &rounded, sizeof bits);
  return (bits >> 31) != 0 ? bits : ~bits & 0x7FFFFFFFu;
}

double key_before(std::uint32_t order) {
  const std::uint32_t bits = (order >> 31) != 0 ? order : ~order & 0x7FFFFFFFu;
  float rounded;
  std::memcpy(&rounded, &bits, sizeof bits);
  return double(std::nextafter(rounded, std::numeric_limits<float>::infinity()));
}

CellLists::CellLists(const ViewedFaces& screen, const View& view)
    : columns_((view.width + kLargestCell - 1) / kLargestCell),
      rows_((view.height + kLargestCell - 1) / kLargestCell),
      ends_(size() + 1, 0),
      spans_(screen.faces.size()),
      orders_(screen.faces.size()) {
  find_spans(screen, view);
  const auto visit = [&](const auto& body) {
    for (std::size_t i = 0; i < spans_.size(); ++i) {
      const Span span = spans_[i];
      const std::size_t right = span.right / parts_along, bottom = span.bottom / parts_along;
      for (std::size_t row = span.top / parts_along; row <= bottom; ++row)
        for (std::size_t column = span.left / parts_along; column <= right; ++column)
          body(row * std::size_t(columns_) + column, i);
    }
  };
  visit([&](std::size_t cell, std::size_t) { ++ends_[cell + 1]; });
  for (std::size_t i = 1; i < ends_.size(); ++i) ends_[i] += ends_[i - 1];
  listed_ = Buffer<ListedFace>(ends_.back());
  visit([&](std::size_t cell, std::size_t face) { listed_[ends_[cell]++] = ListedFace(orders_[face]) << 32 | face; });
}

void CellLists::find_spans(const ViewedFaces& screen, const View& view) {
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

CellBox CellLists::box(std::size_t cell, const View& view) const {
  return square(int(cell % std::size_t(columns_)) * kLargestCell, int(cell / std::size_t(columns_)) * kLargestCell,
                kLargestCell, view);
}

CellBox CellLists::box_of_part(std::size_t cell, std::size_t part, const View& view) const {
  return square(int(cell % std::size_t(columns_)) * kLargestCell + int(part % parts_along) * kPart,
                int(cell / std::size_t(columns_)) * kLargestCell + int(part / parts_along) * kPart, kPart, view);
}

void RoughOrder::sort(std::span<const ListedFace> listed) {
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

}  // namespace frontmost::faces_detail
