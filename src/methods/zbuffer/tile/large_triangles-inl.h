// SPDX-License-Identifier: Apache-2.0
// Triangles of more than a few pixels, one at a time. All blocks of the tile are classified at once; the open blocks
// are then filled in whole rows.
//
//    +--+--+--+--+      One bit for each of the 64 blocks of a tile tells whether the triangle touches it (t),
//    |  |tt|tt|  |      whether it lies inside of all three edges (f), and whether it is hidden. Hidden blocks are left
//    |tt|ff|ff|tt|      out, full blocks need no edges, and open blocks are filled a row of samples at a time. A block
//    |tt|tt|tt|  |      that the triangle covers wholly also bounds the depth of visible triangles behind it.
//    +--+--+--+--+

// Included once for every target.
#if defined(FRONTMOST_ZBUFFER_LARGE_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ZBUFFER_LARGE_TRIANGLES_INL_H_
#undef FRONTMOST_ZBUFFER_LARGE_TRIANGLES_INL_H_
#else
#define FRONTMOST_ZBUFFER_LARGE_TRIANGLES_INL_H_
#endif

#include <cstring>

#include "view/steep_keys-inl.h"
#include "zbuffer/tile/tile_buffer-inl.h"
#include "zbuffer/triangle_records.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::int32_t kBlockUnits = kBlockSize * kSubPixels;

class LargeTriangles {
 public:
  LargeTriangles(const Picture& picture, const Tile& tile, TileBuffer& buffer)
      : picture_(picture), tile_(tile), buffer_(buffer) {
    low_ = high_ = picture.samples[0];
    for (const glm::ivec2& s : picture.samples) low_ = glm::min(low_, s), high_ = glm::max(high_, s);
  }

  /// Draws the records whose indices are `numbers`, nearest first. Their vertices are relative to the image's top left.
  void DrawAll(std::span<const TriangleRecord> records, std::span<const std::uint32_t> numbers) {
    for (const std::uint32_t i : numbers) {
      TriangleRecord record = records[i];
      // Later records are farther, so blocks that all hide this record hide the others, too.
      if (buffer_.KnownToHide(record.nearest()) == ~std::uint64_t(0)) return;
      for (int k = 0; k < 3; ++k) {
        record.x[k] -= tile_.x * kSubPixels;
        record.y[k] -= tile_.y * kSubPixels;
      }
      Draw(record);
    }
  }

  /// Draws a record unless its vertices equal those of the record before and its id is higher: at equal keys the lower
  /// id is seen. Copies follow each other in clusters, so a million copies are drawn once. Records with holes are
  /// always drawn, as the holes may differ. Precondition as for Draw().
  HWY_NOINLINE void DrawOnce(const TriangleRecord& r) {
    if (!buffer_.minds_holes() && last_.id < r.id && std::memcmp(last_.x, r.x, sizeof r.x) == 0 &&
        std::memcmp(last_.y, r.y, sizeof r.y) == 0 && std::memcmp(last_.key, r.key, sizeof r.key) == 0)
      return;
    last_ = r;
    Draw(r);
  }

  /// Precondition: the record is oriented, with vertices relative to the tile.
  void Draw(const TriangleRecord& r) {
    const PixelRect rect = pixel_rect(r, tile_.width, tile_.height);
    if (rect.is_empty()) return;
    const std::uint64_t touched = TileBuffer::BlocksOf(rect);
    if (buffer_.AllHide(touched, r.nearest())) return;
    const Plane plane(r);
    if (plane.is_steep)
      DrawWith<SteepRows>(r, plane, rect, touched);
    else
      DrawWith<GentleRows>(r, plane, rect, touched);
  }

 private:
  struct Plane : KeyPlane {
    explicit Plane(const TriangleRecord& r) : KeyPlane(r), not_id(~r.id) {
      if (!is_steep) return;
      steep = SteepKeys(r);
      // The keys of blocks are bounded by the same plane, evaluated at the tile's corner with a float's precision.
      x0 = y0 = 0;
      k0 = float(steep.exactly_at(0, 0));
      gx = float(steep.gx());
      gy = float(steep.gy());
    }
    std::uint32_t not_id;
    SteepKeys steep;
  };

  /// Keys of a block's pixels at one sample, a vector of a row at a time, for planes that are not steep.
  class GentleRows {
   public:
    /// `first` is the sample of the block's first pixel, in 1/256 pixel of the tile.
    GentleRows(const Plane& plane, const glm::ivec2& first) : plane_(plane), first_(first) {
      const DI d;
      const DF df;
      for (int y = 0; y < kBlockSize; y += int(kMaxLanes)) {
        const VI dy = hn::Add(hn::ShiftLeft<8>(hn::Iota(d, y)), hn::Set(d, first.y - plane.y0));
        hn::Store(hn::Mul(hn::ConvertTo(df, dy), hn::Set(df, plane.gy)), df, down_ + y);
      }
    }
    HWY_INLINE void SetColumns(VI column) {
      const DF df;
      const VI dx = hn::Add(hn::ShiftLeft<8>(column), hn::Set(DI(), first_.x - plane_.x0));
      base_ = hn::Add(hn::Set(df, plane_.k0), hn::Mul(hn::ConvertTo(df, dx), hn::Set(df, plane_.gx)));
    }
    [[nodiscard]] HWY_INLINE VF At(int y) const { return Clamp(plane_, hn::Add(base_, hn::Set(DF(), down_[y]))); }

   private:
    const Plane& plane_;
    glm::ivec2 first_;
    VF base_;
    HWY_ALIGN_MAX float down_[kBlockSize];
  };

  /// Keys of a block's pixels at one sample, a vector of a row at a time, for steep planes.
  class SteepRows {
   public:
    SteepRows(const Plane& plane, const glm::ivec2& first) : keys_(plane.steep), first_(first) {}
    HWY_INLINE void SetColumns(VI column) {
      columns_.Set(keys_, hn::Add(hn::ShiftLeft<8>(column), hn::Set(DI(), first_.x)));
    }
    [[nodiscard]] HWY_INLINE VF At(int y) const { return columns_.At(keys_, y * kSubPixels + first_.y); }

   private:
    const SteepKeys& keys_;
    view_detail::HWY_NAMESPACE::SteepColumns columns_;
    glm::ivec2 first_;
  };

  /// Key bounds of one triangle, by block: the nearest key, the keys at the four outermost samples, and `slack`. The
  /// slack bounds the rounding errors of such a key and of any sample's key together.
  struct Reach {
    HWY_ALIGN_MAX float nearest[BlockBounds::count], corner[4][BlockBounds::count], slack[BlockBounds::count];
  };

  /// Blocks that are known to have no pixel, or to have every pixel, covered at one sample.
  struct Cover {
    std::uint64_t none = 0, all = 0;
  };

  /// Selects the samples of a block that are kept: all nearer ones, nearer and covered ones, or nearer, covered and
  /// solid ones.
  enum class Filling { whole, covered, solid };

  template <class Rows>
  void DrawWith(const TriangleRecord& r, const Plane& plane, const PixelRect& rect, std::uint64_t touched) {
    Reach reach;
    std::uint64_t open = touched & ~KnownHidden(plane, rect, reach);
    std::uint64_t whole = open;
    for (std::size_t s = 0; s < picture_.samples.size() && open != 0; ++s)
      whole &= DrawSample<Rows>(r, plane, rect, s, open, reach);
    if (buffer_.minds_holes()) return;  // what lies behind a triangle with holes may be seen
    for (whole &= open; whole != 0; whole &= whole - 1)
      KeepPlane(int(hwy::Num0BitsBelowLS1Bit_Nonzero64(whole)), plane, reach);
  }

  /// Calls visit(first, column, row) for vectors of blocks, among them all that touch `rect`: the number of the
  /// vector's first block, and the block's column and row in each lane.
  template <class Visit>
  static HWY_INLINE void ForBlocks(const PixelRect& rect, const Visit& visit) {
    const DI d;
    constexpr int kLanes = int(kMaxLanes);
    const int begin = rect.y0 / kBlockSize * 8 / kLanes * kLanes, end = (rect.y1 / kBlockSize + 1) * 8;
    for (int first = begin; first < end; first += kLanes) {
      const VI block = hn::Iota(d, first);
      visit(first, hn::And(block, hn::Set(d, 7)), hn::ShiftRight<3>(block));
    }
  }

  /// The blocks known to hide the triangle: by their farthest key, or by a triangle that covers them and has a nearer
  /// plane at all four corners. Planes are affine, so a plane that is nearer at the corners is nearer between them.
  [[nodiscard]] HWY_INLINE std::uint64_t KnownHidden(const Plane& p, const PixelRect& rect, Reach& reach) const {
    const DI d;
    const DF df;
    const BlockBounds& bounds = buffer_.bounds();
    const VI unit = hn::Set(d, kBlockUnits);
    constexpr std::int32_t kSpan = (kBlockSize - 1) * kSubPixels;
    std::uint64_t hidden = 0;
    ForBlocks(rect, [&](int first, VI column, VI row) HWY_ATTR {
      const VI x = hn::Mul(column, unit), y = hn::Mul(row, unit);
      const VF left = Term(x, low_.x - p.x0, p.gx), right = Term(x, kSpan + high_.x - p.x0, p.gx);
      const VF top = Term(y, low_.y - p.y0, p.gy), bottom = Term(y, kSpan + high_.y - p.y0, p.gy);
      const VF k0 = hn::Set(df, p.k0);
      const VF key[4] = {hn::Add(hn::Add(k0, left), top), hn::Add(hn::Add(k0, right), top),
                         hn::Add(hn::Add(k0, left), bottom), hn::Add(hn::Add(k0, right), bottom)};
      // A key has three rounding errors, each of at most 2^-24 of this sum. The key at a corner and the key at a sample
      // together make 6 * 2^-24. Steep triangles have as many errors, because both their plane and their keys are
      // rounded. The factor 8 and the constant leave a margin, also for numbers so small that roundings are not
      // relative.
      const VF sum =
          hn::Add(hn::Abs(k0), hn::Add(hn::Max(hn::Abs(left), hn::Abs(right)), hn::Max(hn::Abs(top), hn::Abs(bottom))));
      const VF slack = hn::Add(hn::Mul(sum, hn::Set(df, 8.0f / 16777216.0f)), hn::Set(df, 1e-42f));
      const VF nearest = Clamp(p, hn::Add(hn::Max(hn::Max(key[0], key[1]), hn::Max(key[2], key[3])), slack));
      auto behind = hn::Lt(nearest, hn::Load(df, bounds.greatest + first));
      for (int c = 0; c < 4; ++c) {
        const VF at_most = hn::Max(hn::Add(key[c], slack), hn::Set(df, p.k_min));
        behind = hn::And(behind, hn::Lt(at_most, hn::Load(df, bounds.corner[c] + first)));
        hn::Store(key[c], df, reach.corner[c] + first);
      }
      hn::Store(slack, df, reach.slack + first);
      hn::Store(nearest, df, reach.nearest + first);
      behind = hn::Or(behind, hn::Lt(nearest, hn::Load(df, bounds.farthest + first)));
      hidden |= BitsOf(df, behind) << first;
    });
    return hidden;
  }

  [[nodiscard]] static HWY_INLINE VF Term(VI block, std::int32_t offset, float gradient) {
    const DF df;
    return hn::Mul(hn::ConvertTo(df, hn::Add(block, hn::Set(DI(), offset))), hn::Set(df, gradient));
  }

  /// Stores the plane of a triangle that covers all samples of the block, if the plane is nearer than the stored one.
  /// From then on everything behind the plane is hidden.
  HWY_INLINE void KeepPlane(int block, const Plane& p, const Reach& reach) const {
    BlockBounds& bounds = buffer_.bounds();
    float corner[4], gain = 0;
    for (int c = 0; c < 4; ++c) {
      corner[c] = reach.corner[c][block] - reach.slack[block];
      gain += corner[c] - bounds.corner[c][block];
    }
    // A block keeps the plane whose corner keys have the greater sum. Each of the two planes is a valid bound by
    // itself.
    if (bounds.greatest[block] > 0 && gain <= 0) return;
    for (int c = 0; c < 4; ++c) bounds.corner[c][block] = corner[c];
    bounds.greatest[block] = p.k_max;
  }

  [[nodiscard]] static HWY_INLINE VF Clamp(const Plane& p, VF key) {
    const DF df;
    return hn::Min(hn::Max(key, hn::Set(df, p.k_min)), hn::Set(df, p.k_max));
  }

  [[nodiscard]] HWY_INLINE Cover CoverOf(const TriangleEdges& edges, const PixelRect& rect) const {
    const DI d;
    constexpr std::int32_t kSpan = kBlockSize - 1;
    Cover cover;
    ForBlocks(rect, [&](int first, VI column, VI row) HWY_ATTR {
      VI outside = hn::Zero(d), not_inside = hn::Zero(d);
      for (int k = 0; k < 3; ++k) {
        const std::int32_t right = kSpan * edges.step_x[k], down = kSpan * edges.step_y[k];
        const VI e =
            hn::Add(hn::Add(hn::Set(d, edges.first[k]), hn::Mul(column, hn::Set(d, kBlockSize * edges.step_x[k]))),
                    hn::Mul(row, hn::Set(d, kBlockSize * edges.step_y[k])));
        // The block's corners give the greatest and the least value of the edge function. Signs are or-ed, which is
        // cheaper than comparing them.
        outside = hn::Or(outside, hn::Add(e, hn::Set(d, HWY_MAX(right, 0) + HWY_MAX(down, 0))));
        not_inside = hn::Or(not_inside, hn::Add(e, hn::Set(d, HWY_MIN(right, 0) + HWY_MIN(down, 0))));
      }
      cover.none |= BitsOf(d, hn::Lt(outside, hn::Zero(d))) << first;
      cover.all |= BitsOf(d, hn::Gt(not_inside, hn::Set(d, -1))) << first;
    });
    return cover;
  }

  /// Draws one sample of the open blocks. \returns the blocks whose every pixel is covered at this sample. At the first
  /// sample, also closes the blocks that were drawn to lately and turn out to hide the triangle.
  template <class Rows>
  [[nodiscard]] std::uint64_t DrawSample(const TriangleRecord& r, const Plane& plane, const PixelRect& rect,
                                         std::size_t sample, std::uint64_t& open, const Reach& reach) {
    const TriangleEdges edges(r, picture_.samples[sample]);
    const Cover cover = CoverOf(edges, rect);
    for (std::uint64_t left = open & ~cover.none; left != 0; left &= left - 1) {
      const int block = int(hwy::Num0BitsBelowLS1Bit_Nonzero64(left));
      // Only before the first sample: afterwards the triangle may be hidden by itself.
      if (sample == 0 && buffer_.Hides(block, reach.nearest[block])) {
        open &= ~(std::uint64_t(1) << block);
        continue;
      }
      if (buffer_.minds_holes())
        FillBlock<Filling::solid, Rows>(plane, edges, rect, block, sample);
      else if (cover.all >> block & 1)
        FillBlock<Filling::whole, Rows>(plane, edges, rect, block, sample);
      else
        FillBlock<Filling::covered, Rows>(plane, edges, rect, block, sample);
    }
    return cover.all;
  }

  template <Filling kFilling, class Rows>
  HWY_INLINE void FillBlock(const Plane& p, const TriangleEdges& edges, const PixelRect& rect, int block,
                            std::size_t sample) {
    const DI d;
    const DU du;
    constexpr bool kWhole = kFilling == Filling::whole;
    const int bx = block % 8, by = block / 8;
    const glm::ivec2 first_sample = picture_.samples[sample] + glm::ivec2(bx, by) * kBlockUnits;
    Rows keys(p, first_sample);
    const int top = by * kBlockSize;
    const int y0 = kWhole ? 0 : HWY_MAX(rect.y0 - top, 0),
              y1 = kWhole ? kBlockSize - 1 : HWY_MIN(rect.y1 - top, kBlockSize - 1);
    LeastKey least;
    for (int x = 0; x < kBlockSize; x += int(kMaxLanes)) {
      const VI column = hn::Add(hn::Load(d, kPixelOrder.column), hn::Set(d, x));
      keys.SetColumns(column);
      VI e[3];
      if (!kWhole)
        for (int k = 0; k < 3; ++k) {
          const std::int32_t first = edges.first[k] + bx * kBlockSize * edges.step_x[k] + (top + y0) * edges.step_y[k];
          e[k] = hn::Add(hn::Set(d, first), hn::Mul(column, hn::Set(d, edges.step_x[k])));
        }
      const VU not_id = hn::Set(du, p.not_id);
      std::uint64_t* row = buffer_.Row(sample, top + y0) + bx * kBlockSize + x;
      for (int y = y0; y <= y1; ++y, row += kTileStride) {
        const VU bits = hn::BitCast(du, keys.At(y));
        if (kWhole) {
          MergeRow(WordsOf(bits, not_id), row, least);
        } else {
          const auto covered = hn::RebindMask(du, hn::Gt(hn::Or(hn::Or(e[0], e[1]), e[2]), hn::Set(d, -1)));
          const Words words = WordsOf(hn::IfThenElseZero(covered, bits), hn::IfThenElseZero(covered, not_id));
          if (kFilling == Filling::solid)
            buffer_.KeepSolidRow(words, row, first_sample + glm::ivec2(x, y) * kSubPixels, least);
          else
            MergeRow(words, row, least);
          for (int k = 0; k < 3; ++k) e[k] = hn::Add(e[k], hn::Set(d, edges.step_y[k]));
        }
      }
    }
    if (y0 == 0 && y1 == kBlockSize - 1 && picture_.samples.size() == 1)
      buffer_.SetLeast(block, least);
    else
      buffer_.MarkDrawn(std::uint64_t(1) << block);
  }

  const Picture& picture_;
  const Tile& tile_;
  TileBuffer& buffer_;
  glm::ivec2 low_, high_;  // least and greatest sample offset
  TriangleRecord last_{{}, {}, {}, no_primitive};
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
