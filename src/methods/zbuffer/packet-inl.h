// SPDX-License-Identifier: Apache-2.0
// Packets of triangles, in the form that all paths of drawing share.
//
//    lane        0     1     2    ...           A packet is as many triangles as the vector has lanes. Edges and key
//    edge 0      e0    e0    e0                 planes are set up for all at once, and then all are walked in step: in
//    edge 1      e1    e1    e1                 step k each lane tests the k-th pixel of its own rectangle.
//    key plane   k     k     k

// Included once for every target.
#if defined(FRONTMOST_ZBUFFER_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ZBUFFER_PACKET_INL_H_
#undef FRONTMOST_ZBUFFER_PACKET_INL_H_
#else
#define FRONTMOST_ZBUFFER_PACKET_INL_H_
#endif

#include "base/highway-inl.h"
#include "base/lane_types-inl.h"
#include "base/lanes-inl.h"
#include "view/facing-inl.h"
#include "view/key_planes-inl.h"
#include "zbuffer/place/triangle_batch.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::HWY_NAMESPACE;
using view_detail::HWY_NAMESPACE::Kept;
using view_detail::HWY_NAMESPACE::KeyPlanes;
using view_detail::HWY_NAMESPACE::KeyPlanesOf;

// Vertices no farther apart than this keep every edge value inside the triangle's box within 32 bits: two products of
// at most 31744 * (31744 + 256).
constexpr std::int32_t kSmallExtent = 124 * 256;

#if HWY_TARGET <= HWY_AVX3
// 64 entries are four vectors, and one permutation reads two vectors. A gather takes several times as long.
HWY_INLINE VI LookUp64(const std::int32_t* table, VI number) {
  const auto low = _mm512_permutex2var_epi32(_mm512_load_si512(table), number.raw, _mm512_load_si512(table + 16));
  const auto high = _mm512_permutex2var_epi32(_mm512_load_si512(table + 32), number.raw, _mm512_load_si512(table + 48));
  return VI{_mm512_mask_blend_epi32(_mm512_test_epi32_mask(number.raw, _mm512_set1_epi32(32)), low, high)};
}
#else
/// Returns the entries of an aligned table of 64 at the indices `number`.
HWY_INLINE VI LookUp64(const std::int32_t* table, VI number) { return hn::GatherIndex(DI(), table, number); }
#endif

/// The least and the greatest coordinate of each triangle.
struct CoordinateRange {
  VI least, greatest;
};
HWY_INLINE CoordinateRange RangeOf(VI a, VI b, VI c) { return {hn::Min(a, hn::Min(b, c)), hn::Max(a, hn::Max(b, c))}; }

struct PixelRange {
  VI first, last;
};
/// PixelsOf() for the pixels from `first` to `last`.
HWY_INLINE PixelRange PixelsBetween(const CoordinateRange& range, std::int32_t low, std::int32_t high,
                                    std::int32_t first, std::int32_t last) {
  const DI d;
  return {hn::Max(hn::ShiftRight<8>(hn::Add(range.least, hn::Set(d, 255 - high))), hn::Set(d, first)),
          hn::Min(hn::ShiftRight<8>(hn::Sub(range.greatest, hn::Set(d, low))), hn::Set(d, last))};
}
/// The first of `size` pixels that has a sample at or after the least coordinate, and the last that has one at or
/// before the greatest. `low` and `high` are the outermost sample offsets. The range is empty if first > last.
HWY_INLINE PixelRange PixelsOf(const CoordinateRange& range, std::int32_t low, std::int32_t high, std::int32_t size) {
  return PixelsBetween(range, low, high, 0, size - 1);
}

/// One vertex of each triangle of a vector: its number, and its place on the screen.
struct Corners {
  VI number, x, y;
};
HWY_INLINE Corners Chosen(MI mask, const Corners& yes, const Corners& no) {
  return {hn::IfThenElse(mask, yes.number, no.number), hn::IfThenElse(mask, yes.x, no.x),
          hn::IfThenElse(mask, yes.y, no.y)};
}

/// Winding of small triangles. Triangles that face the eye have negative areas, as y is down; swapping their last two
/// vertices makes the areas positive.
struct Winding {
  MI front;
  MI kept;  ///< triangles that have an area and are not culled
};
/// Precondition: vertices of kept triangles are no farther apart than kSmallExtent.
template <class Ids>
HWY_INLINE Winding WindingOf(const FacingRule& facing, const Corners (&corners)[3], MI asked, const Ids& ids) {
  const Corners &a = corners[0], &b = corners[1], &c = corners[2];
  const VI zero = hn::Zero(DI());
  const VI area = hn::Sub(hn::Mul(hn::Sub(b.x, a.x), hn::Sub(c.y, a.y)), hn::Mul(hn::Sub(c.x, a.x), hn::Sub(b.y, a.y)));
  const MI front = hn::Lt(area, zero);
  const MI back = hn::Gt(area, zero);
  return {front, Kept(DI(), facing, front, hn::And(back, asked), ids)};
}

HWY_INLINE MI AllLanes() { return hn::Eq(hn::Zero(DI()), hn::Zero(DI())); }

/// The triangles of a packet that may cover a sample. The order of their vertices makes their areas positive.
struct PlacedPacket {
  MI kept;
  const Corners corners[3];
  PixelRange columns, rows;
};

/// Returns BatchColumns::tiles of each triangle. Eight bits a number are enough, because the largest image has 128
/// tiles in either direction.
HWY_INLINE VI TilesOf(const PixelRange& columns, const PixelRange& rows) {
  static_assert(kTileSize == 1 << 7);
  const VI first = hn::Or(hn::ShiftRight<7>(columns.first), hn::ShiftLeft<8>(hn::ShiftRight<7>(rows.first)));
  const VI last = hn::Or(hn::ShiftRight<7>(columns.last), hn::ShiftLeft<8>(hn::ShiftRight<7>(rows.last)));
  return hn::Or(first, hn::ShiftLeft<16>(last));
}

/// The pixel rectangle of a batch, widened by each packet that is placed.
class WidenedRect {
 public:
  explicit WidenedRect(const PixelRect& rect)
      : least_x_(hn::Set(DI(), rect.x0)),
        least_y_(hn::Set(DI(), rect.y0)),
        greatest_x_(hn::Set(DI(), rect.x1)),
        greatest_y_(hn::Set(DI(), rect.y1)) {}
  HWY_INLINE void Add(const PlacedPacket& placed) {
    least_x_ = hn::IfThenElse(placed.kept, hn::Min(least_x_, placed.columns.first), least_x_);
    least_y_ = hn::IfThenElse(placed.kept, hn::Min(least_y_, placed.rows.first), least_y_);
    greatest_x_ = hn::IfThenElse(placed.kept, hn::Max(greatest_x_, placed.columns.last), greatest_x_);
    greatest_y_ = hn::IfThenElse(placed.kept, hn::Max(greatest_y_, placed.rows.last), greatest_y_);
  }
  [[nodiscard]] PixelRect rect() const {
    const DI d;
    return {hn::GetLane(hn::MinOfLanes(d, least_x_)), hn::GetLane(hn::MinOfLanes(d, least_y_)),
            hn::GetLane(hn::MaxOfLanes(d, greatest_x_)), hn::GetLane(hn::MaxOfLanes(d, greatest_y_))};
  }

 private:
  VI least_x_, least_y_, greatest_x_, greatest_y_;
};

/// Finds which `live` triangles may cover a sample, and passes them to `sink`. The sink's ColumnsOf(range) and
/// RowsOf(range) return the pixels that have a sample within a range of coordinates, and Ids() returns the ids.
/// PutLarge(mask) receives the triangles with vertices farther apart than kSmallExtent, not yet oriented or culled.
/// PutSmall(placed) receives all others.
template <class Sink>
HWY_INLINE void SortOut(const Corners (&c)[3], MI live, const FacingRule& facing, Sink& sink) {
  const DI d;
  const CoordinateRange x = RangeOf(c[0].x, c[1].x, c[2].x), y = RangeOf(c[0].y, c[1].y, c[2].y);
  const PixelRange columns = sink.ColumnsOf(x), rows = sink.RowsOf(y);
  MI keep = hn::AndNot(hn::Or(hn::Gt(columns.first, columns.last), hn::Gt(rows.first, rows.last)), live);
  if (hn::AllFalse(d, keep)) return;
  const VI extent = hn::Max(hn::Sub(x.greatest, x.least), hn::Sub(y.greatest, y.least));
  const MI large = hn::And(keep, hn::Gt(extent, hn::Set(d, kSmallExtent)));
  if (!hn::AllFalse(d, large)) {
    sink.PutLarge(large);
    keep = hn::AndNot(large, keep);
  }
  const Winding winding = WindingOf(facing, c, keep, [&]() HWY_ATTR { return sink.Ids(); });
  keep = hn::And(keep, winding.kept);
  if (hn::AllFalse(d, keep)) return;
  sink.PutSmall({keep, {c[0], Chosen(winding.front, c[2], c[1]), Chosen(winding.front, c[1], c[2])}, columns, rows});
}

/// Three edges and a key plane for each triangle. Vertices are no farther apart than kSmallExtent, and areas are
/// positive.
struct Packet : KeyPlanes {
  VI x[3], y[3];  // vertices
  CoordinateRange columns, rows;
  VI dx[3], dy[3], bias[3];  // edge k starts at vertex k
  VI area;                   // twice the area
};

/// Precondition: the vertices of `b` are set.
HWY_INLINE void SetUpPacket(Packet& b, const VF (&key)[3]) {
  b.columns = RangeOf(b.x[0], b.x[1], b.x[2]);
  b.rows = RangeOf(b.y[0], b.y[1], b.y[2]);
  for (int k = 0; k < 3; ++k) {
    const int n = k == 2 ? 0 : k + 1;
    b.dx[k] = hn::Sub(b.x[n], b.x[k]);
    b.dy[k] = hn::Sub(b.y[n], b.y[k]);
    // Top-left edges include their own points, with bias 0; other edges have bias -1. An edge is top-left if dy < 0, or
    // dy = 0 and dx > 0. The test is dy * 2^16 - dx < 0, as both are within 15 bits.
    b.bias[k] = hn::Not(hn::ShiftRight<31>(hn::Sub(hn::ShiftLeft<16>(b.dy[k]), b.dx[k])));
  }
  b.area = hn::Sub(hn::Mul(b.dx[2], b.dy[0]), hn::Mul(b.dx[0], b.dy[2]));
  static_cast<KeyPlanes&>(b) = KeyPlanesOf(b.x, b.y, key);
}

/// Edge values at the samples (sx, sy) within the triangles' boxes. A sample is covered if no value is negative. From
/// pixel to pixel the values grow by -dy in x and by dx in y.
struct PacketEdges {
  VI e[3];
};
HWY_INLINE PacketEdges EdgesAt(const Packet& b, VI sx, VI sy) {
  PacketEdges at;
  for (int k = 0; k < 2; ++k)
    at.e[k] = hn::Sub(hn::Mul(b.dx[k], hn::Sub(sy, b.y[k])), hn::Mul(b.dy[k], hn::Sub(sx, b.x[k])));
  // The three edge functions of a point add up to twice the area.
  at.e[2] = hn::Sub(b.area, hn::Add(at.e[0], at.e[1]));
  for (int k = 0; k < 3; ++k) at.e[k] = hn::ShiftRight<8>(hn::Add(at.e[k], b.bias[k]));
  return at;
}

/// Reads those triangles of a batch that lie in one tile, a packet at a time. Triangles keep their order, because the
/// depth buffer needs it:
///
///    run of 20, vectors of 16    [ whole vector as it stands ][4 numbers wait]
///    next run of 7               [4 + 7 numbers wait]
///    next run of 9               [16 numbers: gathered together][4 wait]
///
/// Calls visit(count, fetch) for packets of `count` triangles. fetch(tag, column) reads a vector of a column of
/// BatchColumns; the lanes after the last triangle repeat the first triangle of the packet.
class RunReader {
 public:
  /// Reads whole vectors of a run directly if no triangles wait. All other triangles wait until they fill a vector,
  /// together with triangles of other runs, and are then gathered.
  template <class Visit>
  HWY_INLINE void Read(const TileRun& run, const Visit& visit) {
    const DI d;
    std::size_t i = run.first;
    const std::size_t end = i + run.count;
    if (run.count == 1) {  // most runs are this short if triangles are scattered
      numbers_[pending_++] = std::int32_t(i);
      if (pending_ == hn::Lanes(d)) Finish(visit);
      return;
    }
    for (; pending_ == 0 && i + hn::Lanes(d) <= end; i += hn::Lanes(d))
      visit(hn::Lanes(d), [&](auto tag, const auto* column) HWY_ATTR { return hn::LoadU(tag, column + i); });
    while (i < end) {
      const std::size_t taken = HWY_MIN(hn::Lanes(d) - pending_, end - i);
      hn::StoreU(CountFrom(d, std::int32_t(i)), d, numbers_ + pending_);
      pending_ += taken;
      i += taken;
      if (pending_ == hn::Lanes(d)) Finish(visit);
    }
  }

  /// Reads the triangles that still wait.
  template <class Visit>
  HWY_INLINE void Finish(const Visit& visit) {
    if (pending_ == 0) return;
    const DI d;
    const MI live = hn::Lt(hn::Iota(d, 0), hn::Set(d, std::int32_t(pending_)));
    const VI number = hn::IfThenElse(live, hn::Load(d, numbers_), hn::Set(d, numbers_[0]));
    visit(pending_, [&](auto tag, const auto* column) HWY_ATTR { return hn::GatherIndex(tag, column, number); });
    pending_ = 0;
  }

 private:
  HWY_ALIGN_MAX std::int32_t numbers_[2 * kMaxLanes];
  std::size_t pending_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
