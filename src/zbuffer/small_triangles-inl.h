// SPDX-License-Identifier: Apache-2.0
// Triangles of a few pixels, as many at once as the vector holds: all of a batch are walked pixel by pixel in step,
// and the covered pixels of all are then merged into the tile together.

// Included once for every target.
#if defined(FRONTMOST_ZBUFFER_SMALL_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ZBUFFER_SMALL_TRIANGLES_INL_H_
#undef FRONTMOST_ZBUFFER_SMALL_TRIANGLES_INL_H_
#else
#define FRONTMOST_ZBUFFER_SMALL_TRIANGLES_INL_H_
#endif

#include "zbuffer/compactor-inl.h"
#include "zbuffer/large_triangles-inl.h"
#include "zbuffer/tile_buffer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A triangle whose pixel rectangle is at most this wide and high is drawn with others at once.
constexpr int kWalkLimit = 16;

/// Small triangles waiting to be drawn, set apart by corner. Room for one vector more than is drawn at a time.
struct TriangleQueue {
  static constexpr std::size_t kRoom = 3 * kMaxLanes;
  HWY_ALIGN_MAX std::int32_t x[3][kRoom], y[3][kRoom];
  HWY_ALIGN_MAX std::int32_t key[3][kRoom];  // bits of the float
  HWY_ALIGN_MAX std::uint32_t id[kRoom];
  std::size_t count = 0;
};

/// Three edges and a depth plane for as many triangles as the vector holds.
struct Batch {
  VI x0, y0, dx[3], dy[3], bias[3], area;  // edge k runs from corner k; twice the area
  VI cx[3], cy[3];                         // its start
  VF k0, gx, gy, k_min, k_max;
  VI px, py, width, height;  // pixel rectangle within the tile
  VU not_id;
};

class SmallTriangles {
 public:
  SmallTriangles(const FrameInput& frame, const TileJob& job, TileScratch& scratch, TileBuffer& buffer,
                 LargeTriangles& large)
      : frame_(frame), job_(job), references_(scratch.references.data()), buffer_(buffer), large_(large) {
    low_ = high_ = frame.samples[0];
    for (const glm::ivec2& s : frame.samples) low_ = glm::min(low_, s), high_ = glm::max(high_, s);
  }

  /// Where triangles are to be appended, less than a vector of them before DrawFull() is called.
  [[nodiscard]] HWY_INLINE TriangleQueue& queue() { return queue_; }
  /// Draws as long as a vector can be filled.
  HWY_INLINE void DrawFull() {
    while (queue_.count >= hn::Lanes(DI())) DrawQueued();
  }
  void Finish() {
    while (queue_.count > 0) DrawQueued();
  }

  /// The first pixel of the tile that has a sample at or after `minimum`, and the last that has one at or before
  /// `maximum`.
  [[nodiscard]] HWY_INLINE VI FirstPixelX(VI minimum) const { return FirstPixel(minimum, high_.x); }
  [[nodiscard]] HWY_INLINE VI FirstPixelY(VI minimum) const { return FirstPixel(minimum, high_.y); }
  [[nodiscard]] HWY_INLINE VI LastPixelX(VI maximum) const { return LastPixel(maximum, low_.x, job_.width); }
  [[nodiscard]] HWY_INLINE VI LastPixelY(VI maximum) const { return LastPixel(maximum, low_.y, job_.height); }

 private:
  static HWY_INLINE VI FirstPixel(VI minimum, std::int32_t last_offset) {
    const DI d;
    return hn::Max(hn::ShiftRight<8>(hn::Add(minimum, hn::Set(d, 255 - last_offset))), hn::Zero(d));
  }
  static HWY_INLINE VI LastPixel(VI maximum, std::int32_t first_offset, std::int32_t size) {
    const DI d;
    return hn::Min(hn::ShiftRight<8>(hn::Sub(maximum, hn::Set(d, first_offset))), hn::Set(d, size - 1));
  }

  void DrawQueued() {
    const DI d;
    const std::size_t drawn = HWY_MIN(queue_.count, hn::Lanes(d));
    Batch batch = SetUp(drawn);
    const VI limit = hn::Set(d, kWalkLimit);
    const MI large = hn::Or(hn::Gt(batch.width, limit), hn::Gt(batch.height, limit));
    if (!hn::AllFalse(d, large)) {
      for (std::uint64_t left = BitsOf(d, large); left != 0; left &= left - 1)
        large_.Draw(QueuedRecord(hwy::Num0BitsBelowLS1Bit_Nonzero64(left)));
      batch.width = hn::IfThenZeroElse(large, batch.width);
      batch.height = hn::IfThenZeroElse(large, batch.height);
    }
    const int most_x = hn::GetLane(hn::MaxOfLanes(d, batch.width));
    const int most_y = hn::GetLane(hn::MaxOfLanes(d, batch.height));
    for (std::size_t s = 0; s < frame_.samples.size(); ++s) {
      const std::size_t found = Walk(batch, most_x, most_y, s);
      Merge(batch, found, s);
    }
    Shift(drawn);
  }

  [[nodiscard]] TriangleRecord QueuedRecord(std::size_t lane) const {
    TriangleRecord record;
    for (int k = 0; k < 3; ++k) {
      record.x[k] = queue_.x[k][lane];
      record.y[k] = queue_.y[k][lane];
      std::memcpy(&record.key[k], &queue_.key[k][lane], sizeof(float));
    }
    record.id = queue_.id[lane];
    return record;
  }

  /// Moves what is left in the queue, less than a vector unless all of it was drawn, to its front.
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

  HWY_INLINE Batch SetUp(std::size_t used) const {
    const DI d;
    const DF df;
    const DU du;
    Batch b;
    VF key[3];
    for (int k = 0; k < 3; ++k) {
      b.cx[k] = hn::Load(d, queue_.x[k]);
      b.cy[k] = hn::Load(d, queue_.y[k]);
      key[k] = hn::BitCast(df, hn::Load(d, queue_.key[k]));
    }
    b.x0 = b.cx[0];
    b.y0 = b.cy[0];
    b.not_id = hn::Not(hn::Load(du, queue_.id));
    for (int k = 0; k < 3; ++k) {
      const int n = k == 2 ? 0 : k + 1;
      b.dx[k] = hn::Sub(b.cx[n], b.cx[k]);
      b.dy[k] = hn::Sub(b.cy[n], b.cy[k]);
      // Top-left edges include their own points: bias 0, the others -1. Top-left is dy < 0, or dy = 0 and dx > 0; that
      // is dy * 2^16 - dx < 0, as both are within 15 bits.
      b.bias[k] = hn::Not(hn::ShiftRight<31>(hn::Sub(hn::ShiftLeft<16>(b.dy[k]), b.dx[k])));
    }
    SetUpPlane(b, key);
    SetUpRect(b, used);
    return b;
  }

  HWY_INLINE void SetUpPlane(Batch& b, const VF key[3]) const {
    const DF df;
    const VI x1 = b.dx[0], y1 = b.dy[0];
    const VI x2 = hn::Sub(b.cx[2], b.x0), y2 = hn::Sub(b.cy[2], b.y0);
    b.area = hn::Sub(hn::Mul(x1, y2), hn::Mul(x2, y1));
    const VF k1 = hn::Sub(key[1], key[0]), k2 = hn::Sub(key[2], key[0]);
    const VF fx1 = hn::ConvertTo(df, x1), fy1 = hn::ConvertTo(df, y1);
    const VF fx2 = hn::ConvertTo(df, x2), fy2 = hn::ConvertTo(df, y2);
    const VF fa = hn::ConvertTo(df, b.area);
    b.k0 = key[0];
    b.gx = hn::Div(hn::Sub(hn::Mul(k1, fy2), hn::Mul(k2, fy1)), fa);
    b.gy = hn::Div(hn::Sub(hn::Mul(fx1, k2), hn::Mul(fx2, k1)), fa);
    b.k_min = hn::Min(key[0], hn::Min(key[1], key[2]));
    b.k_max = hn::Max(key[0], hn::Max(key[1], key[2]));
  }

  HWY_INLINE void SetUpRect(Batch& b, std::size_t used) const {
    const DI d;
    const VI x_min = hn::Min(b.cx[0], hn::Min(b.cx[1], b.cx[2])), x_max = hn::Max(b.cx[0], hn::Max(b.cx[1], b.cx[2]));
    const VI y_min = hn::Min(b.cy[0], hn::Min(b.cy[1], b.cy[2])), y_max = hn::Max(b.cy[0], hn::Max(b.cy[1], b.cy[2]));
    b.px = FirstPixelX(x_min);
    b.py = FirstPixelY(y_min);
    const VI one = hn::Set(d, 1);
    const MI live = hn::Lt(hn::Iota(d, 0), hn::Set(d, std::int32_t(used)));
    b.width = hn::IfThenElseZero(live, hn::Add(hn::Sub(LastPixelX(x_max), b.px), one));
    b.height = hn::IfThenElseZero(live, hn::Add(hn::Sub(LastPixelY(y_max), b.py), one));
  }

  /// Walks the rectangles of all triangles of a batch at once, one pixel position a step, and notes the covered
  /// (pixel, triangle) pairs as word offset << 12 | y << 8 | x << 4 | lane. \returns how many.
  HWY_INLINE std::size_t Walk(const Batch& b, int most_x, int most_y, std::size_t sample) {
    const DI d;
    const DU du;
    const glm::ivec2 offset = frame_.samples[sample];
    const VI sx = hn::Add(hn::ShiftLeft<8>(b.px), hn::Set(d, offset.x));
    const VI sy = hn::Add(hn::ShiftLeft<8>(b.py), hn::Set(d, offset.y));
    VI edge[3], row[3], step[3];
    for (int k = 0; k < 2; ++k)
      edge[k] = hn::Sub(hn::Mul(b.dx[k], hn::Sub(sy, b.cy[k])), hn::Mul(b.dy[k], hn::Sub(sx, b.cx[k])));
    // The three edge functions of a point add up to twice the area.
    edge[2] = hn::Sub(b.area, hn::Add(edge[0], edge[1]));
    for (int k = 0; k < 3; ++k) {
      row[k] = hn::ShiftRight<8>(hn::Add(edge[k], b.bias[k]));
      step[k] = hn::Neg(b.dy[k]);
    }
    const VI first = hn::Add(hn::Mul(b.py, hn::Set(d, kTileStride)), b.px);
    const VI base = hn::Or(hn::ShiftLeft<12>(first), hn::Iota(d, 0));
    std::uint32_t* out = references_;
    for (int y = 0; y < most_y; ++y) {
      const VI row_width = hn::IfThenElseZero(hn::Gt(b.height, hn::Set(d, y)), b.width);
      VI e0 = row[0], e1 = row[1], e2 = row[2];
      VI reference = hn::Add(base, hn::Set(d, (y * kTileStride) << 12 | y << 8));
      for (int x = 0; x < most_x; ++x) {
        const VI all = hn::Or(hn::Or(e0, e1), e2);
        const MI covered = hn::And(hn::Gt(all, hn::Set(d, -1)), hn::Gt(row_width, hn::Set(d, x)));
        out += CompactInto(hn::BitCast(du, reference), hn::RebindMask(du, covered), du, out);
        e0 = hn::Add(e0, step[0]);
        e1 = hn::Add(e1, step[1]);
        e2 = hn::Add(e2, step[2]);
        reference = hn::Add(reference, hn::Set(d, 1 << 12 | 1 << 4));
      }
      for (int k = 0; k < 3; ++k) row[k] = hn::Add(row[k], b.dx[k]);
    }
    return std::size_t(out - references_);
  }

  /// Finds the keys of the covered pairs, as many at a time as the vector holds, and keeps the greater words.
  HWY_INLINE void Merge(const Batch& b, std::size_t count, std::size_t sample) {
    const DI d;
    const DU du;
    const DF df;
    const glm::ivec2 offset = frame_.samples[sample];
    const VI from_x = hn::Sub(hn::Add(hn::ShiftLeft<8>(b.px), hn::Set(d, offset.x)), b.x0);
    const VI from_y = hn::Sub(hn::Add(hn::ShiftLeft<8>(b.py), hn::Set(d, offset.y)), b.y0);
    std::uint64_t* words = buffer_.Row(sample, 0);
    HWY_ALIGN_MAX std::uint64_t found[kMaxLanes];
    HWY_ALIGN_MAX std::uint32_t at[kMaxLanes];
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      const VU in_line = hn::LoadU(du, references_ + i);
      hn::Store(hn::ShiftRight<12>(in_line), du, at);
      const VI reference = hn::BitCast(d, InPixelOrder(in_line));
      const auto lane = hn::IndicesFromVec(d, hn::And(reference, hn::Set(d, std::int32_t(hn::Lanes(d)) - 1)));
      const auto lane_f = hn::IndicesFromVec(df, hn::And(reference, hn::Set(d, std::int32_t(hn::Lanes(d)) - 1)));
      const auto lane_u = hn::IndicesFromVec(du, hn::And(reference, hn::Set(d, std::int32_t(hn::Lanes(d)) - 1)));
      const VI nibble = hn::Set(d, 15);
      const VI x = hn::ShiftLeft<8>(hn::And(hn::ShiftRight<4>(reference), nibble));
      const VI y = hn::ShiftLeft<8>(hn::And(hn::ShiftRight<8>(reference), nibble));
      const VF dx = hn::ConvertTo(df, hn::Add(hn::TableLookupLanes(from_x, lane), x));
      const VF dy = hn::ConvertTo(df, hn::Add(hn::TableLookupLanes(from_y, lane), y));
      VF key = hn::Add(hn::TableLookupLanes(b.k0, lane_f), hn::Mul(dx, hn::TableLookupLanes(b.gx, lane_f)));
      key = hn::Add(key, hn::Mul(dy, hn::TableLookupLanes(b.gy, lane_f)));
      key = hn::Min(hn::Max(key, hn::TableLookupLanes(b.k_min, lane_f)), hn::TableLookupLanes(b.k_max, lane_f));
      StoreWords(WordsOf(hn::BitCast(du, key), hn::TableLookupLanes(b.not_id, lane_u)), found);
      const std::size_t live = HWY_MIN(count - i, hn::Lanes(d));
      for (std::size_t k = 0; k < live; ++k) {
        std::uint64_t& kept = words[at[k]];
        kept = HWY_MAX(kept, found[k]);
      }
    }
  }

  const FrameInput& frame_;
  const TileJob& job_;
  std::uint32_t* references_;
  TileBuffer& buffer_;
  LargeTriangles& large_;
  glm::ivec2 low_, high_;  // of the sample offsets
  TriangleQueue queue_;
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
