// SPDX-License-Identifier: Apache-2.0
// Makes the fragments of triangles. Triangles of a few pixels are drawn many at a time, larger triangles one at a time,
// in blocks of 4 x 4 pixels.
//
// The least and greatest edge value over all samples of a block tell whether it is wholly outside of an edge, wholly
// inside of all three, or neither. Pixels that are covered wholly get full masks. In all other pixels samples are
// tested, many pixels together.
//
// Edge values of triangles of up to 128 pixels fit 32 bits all over the tile, so whole rows of blocks are classified
// together. Edge values of larger triangles are computed in 64 bits at the corner of each block and clamped there:
// within a block their signs stay right.

// Included once for every target.
#if defined(FRONTMOST_ABUFFER_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ABUFFER_TRIANGLES_INL_H_
#undef FRONTMOST_ABUFFER_TRIANGLES_INL_H_
#else
#define FRONTMOST_ABUFFER_TRIANGLES_INL_H_
#endif

#include "abuffer/gather/fragment_sink-inl.h"
#include "view/key_planes-inl.h"
#include "view/steep_keys-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Limit of edge values at a block's corner. Within the block a value changes by at most 2^29 + 2^27, so its sign stays
// right and its sums stay within 32 bits.
constexpr std::int64_t kEdgeLimit = std::int64_t(1) << 30;

class LargeFragments {
 public:
  explicit LargeFragments(FragmentSink& sink) : sink_(sink) {
    for (std::int32_t i = 0; i < 16; ++i) {
      column_[i] = i % 4;
      row_[i] = i / 4;
      centre_x_[i] = float(column_[i] * kSubPixels);
      centre_y_[i] = float(row_[i] * kSubPixels);
    }
  }

  /// Draws one triangle. Precondition: the triangle is oriented, with vertices relative to the tile.
  void Draw(const ScreenTriangle& t) {
    const Bounds rect = BoundsOf(t);
    if (rect.x1 < rect.x0 || rect.y1 < rect.y0) return;
    SetUpEdges(t);
    SetUpPlane(t);
    const std::size_t before = sink_.arrived.count;
    if (IsNarrow(t))
      DrawNarrow(rect);
    else
      DrawWide(rect);
    if (sink_.arrived.count > before) KeepPlane();
  }

 private:
  struct Bounds {
    std::int32_t x0, y0, x1, y1;
  };
  struct Edge {
    std::int64_t first;  // value at the tile's corner
    std::int32_t step_x, step_y;
    std::int32_t sample_min, sample_max;   // extreme differences of a pixel's samples from its corner
    std::int32_t block_min, block_max;     // extreme differences of a block's samples from its corner
    HWY_ALIGN_MAX std::int32_t pixel[16];  // differences of a block's pixels from its corner
    HWY_ALIGN_MAX std::int32_t block[16];  // differences of a row's blocks from the first
  };

  [[nodiscard]] Bounds BoundsOf(const ScreenTriangle& t) const {
    const SamplePattern& p = sink_.pattern;
    const auto [x_min, x_max] = std::minmax({t.x[0], t.x[1], t.x[2]});
    const auto [y_min, y_max] = std::minmax({t.y[0], t.y[1], t.y[2]});
    return {std::max((x_min + 255 - p.high_x * SamplePattern::unit) >> 8, 0),
            std::max((y_min + 255 - p.high_y * SamplePattern::unit) >> 8, 0),
            std::min((x_max - p.low_x * SamplePattern::unit) >> 8, sink_.width - 1),
            std::min((y_max - p.low_y * SamplePattern::unit) >> 8, sink_.height - 1)};
  }

  void SetUpEdges(const ScreenTriangle& t) {
    const SamplePattern& p = sink_.pattern;
    for (int k = 0; k < 3; ++k) {
      const int n = k == 2 ? 0 : k + 1;
      const std::int32_t dx = t.x[n] - t.x[k], dy = t.y[n] - t.y[k];
      Edge& e = edge_[k];
      // 64 bits are needed, because vertices may be as far away as the guard band, where products exceed 32 bits.
      e.first = (std::int64_t(dy) * t.x[k] - std::int64_t(dx) * t.y[k] - (IsTopLeft(dx, dy) ? 0 : 1)) >> 4;
      e.step_x = -dy * kStepsOfPixel;
      e.step_y = dx * kStepsOfPixel;
      e.sample_max = std::max(dx * p.low_y, dx * p.high_y) + std::max(-dy * p.low_x, -dy * p.high_x);
      e.sample_min = std::min(dx * p.low_y, dx * p.high_y) + std::min(-dy * p.low_x, -dy * p.high_x);
      e.block_max = e.sample_max + 3 * (std::max(e.step_x, 0) + std::max(e.step_y, 0));
      e.block_min = e.sample_min + 3 * (std::min(e.step_x, 0) + std::min(e.step_y, 0));
      for (int i = 0; i < 16; ++i) e.pixel[i] = column_[i] * e.step_x + row_[i] * e.step_y;
      sink_.samples.Fill(steps_, k, dx, dy);
    }
  }

  void SetUpPlane(const ScreenTriangle& t) {
    const KeyPlane plane(t);
    id_ = t.id;
    x0_ = plane.x0;
    y0_ = plane.y0;
    k0_ = plane.k0;
    gx_ = plane.gx;
    gy_ = plane.gy;
    low_ = plane.k_min;
    high_ = plane.k_max;
    is_steep_ = plane.is_steep;
    if (is_steep_) {
      steep_ = SteepKeys(t);
      gx_ = float(steep_.gx());
      gy_ = float(steep_.gy());
    }
    const float slope = std::abs(gx_) + std::abs(gy_);
    const auto [x_min, x_max] = std::minmax({t.x[0], t.x[1], t.x[2]});
    const auto [y_min, y_max] = std::minmax({t.y[0], t.y[1], t.y[2]});
    // Keys of steep triangles are rounded only once, so only the rounding of their gradients over half a pixel counts.
    const float reach_x = is_steep_ ? kHalfPixel : float(x_max - x_min) + 2 * kSubPixels;
    const float reach_y = is_steep_ ? kHalfPixel : float(y_max - y_min) + 2 * kSubPixels;
    slack_ = (high_ + (reach_x * std::abs(gx_) + reach_y * std::abs(gy_))) * kKeyRounding + kLeastRounding;
    // Even in steep triangles, no key leaves the range of the vertices' keys.
    half_ = std::min(slope * kHalfPixel, high_ - low_) + slack_;
    triangle_ = std::uint32_t(sink_.triangles.count);
  }

  void KeepPlane() {
    LocalTriangles& t = sink_.triangles;
    t.reserve(1);
    const std::size_t n = t.count++;
    t.x0[n] = x0_;
    t.y0[n] = y0_;
    t.k0[n] = k0_;
    t.gx[n] = gx_;
    t.gy[n] = gy_;
    t.low[n] = low_;
    t.high[n] = high_;
    t.slack[n] = slack_;
    t.half[n] = half_;
    t.id[n] = id_;
    t.steep[n] = is_steep_ ? std::uint32_t(t.steep_keys.size()) : no_index;
    if (is_steep_) t.steep_keys.push_back(steep_);
  }

  /// Returns whether edge functions stay below 2^28 all over the tile: true up to 128 pixels of width and height.
  [[nodiscard]] static bool IsNarrow(const ScreenTriangle& t) {
    constexpr std::int32_t most = 128 * kSubPixels;
    const auto [x_min, x_max] = std::minmax({t.x[0], t.x[1], t.x[2]});
    const auto [y_min, y_max] = std::minmax({t.y[0], t.y[1], t.y[2]});
    return x_max - x_min <= most && y_max - y_min <= most;
  }

  /// Draws a row of blocks at a time.
  HWY_INLINE void DrawNarrow(const Bounds& rect) {
    std::int32_t row[3];
    for (int k = 0; k < 3; ++k) {
      row[k] = std::int32_t(edge_[k].first) + (rect.y0 & ~3) * edge_[k].step_y;
      for (int i = 0; i < kBlocksAcross; ++i) edge_[k].block[i] = 4 * i * edge_[k].step_x;
    }
    for (std::int32_t by = rect.y0 / 4; by <= rect.y1 / 4; ++by) {
      const BlockRow blocks = FindBlocks(rect, row);
      const std::uint64_t full = 4 * by + 4 <= sink_.height ? blocks.full : 0;
      ForEachBit(blocks.touched, [&](std::size_t i) HWY_ATTR {
        const auto bx = std::int32_t(i);
        std::int32_t e[3];
        for (int k = 0; k < 3; ++k) e[k] = row[k] + edge_[k].block[i];
        DrawBlock(bx, by, e, (full >> i & 1) != 0);
      });
      for (int k = 0; k < 3; ++k) row[k] += 4 * edge_[k].step_y;
    }
  }

  struct BlockRow {
    std::uint64_t touched = 0, full = 0;
  };
  /// Classifies a row of blocks. `row` holds the edge values at the corner of the row's first block.
  HWY_INLINE BlockRow FindBlocks(const Bounds& rect, const std::int32_t (&row)[3]) const {
    const DI d;
    BlockRow result;
    constexpr auto lanes = std::int32_t(kMaxLanes);
    for (std::int32_t first = rect.x0 / 4 / lanes * lanes; first <= rect.x1 / 4; first += lanes) {
      VI most = hn::Zero(d), least = hn::Zero(d);
      for (int k = 0; k < 3; ++k) {
        const VI at = hn::Add(hn::Set(d, row[k]), hn::Load(d, edge_[k].block + first));
        most = hn::Or(most, hn::Add(at, hn::Set(d, edge_[k].block_max)));
        least = hn::Or(least, hn::Add(at, hn::Set(d, edge_[k].block_min)));
      }
      result.touched |= BitsOf(d, hn::Gt(most, hn::Set(d, -1))) << first;
      result.full |= BitsOf(d, hn::Gt(least, hn::Set(d, -1))) << first;
    }
    const auto below = [](std::int32_t block) { return (std::uint64_t(1) << block) - 1; };
    result.touched &= below(rect.x1 / 4 + 1) & ~below(rect.x0 / 4);
    result.full &= below(sink_.width / 4);
    return result;
  }

  void DrawWide(const Bounds& rect) {
    for (std::int32_t by = rect.y0 / 4; by <= rect.y1 / 4; ++by)
      for (std::int32_t bx = rect.x0 / 4; bx <= rect.x1 / 4; ++bx) {
        std::int32_t e[3];
        for (int k = 0; k < 3; ++k) {
          const Edge& edge = edge_[k];
          const std::int64_t at = edge.first + std::int64_t(4 * bx) * edge.step_x + std::int64_t(4 * by) * edge.step_y;
          e[k] = std::int32_t(HWY_MAX(HWY_MIN(at, kEdgeLimit), -kEdgeLimit));
        }
        std::int32_t most = 0, least = 0;
        for (int k = 0; k < 3; ++k) {
          most |= e[k] + edge_[k].block_max;
          least |= e[k] + edge_[k].block_min;
        }
        if (most < 0) continue;
        DrawBlock(bx, by, e, least >= 0 && 4 * bx + 4 <= sink_.width && 4 * by + 4 <= sink_.height);
      }
  }

  HWY_INLINE void DrawBlock(std::int32_t bx, std::int32_t by, const std::int32_t (&e)[3], bool is_full) {
    for (std::int32_t i = 0; i < 16; i += std::int32_t(hn::Lanes(DI()))) {
      if (is_full)
        DrawPixels<true>(bx, by, i, e);
      else
        DrawPixels<false>(bx, by, i, e);
    }
  }

  template <bool kFull>
  HWY_INLINE void DrawPixels(std::int32_t bx, std::int32_t by, std::int32_t first, const std::int32_t* e) {
    const DI d;
    MI touched = hn::Eq(hn::Zero(d), hn::Zero(d)), covered = touched;
    if (!kFull) {
      VI least = hn::Zero(d), most = hn::Zero(d);
      for (int k = 0; k < 3; ++k) {
        const VI at = hn::Add(hn::Set(d, e[k]), hn::Load(d, edge_[k].pixel + first));
        hn::Store(at, d, corner_[k]);
        most = hn::Or(most, hn::Add(at, hn::Set(d, edge_[k].sample_max)));
        least = hn::Or(least, hn::Add(at, hn::Set(d, edge_[k].sample_min)));
      }
      const VI x = hn::Add(hn::Load(d, column_ + first), hn::Set(d, 4 * bx));
      const VI y = hn::Add(hn::Load(d, row_ + first), hn::Set(d, 4 * by));
      touched = hn::And(hn::Lt(x, hn::Set(d, sink_.width)), hn::Lt(y, hn::Set(d, sink_.height)));
      touched = hn::And(touched, hn::Gt(most, hn::Set(d, -1)));
      covered = hn::And(touched, hn::Gt(least, hn::Set(d, -1)));
      if (hn::AllFalse(d, touched)) return;
    }
    const VF key = KeysOf(bx, by, first);
    const std::uint32_t pixel = std::uint32_t((by * kBlocksAcross + bx) * 16 + first);
    if (kFull) return AppendFull(pixel, key);
    if (!hn::AllFalse(d, covered)) AppendWhole(pixel, key, covered);
    AppendParts(pixel, key, BitsOf(d, hn::AndNot(covered, touched)));
  }

  /// Returns the keys of a block's pixels. Distances are whole numbers below 2^24, so floats add them exactly.
  [[nodiscard]] HWY_INLINE VF KeysOf(std::int32_t bx, std::int32_t by, std::int32_t first) const {
    const DF d;
    constexpr std::int32_t size = 4 * kSubPixels, half = kSubPixels / 2;
    if (is_steep_) {
      const VI x = hn::ConvertTo(DI(), hn::Add(hn::Load(d, centre_x_ + first), hn::Set(d, float(bx * size + half))));
      const VI y = hn::ConvertTo(DI(), hn::Add(hn::Load(d, centre_y_ + first), hn::Set(d, float(by * size + half))));
      view_detail::HWY_NAMESPACE::SteepColumns columns;
      columns.Set(steep_, x);
      return columns.At(steep_, y);
    }
    const VF dx = hn::Add(hn::Load(d, centre_x_ + first), hn::Set(d, float(bx * size + half - x0_)));
    const VF dy = hn::Add(hn::Load(d, centre_y_ + first), hn::Set(d, float(by * size + half - y0_)));
    VF key = hn::Add(hn::Set(d, k0_), hn::Mul(dx, hn::Set(d, gx_)));
    key = hn::Add(key, hn::Mul(dy, hn::Set(d, gy_)));
    return hn::Min(hn::Max(key, hn::Set(d, low_)), hn::Set(d, high_));
  }

  /// Appends a vector of pixels that are covered wholly.
  HWY_INLINE void AppendFull(std::uint32_t pixel, VF key) {
    const DU du;
    const VU count = hn::Load(du, sink_.counts + pixel);
    hn::Store(hn::Add(count, hn::Set(du, 1)), du, sink_.counts + pixel);
    sink_.AppendVector(hn::BitCast(du, key), PlaceOf(pixel, count), triangle_);
  }

  /// Appends the pixels of a vector that are covered wholly.
  HWY_INLINE void AppendWhole(std::uint32_t pixel, VF key, MI covered) {
    const DU du;
    const auto mask = hn::RebindMask(du, covered);
    const VU count = hn::Load(du, sink_.counts + pixel);
    hn::Store(hn::Add(count, hn::IfThenElseZero(mask, hn::Set(du, 1))), du, sink_.counts + pixel);
    sink_.AppendSome(hn::BitCast(du, key), PlaceOf(pixel, count), triangle_, mask);
  }

  static HWY_INLINE VU PlaceOf(std::uint32_t pixel, VU count) {
    return hn::Or(hn::ShiftLeft<kRankBits>(CountFrom(DU(), pixel)), count);
  }

  /// Appends pixels that are covered partly, or not at all.
  HWY_INLINE void AppendParts(std::uint32_t pixel, VF key, std::uint64_t touched) {
    HWY_ALIGN_MAX std::uint32_t keys[kMaxLanes];
    hn::Store(hn::BitCast(DU(), key), DU(), keys);
    ForEachBit(touched, [&](std::size_t i) HWY_ATTR {
      const std::uint64_t mask = sink_.samples.MaskOf(steps_, corner_[0][i], corner_[1][i], corner_[2][i]);
      sink_.Append(pixel + std::uint32_t(i), keys[i], triangle_, mask);
    });
  }

  FragmentSink& sink_;
  // Positions of a block's pixels in the block, in pixels and in 1/256 pixel.
  HWY_ALIGN_MAX std::int32_t column_[16], row_[16];
  HWY_ALIGN_MAX float centre_x_[16], centre_y_[16];
  HWY_ALIGN_MAX std::int32_t corner_[3][kMaxLanes];
  Edge edge_[3];
  SampleSteps steps_;
  std::uint32_t id_, triangle_;
  std::int32_t x0_, y0_;
  float k0_, gx_, gy_, low_, high_, slack_, half_;
  bool is_steep_;
  SteepKeys steep_;
};

// Triangles no wider and higher than this touch at most 16 x 16 pixels.
constexpr std::int32_t kSmallExtent = 15 * kSubPixels;

/// Small triangles that wait to be drawn: x, y and key bits of three vertices, and the id. The room is one vector more
/// than the queue ever holds, because stores write whole vectors.
struct FragmentQueue {
  static constexpr int kFields = 10;
  HWY_ALIGN_MAX std::int32_t field[kFields][3 * kMaxLanes];
  std::size_t count = 0;
};

/// Triangles of a few pixels, as many at once as the vector holds. All triangles of a batch are walked pixel by pixel
/// in step. The walk keeps only (triangle, pixel) pairs, because most pixels of a small triangle's box are not covered.
/// Masks and keys are computed for touched pixels only, in vectors that are full again.
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
      t.key[k] = bits_as<float>(queue_.field[6 + k][lane]);
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

  /// Stores the (triangle, pixel) pairs that may cover a sample, as y << 8 | x << 4 | lane. \returns their number. If
  /// the pattern has one sample, every stored pair covers it.
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
