// SPDX-License-Identifier: Apache-2.0
// Writes a tile to a VisiblePixels: sample 0 as planes, and the other samples if a pixel's samples differ.
//
// Rows are read twice: first to find mixed pixels, which gives the row's share of `others`, then to fill that share.
// Tiles take their shares as they come, so the order of `others` depends on threads; the samples of a pixel do not.

// Included once for every target.
#if defined(FRONTMOST_ZBUFFER_TILE_PIXELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ZBUFFER_TILE_PIXELS_INL_H_
#undef FRONTMOST_ZBUFFER_TILE_PIXELS_INL_H_
#else
#define FRONTMOST_ZBUFFER_TILE_PIXELS_INL_H_
#endif

#include <bit>

#include "base/lanes-inl.h"
#include "frontmost/view.h"
#include "zbuffer/tile/tile_buffer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

class TilePixels {
 public:
  TilePixels(const Picture& picture, const Tile& tile) : picture_(picture), to_(*picture.pixels), tile_(tile) {}

  void Write(const TileBuffer& buffer) const {
    for (int y = 0; y < tile_.height; ++y) {
      WriteFirst(buffer.Row(0, y), y);
      WriteOthers(buffer, y);
    }
  }

  /// Fills a tile in which nothing is seen.
  void Fill() const {
    for (int y = 0; y < tile_.height; ++y) {
      const std::size_t at = FirstPixel(y);
      std::fill_n(to_.primitives + at, tile_.width, no_primitive);
      std::fill_n(to_.keys + at, tile_.width, 0.0f);
      std::fill_n(to_.mixed + FirstRun(y), RunCount(), std::uint16_t(0));
    }
  }

 private:
  static constexpr int kRun = VisiblePixels::run;
  static_assert(kTileSize % kRun == 0);

  [[nodiscard]] std::size_t FirstPixel(int y) const {
    return std::size_t(tile_.y + y) * std::size_t(picture_.view.width) + std::size_t(tile_.x);
  }
  [[nodiscard]] std::size_t FirstRun(int y) const {
    return std::size_t(tile_.y + y) * to_.runs_across + std::size_t(tile_.x / kRun);
  }
  [[nodiscard]] std::size_t RunCount() const { return std::size_t((tile_.width + kRun - 1) / kRun); }

  void WriteFirst(const std::uint64_t* row, int y) const {
    PrimitiveId* const primitives = to_.primitives + FirstPixel(y);
    float* const keys = to_.keys + FirstPixel(y);
    const auto width = std::size_t(tile_.width);
    std::size_t x = 0;
#if HWY_TARGET != HWY_SCALAR
    for (; x + hn::Lanes(DU()) <= width; x += hn::Lanes(DU())) {
      const RowPart part(row + x);
      hn::StoreU(part.id(), DU(), primitives + x);
      hn::StoreU(part.key(), DF(), keys + x);
    }
#endif
    for (; x < width; ++x) {
      const std::uint32_t bits = std::uint32_t(row[x] >> 32);
      primitives[x] = ~std::uint32_t(row[x]);
      std::memcpy(keys + x, &bits, sizeof bits);
    }
  }

  void WriteOthers(const TileBuffer& buffer, int y) const {
    std::uint16_t* const mixed = to_.mixed + FirstRun(y);
    unsigned count = 0;
    for (std::size_t r = 0; r < RunCount(); ++r) {
      mixed[r] = MixedOf(buffer, y, int(r) * kRun);
      count += unsigned(std::popcount(mixed[r]));
    }
    if (count == 0) return;
    const std::size_t samples = picture_.samples.size();
    std::uint32_t place = to_.other_count->fetch_add(count * std::uint32_t(samples - 1));
    for (std::size_t r = 0; r < RunCount(); ++r) {
      to_.places[FirstRun(y) + r] = place;
      ForEachBit(mixed[r], [&](std::size_t bit) {
        for (std::size_t s = 1; s < samples; ++s)
          to_.others[place++] = ~std::uint32_t(buffer.Row(s, y)[r * kRun + bit]);
      });
    }
  }

  /// A bit for each pixel of the run at x whose samples see different primitives.
  [[nodiscard]] HWY_INLINE std::uint16_t MixedOf(const TileBuffer& buffer, int y, int x) const {
    const DU d;
    unsigned bits = 0;
    for (int i = 0; i < kRun; i += int(hn::Lanes(d))) {
      const VU first = RowPart(buffer.Row(0, y) + x + i).id();
      VU different = hn::Zero(d);
      for (std::size_t s = 1; s < picture_.samples.size(); ++s)
        different = hn::Or(different, hn::Xor(RowPart(buffer.Row(s, y) + x + i).id(), first));
      bits |= unsigned(BitsOf(d, hn::Ne(different, hn::Zero(d)))) << i;
    }
    return std::uint16_t(bits);
  }

  const Picture& picture_;
  const PixelPlanes& to_;
  const Tile& tile_;
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
