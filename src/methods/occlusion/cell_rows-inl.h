// SPDX-License-Identifier: Apache-2.0
// Rows of cells of a tile, several at a time.

// Included once for every target.
#if defined(FRONTMOST_OCCLUSION_CELL_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_OCCLUSION_CELL_ROWS_INL_H_
#undef FRONTMOST_OCCLUSION_CELL_ROWS_INL_H_
#else
#define FRONTMOST_OCCLUSION_CELL_ROWS_INL_H_
#endif

#include "base/highway-inl.h"
#include "base/lanes-inl.h"
#include "occlusion/cells.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::occlusion_detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using frontmost::HWY_NAMESPACE::BitsOf;

using RowF = hn::CappedTag<float, tile_rows>;
using RowI = hn::RebindToSigned<RowF>;
using RowU = hn::RebindToUnsigned<RowF>;

/// Returns the lowest `count` bits, for counts of 0 to 32.
HWY_INLINE hn::Vec<RowU> LowBits(hn::Vec<RowI> count) {
  const RowI d;
  const RowU du;
  const auto all = hn::Set(du, ~0u);
  const auto is_all = hn::RebindMask(du, hn::Gt(count, hn::Set(d, 31)));
  const auto shift = hn::BitCast(du, hn::And(count, hn::Set(d, 31)));
  return hn::IfThenElse(is_all, all, hn::Sub(hn::Shl(hn::Set(du, 1u), shift), hn::Set(du, 1u)));
}

/// LowBits() of one count.
inline std::uint32_t low_bits(int count) { return count >= 32 ? ~0u : (1u << count) - 1u; }

/// The cells of a tile that lie within a rectangle. The tile begins at (x, y). Precondition: the rectangle reaches into
/// the tile.
struct CellsWithin {
  std::uint32_t columns;
  int first_row, end_row;

  CellsWithin(const CellRect& rect, int x, int y)
      : columns(low_bits(std::min(rect.x1 - x, tile_columns)) & ~low_bits(std::max(rect.x0 - x, 0))),
        first_row(std::max(rect.y0 - y, 0)),
        end_row(std::min(rect.y1 - y, tile_rows)) {}
  /// The cells of a vector of rows from `row` on.
  [[nodiscard]] HWY_INLINE hn::Vec<RowU> operator()(int row) const {
    const RowU d;
    const RowI di;
    const auto number = hn::Add(hn::Iota(di, 0), hn::Set(di, row));
    const auto counts = hn::And(hn::Gt(number, hn::Set(di, first_row - 1)), hn::Lt(number, hn::Set(di, end_row)));
    return hn::IfThenElseZero(hn::RebindMask(d, counts), hn::Set(d, columns));
  }
};

/// Returns whether a tile, which begins at (x, y), has all of its cells that lie within a rectangle. Precondition:
/// there are such cells.
HWY_INLINE bool HasAll(const std::uint32_t* rows, const CellRect& rect, int x, int y) {
  const RowU d;
  const CellsWithin within(rect, x, y);
  auto missing = hn::Zero(d);
  for (int r = 0; r < tile_rows; r += int(hn::Lanes(d)))
    missing = hn::Or(missing, hn::AndNot(hn::Load(d, rows + r), within(r)));
  return hn::AllTrue(d, hn::Eq(missing, hn::Zero(d)));
}

/// Returns whether triangles nearer than `depth` cover all cells of a rectangle within the screen.
HWY_INLINE bool IsCovered(const CellCover& cover, const CellRect& rect, float depth) {
  const RowF d;
  const auto wanted = hn::Set(d, depth);
  const int first = rect.x0 / tile_columns, end = (rect.x1 - 1) / tile_columns + 1;
  for (int ty = rect.y0 / tile_rows; ty * tile_rows < rect.y1; ++ty) {
    const int row = ty * cover.covered.tiles_x();
    // Most tiles within a covered rectangle are full.
    for (int tx = first; tx < end; tx += int(hn::Lanes(d))) {
      const auto is_full = hn::Lt(hn::LoadU(d, cover.full_depth.data() + row + tx), wanted);
      std::uint64_t others = BitsOf(d, hn::Not(is_full)) & low_bits(std::min(end - tx, 16));
      for (; others != 0; others &= others - 1) {
        const int its_tx = tx + int(hwy::Num0BitsBelowLS1Bit_Nonzero64(others)), tile = row + its_tx;
        if (!(cover.depth[std::size_t(tile)] < depth)) return false;
        if (!HasAll(cover.covered.rows(tile), rect, its_tx * tile_columns, ty * tile_rows)) return false;
      }
    }
  }
  return true;
}

}  // namespace frontmost::occlusion_detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
