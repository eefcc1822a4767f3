// SPDX-License-Identifier: Apache-2.0
// Triangles of a few pixels, as many at once as the vector holds. All triangles of a packet are walked pixel by pixel
// in step; their covered pixels are then merged into the tile together.
//
//    queue --full--> packet: edges, planes, rectangles --> walk --> (triangle, pixel) pairs --> merged together
//                       +-- too large, or steep --> LargeTriangles, one by one
//
// Pairs of different triangles may belong to one pixel. The merge keeps the greater word of key and id, so the order of
// pairs does not matter.

// Included once for every target.
#if defined(FRONTMOST_ZBUFFER_SMALL_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ZBUFFER_SMALL_TRIANGLES_INL_H_
#undef FRONTMOST_ZBUFFER_SMALL_TRIANGLES_INL_H_
#else
#define FRONTMOST_ZBUFFER_SMALL_TRIANGLES_INL_H_
#endif

#include "base/compactor-inl.h"
#include "zbuffer/packet-inl.h"
#include "zbuffer/tile/large_triangles-inl.h"
#include "zbuffer/tile/tile_buffer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using frontmost::HWY_NAMESPACE::CompactInto;
using frontmost::HWY_NAMESPACE::Compactor;

// A triangle whose pixel rectangle is at most this wide and high is drawn in a packet. A packet is walked over the
// greatest width and the greatest height of its rectangles, so a wide triangle beside a high one would multiply the
// cost. The height may be greater, because triangles of walls are higher than wide.
constexpr int kWalkWidth = kMostWalked.x, kWalkHeight = kMostWalked.y;
// A triangle of more pixels than this is first tested against the hierarchical depth.
constexpr std::int32_t kWalkUnseen = 96;

/// Small triangles that wait to be drawn, with an array for each coordinate of each vertex. The room is one vector more
/// than the queue ever holds, because stores write whole vectors.
struct TriangleQueue {
  static constexpr std::size_t kRoom = 3 * kMaxLanes;
  HWY_ALIGN_MAX std::int32_t x[3][kRoom], y[3][kRoom];
  HWY_ALIGN_MAX std::int32_t key[3][kRoom];  // bits of the float
  HWY_ALIGN_MAX std::uint32_t id[kRoom];
  std::size_t count = 0;
};

/// Triangles that are drawn together, with their pixel rectangles within the tile.
struct SmallPacket : Packet {
  VI px, py, width, height;
  VU not_id;
};

class SmallTriangles {
 public:
  SmallTriangles(const Picture& picture, const Tile& tile, TileScratch& scratch, TileBuffer& buffer,
                 LargeTriangles& large)
      : picture_(picture), tile_(tile), references_(scratch.references.data()), buffer_(buffer), large_(large) {
    low_ = high_ = picture.samples[0];
    for (const glm::ivec2& s : picture.samples) low_ = glm::min(low_, s), high_ = glm::max(high_, s);
  }

  /// The queue that triangles are appended to. After DrawFull() it holds less than a vector of triangles.
  [[nodiscard]] HWY_INLINE TriangleQueue& queue() { return queue_; }
  /// Draws packets as long as a vector can be filled.
  HWY_INLINE void DrawFull() {
    while (queue_.count >= hn::Lanes(DI())) DrawQueued();
  }
  void Finish() {
    while (queue_.count > 0) DrawQueued();
  }

  /// The pixels of the tile that have a sample within the coordinate ranges of triangles.
  [[nodiscard]] HWY_INLINE PixelRange ColumnsOf(const CoordinateRange& x) const {
    return PixelsOf(x, low_.x, high_.x, tile_.width);
  }
  [[nodiscard]] HWY_INLINE PixelRange RowsOf(const CoordinateRange& y) const {
    return PixelsOf(y, low_.y, high_.y, tile_.height);
  }

 private:
  void DrawQueued() {
    const DI d;
    const std::size_t drawn = HWY_MIN(queue_.count, hn::Lanes(d));
    SmallPacket packet = SetUp(drawn);
    const MI large =
        hn::Or(hn::Gt(packet.width, hn::Set(d, kWalkWidth)), hn::Gt(packet.height, hn::Set(d, kWalkHeight)));
    const MI single = hn::Or(large, packet.steep);
    if (!hn::AllFalse(d, single)) {
      ForEachBit(BitsOf(d, single), [&](std::size_t lane) { large_.DrawOnce(QueuedRecord(lane)); });
      packet.width = hn::IfThenZeroElse(single, packet.width);
      packet.height = hn::IfThenZeroElse(single, packet.height);
    }
    LeaveOutHidden(packet);
    const int most_x = hn::GetLane(hn::MaxOfLanes(d, packet.width));
    const int most_y = hn::GetLane(hn::MaxOfLanes(d, packet.height));
    for (std::size_t s = 0; s < picture_.samples.size(); ++s) {
      const std::size_t found = Walk(packet, most_x, most_y, s);
      Merge(packet, found, s);
    }
    Shift(drawn);
  }

  /// Drops hidden triangles from the packet. Tests only triangles that take long to walk.
  HWY_INLINE void LeaveOutHidden(SmallPacket& packet) {
    const DI d;
    const MI asked = hn::Gt(hn::Mul(packet.width, packet.height), hn::Set(d, kWalkUnseen));
    if (hn::AllFalse(d, asked)) return;
    HWY_ALIGN_MAX std::int32_t x[kMaxLanes], y[kMaxLanes], width[kMaxLanes], height[kMaxLanes];
    HWY_ALIGN_MAX float nearest[kMaxLanes];
    hn::Store(packet.px, d, x);
    hn::Store(packet.py, d, y);
    hn::Store(packet.width, d, width);
    hn::Store(packet.height, d, height);
    hn::Store(packet.k_max, DF(), nearest);
    ForEachBit(BitsOf(d, asked), [&](std::size_t i) {
      const PixelRect rect{x[i], y[i], x[i] + width[i] - 1, y[i] + height[i] - 1};
      if (buffer_.AllHide(TileBuffer::BlocksOf(rect), nearest[i])) width[i] = 0;
    });
    packet.width = hn::Load(d, width);
  }

  [[nodiscard]] TriangleRecord QueuedRecord(std::size_t lane) const {
    TriangleRecord record;
    for (int k = 0; k < 3; ++k) {
      record.x[k] = queue_.x[k][lane];
      record.y[k] = queue_.y[k][lane];
      record.key[k] = bits_as<float>(queue_.key[k][lane]);
    }
    record.id = queue_.id[lane];
    return record;
  }

  /// Moves the rest of the queue to its front. The rest is less than a vector unless all was drawn.
  HWY_INLINE void Shift(std::size_t drawn) {
    const DI d;
    const DU du;
    queue_.count -= drawn;
    if (queue_.count == 0) return;
    for (int k = 0; k < 3; ++k) {
      hn::Store(hn::LoadU(d, queue_.x[k] + drawn), d, queue_.x[k]);
      hn::Store(hn::LoadU(d, queue_.y[k] + drawn), d, queue_.y[k]);
      hn::Store(hn::LoadU(d, queue_.key[k] + drawn), d, queue_.key[k]);
    }
    hn::Store(hn::LoadU(du, queue_.id + drawn), du, queue_.id);
  }

  HWY_INLINE SmallPacket SetUp(std::size_t used) const {
    const DI d;
    SmallPacket b;
    VF key[3];
    for (int k = 0; k < 3; ++k) {
      b.x[k] = hn::Load(d, queue_.x[k]);
      b.y[k] = hn::Load(d, queue_.y[k]);
      key[k] = hn::BitCast(DF(), hn::Load(d, queue_.key[k]));
    }
    b.not_id = hn::Not(hn::Load(DU(), queue_.id));
    SetUpPacket(b, key);
    const PixelRange columns = ColumnsOf(b.columns), rows = RowsOf(b.rows);
    const VI one = hn::Set(d, 1);
    const MI live = hn::Lt(hn::Iota(d, 0), hn::Set(d, std::int32_t(used)));
    b.px = columns.first;
    b.py = rows.first;
    // Lanes after the last triangle hold old values; a width and height of 0 keeps them from being walked.
    b.steep = hn::And(b.steep, live);
    b.width = hn::IfThenElseZero(live, hn::Add(hn::Sub(columns.last, b.px), one));
    b.height = hn::IfThenElseZero(live, hn::Add(hn::Sub(rows.last, b.py), one));
    return b;
  }

  /// Walks the rectangles of all triangles of a packet at once, one pixel position a step, and stores the covered
  /// (pixel, triangle) pairs as word offset << 13 | y << 8 | x << 4 | lane. \returns the number of pairs.
  HWY_INLINE std::size_t Walk(const SmallPacket& b, int most_x, int most_y, std::size_t sample) {
    const DI d;
    const DU du;
    const glm::ivec2 offset = picture_.samples[sample];
    const VI sx = hn::Add(hn::ShiftLeft<8>(b.px), hn::Set(d, offset.x));
    const VI sy = hn::Add(hn::ShiftLeft<8>(b.py), hn::Set(d, offset.y));
    PacketEdges row = EdgesAt(b, sx, sy);
    const VI first = hn::Add(hn::Mul(b.py, hn::Set(d, kTileStride)), b.px);
    const VI base = hn::Or(hn::ShiftLeft<13>(first), hn::Iota(d, 0));
    std::uint32_t* out = references_;
    for (int y = 0; y < most_y; ++y) {
      const VI row_width = hn::IfThenElseZero(hn::Gt(b.height, hn::Set(d, y)), b.width);
      VI e0 = row.e[0], e1 = row.e[1], e2 = row.e[2];
      VI reference = hn::Add(base, hn::Set(d, (y * kTileStride) << 13 | y << 8));
      for (int x = 0; x < most_x; ++x) {
        const VI all = hn::Or(hn::Or(e0, e1), e2);
        const MI covered = hn::And(hn::Gt(all, hn::Set(d, -1)), hn::Gt(row_width, hn::Set(d, x)));
        out += CompactInto(hn::BitCast(du, reference), hn::RebindMask(du, covered), du, out);
        e0 = hn::Sub(e0, b.dy[0]);
        e1 = hn::Sub(e1, b.dy[1]);
        e2 = hn::Sub(e2, b.dy[2]);
        reference = hn::Add(reference, hn::Set(d, 1 << 13 | 1 << 4));
      }
      for (int k = 0; k < 3; ++k) row.e[k] = hn::Add(row.e[k], b.dx[k]);
    }
    return std::size_t(out - references_);
  }

  /// Finds the keys of the covered pairs, as many at a time as the vector holds, and keeps the greater words.
  HWY_INLINE void Merge(const SmallPacket& b, std::size_t count, std::size_t sample) {
    const DI d;
    const DU du;
    const DF df;
    const glm::ivec2 offset = picture_.samples[sample];
    const VI from_x = hn::Sub(hn::Add(hn::ShiftLeft<8>(b.px), hn::Set(d, offset.x)), b.x0);
    const VI from_y = hn::Sub(hn::Add(hn::ShiftLeft<8>(b.py), hn::Set(d, offset.y)), b.y0);
    std::uint64_t* words = buffer_.Row(sample, 0);
    HWY_ALIGN_MAX std::uint64_t found[kMaxLanes];
    HWY_ALIGN_MAX std::uint32_t at[kMaxLanes];
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      const VU in_line = hn::LoadU(du, references_ + i);
      hn::Store(hn::ShiftRight<13>(in_line), du, at);
      const VI reference = hn::BitCast(d, InPixelOrder(in_line));
      const auto lane = hn::IndicesFromVec(d, hn::And(reference, hn::Set(d, std::int32_t(hn::Lanes(d)) - 1)));
      const auto lane_f = hn::IndicesFromVec(df, hn::And(reference, hn::Set(d, std::int32_t(hn::Lanes(d)) - 1)));
      const auto lane_u = hn::IndicesFromVec(du, hn::And(reference, hn::Set(d, std::int32_t(hn::Lanes(d)) - 1)));
      const VI x = hn::ShiftLeft<8>(hn::And(hn::ShiftRight<4>(reference), hn::Set(d, kWalkWidth - 1)));
      const VI y = hn::ShiftLeft<8>(hn::And(hn::ShiftRight<8>(reference), hn::Set(d, kWalkHeight - 1)));
      const VF dx = hn::ConvertTo(df, hn::Add(hn::TableLookupLanes(from_x, lane), x));
      const VF dy = hn::ConvertTo(df, hn::Add(hn::TableLookupLanes(from_y, lane), y));
      VF key = hn::Add(hn::TableLookupLanes(b.k0, lane_f), hn::Mul(dx, hn::TableLookupLanes(b.gx, lane_f)));
      key = hn::Add(key, hn::Mul(dy, hn::TableLookupLanes(b.gy, lane_f)));
      key = hn::Min(hn::Max(key, hn::TableLookupLanes(b.k_min, lane_f)), hn::TableLookupLanes(b.k_max, lane_f));
      StoreWords(WordsOf(hn::BitCast(du, key), hn::TableLookupLanes(b.not_id, lane_u)), found);
      const std::size_t live = HWY_MIN(count - i, hn::Lanes(d));
      if (buffer_.minds_holes()) {
        for (std::size_t k = 0; k < live; ++k) buffer_.KeepSolid(found[k], words[at[k]], PlaceOf(at[k]) + offset);
        continue;
      }
      for (std::size_t k = 0; k < live; ++k) {
        // One by one, as two of the triangles may have covered the same pixel.
        std::uint64_t& kept = words[at[k]];
        kept = HWY_MAX(kept, found[k]);
      }
    }
  }

  /// The corner of the pixel whose word has this offset.
  [[nodiscard]] static HWY_INLINE glm::ivec2 PlaceOf(std::uint32_t word) {
    return glm::ivec2(int(word % kTileStride), int(word / kTileStride)) * kSubPixels;
  }

  const Picture& picture_;
  const Tile& tile_;
  std::uint32_t* references_;
  TileBuffer& buffer_;
  LargeTriangles& large_;
  glm::ivec2 low_, high_;  // least and greatest sample offset
  TriangleQueue queue_;
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
