// SPDX-License-Identifier: Apache-2.0
// Marking the samples that triangles cover, and counting marked samples.
//
// A row of a triangle is a span. It begins at the first pixel whose sample lies inside all edges that go up, and ends
// before the first pixel whose sample lies outside an edge that goes down. The sign of an edge E(x) = n - d * 256 x
// changes at n / (256 d), rounded up:
//
//    edge goes up    (left, points inclusive)       first pixel    ceil(n / (256 d))
//    edge goes down  (right, points exclusive)   end            ceil(n / (256 d))
//
// n is an integer below 2^53 and exact in a double. With n - 1/2 in place of n, the quotient is at least 1 / (512 d) >
// 2^-33 away from any integer. A product with a reciprocal is wrong by less than 2^-36 for pixels of any canvas.
// Rounding up therefore finds the same integer as exact arithmetic.

#include "report/accounting/object_mask.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "report/accounting/mask_kernel.cpp"
#include <bit>

#include "base/highway-inl.h"
#include "base/isa.h"
// After Highway: a block of its own.
#include "base/lanes-inl.h"
#include "zbuffer/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::accounting_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::HWY_NAMESPACE;
using zbuffer_detail::HWY_NAMESPACE::CoordinateRange;
using zbuffer_detail::HWY_NAMESPACE::PixelRange;
using zbuffer_detail::HWY_NAMESPACE::PixelsOf;
using zbuffer_detail::HWY_NAMESPACE::RangeOf;

using DD = hn::ScalableTag<double>;
using VD = hn::Vec<DD>;
constexpr std::size_t kMaxRows = hn::MaxLanes(DD());  // rows whose spans are found at once

/// The corners of a triangle, ordered so that its area is positive.
struct MaskTriangle {
  std::int32_t x[3], y[3];
};

/// The bound that an edge sets for spans, as a linear function of the row, in pixels. The edge is not level.
struct SpanSide {
  double numerator, step;  ///< numerator at the first row, an integer less 1/2, and its change per row
  double inverse;
};

class SpanFinder {
 public:
  SpanFinder(const MaskPlane& plane, const MaskTriangle& t) : width_(plane.width) {
    const std::int32_t low = std::min({t.y[0], t.y[1], t.y[2]}), high = std::max({t.y[0], t.y[1], t.y[2]});
    first_ = std::max((low + 255 - plane.place.y) >> 8, 0);
    last_ = std::min((high - plane.place.y) >> 8, plane.height - 1);
    for (int k = 0; k < 3; ++k) AddEdge(plane, t, k);
  }

  [[nodiscard]] int first() const { return first_; }
  [[nodiscard]] int last() const { return last_; }

  /// Calls visit(row, begin, end) for one vector of rows after another; `row` is the first row of the vector.
  template <class Visit>
  HWY_INLINE void ForRows(const Visit& visit) const {
    const DD d;
    for (int row = first_; row <= last_; row += int(hn::Lanes(d))) {
      const VD below = hn::Add(hn::Iota(d, 0), hn::Set(d, double(row - first_)));
      VD begin = hn::Zero(d), end = hn::Set(d, double(width_));
      for (int i = 0; i < left_count_; ++i) begin = hn::Max(begin, At(left_[i], below));
      for (int i = 0; i < right_count_; ++i) end = hn::Min(end, At(right_[i], below));
      // The bounds are limited to the canvas, so all of them are small integers.
      visit(row, hn::Min(begin, hn::Set(d, double(width_))), hn::Max(end, hn::Zero(d)));
    }
  }

 private:
  static HWY_INLINE VD At(const SpanSide& side, VD row) {
    const DD d;
    const VD numerator = hn::Add(hn::Set(d, side.numerator), hn::Mul(row, hn::Set(d, side.step)));
    return hn::Ceil(hn::Mul(numerator, hn::Set(d, side.inverse)));
  }

  HWY_INLINE void AddEdge(const MaskPlane& plane, const MaskTriangle& t, int k) {
    const int n = k == 2 ? 0 : k + 1;
    const double dx = t.x[n] - t.x[k], dy = t.y[n] - t.y[k];
    if (dy == 0) {
      // A level edge bounds no span, since rows beyond it are not visited. But a lower level edge excludes its own
      // points, and so a row that lies exactly on it.
      if (dx < 0 && last_ * 256 + plane.place.y == t.y[k]) --last_;
      return;
    }
    const double first_y = first_ * 256 + plane.place.y - t.y[k], from_x = t.x[k] - plane.place.x;
    // An edge that goes up has its signs inverted, so that the divisor is positive.
    const double sign = dy < 0 ? -1 : 1;
    const SpanSide side{sign * (dx * first_y + dy * from_x) - 0.5, sign * dx * 256, sign / (dy * 256)};
    if (dy < 0)
      left_[left_count_++] = side;
    else
      right_[right_count_++] = side;
  }

  SpanSide left_[2], right_[2];
  int left_count_ = 0, right_count_ = 0;
  int width_, first_, last_;
};

HWY_INLINE void MarkSpan(std::uint64_t* row, int begin, int end) {
  const int word = begin / kWordPixels, last = (end - 1) / kWordPixels;
  const std::uint64_t from = ~std::uint64_t(0) << (begin % kWordPixels);
  const std::uint64_t to = ~std::uint64_t(0) >> (kWordPixels - 1 - (end - 1) % kWordPixels);
  if (word == last) {
    row[word] |= from & to;
    return;
  }
  row[word] |= from;
  for (int i = word + 1; i < last; ++i) row[i] = ~std::uint64_t(0);
  row[last] |= to;
}

/// Marks one triangle, many rows at once.
void MarkTriangle(const MaskPlane& plane, const MaskTriangle& triangle) {
  const hn::Rebind<std::int32_t, DD> d32;
  const SpanFinder finder(plane, triangle);
  finder.ForRows([&](int row, VD begin, VD end) HWY_ATTR {
    HWY_ALIGN_MAX std::int32_t begins[kMaxRows], ends[kMaxRows];
    hn::Store(hn::DemoteTo(d32, begin), d32, begins);
    hn::Store(hn::DemoteTo(d32, end), d32, ends);
    const int rows = std::min(finder.last() - row + 1, int(hn::Lanes(DD())));
    for (int r = 0; r < rows; ++r)
      if (begins[r] < ends[r]) MarkSpan(plane.row(row + r), begins[r], ends[r]);
  });
}

/// Marks small triangles, as many at once as a vector holds, and in each step one row of every triangle.
class SmallMarker {
 public:
  /// Triangles larger than this, in pixels, are marked one by one. The edge values of smaller ones fit into 32 bits.
  /// The lower 8 bits of an edge value decide nothing; without these bits the values fit into floats. Over 64 pixels a
  /// quotient is wrong by less than 2^-16. With half a unit subtracted, a quotient is at least 2^-15 away from any
  /// integer.
  static constexpr std::int32_t kMostPixels = 62, kMostRows = 32;

  SmallMarker(const MaskPlane& plane, const BatchColumns& columns) : plane_(plane), columns_(columns) {}

  void Mark(std::size_t first, std::size_t count) {
    const DI d;
    const MI live = hn::Lt(hn::Iota(d, 0), hn::Set(d, std::int32_t(std::min(count, hn::Lanes(d)))));
    for (int k = 0; k < 3; ++k) {
      x_[k] = hn::LoadU(d, columns_.x[k] + first);
      y_[k] = hn::LoadU(d, columns_.y[k] + first);
    }
    const CoordinateRange x = RangeOf(x_[0], x_[1], x_[2]), y = RangeOf(y_[0], y_[1], y_[2]);
    const std::int32_t place_x = plane_.place.x, place_y = plane_.place.y;
    rows_ = PixelsOf(y, place_y, place_y, plane_.height);
    left_ = PixelsOf(x, place_x, place_x, plane_.width).first;
    const VI extent = hn::Max(hn::Sub(x.greatest, x.least), hn::Sub(y.greatest, y.least));
    const VI height = hn::Sub(rows_.last, rows_.first);
    const MI small = hn::And(hn::Lt(extent, hn::Set(d, kMostPixels * 256)), hn::Lt(height, hn::Set(d, kMostRows)));
    ForEachBit(BitsOf(d, hn::AndNot(small, live)), [&](std::size_t lane) {
      const std::size_t i = first + lane;
      MarkTriangle(plane_, {{columns_.x[0][i], columns_.x[1][i], columns_.x[2][i]},
                            {columns_.y[0][i], columns_.y[1][i], columns_.y[2][i]}});
    });
    MarkSmall(hn::And(small, live), height);
  }

 private:
  HWY_INLINE void MarkSmall(MI live, VI height) {
    const DI d;
    const std::int32_t most = hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElse(live, height, hn::Set(d, -1))));
    VF edge[3], step[3], inverse[3];
    MF is_left[3];
    for (int k = 0; k < 3; ++k) SetUpEdge(k, edge[k], step[k], inverse[k], is_left[k]);
    for (std::int32_t row = 0; row <= most; ++row) {
      const DF df;
      VF begin = hn::Zero(df), end = hn::Set(df, 64);
      for (int k = 0; k < 3; ++k) {
        const VF crossing = hn::Mul(edge[k], inverse[k]);
        begin = hn::IfThenElse(is_left[k], hn::Max(begin, crossing), begin);
        end = hn::IfThenElse(is_left[k], end, hn::Min(end, crossing));
        edge[k] = hn::Sub(edge[k], step[k]);
      }
      const MI in_row = hn::AndNot(hn::Lt(height, hn::Set(d, row)), live);
      MarkRow(in_row, hn::Add(rows_.first, hn::Set(d, row)),
              hn::ConvertTo(d, hn::Ceil(hn::Min(begin, hn::Set(df, 64)))),
              hn::ConvertTo(d, hn::Ceil(hn::Max(end, hn::Zero(df)))));
    }
  }

  /// An edge has the value n + s x at pixel x, counted from left_. `edge` is -(n + 1/2), `step` is the growth of n per
  /// row, and the edge is crossed at x = edge * inverse. A level edge counts as a left edge that is crossed far away:
  /// to the left if the row lies inside of the edge, otherwise to the right.
  HWY_INLINE void SetUpEdge(int k, VF& edge, VF& step, VF& inverse, MF& is_left) const {
    const DI d;
    const DF df;
    const int n = k == 2 ? 0 : k + 1;
    const VI dx = hn::Sub(x_[n], x_[k]), dy = hn::Sub(y_[n], y_[k]), zero = hn::Zero(d);
    const VI from_y = hn::Sub(hn::Add(hn::ShiftLeft<8>(rows_.first), hn::Set(d, plane_.place.y)), y_[k]);
    const VI from_x = hn::Sub(hn::Add(hn::ShiftLeft<8>(left_), hn::Set(d, plane_.place.x)), x_[k]);
    const VI value = hn::Sub(hn::Mul(dx, from_y), hn::Mul(dy, from_x));
    const MI is_top_left = hn::Or(hn::Lt(dy, zero), hn::And(hn::Eq(dy, zero), hn::Gt(dx, zero)));
    const VI biased = hn::IfThenElse(is_top_left, value, hn::Sub(value, hn::Set(d, 1)));
    edge = hn::Neg(hn::Add(hn::ConvertTo(df, hn::ShiftRight<8>(biased)), hn::Set(df, 0.5f)));
    step = hn::ConvertTo(df, dx);
    inverse = hn::Div(hn::Set(df, 1), hn::ConvertTo(df, hn::Neg(dy)));
    is_left = hn::RebindMask(df, hn::Not(hn::Gt(dy, zero)));
  }

  /// Marks pixels [begin, end), counted from the left, in a row of each triangle.
  HWY_INLINE void MarkRow(MI live, VI row, VI begin, VI end) {
    const DI d;
    const VI stop = hn::Min(hn::Add(left_, end), hn::Set(d, plane_.width)), start = hn::Add(left_, begin);
    const VI count = hn::Sub(stop, start);
    const std::uint64_t some = BitsOf(d, hn::And(live, hn::Gt(count, hn::Zero(d))));
    if (some == 0) return;
    HWY_ALIGN_MAX std::int32_t word[kMaxLanes], bit[kMaxLanes], length[kMaxLanes];
    const VI first = hn::Mul(row, hn::Set(d, std::int32_t(plane_.stride)));
    hn::Store(hn::Add(first, hn::ShiftRight<6>(start)), d, word);
    hn::Store(hn::And(start, hn::Set(d, kWordPixels - 1)), d, bit);
    hn::Store(count, d, length);
    ForEachBit(some, [&](std::size_t lane) {
      const std::uint64_t bits = ~std::uint64_t(0) >> (kWordPixels - length[lane]);
      std::uint64_t* const words = plane_.words + word[lane];
      words[0] |= bits << bit[lane];
      if (bit[lane] + length[lane] > kWordPixels) words[1] |= bits >> (kWordPixels - bit[lane]);
    });
  }

  const MaskPlane& plane_;
  const BatchColumns& columns_;
  // The packet that is being marked.
  VI x_[3], y_[3];
  PixelRange rows_;
  VI left_;  // the first pixel column
};

void MarkTriangles(const MaskPlane& plane, const BatchColumns& columns, std::size_t count) {
  SmallMarker marker(plane, columns);
  for (std::size_t i = 0; i < count; i += hn::Lanes(DI())) marker.Mark(i, count - i);
}

void FindSpans(const MaskPlane& plane, const TriangleRecord& record, RowSpans& spans) {
  const hn::Rebind<std::int32_t, DD> d32;
  MaskTriangle triangle;
  std::copy_n(record.x, 3, triangle.x);
  std::copy_n(record.y, 3, triangle.y);
  const SpanFinder finder(plane, triangle);
  spans.first = finder.first();
  spans.count = std::max(finder.last() - finder.first() + 1, 0);
  const std::size_t room = std::size_t(spans.count) + kMaxRows;
  if (spans.begin.size() < room) spans.begin.resize(room), spans.end.resize(room);
  finder.ForRows([&](int row, VD begin, VD end) HWY_ATTR {
    hn::StoreU(hn::DemoteTo(d32, begin), d32, spans.begin.data() + (row - spans.first));
    hn::StoreU(hn::DemoteTo(d32, end), d32, spans.end.data() + (row - spans.first));
  });
}

void MarkSpans(const MaskPlane& plane, const RowSpans& spans) {
  for (int i = 0; i < spans.count; ++i) {
    const std::int32_t begin = spans.begin[std::size_t(i)], end = spans.end[std::size_t(i)];
    if (begin < end) MarkSpan(plane.row(spans.first + i), begin, end);
  }
}

/// The bits of a word for pixels [x0, x1].
HWY_INLINE std::uint64_t BitsWithin(int word, int x0, int x1) {
  const int first = x0 - word * kWordPixels, last = x1 - word * kWordPixels;
  std::uint64_t bits = ~std::uint64_t(0);
  if (first > 0) bits = bits << first;
  if (last < kWordPixels - 1) bits &= ~std::uint64_t(0) >> (kWordPixels - 1 - last);
  return bits;
}

MarkedSamples CountMarked(const MaskPlane& plane, const PixelRect& rect) {
  MarkedSamples marked;
  const int first = rect.x0 / kWordPixels, last = rect.x1 / kWordPixels;
  int x0 = plane.width, x1 = -1;
  for (int y = rect.y0; y <= rect.y1; ++y) {
    const std::uint64_t* const row = plane.row(y);
    bool any = false;
    for (int w = first; w <= last; ++w) {
      const std::uint64_t bits = row[w] & BitsWithin(w, rect.x0, rect.x1);
      if (bits == 0) continue;
      marked.count += std::uint64_t(std::popcount(bits));
      x0 = std::min(x0, w * kWordPixels + std::countr_zero(bits));
      x1 = std::max(x1, w * kWordPixels + 63 - std::countl_zero(bits));
      any = true;
    }
    if (!any) continue;
    if (marked.rect.is_empty()) marked.rect = {0, y, 0, y};
    marked.rect.y1 = y;
  }
  if (marked.count > 0) marked.rect.x0 = x0, marked.rect.x1 = x1;
  return marked;
}

std::uint64_t CountCommon(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += std::uint64_t(std::popcount(a[i] & b[i]));
  return count;
}

SeenSpan FindSeenSpan(std::span<const PrimitiveId> ids, const float* keys, PrimitiveId first, std::uint32_t count) {
  const DU d;
  const DI di;
  const DF df;
  SeenSpan span{0, 0};
  // Keys are not negative, so they are ordered like their bits.
  auto nearest = hn::Zero(di);
  for (; span.end + hn::Lanes(d) <= ids.size(); span.end += hn::Lanes(d)) {
    const auto number = hn::Sub(hn::LoadU(d, ids.data() + span.end), hn::Set(d, first));
    if (!hn::AllTrue(d, hn::Lt(number, hn::Set(d, count)))) break;
    nearest = hn::Max(nearest, hn::BitCast(di, hn::LoadU(df, keys + span.end)));
  }
  span.nearest = hn::GetLane(hn::BitCast(df, hn::MaxOfLanes(di, nearest)));
  for (; span.end < ids.size() && ids[span.end] - first < count; ++span.end)
    span.nearest = std::max(span.nearest, keys[span.end]);
  return span;
}

void CountSeen(const MaskPlane& plane, const PixelRect& rect, const SeenObjects& seen, SampleCounts& counts) {
  const int first = rect.x0 / kWordPixels, last = rect.x1 / kWordPixels;
  for (int y = rect.y0; y <= rect.y1; ++y) {
    const std::uint64_t* const row = plane.row(y);
    for (int w = first; w <= last; ++w) {
      if (row[w] == 0) continue;
      for (const SeenRun& run : seen.in(plane.number, y, w)) {
        const std::uint64_t bits = row[w] & run.bits();
        if (bits == 0 || run.object == no_index) continue;
        std::uint32_t& count = counts.of_object[run.object];
        if (count == 0) counts.met.push_back(run.object);
        count += std::uint32_t(std::popcount(bits));
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::accounting_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::accounting_detail {

FRONTMOST_KERNELS(MarkTriangles);
FRONTMOST_KERNELS(FindSpans);
FRONTMOST_KERNELS(MarkSpans);
FRONTMOST_KERNELS(CountMarked);
FRONTMOST_KERNELS(CountCommon);
FRONTMOST_KERNELS(CountSeen);
FRONTMOST_KERNELS(FindSeenSpan);

void mark_triangles(const MaskPlane& plane, const BatchColumns& columns, std::size_t count, Isa isa) {
  kernel_for(MarkTrianglesKernels, isa)(plane, columns, count);
}

void find_spans(const MaskPlane& plane, const TriangleRecord& record, RowSpans& spans, Isa isa) {
  kernel_for(FindSpansKernels, isa)(plane, record, spans);
}

void mark_spans(const MaskPlane& plane, const RowSpans& spans, Isa isa) {
  kernel_for(MarkSpansKernels, isa)(plane, spans);
}

MarkedSamples count_marked(const MaskPlane& plane, const PixelRect& rect, Isa isa) {
  return kernel_for(CountMarkedKernels, isa)(plane, rect);
}

std::uint64_t count_common(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b, Isa isa) {
  return kernel_for(CountCommonKernels, isa)(a, b);
}

void count_seen(const MaskPlane& plane, const PixelRect& rect, const SeenObjects& seen, SampleCounts& counts, Isa isa) {
  kernel_for(CountSeenKernels, isa)(plane, rect, seen, counts);
}

SeenSpan find_seen_span(std::span<const PrimitiveId> ids, const float* keys, PrimitiveId first, std::uint32_t count,
                        Isa isa) {
  return kernel_for(FindSeenSpanKernels, isa)(ids, keys, first, count);
}

}  // namespace frontmost::accounting_detail
#endif  // HWY_ONCE
