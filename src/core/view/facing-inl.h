// SPDX-License-Identifier: Apache-2.0
// FacingRule for a vector of triangles at a time.

// Included once for every target.
#if defined(FRONTMOST_VIEW_FACING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_VIEW_FACING_INL_H_
#undef FRONTMOST_VIEW_FACING_INL_H_
#else
#define FRONTMOST_VIEW_FACING_INL_H_
#endif

#include "base/highway-inl.h"
#include "base/lanes-inl.h"
#include "view/facing_rule.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::view_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The lanes of `asked` whose triangles are double-sided. `ids` has a value for each lane; lanes that are not asked for
/// may hold any value.
template <class D, class Ids>
HWY_NOINLINE hn::Mask<D> DoubleSided(D d, const FacingRule& rule, hn::Mask<D> asked, Ids ids) {
  const hn::RebindToSigned<D> di;
  const hn::RebindToUnsigned<D> du;
  alignas(64) std::uint32_t id[hn::MaxLanes(du)];
  alignas(64) std::int32_t answer[hn::MaxLanes(di)] = {};
  hn::Store(ids, du, id);
  frontmost::HWY_NAMESPACE::ForEachBit(frontmost::HWY_NAMESPACE::BitsOf(d, asked),
                                       [&](std::size_t lane) { answer[lane] = rule.keeps(id[lane], false) ? -1 : 0; });
  return hn::RebindMask(d, hn::MaskFromVec(hn::Load(di, answer)));
}

/// The lanes that a rule keeps, among those seen from the front and those seen from behind; lanes of `back` must hold
/// triangles. `ids()` is called only if materials differ.
template <class D, class Ids>
HWY_INLINE hn::Mask<D> Kept(D d, const FacingRule& rule, hn::Mask<D> front, hn::Mask<D> back, const Ids& ids) {
  switch (rule.culling()) {
    case Culling::none: return hn::Or(front, back);
    case Culling::back: return front;
    case Culling::front: return back;
    case Culling::both: break;
    case Culling::material: return hn::Or(front, DoubleSided(d, rule, back, ids()));
  }
  return hn::And(front, back);  // no lane, because no triangle is seen from both sides
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::view_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
