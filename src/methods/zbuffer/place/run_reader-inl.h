// SPDX-License-Identifier: Apache-2.0
// Reads the triangles of a batch that lie in one tile, a packet at a time and in their order.
//
//    run of 20, vectors of 16    [ whole vector as it stands ][4 numbers wait]
//    next run of 7               [4 + 7 numbers wait]
//    next run of 9               [16 numbers: gathered together][4 wait]
//
// Long runs are read directly from memory; the rest of a run waits, so that vectors are always full. Triangles keep the
// order of the runs, which the depth buffer needs.

// Included once for every target.
#if defined(FRONTMOST_ZBUFFER_RUN_READER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ZBUFFER_RUN_READER_INL_H_
#undef FRONTMOST_ZBUFFER_RUN_READER_INL_H_
#else
#define FRONTMOST_ZBUFFER_RUN_READER_INL_H_
#endif

#include "base/highway-inl.h"
#include "zbuffer/packet-inl.h"
#include "zbuffer/place/triangle_batch.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Calls visit(count, fetch) for packets of `count` triangles. fetch(tag, column) reads a vector of a column of
/// BatchColumns; lanes behind the last triangle repeat the first.
class RunReader {
 public:
  /// Reads whole vectors of a run directly. Gathers the rest together with the rest of other runs, once it fills a
  /// vector.
  template <class Visit>
  HWY_INLINE void Read(const TileRun& run, const Visit& visit) {
    const DI d;
    std::size_t i = run.first;
    const std::size_t end = i + run.count;
    if (run.count == 1) {  // most runs are this short if triangles are strewn
      numbers_[pending_++] = std::int32_t(i);
      if (pending_ == hn::Lanes(d)) Finish(visit);
      return;
    }
    for (; pending_ == 0 && i + hn::Lanes(d) <= end; i += hn::Lanes(d))
      visit(hn::Lanes(d), [&](auto tag, const auto* column) HWY_ATTR { return hn::LoadU(tag, column + i); });
    while (i < end) {
      const std::size_t taken = HWY_MIN(hn::Lanes(d) - pending_, end - i);
      hn::StoreU(CountFrom(d, std::int32_t(i)), d, numbers_ + pending_);
      pending_ += taken;
      i += taken;
      if (pending_ == hn::Lanes(d)) Finish(visit);
    }
  }

  /// Reads the triangles that still wait.
  template <class Visit>
  HWY_INLINE void Finish(const Visit& visit) {
    if (pending_ == 0) return;
    const DI d;
    const MI live = hn::Lt(hn::Iota(d, 0), hn::Set(d, std::int32_t(pending_)));
    const VI number = hn::IfThenElse(live, hn::Load(d, numbers_), hn::Set(d, numbers_[0]));
    visit(pending_, [&](auto tag, const auto* column) HWY_ATTR { return hn::GatherIndex(tag, column, number); });
    pending_ = 0;
  }

 private:
  HWY_ALIGN_MAX std::int32_t numbers_[2 * kMaxLanes];
  std::size_t pending_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
