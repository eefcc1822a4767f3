// SPDX-License-Identifier: Apache-2.0
// The keys of steep triangles (triangle_keys.h) for a vector of samples at a time, with the same bits.
//
// Along a row only x changes, and along a column only y. Each product with x is computed once for a column (Set), and
// each product with y once for a row (At). A sample then needs only two subtractions and one sum of products.

// Included once for every target.
#if defined(FRONTMOST_VIEW_STEEP_KEYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_VIEW_STEEP_KEYS_INL_H_
#undef FRONTMOST_VIEW_STEEP_KEYS_INL_H_
#else
#define FRONTMOST_VIEW_STEEP_KEYS_INL_H_
#endif

#include "base/highway-inl.h"
#include "base/lane_types-inl.h"
#include "view/triangle_keys.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::view_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::HWY_NAMESPACE;

using KeyD = hn::ScalableTag<double>;
using KeyF = hn::Rebind<float, KeyD>;

/// Keys at the samples of a column, row after row. Terms that depend on x are computed once.
class SteepColumn {
 public:
  /// `x` is counted from the origin of the vertices, in 1/256 pixel.
  HWY_INLINE void Set(const SteepKeys& keys, hn::Vec<KeyD> x) {
    const auto dx = hn::Sub(x, hn::Set(KeyD(), keys.x0));
    q_ = hn::Mul(hn::Set(KeyD(), keys.qy), dx);
    p_ = hn::Mul(hn::Set(KeyD(), keys.py), dx);
  }

  /// Precondition: Set() with the same keys.
  [[nodiscard]] HWY_INLINE hn::Vec<KeyF> At(const SteepKeys& keys, std::int32_t y) const {
    const KeyD d;
    const double dy = double(y) - keys.y0;
    return Sum(keys, hn::Set(d, keys.qx * dy), hn::Set(d, keys.px * dy));
  }
  /// At() with a row for each lane.
  [[nodiscard]] HWY_INLINE hn::Vec<KeyF> At(const SteepKeys& keys, hn::Vec<KeyD> y) const {
    const KeyD d;
    const auto dy = hn::Sub(y, hn::Set(d, keys.y0));
    return Sum(keys, hn::Mul(hn::Set(d, keys.qx), dy), hn::Mul(hn::Set(d, keys.px), dy));
  }

 private:
  [[nodiscard]] HWY_INLINE hn::Vec<KeyF> Sum(const SteepKeys& keys, hn::Vec<KeyD> q, hn::Vec<KeyD> p) const {
    const KeyD d;
    const KeyF df;
    const auto e1 = hn::Sub(q, q_), e2 = hn::Sub(p, p_);
    const auto sum = hn::Add(hn::Mul(e1, hn::Set(d, keys.a)), hn::Mul(e2, hn::Set(d, keys.b)));
    const auto key = hn::DemoteTo(df, hn::Add(hn::Set(d, keys.k0), sum));
    return hn::Min(hn::Max(key, hn::Set(df, keys.k_min)), hn::Set(df, keys.k_max));
  }

  hn::Vec<KeyD> q_, p_;
};

/// SteepColumn for as many columns as a vector of floats has lanes.
class SteepColumns {
 public:
  HWY_INLINE void Set(const SteepKeys& keys, VI x) {
    HWY_ALIGN_MAX std::int32_t lanes[kMaxLanes];
    hn::Store(x, DI(), lanes);
    for (std::size_t i = 0; i < kParts; ++i) columns_[i].Set(keys, Part(lanes, i));
  }
  [[nodiscard]] HWY_INLINE VF At(const SteepKeys& keys, std::int32_t y) const {
    HWY_ALIGN_MAX float result[kMaxLanes];
    for (std::size_t i = 0; i < kParts; ++i) hn::Store(columns_[i].At(keys, y), KeyF(), result + i * kPart);
    return hn::Load(DF(), result);
  }
  /// At() with a row for each lane.
  [[nodiscard]] HWY_INLINE VF At(const SteepKeys& keys, VI y) const {
    HWY_ALIGN_MAX std::int32_t lanes[kMaxLanes];
    HWY_ALIGN_MAX float result[kMaxLanes];
    hn::Store(y, DI(), lanes);
    for (std::size_t i = 0; i < kParts; ++i)
      hn::Store(columns_[i].At(keys, Part(lanes, i)), KeyF(), result + i * kPart);
    return hn::Load(DF(), result);
  }

 private:
  static constexpr std::size_t kPart = hn::MaxLanes(KeyD()), kParts = kMaxLanes / kPart;

  static HWY_INLINE hn::Vec<KeyD> Part(const std::int32_t* lanes, std::size_t i) {
    return hn::PromoteTo(KeyD(), hn::Load(hn::Rebind<std::int32_t, KeyD>(), lanes + i * kPart));
  }

  SteepColumn columns_[kParts];
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::view_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
