// SPDX-License-Identifier: Apache-2.0
// The private buffer of one tile: a 64-bit word for every sample, and the farthest key of each block.
//
// N. Greene, M. Kass, G. Miller. Hierarchical Z-Buffer Visibility. 1993.
//
//    words      one a sample, row by row; rows are 8 words longer than the tile is wide, so that samples of a column
//               do not fall onto the same lines of the cache
//    farthest   by block: the farthest key of all of its samples
//    corner     plane of a triangle that covers a block wholly: triangles behind it are hidden, too

// Included once for every target.
#if defined(FRONTMOST_ZBUFFER_TILE_BUFFER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ZBUFFER_TILE_BUFFER_INL_H_
#undef FRONTMOST_ZBUFFER_TILE_BUFFER_INL_H_
#else
#define FRONTMOST_ZBUFFER_TILE_BUFFER_INL_H_
#endif

#include <algorithm>

#include "base/highway-inl.h"
#include "hwy/cache_control.h"
#include "zbuffer/packet-inl.h"
#include "zbuffer/tile/tile.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DW = hn::ScalableTag<std::uint64_t>;
using DWI = hn::RebindToSigned<DW>;

// The word of pixels of the tile that lie outside the image. It is nearer than any key, so that these pixels never keep
// a block from hiding triangles.
constexpr std::uint64_t kOutsideImage = std::uint64_t(0x7F7FFFFF) << 32;

/// The order of pixels in vectors of 32-bit lanes. Interleaving keys and ids in this order gives words in the order of
/// pixels.
struct PixelOrder {
  HWY_ALIGN_MAX std::int32_t column[kMaxLanes];
  constexpr PixelOrder() : column{} {
    for (int i = 0; i < int(kMaxLanes); ++i)
      column[i] = kMaxLanes == 1 ? 0 : i / 4 * 2 + i % 2 + (i % 4 >= 2 ? int(kMaxLanes) / 2 : 0);
  }
};
constexpr PixelOrder kPixelOrder;

HWY_INLINE VU InPixelOrder(VU in_line) {
  return hn::TableLookupLanes(in_line, hn::SetTableIndices(DU(), kPixelOrder.column));
}

/// The words that a vector of keys and a vector of ids make: one vector or two.
struct Words {
#if HWY_TARGET == HWY_SCALAR
  static constexpr std::size_t kVectors = 1;
#else
  static constexpr std::size_t kVectors = 2;
#endif
  hn::Vec<DWI> word[kVectors];
};

/// Makes words in the order of pixels. Key bits and complements of ids are given in kPixelOrder.
HWY_INLINE Words WordsOf(VU key_bits, VU not_ids) {
  const DWI d;
#if HWY_TARGET == HWY_SCALAR
  const DW dw;
  return {{hn::BitCast(d, hn::Or(hn::ShiftLeft<32>(hn::PromoteTo(dw, key_bits)), hn::PromoteTo(dw, not_ids)))}};
#else
  const DU du;
  return {{hn::BitCast(d, hn::InterleaveLower(du, not_ids, key_bits)),
           hn::BitCast(d, hn::InterleaveUpper(du, not_ids, key_bits))}};
#endif
}

/// The least key among many words.
class LeastKey {
#if HWY_TARGET == HWY_SCALAR
  using D = DWI;
  static constexpr std::uint32_t kLowHalf = 0xFFFFFFFF;
#else
  // Minima are taken over half words, because every target has a minimum instruction for half words but not for words.
  // The odd halves hold the keys; the minima of the even halves are meaningless.
  using D = hn::Repartition<std::int32_t, DWI>;
  static constexpr std::uint32_t kLowHalf = 0x80000000;  // the least value of an even lane
#endif

 public:
  LeastKey() : least_(hn::BitCast(D(), hn::Set(DWI(), std::int64_t(kOutsideImage)))) {}
  HWY_INLINE void Fold(hn::Vec<DWI> words) { least_ = hn::Min(least_, hn::BitCast(D(), words)); }

  /// Returns false if some key is not greater than `key`, and in rare cases also if all keys are greater.
  [[nodiscard]] HWY_INLINE bool IsAbove(float key) const {
    const auto limit =
        hn::BitCast(D(), hn::Set(DWI(), std::int64_t(std::uint64_t(bits_as<std::uint32_t>(key)) << 32 | kLowHalf)));
    return hn::AllTrue(D(), hn::Gt(least_, limit));
  }
  [[nodiscard]] float key() const {
    HWY_ALIGN_MAX std::int32_t halves[2 * hn::MaxLanes(DWI())];
    hn::Store(hn::BitCast(DWI(), least_), DWI(), reinterpret_cast<std::int64_t*>(halves));
    for (std::size_t i = 3; i < 2 * hn::Lanes(DWI()); i += 2) halves[1] = HWY_MIN(halves[1], halves[i]);
    return bits_as<float>(halves[1]);
  }

 private:
  hn::Vec<D> least_;
};

/// Keeps the greater words of a row of pixels, and folds the kept words into `least`.
HWY_INLINE void MergeRow(const Words& words, std::uint64_t* row, LeastKey& least) {
  const DWI d;
  auto* kept = reinterpret_cast<std::int64_t*>(row);
  for (const auto& word : words.word) {
    const auto greater = hn::Max(word, hn::Load(d, kept));
    hn::Store(greater, d, kept);
    least.Fold(greater);
    kept += hn::Lanes(d);
  }
}

HWY_INLINE void StoreWords(const Words& words, std::uint64_t* to) {
  const DWI d;
  for (const auto& word : words.word) {
    hn::Store(word, d, reinterpret_cast<std::int64_t*>(to));
    to += hn::Lanes(d);
  }
}

template <class D>
HWY_INLINE void FillRow(D d, hn::TFromD<D> value, hn::TFromD<D>* row, std::size_t width, bool streams) {
  const auto vector = hn::Set(d, value);
  std::size_t x = 0;
  if (streams && reinterpret_cast<std::uintptr_t>(row) % 64 == 0)
    for (; x + hn::Lanes(d) <= width; x += hn::Lanes(d)) hn::Stream(vector, d, row + x);
  for (; x < width; ++x) row[x] = value;
}

/// Writes a tile in which nothing is seen.
HWY_INLINE void FillTile(const Picture& picture, const Tile& tile) {
  for (std::size_t s = 0; s < picture.samples.size(); ++s)
    for (int y = 0; y < tile.height; ++y) {
      const std::size_t at =
          (s * std::size_t(picture.view.height) + std::size_t(tile.y + y)) * std::size_t(picture.view.width) +
          std::size_t(tile.x);
      FillRow(DU(), no_primitive, picture.primitives + at, std::size_t(tile.width), picture.streams);
      FillRow(DF(), 0.0f, picture.keys + at, std::size_t(tile.width), picture.streams);
    }
  hwy::FlushStream();
}

/// The words of neighbouring pixels of a row, as many as a vector has 32-bit lanes.
class RowPart {
 public:
#if HWY_TARGET == HWY_SCALAR
  explicit HWY_INLINE RowPart(const std::uint64_t* row) : word_(*row) {}
  [[nodiscard]] HWY_INLINE VU id() const { return hn::Set(DU(), ~std::uint32_t(word_)); }

 private:
  std::uint64_t word_;
#else
  explicit HWY_INLINE RowPart(const std::uint64_t* row)
      : low_(hn::Load(DU(), reinterpret_cast<const std::uint32_t*>(row))),
        high_(hn::Load(DU(), reinterpret_cast<const std::uint32_t*>(row) + hn::Lanes(DU()))) {}
  [[nodiscard]] HWY_INLINE VU id() const { return hn::Not(hn::ConcatEven(DU(), high_, low_)); }
  [[nodiscard]] HWY_INLINE VF key() const { return hn::BitCast(DF(), hn::ConcatOdd(DU(), high_, low_)); }

 private:
  VU low_, high_;
#endif
};

/// The tile's samples as 64-bit words: the key's bits above the complement of the id. The greater word is the nearer
/// fragment, or at equal keys the fragment with the lower id; 0 means "nothing". Keys are not negative, so words can be
/// compared as signed numbers, the only comparison that AVX2 has. The buffer also holds the hierarchical depth: the
/// farthest key of each block, found on demand.
class TileBuffer {
 public:
  TileBuffer(const Picture& picture, const Tile& tile, TileScratch& scratch)
      : picture_(picture), tile_(tile), words_(scratch.words.data()), bounds_(scratch.bounds[0]) {}

  /// The blocks that a rectangle of pixels touches. Precondition: the rectangle is not empty, and within the tile.
  [[nodiscard]] static HWY_INLINE std::uint64_t BlocksOf(const PixelRect& rect) {
    constexpr std::uint64_t kFirstColumn = 0x0101010101010101u;
    const int x0 = rect.x0 / kBlockSize, x1 = rect.x1 / kBlockSize;
    const int y0 = rect.y0 / kBlockSize, y1 = rect.y1 / kBlockSize;
    const std::uint64_t columns = ((std::uint64_t(2) << (x1 - x0)) - 1) << x0;
    const std::uint64_t rows = (~std::uint64_t(0) >> (56 - 8 * (y1 - y0))) << (8 * y0);
    return columns * kFirstColumn & rows;
  }

  /// The blocks of the tile that a rectangle of the image touches. Precondition: there is at least one.
  [[nodiscard]] HWY_INLINE std::uint64_t BlocksInTile(const PixelRect& rect) const {
    return BlocksOf({HWY_MAX(rect.x0 - tile_.x, 0), HWY_MAX(rect.y0 - tile_.y, 0),
                     HWY_MIN(rect.x1 - tile_.x, tile_.width - 1), HWY_MIN(rect.y1 - tile_.y, tile_.height - 1)});
  }

  [[nodiscard]] HWY_INLINE std::uint64_t* Row(std::size_t sample, int y) const {
    return words_ + sample * kTileWords + std::size_t(y) * kTileStride;
  }

  void Clear() {
    const DW d;
    for (std::size_t s = 0; s < picture_.samples.size(); ++s)
      for (int y = 0; y < kTileSize; ++y) {
        std::uint64_t* row = Row(s, y);
        const int inside = y < tile_.height ? tile_.width : 0;
        for (int x = 0; x < kTileSize; x += int(hn::Lanes(d))) hn::Store(hn::Zero(d), d, row + x);
        for (int x = inside; x < kTileSize; ++x) row[x] = kOutsideImage;
      }
    std::fill(std::begin(bounds_.farthest), std::end(bounds_.farthest), 0.0f);
    std::fill(std::begin(bounds_.greatest), std::end(bounds_.greatest), 0.0f);  // no plane
    // In a whole tile, empty blocks hide nothing, so the farthest keys of 0 are right. At the image's rim, a block that
    // lies outside the image hides everything, so blocks are marked as drawn to.
    const bool whole = tile_.width == kTileSize && tile_.height == kTileSize;
    dirty_ = whole ? 0 : ~std::uint64_t(0);
  }

  /// Restores, after Clear(), the words that WriteOut() left in the planes and the keys that FindFarthest() found.
  void ReadBack(const float* farthest) {
    for (std::size_t s = 0; s < picture_.samples.size(); ++s)
      for (int y = 0; y < tile_.height; ++y) ReadRow(s, y);
    std::copy_n(farthest, BlockBounds::count, bounds_.farthest);
    dirty_ = 0;
  }

  /// Stores the farthest key of every block, or 0 if a sample of the block is not covered.
  void FindFarthest(float* farthest) {
    Refresh();
    std::copy_n(bounds_.farthest, BlockBounds::count, farthest);
  }

  [[nodiscard]] HWY_INLINE BlockBounds& bounds() const { return bounds_; }

  /// Notes that these blocks were drawn to. Their stored farthest key is only a bound from then on.
  HWY_INLINE void MarkDrawn(std::uint64_t blocks) { dirty_ |= blocks; }

  /// Sets the farthest key of a block, if all its samples were seen.
  HWY_INLINE void SetLeast(int block, const LeastKey& least) {
    bounds_.farthest[block] = least.key();
    dirty_ &= ~(std::uint64_t(1) << block);
  }

  /// True if every sample of the block is strictly nearer than `nearest`.
  [[nodiscard]] HWY_INLINE bool Hides(int block, float nearest) {
    if (bounds_.farthest[block] > nearest) return true;
    return (dirty_ >> block & 1) && FindHiding(block, nearest);
  }

  /// The blocks that are known to hide everything no nearer than `nearest`.
  [[nodiscard]] HWY_INLINE std::uint64_t KnownToHide(float nearest) const {
    const DF d;
    const VF key = hn::Set(d, nearest);
    std::uint64_t hiding = 0;
    for (std::size_t i = 0; i < BlockBounds::count; i += hn::Lanes(d))
      hiding |= BitsOf(d, hn::Gt(hn::Load(d, bounds_.farthest + i), key)) << i;
    return hiding;
  }

  /// Finds the farthest key of every block that was drawn to.
  void Refresh() {
    for (; dirty_ != 0;) {
      const int block = int(hwy::Num0BitsBelowLS1Bit_Nonzero64(dirty_));
      if (!FindHiding(block, -1.0f)) dirty_ &= ~(std::uint64_t(1) << block);
    }
  }

  /// Returns the triangles that blocks certainly hide, given the triangles' pixels and greatest keys. Triangles that
  /// span more than two by two blocks are not tested.
  [[nodiscard]] HWY_INLINE MI Hidden(const PixelRange& columns, const PixelRange& rows, VF nearest) const {
    static_assert(kBlockSize == 1 << 4 && kTileSize / kBlockSize == 8);
    const DI d;
    const VI x0 = hn::ShiftRight<4>(columns.first), x1 = hn::ShiftRight<4>(columns.last);
    const VI y0 = hn::ShiftLeft<3>(hn::ShiftRight<4>(rows.first)), y1 = hn::ShiftLeft<3>(hn::ShiftRight<4>(rows.last));
    const MI wide = hn::Or(hn::Gt(hn::Sub(x1, x0), hn::Set(d, 1)), hn::Gt(hn::Sub(y1, y0), hn::Set(d, 8)));
    const VF farthest = hn::Min(hn::Min(Farthest(hn::Add(x0, y0)), Farthest(hn::Add(x1, y0))),
                                hn::Min(Farthest(hn::Add(x0, y1)), Farthest(hn::Add(x1, y1))));
    return hn::AndNot(wide, hn::RebindMask(d, hn::Gt(farthest, nearest)));
  }

  /// True if every sample of the blocks is strictly nearer than `nearest`.
  [[nodiscard]] HWY_INLINE bool AllHide(std::uint64_t blocks, float nearest) {
    std::uint64_t left = blocks & ~KnownToHide(nearest);
    // A block that was not drawn to since its farthest key was found still does not hide.
    if (left & ~dirty_) return false;
    for (; left != 0; left &= left - 1)
      if (!Hides(int(hwy::Num0BitsBelowLS1Bit_Nonzero64(left)), nearest)) return false;
    return true;
  }

  /// From this call on, triangles that are drawn have holes.
  void MindHoles(TileHoles& holes) { holes_ = &holes; }
  [[nodiscard]] HWY_INLINE bool minds_holes() const { return holes_ != nullptr; }

  /// Keeps `word` if it is the greater one, unless its sample looks through a hole.
  HWY_INLINE void KeepSolid(std::uint64_t word, std::uint64_t& kept, const glm::ivec2& place) const {
    if (word > kept && !holes_->has(~std::uint32_t(word), place)) kept = word;
  }

  /// Does KeepSolid() for a row of pixels, and folds the kept words into `least`. `place` is that of the first sample.
  HWY_INLINE void KeepSolidRow(const Words& words, std::uint64_t* row, const glm::ivec2& place, LeastKey& least) const {
    const DWI d;
    HWY_ALIGN_MAX std::uint64_t word[kMaxLanes];
    StoreWords(words, word);
    for (std::size_t v = 0; v < Words::kVectors; ++v) {
      const std::size_t first = v * hn::Lanes(d);
      const auto* kept = reinterpret_cast<const std::int64_t*>(row + first);
      ForEachBit(BitsOf(d, hn::Gt(words.word[v], hn::Load(d, kept))), [&](std::size_t lane) {
        const std::size_t i = first + lane;
        KeepSolid(word[i], row[i], place + glm::ivec2(int(i) * kSubPixels, 0));
      });
      least.Fold(hn::Load(d, kept));
    }
  }

  void WriteOut() const {
    for (std::size_t s = 0; s < picture_.samples.size(); ++s)
      for (int y = 0; y < tile_.height; ++y) WriteRow(s, y);
    // Streamed stores are weakly ordered, and another thread may read the planes next.
    hwy::FlushStream();
  }

 private:
  [[nodiscard]] HWY_INLINE VF Farthest(VI block) const {
    return hn::BitCast(DF(), LookUp64(reinterpret_cast<const std::int32_t*>(bounds_.farthest), block));
  }

  /// Returns whether every sample of the block is nearer than `nearest`. Stops reading when a sample is not; otherwise
  /// stores the farthest key.
  [[nodiscard]] bool FindHiding(int block, float nearest) {
    constexpr int kRowsAtOnce = 4;
    const DWI d;
    const int bx = block % 8, by = block / 8;
    LeastKey least;
    for (std::size_t s = 0; s < picture_.samples.size(); ++s)
      for (int y = by * kBlockSize; y < (by + 1) * kBlockSize; y += kRowsAtOnce) {
        const auto* row = reinterpret_cast<const std::int64_t*>(Row(s, y)) + bx * kBlockSize;
        for (int k = 0; k < kRowsAtOnce; ++k, row += kTileStride)
          for (int x = 0; x < kBlockSize; x += int(hn::Lanes(d))) least.Fold(hn::Load(d, row + x));
        if (!least.IsAbove(nearest)) return false;
      }
    SetLeast(block, least);
    return true;
  }

  /// Index of a row of the tile in the planes.
  [[nodiscard]] std::size_t PlaceOf(std::size_t sample, int y) const {
    return (sample * std::size_t(picture_.view.height) + std::size_t(tile_.y + y)) * std::size_t(picture_.view.width) +
           std::size_t(tile_.x);
  }

  /// The inverse of WriteRow(); no_primitive with key 0 becomes the word 0 again.
  void ReadRow(std::size_t sample, int y) {
    const std::size_t at = PlaceOf(sample, y);
    std::uint64_t* row = Row(sample, y);
    for (std::size_t x = 0; x < std::size_t(tile_.width); ++x)
      row[x] = std::uint64_t(bits_as<std::uint32_t>(picture_.keys[at + x])) << 32 | ~picture_.primitives[at + x];
  }

  void WriteRow(std::size_t sample, int y) const {
    const std::size_t at = PlaceOf(sample, y);
    const std::uint64_t* row = Row(sample, y);
    PrimitiveId* primitives = picture_.primitives + at;
    float* keys = picture_.keys + at;
    const std::size_t width = std::size_t(tile_.width);
    std::size_t x = 0;
#if HWY_TARGET != HWY_SCALAR
    const std::size_t lanes = hn::Lanes(DU());
    // Streamed vectors must be aligned. Planes are aligned to 64 bytes, rows only if the width is a multiple of 16.
    const bool streams = picture_.streams && at % 16 == 0;
    for (; x + lanes <= width; x += lanes) {
      const RowPart part(row + x);
      if (streams) {
        hn::Stream(part.id(), DU(), primitives + x);
        hn::Stream(part.key(), DF(), keys + x);
      } else {
        hn::StoreU(part.id(), DU(), primitives + x);
        hn::StoreU(part.key(), DF(), keys + x);
      }
    }
#endif
    for (; x < width; ++x) {
      primitives[x] = ~std::uint32_t(row[x]);
      keys[x] = bits_as<float>(std::uint32_t(row[x] >> 32));
    }
  }

  const Picture& picture_;
  const Tile& tile_;
  std::uint64_t* words_;
  BlockBounds& bounds_;
  TileHoles* holes_ = nullptr;
  std::uint64_t dirty_ = 0;  // blocks drawn to since their farthest key was found
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
