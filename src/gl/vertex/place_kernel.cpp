// SPDX-License-Identifier: Apache-2.0
// Sorts out the triangles of a batch. Small ones inside the clip volume are placed, oriented and appended
// to the columns; the numbers of large ones, and of triangles that a plane cuts, go to `apart`.

#include "vertex/batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vertex/place_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/compactor-inl.h"
#include "zbuffer/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::gl_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::zbuffer_detail;
using namespace frontmost::zbuffer_detail::HWY_NAMESPACE;
using frontmost::HWY_NAMESPACE::Compactor;

/// The sink of SortOut().
class WindowPlacer {
 public:
  WindowPlacer(Batch& batch, std::vector<std::uint32_t>& apart)
      : b_(batch),
        d_(*batch.state),
        to_(batch.placed.small()),
        apart_(apart),
        facing_(d_.culling, nullptr),
        rect_(to_.rect) {
    back_is_clockwise_ = d_.state.polygon.front_face == GL_CCW;
  }

  void Place() {
    const DI d;
    for (std::size_t i = 0; i < std::size_t(b_.triangle_count); i += hn::Lanes(d)) PlacePacket(i);
    to_.rect = rect_.rect();
  }

  [[nodiscard]] HWY_INLINE PixelRange ColumnsOf(const CoordinateRange& x) const {
    return PixelsBetween(x, kCentre, kCentre, d_.viewport.x0, d_.viewport.x1);
  }
  [[nodiscard]] HWY_INLINE PixelRange RowsOf(const CoordinateRange& y) const {
    return PixelsBetween(y, kCentre, kCentre, d_.viewport.y0, d_.viewport.y1);
  }
  [[nodiscard]] HWY_INLINE VU Ids() const { return hn::Zero(DU()); }  // facing does not depend on them
  HWY_INLINE void PutLarge(MI large) { others_ |= BitsOf(DI(), large); }
  HWY_INLINE void PutSmall(const PlacedPacket& placed) {
    const DI d;
    rect_.Add(placed);
    const Compactor<DI> compact(placed.kept);
    BatchColumns& to = to_.columns();
    const std::size_t at = to_.count;
    for (int k = 0; k < 3; ++k) {
      const Corners& corner = placed.corners[k];
      compact.Store(corner.x, to.x[k] + at);
      compact.Store(corner.y, to.y[k] + at);
      compact.Store(hn::GatherIndex(d, reinterpret_cast<const std::int32_t*>(b_.window_z()), corner.number),
                    to.key[k] + at);
      compact.Store(corner.number, b_.small_corners[k].data() + at);
    }
    const MI turned = hn::Ne(placed.corners[1].number, second_);  // clockwise ones were turned
    const VI clockwise = hn::VecFromMask(d, turned);              // -1 or 0
    const VI back = back_is_clockwise_ ? hn::Neg(clockwise) : hn::Add(clockwise, hn::Set(d, 1));
    const VI id = hn::Or(hn::ShiftLeft<1>(CountFrom(d, std::int32_t(first_))), back);
    compact.Store(hn::BitCast(DU(), id), to.id + at);
    compact.Store(hn::BitCast(DU(), TilesOf(placed.columns, placed.rows)), to.tiles + at);
    to_.count += compact.count();
  }

 private:
  static constexpr std::int32_t kCentre = kSubPixels / 2;

  HWY_INLINE void PlacePacket(std::size_t first) {
    const DI d;
    const Corners fetched[3] = {Fetch(0, first), Fetch(1, first), Fetch(2, first)};
    const std::int32_t count = std::int32_t(HWY_MIN(std::size_t(b_.triangle_count) - first, hn::Lanes(d)));
    MI live = hn::Lt(hn::Iota(d, 0), hn::Set(d, count));
    first_ = first;
    second_ = fetched[1].number;
    const VI ca = Code(fetched[0]), cb = Code(fetched[1]), cc = Code(fetched[2]);
    const MI inside = hn::Eq(hn::Or(ca, hn::Or(cb, cc)), hn::Zero(d));
    const MI cut = hn::And(live, hn::AndNot(inside, hn::Eq(hn::And(ca, hn::And(cb, cc)), hn::Zero(d))));
    others_ = BitsOf(d, cut);
    live = hn::And(live, inside);
    if (!hn::AllFalse(d, live)) SortOut(fetched, live, facing_, *this);
    if (others_ != 0) ForEachBit(others_, [&](std::size_t lane) { apart_.push_back(std::uint32_t(first_ + lane)); });
  }

  [[nodiscard]] HWY_INLINE Corners Fetch(int k, std::size_t first) const {
    const DI d;
    const VI n = hn::LoadU(d, b_.corners[k].data() + first);
    return {n, hn::GatherIndex(d, b_.place(0), n), hn::GatherIndex(d, b_.place(1), n)};
  }
  [[nodiscard]] HWY_INLINE VI Code(const Corners& c) const { return hn::GatherIndex(DI(), b_.out_codes(), c.number); }

  Batch& b_;
  const DrawState& d_;
  TriangleBatch& to_;
  std::vector<std::uint32_t>& apart_;
  FacingRule facing_;
  bool back_is_clockwise_;
  WidenedRect rect_;
  std::size_t first_ = 0;
  VI second_;  // vertex 1 of each triangle of the packet
  std::uint64_t others_ = 0;
};

void PlaceSmall(Batch& batch, std::vector<std::uint32_t>& apart) { WindowPlacer(batch, apart).Place(); }

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::gl_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::gl_detail {

FRONTMOST_KERNELS(PlaceSmall);

void place_small(Batch& batch, std::vector<std::uint32_t>& apart, Isa isa) {
  kernel_for(PlaceSmallKernels, isa)(batch, apart);
}

}  // namespace frontmost::gl_detail
#endif  // HWY_ONCE
