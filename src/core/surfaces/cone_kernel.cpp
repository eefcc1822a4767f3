// SPDX-License-Identifier: Apache-2.0
// Makes normal cones, a vector of triangles at a time.
//
// There are two passes over a cluster. The first finds the unit normals, whose bounding box has the axis in its middle;
// the second finds the least cosine between the axis and a normal. A cone must never be too narrow. So a cluster gets
// no cone if rounding could reverse a direction: for needles, boxes without extent, and normals that open to a half
// turn.

#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "surfaces/cluster_set.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surfaces/cone_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/lane_types-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct ConeVector {
  VF x, y, z;
};

HWY_INLINE ConeVector Sub(const ConeVector& a, const ConeVector& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE VF Dot(const ConeVector& a, const ConeVector& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE ConeVector Cross(const ConeVector& a, const ConeVector& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

/// Finds the cones of clusters, one after the other.
class ConeMaker {
 public:
  explicit ConeMaker(const ClusterSet& set) : set_(set) {}

  void Make(std::size_t i, ConeArrays& cones) {
    const Box box = set_.boxes.get(i);
    const glm::vec3 size = box.high - box.low;
    // Lengths are in units of the box: products of four of them neither overflow nor underflow.
    const float widest = HWY_MAX(size.x, HWY_MAX(size.y, size.z)), scale = 1.0f / widest;
    if (!(widest > 0 && widest <= kMost && scale <= kMost)) return Leave(i, cones);
    FindNormals(set_.clusters[i], scale);
    const DF d;
    // A triangle whose normal is mostly rounding error could face either way, so its cluster could never be left out.
    if (!hn::AllFalse(d, too_flat_)) return Leave(i, cones);
    const float squared_altitude = Least(least_squared_altitude_);
    if (squared_altitude == kMost) return Leave(i, cones);  // no triangle has a normal
    const glm::vec3 axis = Axis();
    // If normals cancel out, there is no axis. This is tested here, because Min of NaN and a number depends on the
    // processor.
    if (!(glm::dot(axis, axis) <= kMost)) return Leave(i, cones);
    const float cosine = LeastCosine(axis), altitude = std::sqrt(squared_altitude) * widest;
    if (!(cosine > 0 && altitude > 0 && altitude <= kMost)) return Leave(i, cones);
    cones.x[i] = axis.x, cones.y[i] = axis.y, cones.z[i] = axis.z;
    cones.cosine[i] = cosine;
    cones.altitude[i] = altitude;
  }

  static void Leave(std::size_t i, ConeArrays& cones) {
    cones.x[i] = cones.y[i] = cones.z[i] = cones.cosine[i] = cones.altitude[i] = 0;
  }

 private:
  static constexpr float kMost = std::numeric_limits<float>::max();

  HWY_INLINE ConeVector Fetch(const Cluster& cluster, VI number) const {
    const DF d;
    return {hn::GatherIndex(d, set_.x.data() + cluster.first_vertex, number),
            hn::GatherIndex(d, set_.y.data() + cluster.first_vertex, number),
            hn::GatherIndex(d, set_.z.data() + cluster.first_vertex, number)};
  }
  static HWY_INLINE VI Load(const Buffer<std::uint8_t>& numbers, std::size_t at) {
    const DI d;
    return hn::PromoteTo(d, hn::LoadU(hn::Rebind<std::uint8_t, DI>(), numbers.data() + at));
  }

  /// Finds unit normals, the ranges of their components, and the squared altitudes in units of the box.
  void FindNormals(const Cluster& cluster, float scale) {
    const DF d;
    const VF zero = hn::Zero(d), most = hn::Set(d, kMost);
    low_ = {most, most, most};
    high_ = {hn::Neg(most), hn::Neg(most), hn::Neg(most)};
    least_squared_altitude_ = most;
    too_flat_ = hn::Lt(zero, zero);
    count_ = 0;
    for (std::size_t t = 0; t < cluster.triangle_count; t += hn::Lanes(d)) {
      const std::size_t at = cluster.first_triangle + t;
      const VI i0 = Load(set_.i0, at), i1 = Load(set_.i1, at), i2 = Load(set_.i2, at);
      // Coincident vertices still coincide once they are snapped, so such a triangle is never seen, like padding.
      const MF none = hn::RebindMask(d, hn::Or(hn::Or(hn::Eq(i0, i1), hn::Eq(i1, i2)), hn::Eq(i0, i2)));
      AddNormals(Fetch(cluster, i0), Fetch(cluster, i1), Fetch(cluster, i2), none, scale);
    }
  }

  HWY_INLINE void AddNormals(const ConeVector& a, const ConeVector& b, const ConeVector& c, MF none, float scale) {
    const DF d;
    const VF s = hn::Set(d, scale), most = hn::Set(d, kMost);
    ConeVector ab = Sub(b, a), ac = Sub(c, a);
    ab = {hn::Mul(ab.x, s), hn::Mul(ab.y, s), hn::Mul(ab.z, s)};
    ac = {hn::Mul(ac.x, s), hn::Mul(ac.y, s), hn::Mul(ac.z, s)};
    const ConeVector bc = Sub(ac, ab), normal = Cross(ab, ac);
    const VF squared = Dot(normal, normal);  // square of the product of altitude and longest edge
    const VF longest = hn::Max(Dot(ab, ab), hn::Max(Dot(ac, ac), Dot(bc, bc)));
    // 2^-100 is far above subnormal floats, which have less than full precision.
    const VF least = hn::Max(hn::Mul(hn::Mul(longest, longest), hn::Set(d, 0x1p-24f)), hn::Set(d, 0x1p-100f));
    too_flat_ = hn::Or(too_flat_, hn::AndNot(none, hn::Not(hn::Ge(squared, least))));
    least_squared_altitude_ = hn::Min(least_squared_altitude_, hn::IfThenElse(none, most, hn::Div(squared, longest)));
    const VF inverse = hn::Div(hn::Set(d, 1.0f), hn::Sqrt(squared));
    Put(hn::Mul(normal.x, inverse), none, 0, low_.x, high_.x);
    Put(hn::Mul(normal.y, inverse), none, 1, low_.y, high_.y);
    Put(hn::Mul(normal.z, inverse), none, 2, low_.z, high_.z);
    count_ += hn::Lanes(d);
  }

  HWY_INLINE void Put(VF component, MF none, std::size_t axis, VF& low, VF& high) {
    const DF d;
    const VF most = hn::Set(d, kMost);
    low = hn::Min(low, hn::IfThenElse(none, most, component));
    high = hn::Max(high, hn::IfThenElse(none, hn::Neg(most), component));
    hn::Store(hn::IfThenZeroElse(none, component), d, normals_[axis] + count_);
  }

  static float Least(VF v) {
    const DF d;
    return hn::GetLane(hn::MinOfLanes(d, v));
  }
  static float Greatest(VF v) {
    const DF d;
    return hn::GetLane(hn::MaxOfLanes(d, v));
  }

  /// Axis towards the middle of the bounding box of normals: one differing normal counts as much as many that agree.
  [[nodiscard]] glm::vec3 Axis() const {
    const glm::vec3 middle(Least(low_.x) + Greatest(high_.x), Least(low_.y) + Greatest(high_.y),
                           Least(low_.z) + Greatest(high_.z));
    return middle * (1.0f / std::sqrt(glm::dot(middle, middle)));  // not finite if there is no axis
  }

  [[nodiscard]] float LeastCosine(const glm::vec3& axis) const {
    const DF d;
    const ConeVector a{hn::Set(d, axis.x), hn::Set(d, axis.y), hn::Set(d, axis.z)};
    VF least = hn::Set(d, 1.0f);
    for (std::size_t i = 0; i < count_; i += hn::Lanes(d)) {
      const ConeVector n{hn::Load(d, normals_[0] + i), hn::Load(d, normals_[1] + i), hn::Load(d, normals_[2] + i)};
      const MF none = hn::Eq(Dot(n, n), hn::Zero(d));
      least = hn::Min(least, hn::IfThenElse(none, least, Dot(n, a)));
    }
    return Least(least);
  }

  static constexpr std::size_t kRoom = (Cluster::max_triangles + Cluster::lanes - 1) / Cluster::lanes * Cluster::lanes;

  const ClusterSet& set_;
  HWY_ALIGN_MAX float normals_[3][kRoom];
  std::size_t count_ = 0;
  ConeVector low_, high_;
  VF least_squared_altitude_;
  MF too_flat_;
};

void MakeCones(const ClusterSet& set, std::size_t begin, std::size_t end, ConeArrays& cones) {
  ConeMaker maker(set);
  for (std::size_t i = begin; i < end; ++i) maker.Make(i, cones);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost {

FRONTMOST_KERNELS(MakeCones);

ConeArrays make_cones(const ClusterSet& set, const Execution& execution) {
  constexpr std::size_t kGrain = 256;
  const std::size_t padded = (set.clusters.size() + Cluster::lanes - 1) / Cluster::lanes * Cluster::lanes;
  ConeArrays cones;
  for (Buffer<float>* array : {&cones.x, &cones.y, &cones.z, &cones.cosine, &cones.altitude})
    *array = Buffer<float>(padded, 0.0f);
  const auto make = kernel_for(MakeConesKernels, execution.isa);
  parallel_for(execution, set.clusters.size(), kGrain,
               [&](std::size_t begin, std::size_t end) { make(set, begin, end, cones); });
  return cones;
}

const ConeArrays& LazyCones::get(const ClusterSet& set, const Execution& execution) const {
  if (const ConeArrays* const cones = made()) return *cones;
  // Several threads may come here: all make the same cones, and the first result is kept.
  auto mine = std::make_unique<ConeArrays>(make_cones(set, execution));
  ConeArrays* first = nullptr;
  if (!made_->cones.compare_exchange_strong(first, mine.get())) return *first;
  return *mine.release();
}

void LazyCones::follow(const ClusterSet& set, std::span<const std::uint32_t> clusters, Isa isa) {
  ConeArrays* const cones = made_->cones.load();
  if (cones == nullptr) return;
  const auto make = kernel_for(MakeConesKernels, isa);
  for (const std::uint32_t c : clusters) make(set, c, c + 1, *cones);
}

std::size_t LazyCones::byte_count() const { return made() ? 5 * sizeof(float) * made()->x.size() : 0; }

}  // namespace frontmost
#endif  // HWY_ONCE
