// SPDX-License-Identifier: Apache-2.0
// Drawing one tile: triangles into a private buffer of 64-bit words, many triangles at a time while they are small.
//
// J. Pineda. A Parallel Algorithm for Polygon Rasterization. 1988 (edge functions).
// N. Greene, M. Kass, G. Miller. Hierarchical Z-Buffer Visibility. 1993 (farthest key by block).
//
// Coordinates are relative to the tile, in 1/256 pixel. Coverage: E >= 0 for three edge functions, biased by the
// top-left rule (y down, area positive: an edge is left where it goes up, top where it is level and goes right). Pixels
// are 256 units apart, so an edge value may be shifted right by 8 before stepping: a step is then -dy or dx, and the
// sign is still exact.
//
// The key at a sample is (k0 + dx*gx) + dy*gy from the first corner, clamped to the triangle's own range. Every
// path evaluates exactly this, so they agree to the bit; and each rounding is monotone, so the corners of a block
// bound the keys inside it.

#include "zbuffer/tile_kernel.h"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/tile_kernel.cpp"
#include "base/isa.h"
#include "hwy/cache_control.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "zbuffer/compactor-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DI = hn::ScalableTag<std::int32_t>;
using DU = hn::RebindToUnsigned<DI>;
using DF = hn::RebindToFloat<DI>;
using VI = hn::Vec<DI>;
using VU = hn::Vec<DU>;
using VF = hn::Vec<DF>;
using MI = hn::Mask<DI>;
// Words are handled in whole vectors of 64 bits, beside half vectors of 32.
using DW = hn::ScalableTag<std::uint64_t>;
using DWI = hn::RebindToSigned<DW>;
using DHU = hn::Rebind<std::uint32_t, DW>;
using DHI = hn::RebindToSigned<DHU>;
using DHF = hn::RebindToFloat<DHU>;

constexpr std::size_t kMaxLanes = hn::MaxLanes(DI());

// A triangle whose pixel rectangle is at most this wide and high is drawn with others at once.
constexpr int kWalkLimit = 16;
// Corners no farther apart than this keep every edge value inside the triangle's box within 32 bits: two products of
// at most 31744 * (31744 + 256).
constexpr std::int32_t kSmallExtent = 124 * kSubPixels;
// An edge value at the tile's first sample is clamped to this. Over 127 pixels both ways it changes by at most
// 2 * 127 * 2^22 < 2^30, so its sign stays right and its sums stay within 32 bits.
constexpr std::int64_t kEdgeLimit = std::int64_t(1) << 30;
// Pixels of the tile that lie outside the image: nearer than anything, so that they never keep a block from hiding.
constexpr std::uint64_t kOutsideImage = std::uint64_t(0x7F7FFFFF) << 32;

/// Small triangles waiting to be drawn, set apart by corner. Room for one vector more than is drawn at a time.
struct TriangleQueue {
  static constexpr std::size_t kRoom = 3 * kMaxLanes;
  HWY_ALIGN_MAX std::int32_t x[3][kRoom], y[3][kRoom];
  HWY_ALIGN_MAX float key[3][kRoom];
  HWY_ALIGN_MAX std::uint32_t id[kRoom];
  std::size_t count = 0;
};

/// A cluster's vertices on the screen.
struct ScreenCluster {
  HWY_ALIGN_MAX std::int32_t x[Cluster::max_vertices], y[Cluster::max_vertices];
  HWY_ALIGN_MAX float key[Cluster::max_vertices];
};

/// Three edges and a depth plane for as many triangles as the vector holds.
struct Batch {
  VI x0, y0, dx[3], dy[3], bias[3];  // edge k runs from corner k
  VI cx[3], cy[3];                   // its start
  VF k0, gx, gy, k_min, k_max;
  VI px, py, width, height;  // pixel rectangle within the tile
  VU not_id;
};

/// The same for one triangle, set up in 64 bits.
struct Large {
  std::int32_t step_x[3], step_y[3];
  std::int32_t x0, y0;
  float k0, gx, gy, k_min, k_max;
  std::uint32_t not_id;
  PixelRect rect;
};

HWY_INLINE bool IsTopLeft(std::int32_t dx, std::int32_t dy) { return dy < 0 || (dy == 0 && dx > 0); }

class TilePainter {
 public:
  TilePainter(const FrameInput& frame, const TileJob& job, TileScratch& scratch)
      : frame_(frame), job_(job), scratch_(scratch), words_(scratch.words.data()) {
    low_ = high_ = frame.samples[0];
    for (const glm::ivec2& s : frame.samples) low_ = glm::min(low_, s), high_ = glm::max(high_, s);
  }

  void Draw() {
    Clear();
    for (const std::uint32_t i : job_.records) DrawRecord(frame_.records[i]);
    for (std::size_t i = 0; i < job_.clusters.size(); ++i) {
      if (i + 2 < job_.clusters.size()) Prefetch(job_.clusters[i + 2]);
      const std::uint32_t cluster = job_.clusters[i];
      const PixelRect rect = InTile(frame_.culled.rect(cluster));
      if (!IsHidden(rect, frame_.culled.nearest[cluster])) DrawCluster(frame_.set.clusters[cluster], rect);
    }
    while (queue_.count > 0) DrawQueued();
  }

  void WriteOut() const {
    for (std::size_t s = 0; s < frame_.samples.size(); ++s)
      for (int y = 0; y < job_.height; ++y) WriteRow(s, y);
  }

 private:
  // -- the buffer ---------------------------------------------------------------------------------------------------

  void Clear() {
    const DW d;
    for (std::size_t s = 0; s < frame_.samples.size(); ++s)
      for (int y = 0; y < kTileSize; ++y) {
        std::uint64_t* row = Row(s, y);
        const int inside = y < job_.height ? job_.width : 0;
        for (int x = 0; x < kTileSize; x += int(hn::Lanes(d))) hn::Store(hn::Zero(d), d, row + x);
        for (int x = inside; x < kTileSize; ++x) row[x] = kOutsideImage;
      }
    std::fill(scratch_.farthest.begin(), scratch_.farthest.end(), 0.0f);
    scratch_.dirty = 0;
  }

  [[nodiscard]] HWY_INLINE std::uint64_t* Row(std::size_t sample, int y) const {
    return words_ + sample * kTileWords + std::size_t(y) * kTileStride;
  }

  void WriteRow(std::size_t sample, int y) const {
    const DW d;
    const DHU dh;
    const DHF df;
    const std::size_t at =
        (sample * std::size_t(frame_.view.height) + std::size_t(job_.y + y)) * std::size_t(frame_.view.width) +
        std::size_t(job_.x);
    const std::uint64_t* row = Row(sample, y);
    PrimitiveId* primitives = frame_.primitives + at;
    float* keys = frame_.keys + at;
    const std::size_t lanes = hn::Lanes(d), width = std::size_t(job_.width);
    const bool streams = frame_.streams && at % 16 == 0 && lanes >= 4;
    std::size_t x = 0;
    for (; x + lanes <= width; x += lanes) {
      const auto word = hn::Load(d, row + x);
      const auto id = hn::Not(hn::TruncateTo(dh, word));
      const auto key = hn::BitCast(df, hn::TruncateTo(dh, hn::ShiftRight<32>(word)));
      if (streams) {
        hn::Stream(id, dh, primitives + x);
        hn::Stream(key, df, keys + x);
      } else {
        hn::StoreU(id, dh, primitives + x);
        hn::StoreU(key, df, keys + x);
      }
    }
    for (; x < width; ++x) {
      primitives[x] = ~std::uint32_t(row[x]);
      const std::uint32_t bits = std::uint32_t(row[x] >> 32);
      std::memcpy(keys + x, &bits, sizeof bits);
    }
  }

  // -- hierarchical depth -------------------------------------------------------------------------------------------

  [[nodiscard]] HWY_INLINE PixelRect InTile(const PixelRect& rect) const {
    return {HWY_MAX(rect.x0 - job_.x, 0), HWY_MAX(rect.y0 - job_.y, 0), HWY_MIN(rect.x1 - job_.x, job_.width - 1),
            HWY_MIN(rect.y1 - job_.y, job_.height - 1)};
  }

  [[nodiscard]] static HWY_INLINE std::uint64_t BlockBit(int bx, int by) { return std::uint64_t(1) << (by * 8 + bx); }

  void FindFarthest(int bx, int by) {
    const DWI d;
    auto least = hn::Set(d, std::int64_t(kOutsideImage));
    for (std::size_t s = 0; s < frame_.samples.size(); ++s)
      for (int y = by * kBlockSize; y < (by + 1) * kBlockSize; ++y) {
        const auto* row = reinterpret_cast<const std::int64_t*>(Row(s, y)) + bx * kBlockSize;
        for (int x = 0; x < kBlockSize; x += int(hn::Lanes(d))) least = hn::Min(least, hn::Load(d, row + x));
      }
    HWY_ALIGN_MAX std::int64_t lanes[kMaxLanes];
    hn::Store(least, d, lanes);
    for (std::size_t i = 1; i < hn::Lanes(d); ++i) lanes[0] = HWY_MIN(lanes[0], lanes[i]);
    const auto bits = std::uint32_t(std::uint64_t(lanes[0]) >> 32);
    std::memcpy(&scratch_.farthest[std::size_t(by * 8 + bx)], &bits, sizeof bits);
    scratch_.dirty &= ~BlockBit(bx, by);
  }

  /// True when every sample of the block is strictly nearer than `nearest`.
  [[nodiscard]] HWY_INLINE bool BlockHides(int bx, int by, float nearest) {
    const std::size_t i = std::size_t(by * 8 + bx);
    if (scratch_.farthest[i] > nearest) return true;
    if (!(scratch_.dirty & BlockBit(bx, by))) return false;
    FindFarthest(bx, by);
    return scratch_.farthest[i] > nearest;
  }

  [[nodiscard]] bool IsHidden(const PixelRect& rect, float nearest) {
    for (int by = rect.y0 / kBlockSize; by <= rect.y1 / kBlockSize; ++by)
      for (int bx = rect.x0 / kBlockSize; bx <= rect.x1 / kBlockSize; ++bx)
        if (!BlockHides(bx, by, nearest)) return false;
    return true;
  }

  // -- clusters -----------------------------------------------------------------------------------------------------

  HWY_INLINE void Prefetch(std::uint32_t index) const {
    const Cluster& cluster = frame_.set.clusters[index];
    const ClusterSet& set = frame_.set;
    for (std::size_t i = 0; i < cluster.vertex_count; i += 16) {
      hwy::Prefetch(set.x.data() + cluster.first_vertex + i);
      hwy::Prefetch(set.y.data() + cluster.first_vertex + i);
      hwy::Prefetch(set.z.data() + cluster.first_vertex + i);
    }
    for (std::size_t i = 0; i < cluster.triangle_count; i += 64) {
      hwy::Prefetch(set.i0.data() + cluster.first_triangle + i);
      hwy::Prefetch(set.i1.data() + cluster.first_triangle + i);
      hwy::Prefetch(set.i2.data() + cluster.first_triangle + i);
    }
    for (std::size_t i = 0; i < cluster.triangle_count; i += 16)
      hwy::Prefetch(set.id.data() + cluster.first_triangle + i);
  }

  // The vertex formula of view/screen_transform.h, many at a time.
  HWY_INLINE void TransformVertices(const Cluster& cluster) {
    const ScreenTransform& t = frame_.transform;
    const DF d;
    const DI di;
    const VI origin_x = hn::Set(di, t.centre_x - job_.x * kSubPixels);
    const VI origin_y = hn::Set(di, t.centre_y - job_.y * kSubPixels);
    for (std::size_t i = 0; i < cluster.vertex_count; i += hn::Lanes(d)) {
      const std::size_t v = cluster.first_vertex + i;
      const VF dx = hn::Sub(hn::Load(d, frame_.set.x.data() + v), hn::Set(d, t.eye[0]));
      const VF dy = hn::Sub(hn::Load(d, frame_.set.y.data() + v), hn::Set(d, t.eye[1]));
      const VF dz = hn::Sub(hn::Load(d, frame_.set.z.data() + v), hn::Set(d, t.eye[2]));
      const VF x = RowOf(t.x_row, t.x_offset, dx, dy, dz), y = RowOf(t.y_row, t.y_offset, dx, dy, dz);
      const VF depth = RowOf(t.d_row, t.d_offset, dx, dy, dz);
      VF sx = x, sy = y, key;
      if (t.orthographic) {
        key = hn::Mul(hn::Sub(hn::Set(d, t.far), depth), hn::Set(d, t.inverse_range));
        key = hn::Max(key, hn::Zero(d));
      } else {
        const VF inverse = hn::Div(hn::Set(d, 1.0f), depth);
        sx = hn::Mul(x, inverse);
        sy = hn::Mul(y, inverse);
        key = hn::Mul(hn::Set(d, t.near), inverse);
      }
      hn::Store(hn::Min(key, hn::Set(d, 1.0f)), d, vertices_.key + i);
      hn::Store(hn::Add(hn::NearestInt(sx), origin_x), di, vertices_.x + i);
      hn::Store(hn::Add(hn::NearestInt(sy), origin_y), di, vertices_.y + i);
    }
  }

  static HWY_INLINE VF RowOf(const std::array<float, 3>& row, float offset, VF dx, VF dy, VF dz) {
    const DF d;
    const VF x = hn::Mul(hn::Set(d, row[0]), dx), y = hn::Mul(hn::Set(d, row[1]), dy);
    return hn::Add(hn::Add(hn::Add(x, y), hn::Mul(hn::Set(d, row[2]), dz)), hn::Set(d, offset));
  }

  void DrawCluster(const Cluster& cluster, const PixelRect& rect) {
    TransformVertices(cluster);
    for (int by = rect.y0 / kBlockSize; by <= rect.y1 / kBlockSize; ++by)
      for (int bx = rect.x0 / kBlockSize; bx <= rect.x1 / kBlockSize; ++bx) scratch_.dirty |= BlockBit(bx, by);
    for (std::size_t i = 0; i < cluster.triangle_count; i += hn::Lanes(DI())) {
      Gather(cluster, i);
      while (queue_.count >= hn::Lanes(DI())) DrawQueued();
    }
  }

  struct Corners {
    VI number, x, y;
  };

  HWY_INLINE Corners Fetch(const Buffer<std::uint8_t>& numbers, std::size_t at) const {
    const DI d;
    const hn::Rebind<std::uint8_t, DI> d8;
    const VI number = hn::PromoteTo(d, hn::LoadU(d8, numbers.data() + at));
    return {number, hn::GatherIndex(d, vertices_.x, number), hn::GatherIndex(d, vertices_.y, number)};
  }

  /// Puts the triangles that may cover a sample of this tile into the queue; large ones are drawn at once.
  HWY_INLINE void Gather(const Cluster& cluster, std::size_t first) {
    const DI d;
    const std::size_t at = cluster.first_triangle + first;
    const Corners a = Fetch(frame_.set.i0, at);
    Corners b = Fetch(frame_.set.i1, at), c = Fetch(frame_.set.i2, at);

    const VI x_min = hn::Min(a.x, hn::Min(b.x, c.x)), x_max = hn::Max(a.x, hn::Max(b.x, c.x));
    const VI y_min = hn::Min(a.y, hn::Min(b.y, c.y)), y_max = hn::Max(a.y, hn::Max(b.y, c.y));
    const VI px0 = FirstPixel(x_min, high_.x), px1 = LastPixel(x_max, low_.x, job_.width);
    const VI py0 = FirstPixel(y_min, high_.y), py1 = LastPixel(y_max, low_.y, job_.height);
    MI keep = hn::And(hn::Not(hn::Gt(px0, px1)), hn::Not(hn::Gt(py0, py1)));
    if (hn::AllFalse(d, keep)) return;

    const VI extent = hn::Max(hn::Sub(x_max, x_min), hn::Sub(y_max, y_min));
    const MI large = hn::And(keep, hn::Gt(extent, hn::Set(d, kSmallExtent)));
    if (!hn::AllFalse(d, large)) {
      DrawLargeLanes(cluster, first, large);
      keep = hn::AndNot(large, keep);
    }

    const VI area =
        hn::Sub(hn::Mul(hn::Sub(b.x, a.x), hn::Sub(c.y, a.y)), hn::Mul(hn::Sub(c.x, a.x), hn::Sub(b.y, a.y)));
    const MI front = hn::Lt(area, hn::Zero(d));  // counter-clockwise to the eye; y is down
    keep = hn::And(keep, Facing(front, area));
    if (hn::AllFalse(d, keep)) return;

    // Turn the area positive: swap the last two corners of front faces.
    const VI bx = hn::IfThenElse(front, c.x, b.x), cx = hn::IfThenElse(front, b.x, c.x);
    const VI by = hn::IfThenElse(front, c.y, b.y), cy = hn::IfThenElse(front, b.y, c.y);
    const VI bn = hn::IfThenElse(front, c.number, b.number), cn = hn::IfThenElse(front, b.number, c.number);
    const DF df;
    const Compactor<DI> compact(keep);
    const std::size_t n = queue_.count;
    compact.Store(a.x, queue_.x[0] + n);
    compact.Store(a.y, queue_.y[0] + n);
    compact.Store(bx, queue_.x[1] + n);
    compact.Store(by, queue_.y[1] + n);
    compact.Store(cx, queue_.x[2] + n);
    compact.Store(cy, queue_.y[2] + n);
    compact.Store(hn::GatherIndex(df, vertices_.key, a.number), queue_.key[0] + n);
    compact.Store(hn::GatherIndex(df, vertices_.key, bn), queue_.key[1] + n);
    compact.Store(hn::GatherIndex(df, vertices_.key, cn), queue_.key[2] + n);
    compact.Store(hn::LoadU(DU(), frame_.set.id.data() + at), queue_.id + n);
    queue_.count += compact.count();
  }

  /// The first pixel that has a sample at or after `minimum`, and the last that has one at or before `maximum`.
  static HWY_INLINE VI FirstPixel(VI minimum, std::int32_t last_offset) {
    const DI d;
    return hn::Max(hn::ShiftRight<8>(hn::Add(minimum, hn::Set(d, 255 - last_offset))), hn::Zero(d));
  }
  static HWY_INLINE VI LastPixel(VI maximum, std::int32_t first_offset, std::int32_t size) {
    const DI d;
    return hn::Min(hn::ShiftRight<8>(hn::Sub(maximum, hn::Set(d, first_offset))), hn::Set(d, size - 1));
  }

  HWY_INLINE MI Facing(MI front, VI area) const {
    const DI d;
    const MI back = hn::Gt(area, hn::Zero(d));
    switch (frame_.view.culling) {
      case Culling::none: return hn::Or(front, back);
      case Culling::back: return front;
      case Culling::front: return back;
      case Culling::both: break;
    }
    return hn::And(front, back);  // none
  }

  void DrawLargeLanes(const Cluster& cluster, std::size_t first, MI large) {
    const DI d;
    HWY_ALIGN_MAX std::int32_t lanes[kMaxLanes];
    hn::Store(hn::IfThenElseZero(large, hn::Set(d, 1)), d, lanes);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      if (lanes[lane] == 0) continue;
      const std::size_t at = cluster.first_triangle + first + lane;
      const std::uint8_t numbers[3] = {frame_.set.i0[at], frame_.set.i1[at], frame_.set.i2[at]};
      TriangleRecord record;
      record.id = frame_.set.id[at];
      for (int k = 0; k < 3; ++k) {
        record.x[k] = vertices_.x[numbers[k]];
        record.y[k] = vertices_.y[numbers[k]];
        record.key[k] = vertices_.key[numbers[k]];
      }
      if (orient(record, frame_.view.culling)) DrawLarge(record);
    }
  }

  // -- small triangles, many at once --------------------------------------------------------------------------------

  void DrawQueued() {
    const std::size_t lanes = hn::Lanes(DI()), drawn = HWY_MIN(queue_.count, lanes);
    const Batch batch = SetUp(drawn);
    HWY_ALIGN_MAX std::int32_t width[kMaxLanes], height[kMaxLanes];
    hn::Store(batch.width, DI(), width);
    hn::Store(batch.height, DI(), height);
    int most_x = 0, most_y = 0;
    for (std::size_t lane = 0; lane < drawn; ++lane) {
      if (width[lane] > kWalkLimit || height[lane] > kWalkLimit) {
        DrawLarge(QueuedRecord(lane));
        width[lane] = 0;
      } else {
        most_x = HWY_MAX(most_x, width[lane]);
        most_y = HWY_MAX(most_y, height[lane]);
      }
    }
    const VI walk_width = hn::Load(DI(), width);
    for (std::size_t s = 0; s < frame_.samples.size(); ++s) {
      const std::size_t found = Walk(batch, walk_width, most_x, most_y, s);
      Merge(batch, found, s);
    }
    Shift(drawn);
  }

  [[nodiscard]] TriangleRecord QueuedRecord(std::size_t lane) const {
    TriangleRecord record;
    for (int k = 0; k < 3; ++k) {
      record.x[k] = queue_.x[k][lane];
      record.y[k] = queue_.y[k][lane];
      record.key[k] = queue_.key[k][lane];
    }
    record.id = queue_.id[lane];
    return record;
  }

  /// Moves what is left in the queue, less than two vectors, to its front.
  HWY_INLINE void Shift(std::size_t drawn) {
    queue_.count -= drawn;
    if (queue_.count == 0) return;
    for (std::size_t i = 0; i < queue_.count; ++i) {
      for (int k = 0; k < 3; ++k) {
        queue_.x[k][i] = queue_.x[k][i + drawn];
        queue_.y[k][i] = queue_.y[k][i + drawn];
        queue_.key[k][i] = queue_.key[k][i + drawn];
      }
      queue_.id[i] = queue_.id[i + drawn];
    }
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
      key[k] = hn::Load(df, queue_.key[k]);
    }
    b.x0 = b.cx[0];
    b.y0 = b.cy[0];
    b.not_id = hn::Not(hn::Load(du, queue_.id));
    for (int k = 0; k < 3; ++k) {
      const int n = k == 2 ? 0 : k + 1;
      b.dx[k] = hn::Sub(b.cx[n], b.cx[k]);
      b.dy[k] = hn::Sub(b.cy[n], b.cy[k]);
      // Top-left edges include their own points: bias 0, the others -1.
      const MI up = hn::Lt(b.dy[k], hn::Zero(d));
      const MI level_right = hn::And(hn::Eq(b.dy[k], hn::Zero(d)), hn::Gt(b.dx[k], hn::Zero(d)));
      b.bias[k] = hn::IfThenZeroElse(hn::Or(up, level_right), hn::Set(d, -1));
    }
    SetUpPlane(b, key);
    SetUpRect(b, used);
    return b;
  }

  HWY_INLINE void SetUpPlane(Batch& b, const VF key[3]) const {
    const DF df;
    const VI x1 = b.dx[0], y1 = b.dy[0];
    const VI x2 = hn::Sub(b.cx[2], b.x0), y2 = hn::Sub(b.cy[2], b.y0);
    const VI area = hn::Sub(hn::Mul(x1, y2), hn::Mul(x2, y1));
    const VF k1 = hn::Sub(key[1], key[0]), k2 = hn::Sub(key[2], key[0]);
    const VF fx1 = hn::ConvertTo(df, x1), fy1 = hn::ConvertTo(df, y1);
    const VF fx2 = hn::ConvertTo(df, x2), fy2 = hn::ConvertTo(df, y2);
    const VF fa = hn::ConvertTo(df, area);
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
    b.px = FirstPixel(x_min, high_.x);
    b.py = FirstPixel(y_min, high_.y);
    const VI one = hn::Set(d, 1);
    const MI live = hn::Lt(hn::Iota(d, 0), hn::Set(d, std::int32_t(used)));
    b.width = hn::IfThenElseZero(live, hn::Add(hn::Sub(LastPixel(x_max, low_.x, job_.width), b.px), one));
    b.height = hn::IfThenElseZero(live, hn::Add(hn::Sub(LastPixel(y_max, low_.y, job_.height), b.py), one));
  }

  /// Walks the rectangles of all triangles of a batch at once, one pixel position a step, and notes the covered
  /// (pixel, triangle) pairs as word offset << 12 | y << 8 | x << 4 | lane. \returns how many.
  HWY_INLINE std::size_t Walk(const Batch& b, VI width, int most_x, int most_y, std::size_t sample) {
    const DI d;
    const DU du;
    const glm::ivec2 offset = frame_.samples[sample];
    const VI sx = hn::Add(hn::ShiftLeft<8>(b.px), hn::Set(d, offset.x));
    const VI sy = hn::Add(hn::ShiftLeft<8>(b.py), hn::Set(d, offset.y));
    VI row[3], step[3];
    for (int k = 0; k < 3; ++k) {
      const VI e = hn::Sub(hn::Mul(b.dx[k], hn::Sub(sy, b.cy[k])), hn::Mul(b.dy[k], hn::Sub(sx, b.cx[k])));
      row[k] = hn::ShiftRight<8>(hn::Add(e, b.bias[k]));
      step[k] = hn::Neg(b.dy[k]);
    }
    const VI first = hn::Add(hn::Mul(b.py, hn::Set(d, kTileStride)), b.px);
    const VI base = hn::Or(hn::ShiftLeft<12>(first), hn::Iota(d, 0));
    std::uint32_t* out = scratch_.references.data();
    for (int y = 0; y < most_y; ++y) {
      const VI row_width = hn::IfThenElseZero(hn::Gt(b.height, hn::Set(d, y)), width);
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
    return std::size_t(out - scratch_.references.data());
  }

  /// Finds the keys of the covered pairs, as many at a time as the vector holds, and keeps the greater words.
  HWY_INLINE void Merge(const Batch& b, std::size_t count, std::size_t sample) {
    const DI d;
    const DU du;
    const DF df;
    const glm::ivec2 offset = frame_.samples[sample];
    const VI from_x = hn::Sub(hn::Add(hn::ShiftLeft<8>(b.px), hn::Set(d, offset.x)), b.x0);
    const VI from_y = hn::Sub(hn::Add(hn::ShiftLeft<8>(b.py), hn::Set(d, offset.y)), b.y0);
    std::uint64_t* words = words_ + sample * kTileWords;
    HWY_ALIGN_MAX std::uint32_t key_bits[kMaxLanes], not_ids[kMaxLanes];
    const std::uint32_t* references = scratch_.references.data();
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      const VI reference = hn::BitCast(d, hn::LoadU(du, references + i));
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
      hn::Store(hn::BitCast(du, key), du, key_bits);
      hn::Store(hn::TableLookupLanes(b.not_id, lane_u), du, not_ids);
      const std::size_t live = HWY_MIN(count - i, hn::Lanes(d));
      for (std::size_t k = 0; k < live; ++k) {
        const std::uint64_t word = std::uint64_t(key_bits[k]) << 32 | not_ids[k];
        std::uint64_t& kept = words[references[i + k] >> 12];
        if (word > kept) kept = word;
      }
    }
  }

  // -- large triangles, one at a time -------------------------------------------------------------------------------

  void DrawRecord(TriangleRecord record) {
    for (int k = 0; k < 3; ++k) {
      record.x[k] -= job_.x * kSubPixels;
      record.y[k] -= job_.y * kSubPixels;
    }
    DrawLarge(record);
  }

  /// Precondition: oriented; corners relative to the tile.
  void DrawLarge(const TriangleRecord& r) {
    Large t;
    t.rect = pixel_rect(r, job_.width, job_.height);
    if (t.rect.x1 < t.rect.x0 || t.rect.y1 < t.rect.y0) return;
    t.not_id = ~r.id;
    t.x0 = r.x[0];
    t.y0 = r.y[0];
    t.k0 = r.key[0];
    const std::int32_t x1 = r.x[1] - r.x[0], y1 = r.y[1] - r.y[0], x2 = r.x[2] - r.x[0], y2 = r.y[2] - r.y[0];
    const float area = float(doubled_area(r));
    const float k1 = r.key[1] - r.key[0], k2 = r.key[2] - r.key[0];
    t.gx = (k1 * float(y2) - k2 * float(y1)) / area;
    t.gy = (float(x1) * k2 - float(x2) * k1) / area;
    t.k_min = HWY_MIN(r.key[0], HWY_MIN(r.key[1], r.key[2]));
    t.k_max = HWY_MAX(r.key[0], HWY_MAX(r.key[1], r.key[2]));

    const std::uint64_t hidden = HiddenBlocks(t);
    for (std::size_t s = 0; s < frame_.samples.size(); ++s) DrawLargeSample(r, t, s, hidden);
  }

  [[nodiscard]] HWY_INLINE float KeyAt(const Large& t, std::int32_t x, std::int32_t y) const {
    const float key = (t.k0 + float(x - t.x0) * t.gx) + float(y - t.y0) * t.gy;
    return HWY_MIN(HWY_MAX(key, t.k_min), t.k_max);
  }

  /// The blocks of the rectangle in which every sample is nearer than the triangle can be.
  [[nodiscard]] std::uint64_t HiddenBlocks(const Large& t) {
    std::uint64_t hidden = 0;
    for (int by = t.rect.y0 / kBlockSize; by <= t.rect.y1 / kBlockSize; ++by)
      for (int bx = t.rect.x0 / kBlockSize; bx <= t.rect.x1 / kBlockSize; ++bx) {
        const int left = bx * kBlockSize * kSubPixels + low_.x, top = by * kBlockSize * kSubPixels + low_.y;
        const int right = (bx * kBlockSize + kBlockSize - 1) * kSubPixels + high_.x;
        const int bottom = (by * kBlockSize + kBlockSize - 1) * kSubPixels + high_.y;
        const float nearest = KeyAt(t, t.gx > 0 ? right : left, t.gy > 0 ? bottom : top);
        if (BlockHides(bx, by, nearest)) hidden |= BlockBit(bx, by);
      }
    return hidden;
  }

  void DrawLargeSample(const TriangleRecord& r, Large& t, std::size_t sample, std::uint64_t hidden) {
    const glm::ivec2 offset = frame_.samples[sample];
    std::int32_t edge[3];
    for (int k = 0; k < 3; ++k) {
      const int n = k == 2 ? 0 : k + 1;
      const std::int32_t dx = r.x[n] - r.x[k], dy = r.y[n] - r.y[k];
      const std::int64_t e =
          std::int64_t(dx) * (offset.y - r.y[k]) - std::int64_t(dy) * (offset.x - r.x[k]) - (IsTopLeft(dx, dy) ? 0 : 1);
      edge[k] = std::int32_t(HWY_MAX(HWY_MIN(e >> 8, kEdgeLimit), -kEdgeLimit));
      t.step_x[k] = -dy;
      t.step_y[k] = dx;
    }
    for (int by = t.rect.y0 / kBlockSize; by <= t.rect.y1 / kBlockSize; ++by)
      for (int bx = t.rect.x0 / kBlockSize; bx <= t.rect.x1 / kBlockSize; ++bx)
        if (!(hidden & BlockBit(bx, by))) DrawBlock(t, edge, bx, by, sample);
  }

  void DrawBlock(const Large& t, const std::int32_t edge[3], int bx, int by, std::size_t sample) {
    constexpr std::int32_t kSpan = kBlockSize - 1;
    std::int32_t at[3];
    bool full = true;
    for (int k = 0; k < 3; ++k) {
      at[k] = edge[k] + bx * kBlockSize * t.step_x[k] + by * kBlockSize * t.step_y[k];
      const std::int32_t right = kSpan * t.step_x[k], down = kSpan * t.step_y[k];
      if (at[k] + HWY_MAX(right, 0) + HWY_MAX(down, 0) < 0) return;
      full = full && at[k] + HWY_MIN(right, 0) + HWY_MIN(down, 0) >= 0;
    }
    scratch_.dirty |= BlockBit(bx, by);
    const int y0 = HWY_MAX(t.rect.y0, by * kBlockSize), y1 = HWY_MIN(t.rect.y1, by * kBlockSize + kSpan);
    for (int y = y0; y <= y1; ++y) {
      std::int32_t e[3];
      for (int k = 0; k < 3; ++k) e[k] = at[k] + (y - by * kBlockSize) * t.step_y[k];
      DrawBlockRow(t, e, full, bx * kBlockSize, y, sample);
    }
  }

  HWY_INLINE void DrawBlockRow(const Large& t, const std::int32_t e[3], bool full, int x, int y, std::size_t sample) {
    const DW d;
    const DWI dwi;
    const DHU du;
    const DHI di;
    const DHF df;
    const glm::ivec2 offset = frame_.samples[sample];
    std::uint64_t* row = Row(sample, y) + x;
    const auto down = hn::Set(df, float(y * kSubPixels + offset.y - t.y0) * t.gy);
    const std::int32_t from_x = x * kSubPixels + offset.x - t.x0;
    for (int i = 0; i < kBlockSize; i += int(hn::Lanes(d))) {
      const auto column = hn::Iota(di, i);
      auto all = hn::Zero(di);
      if (!full)
        for (int k = 0; k < 3; ++k)
          all = hn::Or(all, hn::Add(hn::Set(di, e[k]), hn::Mul(column, hn::Set(di, t.step_x[k]))));
      const auto covered = hn::RebindMask(du, hn::Gt(all, hn::Set(di, -1)));
      const auto dx = hn::ConvertTo(df, hn::Add(hn::ShiftLeft<8>(column), hn::Set(di, from_x)));
      auto key = hn::Add(hn::Add(hn::Set(df, t.k0), hn::Mul(dx, hn::Set(df, t.gx))), down);
      key = hn::Min(hn::Max(key, hn::Set(df, t.k_min)), hn::Set(df, t.k_max));
      const auto bits = hn::PromoteTo(d, hn::IfThenElseZero(covered, hn::BitCast(du, key)));
      const auto ids = hn::PromoteTo(d, hn::IfThenElseZero(covered, hn::Set(du, t.not_id)));
      const auto word = hn::BitCast(dwi, hn::Or(hn::ShiftLeft<32>(bits), ids));
      const auto kept = hn::Load(dwi, reinterpret_cast<const std::int64_t*>(row + i));
      hn::Store(hn::Max(word, kept), dwi, reinterpret_cast<std::int64_t*>(row + i));
    }
  }

  const FrameInput& frame_;
  const TileJob& job_;
  TileScratch& scratch_;
  std::uint64_t* words_;
  glm::ivec2 low_, high_;  // of the sample offsets
  TriangleQueue queue_;
  ScreenCluster vertices_;
};

template <class D>
HWY_INLINE void FillRow(D d, hn::TFromD<D> value, hn::TFromD<D>* row, std::size_t width, bool streams) {
  const auto vector = hn::Set(d, value);
  std::size_t x = 0;
  if (streams && reinterpret_cast<std::uintptr_t>(row) % 64 == 0)
    for (; x + hn::Lanes(d) <= width; x += hn::Lanes(d)) hn::Stream(vector, d, row + x);
  for (; x < width; ++x) row[x] = value;
}

/// A tile in which nothing can be seen.
void FillTile(const FrameInput& frame, const TileJob& job) {
  for (std::size_t s = 0; s < frame.samples.size(); ++s)
    for (int y = 0; y < job.height; ++y) {
      const std::size_t at =
          (s * std::size_t(frame.view.height) + std::size_t(job.y + y)) * std::size_t(frame.view.width) +
          std::size_t(job.x);
      FillRow(DU(), no_primitive, frame.primitives + at, std::size_t(job.width), frame.streams);
      FillRow(DF(), 0.0f, frame.keys + at, std::size_t(job.width), frame.streams);
    }
}

void DrawTile(const FrameInput& frame, const TileJob& job, TileScratch& scratch) {
  if (job.records.empty() && job.clusters.empty()) {
    FillTile(frame, job);
  } else {
    TilePainter painter(frame, job, scratch);
    painter.Draw();
    painter.WriteOut();
  }
  // Streamed stores are weakly ordered: another thread may read the planes next.
  hwy::FlushStream();
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::zbuffer_detail {

HWY_EXPORT(DrawTile);

TileScratch::TileScratch(std::size_t sample_count)
    : words(sample_count * kTileWords),
      farthest(std::size_t(kTileSize / kBlockSize) * (kTileSize / kBlockSize)),
      // Every pixel of the largest walk for every lane, and a vector of slack for whole stores.
      references(std::size_t(16 * 16 * 16) + 64) {}

void draw_tile(const FrameInput& frame, const TileJob& job, TileScratch& scratch, Isa isa) {
  kernel_for(HWY_DISPATCH_TABLE(DrawTile), isa)(frame, job, scratch);
}

}  // namespace frontmost::zbuffer_detail
#endif  // HWY_ONCE
