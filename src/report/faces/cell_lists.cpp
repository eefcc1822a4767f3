// SPDX-License-Identifier: Apache-2.0
#include "report/faces/cell_lists.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace frontmost::faces_detail {
namespace {

/// Pixels along a side of the cells that the picture is divided into at first.
constexpr int kLargestCell = 32;

}  // namespace

std::uint32_t order_of(double key) {
  const float rounded = float(key) + 0.0f;  // -0 is 0
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
      for (std::size_t row = span.top; row <= span.bottom; ++row)
        for (std::size_t column = span.left; column <= span.right; ++column)
          body(row * std::size_t(columns_) + column, i);
    }
  };
  visit([&](std::size_t cell, std::size_t) { ++ends_[cell + 1]; });
  for (std::size_t i = 1; i < ends_.size(); ++i) ends_[i] += ends_[i - 1];
  listed_ = Buffer<ListedFace>(ends_.back());
  visit([&](std::size_t cell, std::size_t face) { listed_[ends_[cell]++] = ListedFace(orders_[face]) << 32 | face; });
}

void CellLists::find_spans(const ViewedFaces& screen, const View& view) {
  const auto cell_at = [](double at, int count) {
    return std::uint16_t(std::clamp(int(std::floor(at / kLargestCell)), 0, count - 1));
  };
  for (std::uint32_t i = 0; i < spans_.size(); ++i) {
    const auto& c = screen.faces[i].corners;
    const ScreenPoint &p = screen.points[c[0]], &q = screen.points[c[1]], &r = screen.points[c[2]];
    const Range x = range_of(p.x, q.x, r.x), y = range_of(p.y, q.y, r.y);
    spans_[i] = {cell_at(x.low, columns_), cell_at(x.high, columns_), cell_at(y.low, rows_), cell_at(y.high, rows_)};
    orders_[i] = order_of(std::max({p.key, q.key, r.key}));
    if (x.low < 0 || x.high > view.width || y.low < 0 || y.high > view.height) beyond_picture_.push_back(i);
  }
}

CellBox CellLists::box(std::size_t cell, const View& view) const {
  const auto x = int(cell % std::size_t(columns_)) * kLargestCell, y = int(cell / std::size_t(columns_)) * kLargestCell;
  return {double(x), double(y), double(std::min(x + kLargestCell, view.width)),
          double(std::min(y + kLargestCell, view.height))};
}

void RoughOrder::sort(std::span<const ListedFace> listed) {
  constexpr std::size_t kMostBuckets = 128, kFacesInBucket = 8;
  sorted_.resize(listed.size());
  ends_.clear();
  least_.clear();
  if (listed.empty()) return;
  const auto [first, last] = std::minmax_element(listed.begin(), listed.end());
  const std::uint64_t least = *first >> 32, range = (*last >> 32) - least + 1;
  const std::uint64_t count = std::min(kMostBuckets, listed.size() / kFacesInBucket + 1);
  const auto bucket_of = [&](ListedFace face) { return std::size_t(((face >> 32) - least) * count / range); };
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
