// SPDX-License-Identifier: Apache-2.0
// Places all vertices of clusters on the screen, and finds the bounds of their clusters.
//
// A cluster's box is that of its snapped vertices, so it needs no margin. A cluster is taken apart if one of its
// vertices cannot be snapped, because it lies beyond the guard band or too near to the eye. The place of such a vertex
// is never read.

#include "abuffer/plan/frame_plan.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "abuffer/plan/screen_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "view/snap-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace screen = view_detail::HWY_NAMESPACE;

using DF = screen::SnapF;
using DI = screen::SnapI;
using VI = hn::Vec<DI>;

class Transformer {
 public:
  Transformer(const ClusterSet& set, const ScreenTransform& t, ScreenClusters& screen)
      : set_(set), t_(t), screen_(screen) {}

  void Place(std::size_t index) {
    const DI di;
    const Cluster& cluster = set_.clusters[index];
    // The guard band bounds all snapped vertices, so these values are beyond any vertex.
    VI low_x = hn::Set(di, kGuardBand), low_y = low_x, high_x = hn::Neg(low_x), high_y = high_x;
    auto plain = hn::Eq(low_x, low_x);
    // Entries past the last vertex repeat it, up to a multiple of 16.
    for (std::size_t i = 0; i < cluster.vertex_count; i += hn::Lanes(di)) {
      const auto is_plain = Snap(cluster.first_vertex + i);
      plain = hn::And(plain, is_plain);
      const VI x = hn::Load(di, screen_.x.data() + cluster.first_vertex + i);
      const VI y = hn::Load(di, screen_.y.data() + cluster.first_vertex + i);
      low_x = hn::Min(low_x, x);
      high_x = hn::Max(high_x, x);
      low_y = hn::Min(low_y, y);
      high_y = hn::Max(high_y, y);
    }
    ClusterPlace& place = screen_.places[index];
    place.fate = hn::AllTrue(di, plain) ? ScreenFate::whole : ScreenFate::apart;
    place.x0 = hn::GetLane(hn::MinOfLanes(di, low_x));
    place.y0 = hn::GetLane(hn::MinOfLanes(di, low_y));
    place.x1 = hn::GetLane(hn::MaxOfLanes(di, high_x));
    place.y1 = hn::GetLane(hn::MaxOfLanes(di, high_y));
    if (place.fate == ScreenFate::whole &&
        (place.x1 < -t_.centre_x || place.x0 > t_.centre_x || place.y1 < -t_.centre_y || place.y0 > t_.centre_y))
      place.fate = ScreenFate::outside;
  }

 private:
  /// \returns the mask of those vertices of a vector that are snapped.
  HWY_INLINE hn::Mask<DI> Snap(std::size_t v) {
    const DF d;
    const DI di;
    const screen::HomogeneousVertices vertices = screen::Transform(
        t_, hn::Load(d, set_.x.data() + v), hn::Load(d, set_.y.data() + v), hn::Load(d, set_.z.data() + v));
    const auto plain = screen::IsPlain(t_, vertices);
    const auto is_snapped = hn::RebindMask(di, plain);
    const screen::ScreenVertices snapped = screen::Snap(t_, vertices);
    // Vertices that are not snapped become zeros, because converting numbers out of range differs from target to
    // target. These zeros are never read.
    hn::Store(hn::IfThenElseZero(plain, snapped.key), d, screen_.key.data() + v);
    hn::Store(hn::IfThenElseZero(is_snapped, snapped.x), di, screen_.x.data() + v);
    hn::Store(hn::IfThenElseZero(is_snapped, snapped.y), di, screen_.y.data() + v);
    return is_snapped;
  }

  const ClusterSet& set_;
  const ScreenTransform& t_;
  ScreenClusters& screen_;
};

void TransformRange(const ClusterSet& set, const ScreenTransform& transform, std::size_t begin, std::size_t end,
                    ScreenClusters& screen) {
  Transformer transformer(set, transform, screen);
  for (std::size_t i = begin; i < end; ++i) transformer.Place(i);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::abuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::abuffer_detail {

FRONTMOST_KERNELS(TransformRange);

void transform_clusters(const ClusterSet& set, const ScreenTransform& transform, Isa isa, std::size_t begin,
                        std::size_t end, ScreenClusters& screen) {
  kernel_for(TransformRangeKernels, isa)(set, transform, begin, end, screen);
}

}  // namespace frontmost::abuffer_detail
#endif  // HWY_ONCE
