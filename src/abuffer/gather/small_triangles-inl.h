// SPDX-License-Identifier: Apache-2.0
// Triangles of a few pixels, as many at once as the vector holds: all of a batch are walked pixel by pixel in step, and
// the pixels found are then given keys and masks together.

// Included once for every target.
#if defined(FRONTMOST_ABUFFER_SMALL_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ABUFFER_SMALL_TRIANGLES_INL_H_
#undef FRONTMOST_ABUFFER_SMALL_TRIANGLES_INL_H_
#else
#define FRONTMOST_ABUFFER_SMALL_TRIANGLES_INL_H_
#endif

#include "abuffer/gather/large_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Triangles no wider and higher than this touch at most 16 x 16 pixels.
constexpr std::int32_t kSmallExtent = 15 * kSubPixels;

/// Small triangles waiting to be drawn: x, y, bits of the key of three corners, and the id. Room for one vector more
/// than is drawn at a time.
struct TriangleQueue {
  static constexpr int kFields = 10;
  HWY_ALIGN_MAX std::int32_t field[kFields][3 * kMaxLanes];
  std::size_t count = 0;
};

template <bool kFlat>
class SmallTriangles {
 public:
  /// Steep triangles go to `large`.
  SmallTriangles(FragmentSink<kFlat>& sink, TileScratch& scratch, LargeTriangles<kFlat>& large)
      : sink_(sink), large_(large), references_(scratch.references.data()) {}

  HWY_INLINE void Append(const VI (&fields)[TriangleQueue::kFields], MI keep) {
    const Compactor<DI> compact(keep);
    for (int f = 0; f < TriangleQueue::kFields; ++f) compact.Store(fields[f], queue_.field[f] + queue_.count);
    queue_.count += compact.count();
  }
  [[nodiscard]] bool IsFull() const { return queue_.count >= hn::Lanes(DI()); }
  void Finish() {
    while (queue_.count > 0 && sink_.HasRoom()) DrawQueued();
  }

  /// Draws a vector of triangles, or what there is.
  void DrawQueued() {
    const DI d;
    const std::size_t drawn = HWY_MIN(queue_.count, hn::Lanes(d));
    SetUp(drawn);
    if (!hn::AllFalse(d, steep_))
      ForEachBit(BitsOf(d, steep_), [&](std::size_t lane) { large_.Draw(QueuedTriangle(lane)); });
    const std::size_t found = Walk();
    if (found > 0) {
      for (std::size_t i = 0; i < drawn; ++i) sink_.ExpectColor(std::uint32_t(queue_.field[9][i]));
      if (!kFlat) KeepPlanes(drawn);
      AppendFound(found);
    }
    queue_.count -= drawn;
    if (queue_.count > 0)
      for (auto& field : queue_.field) hn::Store(hn::LoadU(d, field + drawn), d, field);
  }

 private:
  [[nodiscard]] ScreenTriangle QueuedTriangle(std::size_t lane) const {
    ScreenTriangle t;
    for (int k = 0; k < 3; ++k) {
      t.x[k] = queue_.field[k][lane];
      t.y[k] = queue_.field[3 + k][lane];
      std::memcpy(&t.key[k], &queue_.field[6 + k][lane], sizeof t.key[k]);
    }
    t.id = std::uint32_t(queue_.field[9][lane]);
    return t;
  }

  HWY_INLINE VF KeyOf(int corner) const { return hn::BitCast(DF(), hn::Load(DI(), queue_.field[6 + corner])); }

  HWY_INLINE void SetUp(std::size_t used) {
    const DI d;
    VI x[3], y[3];
    for (int k = 0; k < 3; ++k) {
      x[k] = hn::Load(d, queue_.field[k]);
      y[k] = hn::Load(d, queue_.field[3 + k]);
    }
    const PixelBounds p = sink_.BoundsOf(hn::Min(x[0], hn::Min(x[1], x[2])), hn::Max(x[0], hn::Max(x[1], x[2])),
                                         hn::Min(y[0], hn::Min(y[1], y[2])), hn::Max(y[0], hn::Max(y[1], y[2])));
    const VI one = hn::Set(d, 1);
    const MI live = hn::Lt(hn::Iota(d, 0), hn::Set(d, std::int32_t(used)));
    width_ = hn::IfThenElseZero(live, hn::Add(hn::Sub(p.x1, p.x0), one));
    height_ = hn::IfThenElseZero(live, hn::Add(hn::Sub(p.y1, p.y0), one));
    px_ = p.x0;
    py_ = p.y0;
    for (int k = 0; k < 3; ++k) SetUpEdge(k, x, y);
    SetUpPlane(x, y, live);
    // Drawn one by one.
    width_ = hn::IfThenZeroElse(steep_, width_);
  }

  HWY_INLINE void SetUpEdge(int k, const VI (&x)[3], const VI (&y)[3]) {
    const DI d;
    const SamplePattern& p = sink_.pattern;
    const int n = k == 2 ? 0 : k + 1;
    const VI dx = hn::Sub(x[n], x[k]), dy = hn::Sub(y[n], y[k]);
    // Top-left edges include their own points: bias 0, the others -1. Top-left is dy < 0, or dy = 0 and dx > 0; that is
    // dy * 2^16 - dx < 0, as both are within 15 bits.
    const VI bias = hn::Not(hn::ShiftRight<31>(hn::Sub(hn::ShiftLeft<16>(dy), dx)));
    const VI sx = hn::Sub(hn::ShiftLeft<8>(px_), x[k]), sy = hn::Sub(hn::ShiftLeft<8>(py_), y[k]);
    const VI e = hn::Add(hn::Sub(hn::Mul(dx, sy), hn::Mul(dy, sx)), bias);
    edge_[k] = hn::ShiftRight<4>(e);
    dx_[k] = dx;
    dy_[k] = dy;
    const auto most = [&](VI v, std::int32_t low, std::int32_t high)
                          HWY_ATTR { return hn::Max(hn::Mul(v, hn::Set(d, low)), hn::Mul(v, hn::Set(d, high))); };
    sample_max_[k] = hn::Add(most(dx, p.low_y, p.high_y), most(hn::Neg(dy), p.low_x, p.high_x));
  }

  /// The gradients, from doubles rounded once: as many lanes at a time as a vector of doubles has.
  HWY_INLINE void SetUpGradient(VI area) {
    using DD = hn::ScalableTag<double>;
    const DD d;
    const hn::Rebind<float, DD> half_f;
    const hn::Rebind<std::int32_t, DD> half_i;
    HWY_ALIGN_MAX std::int32_t areas[kMaxLanes], sides[4][kMaxLanes];
    HWY_ALIGN_MAX float key[3][kMaxLanes], gx[kMaxLanes], gy[kMaxLanes];
    hn::Store(area, DI(), areas);
    const VI of_sides[4] = {dx_[0], dy_[0], dx_[2], dy_[2]};
    for (int k = 0; k < 4; ++k) hn::Store(of_sides[k], DI(), sides[k]);
    for (int k = 0; k < 3; ++k) hn::Store(KeyOf(k), DF(), key[k]);
    for (std::size_t i = 0; i < hn::Lanes(DF()); i += hn::Lanes(d)) {
      const auto side = [&](int k) HWY_ATTR { return hn::PromoteTo(d, hn::Load(half_i, sides[k] + i)); };
      const auto key_of = [&](int k) HWY_ATTR { return hn::PromoteTo(d, hn::Load(half_f, key[k] + i)); };
      const auto k1 = hn::Sub(key_of(1), key_of(0)), k2 = hn::Sub(key_of(2), key_of(0));
      const auto scale = hn::Div(hn::Set(d, 1.0), hn::PromoteTo(d, hn::Load(half_i, areas + i)));
      // Side 2 runs to corner 0, which changes the sign of its products.
      const auto across = hn::Neg(hn::Add(hn::Mul(k1, side(3)), hn::Mul(k2, side(1))));
      const auto down = hn::Add(hn::Mul(k2, side(0)), hn::Mul(k1, side(2)));
      hn::Store(hn::DemoteTo(half_f, hn::Mul(across, scale)), half_f, gx + i);
      hn::Store(hn::DemoteTo(half_f, hn::Mul(down, scale)), half_f, gy + i);
    }
    gx_ = hn::Load(DF(), gx);
    gy_ = hn::Load(DF(), gy);
  }

  /// The topmost corner, of two as high the left one: how far corners 1 and 2 are below corner 0 in the order of
  /// reading fits 32 bits.
  HWY_INLINE void SetUpAnchor(const VI (&x)[3], const VI (&y)[3]) {
    const VI zero = hn::Zero(DI());
    const VI to_1 = hn::Add(hn::ShiftLeft<16>(dy_[0]), dx_[0]);
    const VI to_2 = hn::Neg(hn::Add(hn::ShiftLeft<16>(dy_[2]), dx_[2]));
    const MI is_1 = hn::Lt(to_1, zero), is_2 = hn::Lt(to_2, hn::Min(to_1, zero));
    const auto of = [&](VI a, VI b, VI c) HWY_ATTR { return hn::IfThenElse(is_2, c, hn::IfThenElse(is_1, b, a)); };
    x0_ = of(x[0], x[1], x[2]);
    y0_ = of(y[0], y[1], y[2]);
    const auto bits = [&](int k) HWY_ATTR { return hn::Load(DI(), queue_.field[6 + k]); };
    k0_ = hn::BitCast(DF(), of(bits(0), bits(1), bits(2)));
  }

  /// KeyPlane, operation by operation: a triangle's keys must not depend on what draws it.
  HWY_INLINE void SetUpPlane(const VI (&x)[3], const VI (&y)[3], MI live) {
    const DF df;
    SetUpGradient(hn::Sub(hn::Mul(dx_[2], dy_[0]), hn::Mul(dx_[0], dy_[2])));
    SetUpAnchor(x, y);
    low_ = hn::Min(KeyOf(0), hn::Min(KeyOf(1), KeyOf(2)));
    high_ = hn::Max(KeyOf(0), hn::Max(KeyOf(1), KeyOf(2)));
    const auto extent = [&](const VI(&v)[3]) HWY_ATTR {
      const VI most = hn::Max(v[0], hn::Max(v[1], v[2])), least = hn::Min(v[0], hn::Min(v[1], v[2]));
      return hn::ConvertTo(df, hn::Sub(most, least));
    };
    const VF change = hn::Add(hn::Mul(hn::Abs(gx_), extent(x)), hn::Mul(hn::Abs(gy_), extent(y)));
    const VF limit = hn::Sub(low_, hn::Set(df, KeyPlane::least_key)), twice = hn::Add(limit, limit);
    const auto steep = hn::Or(hn::Gt(change, hn::Add(twice, twice)), hn::Gt(hn::Sub(high_, low_), twice));
    steep_ = hn::And(live, hn::RebindMask(DI(), steep));
    if (kFlat) return;
    const VF slope = hn::Add(hn::Abs(gx_), hn::Abs(gy_));
    const VF reach = hn::Set(df, float(kSmallExtent + 2 * kSubPixels));
    slack_ =
        hn::Add(hn::Mul(hn::Add(high_, hn::Mul(slope, reach)), hn::Set(df, kKeyRounding)), hn::Set(df, kLeastRounding));
    // However steep, no key leaves the triangle's range.
    half_ = hn::Add(hn::Min(hn::Mul(slope, hn::Set(df, kHalfPixel)), hn::Sub(high_, low_)), slack_);
  }

  HWY_INLINE void KeepPlanes(std::size_t drawn) {
    const DI d;
    const DU du;
    const DF df;
    LocalTriangles& t = sink_.triangles;
    t.reserve(2 * kMaxLanes);
    const std::size_t n = first_ = t.count;
    hn::StoreU(x0_, d, t.x0.data() + n);
    hn::StoreU(y0_, d, t.y0.data() + n);
    hn::StoreU(k0_, df, t.k0.data() + n);
    hn::StoreU(gx_, df, t.gx.data() + n);
    hn::StoreU(gy_, df, t.gy.data() + n);
    hn::StoreU(low_, df, t.low.data() + n);
    hn::StoreU(high_, df, t.high.data() + n);
    hn::StoreU(slack_, df, t.slack.data() + n);
    hn::StoreU(half_, df, t.half.data() + n);
    hn::StoreU(hn::Set(du, no_index), du, t.steep.data() + n);
    hn::StoreU(hn::BitCast(du, hn::Load(d, queue_.field[9])), du, t.id.data() + n);
    t.count += drawn;
    HWY_ALIGN_MAX std::int32_t dx[kMaxLanes], dy[kMaxLanes];
    for (int k = 0; k < 3; ++k) {
      hn::Store(dx_[k], d, dx);
      hn::Store(dy_[k], d, dy);
      for (std::size_t i = 0; i < drawn; ++i) sink_.samples.Fill(steps_[i], k, dx[i], dy[i]);
    }
  }

  /// Notes (triangle, pixel) pairs of which a sample may be covered as y << 8 | x << 4 | lane. \returns how many. With
  /// one sample that sample is.
  HWY_INLINE std::size_t Walk() {
    const DI d;
    const DU du;
    const int most_x = hn::GetLane(hn::MaxOfLanes(d, width_)), most_y = hn::GetLane(hn::MaxOfLanes(d, height_));
    VI row[3], step_x[3], step_y[3];
    for (int k = 0; k < 3; ++k) {
      row[k] = hn::Add(edge_[k], sample_max_[k]);
      step_x[k] = hn::Neg(hn::ShiftLeft<4>(dy_[k]));
      step_y[k] = hn::ShiftLeft<4>(dx_[k]);
    }
    std::uint32_t* out = references_;
    for (int y = 0; y < most_y; ++y) {
      const VI row_width = hn::IfThenElseZero(hn::Gt(height_, hn::Set(d, y)), width_);
      VI e0 = row[0], e1 = row[1], e2 = row[2];
      for (int x = 0; x < most_x; ++x) {
        const VI all = hn::Or(hn::Or(e0, e1), e2);
        const MI covered = hn::And(hn::Gt(all, hn::Set(d, -1)), hn::Gt(row_width, hn::Set(d, x)));
        out += CompactInto(CountFrom(du, std::uint32_t(y << 8 | x << 4)), hn::RebindMask(du, covered), du, out);
        e0 = hn::Add(e0, step_x[0]);
        e1 = hn::Add(e1, step_x[1]);
        e2 = hn::Add(e2, step_x[2]);
      }
      for (int k = 0; k < 3; ++k) row[k] = hn::Add(row[k], step_y[k]);
    }
    return std::size_t(out - references_);
  }

  HWY_INLINE void AppendFound(std::size_t count) {
    const DI d;
    const DU du;
    const DF df;
    const VI from_x = hn::Sub(hn::Add(hn::ShiftLeft<8>(px_), hn::Set(d, kSubPixels / 2)), x0_);
    const VI from_y = hn::Sub(hn::Add(hn::ShiftLeft<8>(py_), hn::Set(d, kSubPixels / 2)), y0_);
    const VI ids = hn::Load(d, queue_.field[9]);
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      const VI reference = hn::BitCast(d, hn::LoadU(du, references_ + i));
      // Beyond the last there may be anything: lanes stay within the vector.
      const VI lane = hn::And(reference, hn::Set(d, std::int32_t(hn::Lanes(d)) - 1));
      const auto of = hn::IndicesFromVec(d, lane);
      const auto of_f = hn::IndicesFromVec(df, lane);
      const VI x = hn::And(hn::ShiftRight<4>(reference), hn::Set(d, 15));
      const VI y = hn::And(hn::ShiftRight<8>(reference), hn::Set(d, 15));
      const VF dx = hn::ConvertTo(df, hn::Add(hn::TableLookupLanes(from_x, of), hn::ShiftLeft<8>(x)));
      const VF dy = hn::ConvertTo(df, hn::Add(hn::TableLookupLanes(from_y, of), hn::ShiftLeft<8>(y)));
      VF key = hn::Add(hn::TableLookupLanes(k0_, of_f), hn::Mul(dx, hn::TableLookupLanes(gx_, of_f)));
      key = hn::Add(key, hn::Mul(dy, hn::TableLookupLanes(gy_, of_f)));
      const VF low = hn::TableLookupLanes(low_, of_f), high = hn::TableLookupLanes(high_, of_f);
      key = hn::Min(hn::Max(key, low), high);
      const VI px = hn::Add(hn::TableLookupLanes(px_, of), x), py = hn::Add(hn::TableLookupLanes(py_, of), y);
      hn::Store(PixelNumber(px, py), d, pixel_);
      const std::size_t live = HWY_MIN(count - i, hn::Lanes(d));
      if (kFlat) {
        AppendFlat(hn::BitCast(d, key), hn::TableLookupLanes(ids, of), live);
        continue;
      }
      hn::Store(hn::BitCast(du, key), du, key_);
      hn::Store(lane, d, lane_);
      for (int k = 0; k < 3; ++k) {
        const VI sx = hn::Mul(hn::ShiftLeft<4>(x), hn::TableLookupLanes(dy_[k], of));
        const VI sy = hn::Mul(hn::ShiftLeft<4>(y), hn::TableLookupLanes(dx_[k], of));
        hn::Store(hn::Add(hn::TableLookupLanes(edge_[k], of), hn::Sub(sy, sx)), d, corner_[k]);
      }
      AppendMasked(live);
    }
  }

  static HWY_INLINE VI PixelNumber(VI x, VI y) {
    const DI d;
    const VI three = hn::Set(d, 3);
    const VI block = hn::Add(hn::Mul(hn::ShiftRight<2>(y), hn::Set(d, kBlocksAcross)), hn::ShiftRight<2>(x));
    return hn::Add(hn::ShiftLeft<4>(block), hn::Add(hn::ShiftLeft<2>(hn::And(y, three)), hn::And(x, three)));
  }

  HWY_INLINE void AppendFlat(VI key, VI ids, std::size_t live) {
    const DU du;
    Arrived& out = sink_.arrived;
    const std::size_t n = out.count;
    hn::StoreU(hn::BitCast(du, key), du, out.key.data() + n);
    hn::StoreU(hn::BitCast(du, ids), du, out.triangle.data() + n);
    for (std::size_t k = 0; k < live; ++k) {
      const auto pixel = std::uint32_t(pixel_[k]);
      out.place[n + k] = pixel << kRankBits | sink_.counts[pixel]++;
    }
    out.count += live;
  }

  HWY_INLINE void AppendMasked(std::size_t live) {
    for (std::size_t k = 0; k < live; ++k) {
      const auto lane = std::size_t(lane_[k]);
      const std::uint64_t mask = sink_.samples.MaskOf(steps_[lane], corner_[0][k], corner_[1][k], corner_[2][k]);
      sink_.Append(std::uint32_t(pixel_[k]), key_[k], std::uint32_t(first_ + lane), mask);
    }
  }

  FragmentSink<kFlat>& sink_;
  LargeTriangles<kFlat>& large_;
  std::uint32_t* references_;
  TriangleQueue queue_;
  // One batch. Edge functions are at the corner of the first pixel of each triangle's rectangle.
  VI px_, py_, width_, height_, x0_, y0_, edge_[3], dx_[3], dy_[3], sample_max_[3];
  VF k0_, gx_, gy_, low_, high_, slack_, half_;
  MI steep_;
  SampleSteps steps_[kMaxLanes];
  std::size_t first_ = 0;  // of the batch, in LocalTriangles
  // One vector of pairs.
  HWY_ALIGN_MAX std::int32_t pixel_[kMaxLanes], lane_[kMaxLanes], corner_[3][kMaxLanes];
  HWY_ALIGN_MAX std::uint32_t key_[kMaxLanes];
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::abuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
