// SPDX-License-Identifier: Apache-2.0
// Triangles of a few pixels, as many at once as the vector holds. All triangles of a batch are walked pixel by pixel in
// step; the found pixels then get keys and masks together.
//
//    queue     a vector of triangles, set up together: edges, planes of depth
//    walk      pixel 0 of each, pixel 1 of each, ...: which of them are touched
//    found     (triangle, pixel) pairs, a vector at a time: masks over all samples, keys, appended together
//
// The walk keeps only pairs, because most pixels of a small triangle's box are not covered. Masks are computed for
// touched pixels only, in vectors that are full again.

// Included once for every target.
#if defined(FRONTMOST_ABUFFER_SMALL_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ABUFFER_SMALL_TRIANGLES_INL_H_
#undef FRONTMOST_ABUFFER_SMALL_TRIANGLES_INL_H_
#else
#define FRONTMOST_ABUFFER_SMALL_TRIANGLES_INL_H_
#endif

#include "abuffer/gather/large_triangles-inl.h"
#include "view/key_planes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Triangles no wider and higher than this touch at most 16 x 16 pixels.
constexpr std::int32_t kSmallExtent = 15 * kSubPixels;

/// Small triangles that wait to be drawn: x, y and key bits of three vertices, and the id. Has room for one vector more
/// than is drawn at a time.
struct FragmentQueue {
  static constexpr int kFields = 10;
  HWY_ALIGN_MAX std::int32_t field[kFields][3 * kMaxLanes];
  std::size_t count = 0;
};

class SmallFragments {
 public:
  /// Steep triangles go to `large`.
  SmallFragments(FragmentSink& sink, GatherScratch& scratch, LargeFragments& large)
      : sink_(sink), large_(large), references_(scratch.references.data()) {}

  HWY_INLINE void Append(const VI (&fields)[FragmentQueue::kFields], MI keep) {
    const Compactor<DI> compact(keep);
    for (int f = 0; f < FragmentQueue::kFields; ++f) compact.Store(fields[f], queue_.field[f] + queue_.count);
    queue_.count += compact.count();
  }
  [[nodiscard]] bool IsFull() const { return queue_.count >= hn::Lanes(DI()); }
  void Finish() {
    while (queue_.count > 0 && sink_.HasRoom()) DrawQueued();
  }

  /// Draws a vector of triangles, or as many as there are.
  void DrawQueued() {
    const DI d;
    const std::size_t drawn = HWY_MIN(queue_.count, hn::Lanes(d));
    SetUp(drawn);
    if (!hn::AllFalse(d, plane_.steep))
      ForEachBit(BitsOf(d, plane_.steep), [&](std::size_t lane) { large_.Draw(QueuedTriangle(lane)); });
    const std::size_t found = Walk();
    if (found > 0) {
      KeepPlanes(drawn);
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
    const FragmentBounds p = sink_.BoundsOf(hn::Min(x[0], hn::Min(x[1], x[2])), hn::Max(x[0], hn::Max(x[1], x[2])),
                                            hn::Min(y[0], hn::Min(y[1], y[2])), hn::Max(y[0], hn::Max(y[1], y[2])));
    const VI one = hn::Set(d, 1);
    const MI live = hn::Lt(hn::Iota(d, 0), hn::Set(d, std::int32_t(used)));
    width_ = hn::IfThenElseZero(live, hn::Add(hn::Sub(p.x1, p.x0), one));
    height_ = hn::IfThenElseZero(live, hn::Add(hn::Sub(p.y1, p.y0), one));
    px_ = p.x0;
    py_ = p.y0;
    for (int k = 0; k < 3; ++k) SetUpEdge(k, x, y);
    SetUpPlane(x, y, live);
    // Steep triangles are drawn one by one.
    width_ = hn::IfThenZeroElse(plane_.steep, width_);
  }

  HWY_INLINE void SetUpEdge(int k, const VI (&x)[3], const VI (&y)[3]) {
    const DI d;
    const SamplePattern& p = sink_.pattern;
    const int n = k == 2 ? 0 : k + 1;
    const VI dx = hn::Sub(x[n], x[k]), dy = hn::Sub(y[n], y[k]);
    // Top-left edges include their own points, with bias 0; other edges have bias -1. An edge is top-left if dy < 0, or
    // dy = 0 and dx > 0. The test is dy * 2^16 - dx < 0, as both are within 15 bits.
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

  HWY_INLINE void SetUpPlane(const VI (&x)[3], const VI (&y)[3], MI live) {
    const DF df;
    const VF keys[3] = {KeyOf(0), KeyOf(1), KeyOf(2)};
    plane_ = view_detail::HWY_NAMESPACE::KeyPlanesOf(x, y, keys);
    plane_.steep = hn::And(live, plane_.steep);
    const VF slope = hn::Add(hn::Abs(plane_.gx), hn::Abs(plane_.gy));
    const VF reach = hn::Set(df, float(kSmallExtent + 2 * kSubPixels));
    slack_ = hn::Add(hn::Mul(hn::Add(plane_.k_max, hn::Mul(slope, reach)), hn::Set(df, kKeyRounding)),
                     hn::Set(df, kLeastRounding));
    // Even in steep triangles, no key leaves the range of the vertices' keys.
    half_ = hn::Add(hn::Min(hn::Mul(slope, hn::Set(df, kHalfPixel)), hn::Sub(plane_.k_max, plane_.k_min)), slack_);
  }

  HWY_INLINE void KeepPlanes(std::size_t drawn) {
    const DI d;
    const DU du;
    const DF df;
    LocalTriangles& t = sink_.triangles;
    t.reserve(2 * kMaxLanes);
    const std::size_t n = first_ = t.count;
    hn::StoreU(plane_.x0, d, t.x0.data() + n);
    hn::StoreU(plane_.y0, d, t.y0.data() + n);
    hn::StoreU(plane_.k0, df, t.k0.data() + n);
    hn::StoreU(plane_.gx, df, t.gx.data() + n);
    hn::StoreU(plane_.gy, df, t.gy.data() + n);
    hn::StoreU(plane_.k_min, df, t.low.data() + n);
    hn::StoreU(plane_.k_max, df, t.high.data() + n);
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

  /// Notes (triangle, pixel) pairs that may cover a sample, as y << 8 | x << 4 | lane. \returns how many. With one
  /// sample, every noted pair covers it.
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
    const VI from_x = hn::Sub(hn::Add(hn::ShiftLeft<8>(px_), hn::Set(d, kSubPixels / 2)), plane_.x0);
    const VI from_y = hn::Sub(hn::Add(hn::ShiftLeft<8>(py_), hn::Set(d, kSubPixels / 2)), plane_.y0);
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      const VI reference = hn::BitCast(d, hn::LoadU(du, references_ + i));
      // References beyond the last may hold anything, so lanes are limited to the vector.
      const VI lane = hn::And(reference, hn::Set(d, std::int32_t(hn::Lanes(d)) - 1));
      const auto of = hn::IndicesFromVec(d, lane);
      const auto of_f = hn::IndicesFromVec(df, lane);
      const VI x = hn::And(hn::ShiftRight<4>(reference), hn::Set(d, 15));
      const VI y = hn::And(hn::ShiftRight<8>(reference), hn::Set(d, 15));
      const VF dx = hn::ConvertTo(df, hn::Add(hn::TableLookupLanes(from_x, of), hn::ShiftLeft<8>(x)));
      const VF dy = hn::ConvertTo(df, hn::Add(hn::TableLookupLanes(from_y, of), hn::ShiftLeft<8>(y)));
      VF key = hn::Add(hn::TableLookupLanes(plane_.k0, of_f), hn::Mul(dx, hn::TableLookupLanes(plane_.gx, of_f)));
      key = hn::Add(key, hn::Mul(dy, hn::TableLookupLanes(plane_.gy, of_f)));
      const VF low = hn::TableLookupLanes(plane_.k_min, of_f), high = hn::TableLookupLanes(plane_.k_max, of_f);
      key = hn::Min(hn::Max(key, low), high);
      const VI px = hn::Add(hn::TableLookupLanes(px_, of), x), py = hn::Add(hn::TableLookupLanes(py_, of), y);
      hn::Store(PixelNumber(px, py), d, pixel_);
      const std::size_t live = HWY_MIN(count - i, hn::Lanes(d));
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

  HWY_INLINE void AppendMasked(std::size_t live) {
    for (std::size_t k = 0; k < live; ++k) {
      const auto lane = std::size_t(lane_[k]);
      const std::uint64_t mask = sink_.samples.MaskOf(steps_[lane], corner_[0][k], corner_[1][k], corner_[2][k]);
      sink_.Append(std::uint32_t(pixel_[k]), key_[k], std::uint32_t(first_ + lane), mask);
    }
  }

  FragmentSink& sink_;
  LargeFragments& large_;
  std::uint32_t* references_;
  FragmentQueue queue_;
  // State of one batch. Edge functions are at the corner of the first pixel of each triangle's rectangle.
  VI px_, py_, width_, height_, edge_[3], dx_[3], dy_[3], sample_max_[3];
  view_detail::HWY_NAMESPACE::KeyPlanes plane_;
  VF slack_, half_;
  SampleSteps steps_[kMaxLanes];
  std::size_t first_ = 0;  // first triangle of the batch, in LocalTriangles
  // State of one vector of pairs.
  HWY_ALIGN_MAX std::int32_t pixel_[kMaxLanes], lane_[kMaxLanes], corner_[3][kMaxLanes];
  HWY_ALIGN_MAX std::uint32_t key_[kMaxLanes];
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::abuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
