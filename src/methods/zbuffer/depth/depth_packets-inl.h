// SPDX-License-Identifier: Apache-2.0
// Triangles of a few pixels drawn into a depth buffer, a vector at once and yet in their order. All triangles of a
// packet are walked pixel by pixel in step, which gives each a mask of covered pixels. The masks are then drawn in
// order.
//
//    walk      lane 0: mask of 8 x 8 pixels     lane 1: mask     ...        all lanes in step
//    draw      fragments of triangle 0, then those of triangle 1, ...       in the order of submission
//
// Coverage does not depend on the order of triangles, so it is found for all together. Fragments are then listed in
// their order. Keys and depths are computed for a vector of fragments; the tests come one after the other.

// Included once for every target.
#if defined(FRONTMOST_ZBUFFER_DEPTH_PACKETS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ZBUFFER_DEPTH_PACKETS_INL_H_
#undef FRONTMOST_ZBUFFER_DEPTH_PACKETS_INL_H_
#else
#define FRONTMOST_ZBUFFER_DEPTH_PACKETS_INL_H_
#endif

#include <cstring>

#include "base/highway-inl.h"
#include "zbuffer/depth/depth_call.h"
#include "zbuffer/depth/depth_rows-inl.h"
#include "zbuffer/packet-inl.h"
#include "zbuffer/place/run_reader-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <bool is_float>
class DepthPackets {
 public:
  DepthPackets(const DepthCall& call, const Tile& tile)
      : call_(call), tile_(tile), test_(call.rules), rows_(call, tile, test_) {}

  void Draw(const OrderedBatch& batch) {
    const BatchColumns& from = batch.small().columns();
    const auto draw = [&](std::size_t count, const auto& fetch) HWY_ATTR { DrawPacket(count, fetch, from); };
    batch.visit_tile(
        tile_,
        [&](std::span<const TileRun> runs) HWY_ATTR {
          for (const TileRun& run : runs) reader_.Read(run, draw);
        },
        [&](const SingleTriangle& single) HWY_ATTR {
          reader_.Finish(draw);
          DrawSingle(single);
        });
    reader_.Finish(draw);
  }

 private:
  // Triangles with a pixel rectangle at most this wide and high are drawn in packets: 64 pixels, a bit each.
  static constexpr int kWalkLimit = 8;

  template <class Fetch>
  HWY_INLINE void DrawPacket(std::size_t count, const Fetch& fetch, const BatchColumns& from) {
    Load(count, fetch, from);
    DrawLoaded();
  }

  HWY_NOINLINE void DrawLoaded() {
    SetUpPacket(packet_, key_);
    walkable_ = hn::Not(packet_.steep);
    if (call_.cutouts) walkable_ = hn::AndNot(HaveHoles(), walkable_);
    if (call_.rules.has_offset())
      for (std::size_t k = 0; k < count_; ++k) {
        const TriangleRecord record = RecordOf(k);
        const auto [low, high] = std::minmax({record.key[0], record.key[1], record.key[2]});
        offset_[k] = OffsetOf(record, low, high);
      }
    for (std::size_t s = 0; s < call_.planes.samples.size(); ++s) {
      Walk(s);
      Empty(s);
    }
  }

  /// Loads a packet. `fetch` reads a vector of a column.
  template <class Fetch>
  HWY_INLINE void Load(std::size_t count, const Fetch& fetch, const BatchColumns& from) {
    const DI d;
    const VI left = hn::Set(d, tile_.x * kSubPixels), top = hn::Set(d, tile_.y * kSubPixels);
    for (int k = 0; k < 3; ++k) {
      packet_.x[k] = hn::Sub(fetch(d, from.x[k]), left);
      packet_.y[k] = hn::Sub(fetch(d, from.y[k]), top);
      key_[k] = hn::BitCast(DF(), fetch(d, from.key[k]));
    }
    id_ = hn::Add(fetch(DU(), from.id), hn::Set(DU(), call_.id_offset));
    count_ = count;
  }

  /// Draws one triangle, row by row.
  void DrawSingle(const SingleTriangle& single) {
    TriangleRecord record = single.record;
    record.id += call_.id_offset;
    for (int k = 0; k < 3; ++k) {
      record.x[k] -= tile_.x * kSubPixels;
      record.y[k] -= tile_.y * kSubPixels;
    }
    const double offset = call_.rules.has_offset() ? OffsetOf(record, single.low, single.high) : 0.0;
    for (std::size_t s = 0; s < call_.planes.samples.size(); ++s) rows_.Draw(record, offset, s);
  }

  [[nodiscard]] double OffsetOf(const TriangleRecord& record, float low, float high) const {
    const SteepKeys keys(record);
    return call_.rules.offset_of(keys.gx(), keys.gy(), low, high);
  }

  /// Lanes of triangles with holes. Rows draw them, as only rows test holes.
  [[nodiscard]] HWY_NOINLINE MI HaveHoles() const {
    HWY_ALIGN_MAX std::uint32_t id[kMaxLanes];
    HWY_ALIGN_MAX std::int32_t lanes[kMaxLanes] = {};
    hn::Store(id_, DU(), id);
    for (std::size_t k = 0; k < count_; ++k) lanes[k] = call_.cutouts->has(id[k] - call_.id_offset) ? -1 : 0;
    return hn::MaskFromVec(hn::Load(DI(), lanes));
  }

  /// Finds the pixels of each triangle in which this sample is covered, within eight by eight pixels of its first.
  HWY_INLINE void Walk(std::size_t sample) {
    const DI d;
    const glm::ivec2 offset = call_.planes.samples[sample];
    const PixelRange columns = PixelsOf(packet_.columns, offset.x, offset.x, tile_.width);
    const PixelRange rows = PixelsOf(packet_.rows, offset.y, offset.y, tile_.height);
    const VI one = hn::Set(d, 1), limit = hn::Set(d, kWalkLimit);
    VI width = hn::Add(hn::Sub(columns.last, columns.first), one);
    VI height = hn::Add(hn::Sub(rows.last, rows.first), one);
    const MI live = hn::Lt(hn::Iota(d, 0), hn::Set(d, std::int32_t(count_)));
    const MI any = hn::And(live, hn::Gt(hn::Min(width, height), hn::Zero(d)));
    const MI walked = hn::And(hn::And(any, walkable_), hn::Not(hn::Gt(hn::Max(width, height), limit)));
    by_row_ = BitsOf(d, hn::AndNot(walked, any));
    width = hn::IfThenElseZero(walked, width);
    height = hn::IfThenElseZero(walked, height);
    const VI sx = hn::Add(hn::ShiftLeft<8>(columns.first), hn::Set(d, offset.x));
    const VI sy = hn::Add(hn::ShiftLeft<8>(rows.first), hn::Set(d, offset.y));
    const int most_x = hn::GetLane(hn::MaxOfLanes(d, width)), most_y = hn::GetLane(hn::MaxOfLanes(d, height));
    PacketEdges row = EdgesAt(packet_, sx, sy);
    VI mask[2] = {hn::Zero(d), hn::Zero(d)};  // of four rows each
    for (int y = 0; y < most_y; ++y) {
      const VI row_width = hn::IfThenElseZero(hn::Gt(height, hn::Set(d, y)), width);
      VI e0 = row.e[0], e1 = row.e[1], e2 = row.e[2], bit = hn::Set(d, 1 << (y % 4 * 8)), bits = mask[y / 4];
      for (int x = 0; x < most_x; ++x) {
        const MI inside = hn::Gt(row_width, hn::Set(d, x));
        const MI covered = hn::And(hn::Gt(hn::Or(hn::Or(e0, e1), e2), hn::Set(d, -1)), inside);
        bits = hn::Or(bits, hn::IfThenElseZero(covered, bit));
        bit = hn::Add(bit, bit);
        e0 = hn::Sub(e0, packet_.dy[0]);
        e1 = hn::Sub(e1, packet_.dy[1]);
        e2 = hn::Sub(e2, packet_.dy[2]);
      }
      mask[y / 4] = bits;
      for (int k = 0; k < 3; ++k) row.e[k] = hn::Add(row.e[k], packet_.dx[k]);
    }
    hn::Store(hn::BitCast(DU(), mask[0]), DU(), mask_[0]);
    hn::Store(hn::BitCast(DU(), mask[1]), DU(), mask_[1]);
    drawn_ = by_row_ | BitsOf(d, hn::Ne(hn::Or(mask[0], mask[1]), hn::Zero(d)));
    // Offsets from which Merge() finds the keys of a pixel.
    from_x_ = hn::Sub(sx, packet_.x0);
    from_y_ = hn::Sub(sy, packet_.y0);
    hn::Store(hn::Add(hn::Mul(rows.first, hn::Set(d, call_.planes.width)), columns.first), d, first_);
  }

  /// Draws the covered pixels, triangle by triangle.
  void Empty(std::size_t sample) {
    std::size_t count = 0;
    for (std::uint64_t left = drawn_; left != 0; left &= left - 1) {
      const std::size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero64(left);
      if (by_row_ >> lane & 1) {
        Merge(sample, count);
        count = 0;
        rows_.Draw(RecordOf(lane), offset_[lane], sample);
        continue;
      }
      std::uint64_t mask = std::uint64_t(mask_[1][lane]) << 32 | mask_[0][lane];
      for (; mask != 0; mask &= mask - 1)
        references_[count++] = std::uint32_t(hwy::Num0BitsBelowLS1Bit_Nonzero64(mask) << 4 | lane);
    }
    Merge(sample, count);
  }

  /// Tests the fragments collected so far, each a pixel << 4 | lane, in order.
  void Merge(std::size_t sample, std::size_t count) {
    const DI d;
    const DF df;
    const DU du;
    const DD dd;
    HWY_ALIGN_MAX float key[kMaxLanes];
    HWY_ALIGN_MAX std::uint32_t stored[kMaxLanes], id[kMaxLanes];
    HWY_ALIGN_MAX double offset[kMaxLanes] = {};
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      const VI reference = hn::BitCast(d, hn::LoadU(du, references_ + i));
      const std::size_t live = HWY_MIN(count - i, hn::Lanes(d));
      const VI lane = hn::And(reference, hn::Set(d, std::int32_t(hn::Lanes(d)) - 1));
      const auto of_f = hn::IndicesFromVec(df, lane);
      const auto of_i = hn::IndicesFromVec(d, lane);
      const VI x = hn::And(hn::ShiftRight<4>(reference), hn::Set(d, 7)), y = hn::ShiftRight<7>(reference);
      const VF dx = hn::ConvertTo(df, hn::Add(hn::TableLookupLanes(from_x_, of_i), hn::ShiftLeft<8>(x)));
      const VF dy = hn::ConvertTo(df, hn::Add(hn::TableLookupLanes(from_y_, of_i), hn::ShiftLeft<8>(y)));
      VF k = hn::Add(hn::TableLookupLanes(packet_.k0, of_f), hn::Mul(dx, hn::TableLookupLanes(packet_.gx, of_f)));
      k = hn::Add(k, hn::Mul(dy, hn::TableLookupLanes(packet_.gy, of_f)));
      k = hn::Min(hn::Max(k, hn::TableLookupLanes(packet_.k_min, of_f)), hn::TableLookupLanes(packet_.k_max, of_f));
      hn::Store(k, df, key);
      hn::Store(hn::TableLookupLanes(id_, hn::IndicesFromVec(du, lane)), du, id);
      if (call_.rules.has_offset())
        for (std::size_t n = 0; n < live; ++n) offset[n] = offset_[references_[i + n] & 15];
      for (std::size_t n = 0; n < hn::Lanes(d); n += hn::Lanes(dd))
        // Depths may be computed together, but tests may not: two fragments of a vector may belong to one pixel.
        hn::Store(test_.Stored(hn::Load(HalfF(), key + n), hn::Load(dd, offset + n)), HalfU(), stored + n);
      for (std::size_t n = 0; n < live; ++n) Put(PlaceOf(sample, references_[i + n]), stored[n], id[n], key[n]);
    }
  }

  [[nodiscard]] HWY_INLINE std::size_t PlaceOf(std::size_t sample, std::uint32_t reference) const {
    const DepthPlanes& p = call_.planes;
    const std::size_t tile = (sample * std::size_t(p.height) + std::size_t(tile_.y)) * std::size_t(p.width) +
                             std::size_t(tile_.x) + std::size_t(first_[reference & 15]);
    return tile + std::size_t(reference >> 7) * std::size_t(p.width) + (reference >> 4 & 7);
  }

  HWY_INLINE void Put(std::size_t at, std::uint32_t stored, PrimitiveId id, float key) const {
    const DepthPlanes& p = call_.planes;
    if (!test_.Passes(stored, p.stored[at])) return;
    if (call_.rules.mask) p.stored[at] = stored;
    p.primitives[at] = id;
    p.keys[at] = key;
  }

  [[nodiscard]] TriangleRecord RecordOf(std::size_t lane) const {
    HWY_ALIGN_MAX std::int32_t x[kMaxLanes], y[kMaxLanes];
    HWY_ALIGN_MAX float key[kMaxLanes];
    HWY_ALIGN_MAX std::uint32_t id[kMaxLanes];
    TriangleRecord record;
    for (int k = 0; k < 3; ++k) {
      hn::Store(packet_.x[k], DI(), x);
      hn::Store(packet_.y[k], DI(), y);
      hn::Store(key_[k], DF(), key);
      record.x[k] = x[lane];
      record.y[k] = y[lane];
      record.key[k] = key[lane];
    }
    hn::Store(id_, DU(), id);
    record.id = id[lane];
    return record;
  }

  const DepthCall& call_;
  const Tile& tile_;
  DepthTest<is_float> test_;
  DepthRows<is_float> rows_;
  RunReader reader_;
  // State of the packet.
  Packet packet_;
  VF key_[3];
  VU id_;
  MI walkable_;  // drawn many at once
  std::size_t count_ = 0;
  double offset_[kMaxLanes] = {};
  // State of the packet at one sample.
  std::uint64_t by_row_ = 0, drawn_ = 0;         // lanes that rows draw; those and all lanes that cover a pixel
  VI from_x_, from_y_;                           // from the key plane's origin to the sample of the first pixel
  HWY_ALIGN_MAX std::int32_t first_[kMaxLanes];  // index of the first pixel in the tile
  HWY_ALIGN_MAX std::uint32_t mask_[2][kMaxLanes];
  std::uint32_t references_[kMaxLanes * kWalkLimit * kWalkLimit + kMaxLanes];
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
