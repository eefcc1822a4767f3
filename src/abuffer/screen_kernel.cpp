// SPDX-License-Identifier: Apache-2.0
// The vertex formula of view/screen_transform.h, many vertices at a time.

#include "abuffer/screen_clusters.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "abuffer/screen_kernel.cpp"
#include "base/isa.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<DF>;
using VF = hn::Vec<DF>;
using VI = hn::Vec<DI>;

HWY_INLINE VF Row(const std::array<float, 3>& row, float offset, VF dx, VF dy, VF dz) {
  const DF d;
  const VF x = hn::Mul(hn::Set(d, row[0]), dx), y = hn::Mul(hn::Set(d, row[1]), dy);
  return hn::Add(hn::Add(hn::Add(x, y), hn::Mul(hn::Set(d, row[2]), dz)), hn::Set(d, offset));
}

class Transformer {
 public:
  Transformer(const ClusterSet& set, const ScreenTransform& t, ScreenClusters& screen)
      : set_(set), t_(t), screen_(screen) {}

  void Place(std::size_t index) {
    const DI di;
    const Cluster& cluster = set_.clusters[index];
    VI low_x = hn::Set(di, kGuardBand), low_y = low_x, high_x = hn::Neg(low_x), high_y = high_x;
    auto plain = hn::Eq(low_x, low_x);
    // Vertices past the last repeat it, up to a multiple of 16.
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
    place.fate = hn::AllTrue(di, plain) ? ClusterFate::whole : ClusterFate::apart;
    place.x0 = hn::GetLane(hn::MinOfLanes(di, low_x));
    place.y0 = hn::GetLane(hn::MinOfLanes(di, low_y));
    place.x1 = hn::GetLane(hn::MaxOfLanes(di, high_x));
    place.y1 = hn::GetLane(hn::MaxOfLanes(di, high_y));
    if (place.fate == ClusterFate::whole &&
        (place.x1 < -t_.centre_x || place.x0 > t_.centre_x || place.y1 < -t_.centre_y || place.y0 > t_.centre_y))
      place.fate = ClusterFate::outside;
  }

 private:
  HWY_INLINE hn::Mask<DI> Snap(std::size_t v) {
    const DF d;
    const DI di;
    const VF dx = hn::Sub(hn::Load(d, set_.x.data() + v), hn::Set(d, t_.eye[0]));
    const VF dy = hn::Sub(hn::Load(d, set_.y.data() + v), hn::Set(d, t_.eye[1]));
    const VF dz = hn::Sub(hn::Load(d, set_.z.data() + v), hn::Set(d, t_.eye[2]));
    const VF x = Row(t_.x_row, t_.x_offset, dx, dy, dz), y = Row(t_.y_row, t_.y_offset, dx, dy, dz);
    const VF depth = Row(t_.d_row, t_.d_offset, dx, dy, dz);
    const VF w = t_.orthographic ? hn::Set(d, 1.0f) : depth;
    const VF reach = hn::Min(hn::Mul(hn::Set(d, float(kGuardBand)), w), hn::Set(d, std::numeric_limits<float>::max()));
    // Written so that NaN is not plain.
    auto plain = hn::And(hn::Ge(depth, hn::Set(d, t_.near)), hn::Le(depth, hn::Set(d, t_.far)));
    plain = hn::And(plain, hn::And(hn::Le(hn::Abs(x), reach), hn::Le(hn::Abs(y), reach)));

    VF sx = x, sy = y, key;
    if (t_.orthographic) {
      key = hn::Mul(hn::Sub(hn::Set(d, t_.far), depth), hn::Set(d, t_.inverse_range));
      key = hn::Max(key, hn::Zero(d));
    } else {
      const VF inverse = hn::Div(hn::Set(d, 1.0f), depth);
      sx = hn::Mul(x, inverse);
      sy = hn::Mul(y, inverse);
      key = hn::Mul(hn::Set(d, t_.near), inverse);
    }
    hn::Store(hn::IfThenElseZero(plain, hn::Min(key, hn::Set(d, 1.0f))), d, screen_.key.data() + v);
    hn::Store(hn::NearestInt(hn::IfThenElseZero(plain, sx)), di, screen_.x.data() + v);
    hn::Store(hn::NearestInt(hn::IfThenElseZero(plain, sy)), di, screen_.y.data() + v);
    return hn::RebindMask(di, plain);
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
