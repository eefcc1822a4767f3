// SPDX-License-Identifier: Apache-2.0
// The fragments of one tile: rasterised, counted and appended in one go, then placed into lists and sorted.
//
//    singles of the tile ------------------------> LargeFragments --+
//    clusters --fetch, bounds, facing--> small --> SmallFragments --+--> FragmentSink: masks, keys, numbers of arrival
//                                        large --> LargeFragments --+
//
// The sink is asked for room after every vector. If it has none, gather_tile() returns too_much, and the caller halves
// the tile. So the memory of a thread is bounded for every scene.

#include "abuffer/gather/gather_kernel.h"

#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "abuffer/gather/gather_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "abuffer/gather/fragment_sink-inl.h"
#include "view/facing-inl.h"
#include "view/key_planes-inl.h"
#include "view/steep_keys-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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
    KeyPlane& plane = plane_.emplace(t);
    id_ = t.id;
    if (plane.is_steep) {
      steep_ = SteepKeys(t);
      plane.gx = float(steep_.gx());
      plane.gy = float(steep_.gy());
    }
    const float slope = std::abs(plane.gx) + std::abs(plane.gy);
    const auto [x_min, x_max] = std::minmax({t.x[0], t.x[1], t.x[2]});
    const auto [y_min, y_max] = std::minmax({t.y[0], t.y[1], t.y[2]});
    // Keys of steep triangles are rounded only once, so only the rounding of their gradients over half a pixel counts.
    const float reach_x = plane.is_steep ? kHalfPixel : float(x_max - x_min) + 2 * kSubPixels;
    const float reach_y = plane.is_steep ? kHalfPixel : float(y_max - y_min) + 2 * kSubPixels;
    slack_ =
        (plane.k_max + (reach_x * std::abs(plane.gx) + reach_y * std::abs(plane.gy))) * kKeyRounding + kLeastRounding;
    // Even in steep triangles, no key leaves the range of the vertices' keys.
    half_ = std::min(slope * kHalfPixel, plane.k_max - plane.k_min) + slack_;
    triangle_ = std::uint32_t(sink_.triangles.count);
  }

  void KeepPlane() {
    LocalTriangles& t = sink_.triangles;
    t.reserve(1);
    const std::size_t n = t.count++;
    t.x0[n] = plane_->x0;
    t.y0[n] = plane_->y0;
    t.k0[n] = plane_->k0;
    t.gx[n] = plane_->gx;
    t.gy[n] = plane_->gy;
    t.low[n] = plane_->k_min;
    t.high[n] = plane_->k_max;
    t.slack[n] = slack_;
    t.half[n] = half_;
    t.id[n] = id_;
    t.steep[n] = plane_->is_steep ? std::uint32_t(t.steep_keys.size()) : no_index;
    if (plane_->is_steep) t.steep_keys.push_back(steep_);
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
    if (plane_->is_steep) {
      const VI x = hn::ConvertTo(DI(), hn::Add(hn::Load(d, centre_x_ + first), hn::Set(d, float(bx * size + half))));
      const VI y = hn::ConvertTo(DI(), hn::Add(hn::Load(d, centre_y_ + first), hn::Set(d, float(by * size + half))));
      view_detail::HWY_NAMESPACE::SteepColumns columns;
      columns.Set(steep_, x);
      return columns.At(steep_, y);
    }
    const VF dx = hn::Add(hn::Load(d, centre_x_ + first), hn::Set(d, float(bx * size + half - plane_->x0)));
    const VF dy = hn::Add(hn::Load(d, centre_y_ + first), hn::Set(d, float(by * size + half - plane_->y0)));
    VF key = hn::Add(hn::Set(d, plane_->k0), hn::Mul(dx, hn::Set(d, plane_->gx)));
    key = hn::Add(key, hn::Mul(dy, hn::Set(d, plane_->gy)));
    return hn::Min(hn::Max(key, hn::Set(d, plane_->k_min)), hn::Set(d, plane_->k_max));
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
  std::optional<KeyPlane> plane_;  ///< with the gradients of steep_ if it is steep
  float slack_, half_;
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

class TileGatherer {
 public:
  TileGatherer(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch)
      : frame_(frame), job_(job), sink_(frame, job, scratch), large_(sink_), small_(sink_, scratch, large_) {}

  /// \returns false if there are too many fragments.
  bool Run() {
    if (!DrawSingles()) return false;
    for (const std::uint32_t cluster : frame_.plan.clusters(job_.tile))
      if (!DrawCluster(frame_.plan.set().clusters[cluster])) return false;
    small_.Finish();
    return sink_.HasRoom();
  }

 private:
  bool DrawSingles() {
    const auto singles = frame_.plan.singles();
    const auto listed = frame_.plan.singles(job_.tile);
    const std::size_t count = listed ? listed->size() : singles.size();
    for (std::size_t i = 0; i < count; ++i) {
      DrawLarge(singles[listed ? (*listed)[i] : i]);
      if (!sink_.HasRoom()) return false;
    }
    return true;
  }

  bool DrawCluster(const Cluster& cluster) {
    for (std::size_t i = 0; i < cluster.triangle_count; i += hn::Lanes(DI())) {
      Queue(cluster, cluster.first_triangle + i);
      while (small_.IsFull()) {
        small_.DrawQueued();
        if (!sink_.HasRoom()) return false;
      }
    }
    return true;
  }

  struct Corners {
    VI number, x, y;
  };
  HWY_INLINE Corners Fetch(const Cluster& cluster, const Buffer<std::uint8_t>& numbers, std::size_t at) const {
    const DI d;
    const hn::Rebind<std::uint8_t, DI> d8;
    const ScreenClusters& screen = frame_.plan.screen();
    const ScreenTransform& t = frame_.plan.transform();
    const VI number = hn::PromoteTo(d, hn::LoadU(d8, numbers.data() + at));
    const VI x = hn::GatherIndex(d, screen.x.data() + cluster.first_vertex, number);
    const VI y = hn::GatherIndex(d, screen.y.data() + cluster.first_vertex, number);
    return {number, hn::Add(x, hn::Set(d, t.centre_x - job_.pixels.x * kSubPixels)),
            hn::Add(y, hn::Set(d, t.centre_y - job_.pixels.y * kSubPixels))};
  }

  /// Queues the triangles that may cover a sample of this tile; draws large ones at once.
  HWY_INLINE void Queue(const Cluster& cluster, std::size_t at) {
    const DI d;
    const ClusterSet& set = frame_.plan.set();
    const Corners a = Fetch(cluster, set.i0, at), b = Fetch(cluster, set.i1, at), c = Fetch(cluster, set.i2, at);
    const VI x_min = hn::Min(a.x, hn::Min(b.x, c.x)), x_max = hn::Max(a.x, hn::Max(b.x, c.x));
    const VI y_min = hn::Min(a.y, hn::Min(b.y, c.y)), y_max = hn::Max(a.y, hn::Max(b.y, c.y));
    const FragmentBounds p = sink_.BoundsOf(x_min, x_max, y_min, y_max);
    MI keep = hn::And(hn::Not(hn::Gt(p.x0, p.x1)), hn::Not(hn::Gt(p.y0, p.y1)));
    if (hn::AllFalse(d, keep)) return;

    // Only small triangles have products that fit 32 bits, in the area below and in the edge functions of their batch.
    const VI extent = hn::Max(hn::Sub(x_max, x_min), hn::Sub(y_max, y_min));
    const MI large = hn::And(keep, hn::Gt(extent, hn::Set(d, kSmallExtent)));
    if (!hn::AllFalse(d, large)) {
      DrawLargeLanes(cluster, at, large);
      keep = hn::AndNot(large, keep);
    }
    const VI area =
        hn::Sub(hn::Mul(hn::Sub(b.x, a.x), hn::Sub(c.y, a.y)), hn::Mul(hn::Sub(c.x, a.x), hn::Sub(b.y, a.y)));
    const MI front = hn::Lt(area, hn::Zero(d));  // counter-clockwise to the eye; y is down
    const MI back = hn::And(keep, hn::Gt(area, hn::Zero(d)));
    const auto ids = [&]() HWY_ATTR { return hn::LoadU(DU(), set.id.data() + at); };
    keep = hn::And(keep, view_detail::HWY_NAMESPACE::Kept(d, frame_.plan.facing(), front, back, ids));
    if (hn::AllFalse(d, keep)) return;

    // Swapping the last two vertices of front faces makes the area positive.
    const float* key = frame_.plan.screen().key.data() + cluster.first_vertex;
    const auto key_of = [&](VI number) HWY_ATTR { return hn::BitCast(d, hn::GatherIndex(DF(), key, number)); };
    const VI bn = hn::IfThenElse(front, c.number, b.number), cn = hn::IfThenElse(front, b.number, c.number);
    const VI fields[FragmentQueue::kFields] = {a.x,
                                               hn::IfThenElse(front, c.x, b.x),
                                               hn::IfThenElse(front, b.x, c.x),
                                               a.y,
                                               hn::IfThenElse(front, c.y, b.y),
                                               hn::IfThenElse(front, b.y, c.y),
                                               key_of(a.number),
                                               key_of(bn),
                                               key_of(cn),
                                               hn::BitCast(d, ids())};
    small_.Append(fields, keep);
  }

  void DrawLargeLanes(const Cluster& cluster, std::size_t at, MI large) {
    for (std::uint64_t left = BitsOf(DI(), large); left != 0; left &= left - 1) {
      const std::size_t i = at + hwy::Num0BitsBelowLS1Bit_Nonzero64(left);
      ScreenTriangle triangle = frame_.plan.snapped(cluster, i - cluster.first_triangle);
      if (!orient(triangle, frame_.plan.facing())) continue;
      // Room is checked for each triangle, because a vector of large triangles may add more fragments than kMostAtOnce.
      if (!sink_.HasRoom()) return;
      DrawLarge(triangle);
    }
  }

  void DrawLarge(ScreenTriangle triangle) {
    for (int k = 0; k < 3; ++k) {
      triangle.x[k] -= job_.pixels.x * kSubPixels;
      triangle.y[k] -= job_.pixels.y * kSubPixels;
    }
    large_.Draw(triangle);
  }

  const GatherInput& frame_;
  const GatherJob& job_;
  FragmentSink sink_;
  LargeFragments large_;
  SmallFragments small_;
};

Gathered GatherTile(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch) {
  std::fill(scratch.counts.begin(), scratch.counts.end(), 0u);
  scratch.arrived.count = Arrived::first;
  scratch.triangles.clear();
  if (!TileGatherer(frame, job, scratch).Run()) return Gathered::too_much;
  return scratch.arrived.count == Arrived::first ? Gathered::nothing : Gathered::something;
}

// The functions below turn fragments in the order of arrival into sorted lists. The lists of the sixteen pixels of a
// group all have the length of the longest.

// Keys are not negative, so words may be compared as signed: AVX2 has no other comparison.
using DW = hn::ScalableTag<std::int64_t>;

HWY_INLINE void CompareExchange(std::int64_t* a, std::int64_t* b) {
  const DW d;
  for (std::size_t i = 0; i < kGroup; i += hn::Lanes(d)) {
    const auto va = hn::Load(d, a + i), vb = hn::Load(d, b + i);
    // Empty slots are 0 and so sink to the end of their lists, whatever their lengths.
    hn::Store(hn::Max(va, vb), d, a + i);
    hn::Store(hn::Min(va, vb), d, b + i);
  }
}

/// Sorts the sixteen lists of a group, greatest first, by one sorting network: K. Batcher. Sorting Networks and Their
/// Applications. 1968; as algorithm M of D. Knuth, The Art of Computer Programming 3, 5.2.2, which takes any length.
/// Measured against separate lists one after the other: insertion sort takes 7 to 8 times as long, std::sort 9 times.
HWY_INLINE void SortGroup(std::uint64_t* slots, std::size_t length) {
  auto* words = reinterpret_cast<std::int64_t*>(slots);
  if (length < 2) return;
  std::size_t top = 1;
  while (2 * top < length) top *= 2;
  for (std::size_t p = top; p > 0; p /= 2) {
    std::size_t q = top, r = 0, d = p;
    for (;;) {
      // The loops visit all i with (i & p) == r, which are every other block of p numbers.
      for (std::size_t begin = r; begin + d < length; begin += 2 * p)
        for (std::size_t i = begin; i < HWY_MIN(begin + p, length - d); ++i)
          CompareExchange(words + i * kGroup, words + (i + d) * kGroup);
      if (q == p) break;
      d = q - p;
      q /= 2;
      r = p;
    }
  }
}

/// Sorts fragments of equal keys, which are in the order of arrival, by id.
inline void OrderTies(GatherScratch& s, std::size_t group, std::size_t lane) {
  const auto length = s.length(group);
  const auto at = [&](std::size_t i) -> std::uint64_t& { return s.slot(group, i)[lane]; };
  const auto id = [&](std::uint64_t word) { return s.triangles.id[s.arrived.triangle[~std::uint32_t(word)]]; };
  for (std::size_t begin = 0; begin < length && at(begin) != 0;) {
    std::size_t end = begin + 1;
    // An empty slot has the key 0 as well.
    while (end < length && at(end) != 0 && at(end) >> 32 == at(begin) >> 32) ++end;
    if (end - begin > 1) {
      std::vector<std::uint64_t>& run = s.run;
      run.clear();
      for (std::size_t i = begin; i < end; ++i) run.push_back(at(i));
      // Pieces of one clipped triangle have one id; their masks are disjoint, and so give a definite order.
      std::sort(run.begin(), run.end(), [&](std::uint64_t a, std::uint64_t b) {
        const PrimitiveId ia = id(a), ib = id(b);
        if (ia != ib) return ia < ib;
        return s.arrived.mask(~std::uint32_t(a)) < s.arrived.mask(~std::uint32_t(b));
      });
      for (std::size_t i = begin; i < end; ++i) at(i) = run[i - begin];
    }
    begin = end;
  }
}

inline void FindTies(GatherScratch& s, std::size_t group) {
  const DW d;
  const std::size_t length = s.length(group);
  for (std::size_t lane = 0; lane < kGroup; lane += hn::Lanes(d)) {
    auto tied = hn::Lt(hn::Zero(d), hn::Zero(d));
    for (std::size_t i = 0; i + 1 < length; ++i) {
      const auto a = hn::Load(d, reinterpret_cast<std::int64_t*>(s.slot(group, i)) + lane);
      const auto b = hn::Load(d, reinterpret_cast<std::int64_t*>(s.slot(group, i + 1)) + lane);
      // Empty slots are 0 and tie with each other, but in a real tie b is not 0.
      const auto equal = hn::Eq(hn::ShiftRight<32>(a), hn::ShiftRight<32>(b));
      tied = hn::Or(tied, hn::And(equal, hn::Ne(b, hn::Zero(d))));
    }
    for (std::uint64_t left = BitsOf(d, tied); left != 0; left &= left - 1)
      OrderTies(s, group, lane + hwy::Num0BitsBelowLS1Bit_Nonzero64(left));
  }
}

/// Makes room for the lists. The number of fragments of each pixel becomes the offset of its list, in words.
HWY_INLINE void MakeRoom(GatherScratch& s) {
  const DU d;
  std::uint32_t base = 0;
  for (std::size_t g = 0; g < kGroups; ++g) {
    s.group_base[g] = base;
    VU longest = hn::Zero(d);
    for (std::size_t i = 0; i < kGroup; i += hn::Lanes(d)) {
      std::uint32_t* counts = s.counts.data() + g * kGroup + i;
      longest = hn::Max(longest, hn::Load(d, counts));
      hn::Store(CountFrom(d, std::uint32_t(base * kGroup + i)), d, counts);
    }
    base += hn::GetLane(hn::MaxOfLanes(d, longest));
  }
  s.group_base[kGroups] = base;
  const std::size_t words = std::size_t(base) * kGroup;
  if (s.slots.size() < words) s.slots = Buffer<std::uint64_t>(words + words / 4);
  std::fill_n(s.slots.data(), words, std::uint64_t(0));
}

HWY_INLINE void Place(GatherScratch& s) {
  const std::uint32_t *place = s.arrived.place.data(), *key = s.arrived.key.data(), *begin = s.counts.data();
  auto* slots = reinterpret_cast<char*>(s.slots.data());
  const std::size_t count = s.arrived.count;
  for (std::size_t n = Arrived::first; n < count; ++n) {
    const std::size_t rank = place[n] & kMostOfPixel;
    const std::uint64_t word = std::uint64_t(key[n]) << 32 | ~std::uint32_t(n);
    // The pointer is to bytes, which may alias any other array: otherwise g++ makes a scatter, which takes longer.
    std::memcpy(slots + (begin[place[n] >> kRankBits] + rank * kGroup) * sizeof word, &word, sizeof word);
  }
}

inline void SortLists(GatherScratch& s) {
  MakeRoom(s);
  Place(s);
  for (std::size_t g = 0; g < kGroups; ++g) {
    SortGroup(s.slot(g, 0), s.length(g));
    FindTies(s, g);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::abuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::abuffer_detail {

FRONTMOST_KERNELS(GatherTile);
FRONTMOST_KERNELS(SortLists);

Gathered gather_tile(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch) {
  return kernel_for(GatherTileKernels, frame.isa)(frame, job, scratch);
}

void sort_lists(Isa isa, GatherScratch& scratch) { kernel_for(SortListsKernels, isa)(scratch); }

}  // namespace frontmost::abuffer_detail
#endif  // HWY_ONCE
