// SPDX-License-Identifier: Apache-2.0
// Draws triangles into a depth buffer, with the depth tests of all fragments in the order of submission.
//
//    walk      lane 0: mask of 8 x 8 pixels     lane 1: mask     ...        all triangles of a packet in step
//    draw      fragments of triangle 0, then those of triangle 1, ...       in the order of submission
//    rows      larger triangles, one at a time, row by row
//
// Coverage does not depend on the order of triangles, so it is found for a whole packet at once. The packet's fragments
// are then listed in the order of submission. Depths are computed in double for a vector of fragments, and rounded
// once, so that every instruction set stores the same bits. Depth tests are made one after the other. Coverage and keys
// follow tile_kernel.cpp.

#include <optional>

#include "zbuffer/depth/depth_call.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/depth/depth_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/wasm_lanes-inl.h"
#include "view/steep_keys-inl.h"
#include "zbuffer/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DD = hn::ScalableTag<double>;
using DDU = hn::RebindToUnsigned<DD>;
using HalfU = hn::Rebind<std::uint32_t, DD>;
using HalfI = hn::RebindToSigned<HalfU>;
using HalfF = hn::RebindToFloat<HalfU>;

constexpr std::size_t kHalfLanes = hn::MaxLanes(DD());

/// Adding this to 0 <= x < 2^32 leaves x, rounded to an integer with ties to even, in the low bits of the sum.
constexpr double kRounder = 6755399441055744.0;  // 1.5 * 2^52

/// Converts keys to stored depths, and tests which pass.
template <bool is_float>
class DepthTest {
 public:
  explicit DepthTest(const DepthRules& rules)
      : rules_(rules),
        steps_(is_float ? 1.0 : double((std::uint32_t(1) << integer_bits(rules.format)) - 1)),
        passing_((rules.passes_less ? kLess : 0) | (rules.passes_equal ? kEqual : 0) |
                 (rules.passes_greater ? kGreater : 0)) {}

  [[nodiscard]] HWY_INLINE hn::Vec<HalfU> Stored(hn::Vec<HalfF> key, hn::Vec<DD> offset) const {
    const DD d;
    const DepthMap& map = rules_.map;
    auto depth = hn::Add(hn::Set(d, map.at_zero), hn::Mul(hn::Set(d, map.slope), hn::PromoteTo(d, key)));
    depth = hn::Min(hn::Max(depth, hn::Set(d, map.low)), hn::Set(d, map.high));
    depth = hn::Add(depth, offset);
    depth = hn::Min(hn::Max(depth, hn::Zero(d)), hn::Set(d, 1.0));
    if constexpr (is_float) {
      return hn::BitCast(HalfU(), hn::DemoteTo(HalfF(), depth));
    } else {
      const auto rounded = hn::Add(hn::Mul(depth, hn::Set(d, steps_)), hn::Set(d, kRounder));
      return hn::TruncateTo(HalfU(), hn::BitCast(DDU(), rounded));
    }
  }

  [[nodiscard]] HWY_INLINE hn::Mask<HalfU> Passes(hn::Vec<HalfU> stored, hn::Vec<HalfU> kept) const {
    const HalfU du;
    hn::Mask<HalfU> less, equal;
    if constexpr (is_float) {
      // The clear value may be negative, and the bits of negative floats have the opposite order.
      const auto a = hn::BitCast(HalfF(), stored), b = hn::BitCast(HalfF(), kept);
      less = hn::RebindMask(du, hn::Lt(a, b));
      equal = hn::RebindMask(du, hn::Eq(a, b));
    } else {
      less = hn::RebindMask(du, hn::Lt(hn::BitCast(HalfI(), stored), hn::BitCast(HalfI(), kept)));
      equal = hn::Eq(stored, kept);
    }
    const auto greater = hn::Not(hn::Or(less, equal));
    auto pass = hn::RebindMask(du, hn::Lt(hn::Zero(HalfI()), hn::Zero(HalfI())));  // none
    if (rules_.passes_less) pass = less;
    if (rules_.passes_equal) pass = hn::Or(pass, equal);
    if (rules_.passes_greater) pass = hn::Or(pass, greater);
    return pass;
  }

  [[nodiscard]] HWY_INLINE bool Passes(std::uint32_t stored, std::uint32_t kept) const {
    bool less, equal;
    if constexpr (is_float) {
      const auto a = bits_as<float>(stored), b = bits_as<float>(kept);
      less = a < b, equal = a == b;
    } else {
      less = stored < kept, equal = stored == kept;
    }
    return (passing_ & (less ? kLess : equal ? kEqual : kGreater)) != 0;
  }

  [[nodiscard]] const DepthRules& rules() const { return rules_; }

 private:
  static constexpr int kLess = 1, kEqual = 2, kGreater = 4;
  const DepthRules& rules_;
  double steps_;
  int passing_;
};

/// The planes' entries for a vector of samples, and the screen position of the first, in 1/256 pixel.
struct Cell {
  std::uint32_t* stored;
  PrimitiveId* primitives;
  float* keys;
  glm::ivec2 place;
};

template <bool is_float>
class DepthRows {
 public:
  DepthRows(const DepthCall& call, const Tile& tile, const DepthTest<is_float>& test)
      : call_(call), tile_(tile), test_(test) {}

  /// Draws one triangle at one of a pixel's samples. Vertices are relative to the tile.
  void Draw(const TriangleRecord& r, double offset, std::size_t sample) {
    const glm::ivec2 at = call_.planes.samples[sample];
    const PixelRect rect = sampled_rect(r, at, at, tile_.width, tile_.height);
    if (rect.is_empty()) return;
    const KeyPlane plane(r);
    const TriangleEdges edges(r, at);
    const PrimitiveId own_id = r.id - call_.id_offset;
    std::optional<ScreenCutout> cutout;
    if (call_.cutouts && call_.cutouts->has(own_id)) cutout.emplace((*call_.cutouts)[own_id], call_.rays);
    const SteepKeys steep = plane.is_steep ? SteepKeys(r) : SteepKeys();
    const Paint paint{plane, hn::Set(DD(), offset), r.id, sample, cutout ? &*cutout : nullptr};
    const HalfI d;
    const int lanes = int(hn::Lanes(d)), first = rect.x0 / lanes * lanes;
    hn::Vec<HalfI> row[3], step[3];
    for (int k = 0; k < 3; ++k) {
      const std::int32_t start = edges.first[k] + first * edges.step_x[k] + rect.y0 * edges.step_y[k];
      row[k] = hn::Add(hn::Set(d, start), hn::Mul(hn::Iota(d, 0), hn::Set(d, edges.step_x[k])));
      step[k] = hn::Set(d, lanes * edges.step_x[k]);
    }
    for (int y = rect.y0; y <= rect.y1; ++y) {
      // These operations and their order are the same as for packets, so that both give the same bits.
      const float dy_gy = float(y * kSubPixels + at.y - plane.y0) * plane.gy;
      auto e0 = row[0], e1 = row[1], e2 = row[2];
      for (int x = first; x <= rect.x1; x += lanes) {
        const auto covered = hn::RebindMask(HalfU(), hn::Gt(hn::Or(hn::Or(e0, e1), e2), hn::Set(d, -1)));
        if (!hn::AllFalse(HalfU(), covered)) {
          const glm::ivec2 from = glm::ivec2(x, y) * kSubPixels + at;
          Put(paint, x, y, covered, plane.is_steep ? KeyOf(steep, from) : Key(plane, from.x - plane.x0, dy_gy));
        }
        e0 = hn::Add(e0, step[0]);
        e1 = hn::Add(e1, step[1]);
        e2 = hn::Add(e2, step[2]);
      }
      for (int k = 0; k < 3; ++k) row[k] = hn::Add(row[k], hn::Set(d, edges.step_y[k]));
    }
  }

 private:
  /// The values that all samples of a triangle share.
  struct Paint {
    const KeyPlane& plane;
    hn::Vec<DD> offset;
    PrimitiveId id;
    std::size_t sample;
    const ScreenCutout* cutout;  ///< null if the triangle has no holes
  };

  /// Returns the samples of `seen` that do not look into a hole. The first lane's sample is at `place`.
  [[nodiscard]] static HWY_NOINLINE hn::Mask<HalfU> Solid(const ScreenCutout& cutout, const glm::ivec2& place,
                                                          hn::Mask<HalfU> seen) {
    const HalfU d;
    HWY_ALIGN_MAX std::uint32_t lanes[kHalfLanes];
    hn::Store(hn::VecFromMask(d, seen), d, lanes);
    for (std::size_t i = 0; i < hn::Lanes(d); ++i)
      if (lanes[i] != 0 && cutout.is_hole(place.x + int(i) * kSubPixels, place.y)) lanes[i] = 0;
    return hn::MaskFromVec(hn::Load(d, lanes));
  }

  [[nodiscard]] static HWY_INLINE hn::Vec<HalfF> Key(const KeyPlane& plane, std::int32_t from_x, float dy_gy) {
    const HalfI di;
    const HalfF d;
    const auto dx = hn::ConvertTo(d, hn::Add(hn::ShiftLeft<8>(hn::Iota(di, 0)), hn::Set(di, from_x)));
    const auto key = hn::Add(hn::Add(hn::Set(d, plane.k0), hn::Mul(dx, hn::Set(d, plane.gx))), hn::Set(d, dy_gy));
    return hn::Min(hn::Max(key, hn::Set(d, plane.k_min)), hn::Set(d, plane.k_max));
  }

  /// Returns the keys of neighbouring samples of a row, of which `first` is the first.
  [[nodiscard]] static HWY_INLINE hn::Vec<HalfF> KeyOf(const SteepKeys& steep, const glm::ivec2& first) {
    const HalfI d;
    view_detail::HWY_NAMESPACE::SteepColumn column;
    column.Set(steep, hn::PromoteTo(DD(), hn::Add(hn::ShiftLeft<8>(hn::Iota(d, 0)), hn::Set(d, first.x))));
    return column.At(steep, first.y);
  }

  HWY_INLINE void Put(const Paint& paint, int x, int y, hn::Mask<HalfU> covered, hn::Vec<HalfF> key) const {
    const DepthPlanes& p = call_.planes;
    const std::size_t i = (paint.sample * std::size_t(p.height) + std::size_t(tile_.y + y)) * std::size_t(p.width) +
                          std::size_t(tile_.x + x);
    const glm::ivec2 place = glm::ivec2(tile_.x + x, tile_.y + y) * kSubPixels + p.samples[paint.sample];
    const Cell cell{p.stored + i, p.primitives + i, p.keys + i, place};
    const int count = HWY_MIN(int(kHalfLanes), tile_.width - x);
    if (count == int(hn::Lanes(DD()))) {
      PutWhole(paint, cell, covered, key);
      return;
    }
    // A copy is drawn to, because memory of the other lanes belongs to another tile, or lies outside the planes.
    HWY_ALIGN_MAX std::uint32_t stored[kHalfLanes] = {}, primitives[kHalfLanes] = {};
    HWY_ALIGN_MAX float keys[kHalfLanes] = {};
    const Cell copy{stored, primitives, keys, place};
    Copy(cell, copy, count);
    PutWhole(paint, copy, covered, key);
    Copy(copy, cell, count);
  }

  static HWY_INLINE void Copy(const Cell& from, const Cell& to, int count) {
    for (int i = 0; i < count; ++i) {
      to.stored[i] = from.stored[i];
      to.primitives[i] = from.primitives[i];
      to.keys[i] = from.keys[i];
    }
  }

  HWY_INLINE void PutWhole(const Paint& paint, const Cell& cell, hn::Mask<HalfU> covered, hn::Vec<HalfF> key) const {
    const HalfU du;
    const HalfF df;
    const auto stored = test_.Stored(key, paint.offset), kept = hn::LoadU(du, cell.stored);
    auto pass = hn::And(covered, test_.Passes(stored, kept));
    // The hole test comes last: one look into a texture costs as much as many depth tests.
    if (paint.cutout != nullptr) pass = Solid(*paint.cutout, cell.place, pass);
    if (hn::AllFalse(du, pass)) return;
    if (test_.rules().mask) hn::StoreU(hn::IfThenElse(pass, stored, kept), du, cell.stored);
    const auto id = hn::IfThenElse(pass, hn::Set(du, paint.id), hn::LoadU(du, cell.primitives));
    hn::StoreU(id, du, cell.primitives);
    hn::StoreU(hn::IfThenElse(hn::RebindMask(df, pass), key, hn::LoadU(df, cell.keys)), df, cell.keys);
  }

  const DepthCall& call_;
  const Tile& tile_;
  const DepthTest<is_float>& test_;
};

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

  /// Returns the lanes of triangles with holes. These are drawn by rows, because only rows test for holes.
  [[nodiscard]] HWY_NOINLINE MI HaveHoles() const {
    HWY_ALIGN_MAX std::uint32_t id[kMaxLanes];
    HWY_ALIGN_MAX std::int32_t lanes[kMaxLanes] = {};
    hn::Store(id_, DU(), id);
    for (std::size_t k = 0; k < count_; ++k) lanes[k] = call_.cutouts->has(id[k] - call_.id_offset) ? -1 : 0;
    return hn::MaskFromVec(hn::Load(DI(), lanes));
  }

  /// Finds the pixels in which each triangle covers this sample: masks of eight by eight pixels, from the triangle's
  /// first pixel on. Triangles that masks cannot hold are drawn by rows.
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
    VI mask[2] = {hn::Zero(d), hn::Zero(d)};  // four rows in each mask
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
  MI walkable_;  // lanes of triangles that may be drawn many at once
  std::size_t count_ = 0;
  double offset_[kMaxLanes] = {};
  // State of the packet at one sample.
  std::uint64_t by_row_ = 0, drawn_ = 0;         // lanes drawn by rows; all lanes that are drawn
  VI from_x_, from_y_;                           // from the key plane's origin to the sample of the first pixel
  HWY_ALIGN_MAX std::int32_t first_[kMaxLanes];  // index of each triangle's first pixel, counted from the tile's first
  HWY_ALIGN_MAX std::uint32_t mask_[2][kMaxLanes];
  std::uint32_t references_[kMaxLanes * kWalkLimit * kWalkLimit + kMaxLanes];
};

void DrawDepths(const DepthCall& call, const Tile& tile, const OrderedBatch& batch) {
  if (call.rules.format == DepthFormat::f32)
    DepthPackets<true>(call, tile).Draw(batch);
  else
    DepthPackets<false>(call, tile).Draw(batch);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::zbuffer_detail {

FRONTMOST_KERNELS(DrawDepths);

void draw_depths(const DepthCall& call, const Tile& tile, const OrderedBatch& batch, Isa isa) {
  kernel_for(DrawDepthsKernels, isa)(call, tile, batch);
}

}  // namespace frontmost::zbuffer_detail
#endif  // HWY_ONCE
