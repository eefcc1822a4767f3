// SPDX-License-Identifier: Apache-2.0
// Tests many triangles against one ray: which triangles the ray misses, and where it passes through the others.
//
//    sheared along the ray       The triangle is moved so that the ray's origin is at zero, and sheared so that the ray
//        v |   c                 runs along one axis of the world. The ray passes through the triangle if zero lies
//          |  / .                inside the sheared vertices: the three edges then turn about zero in one direction.
//     -----o-/---.--- u          All of this is in floats with an error bound; meet() decides the uncertain cases.
//          a-------b

// Included once for every target.
#if defined(FRONTMOST_RAYCAST_RAY_AXIS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_RAYCAST_RAY_AXIS_INL_H_
#undef FRONTMOST_RAYCAST_RAY_AXIS_INL_H_
#else
#define FRONTMOST_RAYCAST_RAY_AXIS_INL_H_
#endif

#include <cmath>

#include "base/compactor-inl.h"
#include "base/highway-inl.h"
#include "base/lanes-inl.h"
#include "raycast/query/queries.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using frontmost::HWY_NAMESPACE::Compactor;

using QF = hn::CappedTag<float, kRayLanes>;
using QI = hn::RebindToSigned<QF>;
using QU = hn::RebindToUnsigned<QF>;
using QV = hn::Vec<QF>;
using QM = hn::Mask<QF>;
constexpr std::size_t kQueryLanes = hn::MaxLanes(QF());

HWY_INLINE std::uint32_t QueryBits(QM mask) { return std::uint32_t(frontmost::HWY_NAMESPACE::BitsOf(QF(), mask)); }

/// Returns how many of `count` values are greater than value i, or equal to it and before it. The values are the bits
/// of floats from 0 on, which have the same order as the floats, even if these overflow to NaN.
HWY_INLINE std::size_t RankOf(const std::int32_t* at, std::size_t count, std::size_t i) {
  const QI d;
  const auto own = hn::Set(d, at[i]);
  std::size_t rank = 0;
  for (std::size_t first = 0; first < count; first += kQueryLanes) {
    const auto others = hn::Load(d, at + first);
    const auto used = hn::FirstN(d, count - first), before = hn::FirstN(d, i > first ? i - first : 0);
    rank += hn::CountTrue(d, hn::And(used, hn::Or(hn::Gt(others, own), hn::And(before, hn::Eq(others, own)))));
  }
  return rank;
}

/// The triangles that the ray's line certainly misses (`beside`), and those that it certainly passes through
/// (`inside`). If the line meets a triangle at all, it does so between the places `from` and `to`.
struct Passes {
  QM beside, inside;
  QV from, to;
};

/// A ray as an axis. A place on the ray is its distance from the origin along the world axis that the ray moves most
/// along.
class RayAxis {
 public:
  explicit RayAxis(const Query& query) : origin_(query.origin) {
    const glm::vec3 size = glm::abs(query.direction);
    z_ = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    u_ = (z_ + 1) % 3, v_ = (z_ + 2) % 3;
    sign_ = query.direction[z_] < 0 ? -1.0f : 1.0f;
    length_ = size[z_];
    slope_u_ = query.direction[u_] / query.direction[z_];
    slope_v_ = query.direction[v_] / query.direction[z_];
  }

  [[nodiscard]] float place_of(float t) const { return t * length_; }
  [[nodiscard]] float t_of(float place) const { return place / length_; }

  /// Tests triangles that are sheared along the ray. The line meets a triangle if all of its edges turn about the axis
  /// in one direction, and misses it if two edges certainly turn in different directions.
  [[nodiscard]] HWY_INLINE Passes Pass(const RayLeaf& leaf, std::size_t first) const {
    const QF d;
    QV u[3], v[3], z[3];
    for (int k = 0; k < 3; ++k) {
      const auto from_origin = [&](int axis) HWY_ATTR {
        return hn::Sub(hn::Load(d, leaf.corner[k][axis] + first), hn::Set(d, origin_[axis]));
      };
      z[k] = from_origin(z_);
      u[k] = hn::Sub(from_origin(u_), hn::Mul(z[k], hn::Set(d, slope_u_)));
      v[k] = hn::Sub(from_origin(v_), hn::Mul(z[k], hn::Set(d, slope_v_)));
      z[k] = hn::Mul(z[k], hn::Set(d, sign_));
    }
    const auto turn = [&](int a, int b) HWY_ATTR { return hn::Sub(hn::Mul(u[a], v[b]), hn::Mul(v[a], u[b])); };
    const QV e[3] = {turn(1, 2), turn(2, 0), turn(0, 1)};
    const QV wide = hn::Max(Size(u), Size(v)), deep = Size(z), total = hn::Add(hn::Add(e[0], e[1]), e[2]);
    const QV error = hn::Mul(hn::Add(wide, deep), hn::Set(d, 0x1p-20f));
    const QV bound = hn::Add(hn::Mul(hn::Mul(hn::Add(wide, error), error), hn::Set(d, 8.0f)), hn::Set(d, 0x1p-140f));
    const QV least = Least(e), most = Most(e), below = hn::Neg(bound);
    const QM inside = hn::And(Serves(hn::Max(wide, deep), total), hn::Or(hn::Gt(least, bound), hn::Lt(most, below)));
    // The place is the mean of the vertices' places, weighted by turns, each of which may be wrong by `bound`.
    const QV share = hn::Div(hn::Set(d, 1.0f), total);
    const QV sum = hn::Add(hn::Add(hn::Mul(e[0], z[0]), hn::Mul(e[1], z[1])), hn::Mul(e[2], z[2]));
    const QV nearest = Least(z), farthest = Most(z), place = hn::Mul(sum, share);
    const QV wrong = hn::Mul(hn::Mul(hn::Sub(farthest, nearest), bound), hn::Mul(hn::Abs(share), hn::Set(d, 12.0f)));
    const QV slack = hn::Add(wrong, error);
    return {hn::And(hn::Gt(most, bound), hn::Lt(least, below)), inside,
            hn::Sub(hn::IfThenElse(inside, hn::Max(hn::Sub(place, slack), nearest), nearest), error),
            hn::Add(hn::IfThenElse(inside, hn::Min(hn::Add(place, slack), farthest), farthest), error)};
  }

 private:
  /// Returns the triangles that the error bounds hold for. Their sizes are so small that no product overflows and no
  /// turn is NaN, which Least() and Most() may ignore. Their turns are so great that underflow stays within the bounds.
  static HWY_INLINE QM Serves(QV size, QV total) {
    const QF d;
    return hn::And(hn::Lt(size, hn::Set(d, 0x1p40f)), hn::Gt(hn::Abs(total), hn::Set(d, 0x1p-80f)));
  }
  static HWY_INLINE QV Least(const QV (&x)[3]) { return hn::Min(hn::Min(x[0], x[1]), x[2]); }
  static HWY_INLINE QV Most(const QV (&x)[3]) { return hn::Max(hn::Max(x[0], x[1]), x[2]); }
  static HWY_INLINE QV Size(const QV (&x)[3]) { return hn::Max(hn::Max(hn::Abs(x[0]), hn::Abs(x[1])), hn::Abs(x[2])); }

  glm::vec3 origin_;
  int z_ = 2, u_ = 0, v_ = 1;  ///< the axis that the ray moves most along, and the other two
  float sign_ = 1, length_ = 1;
  float slope_u_ = 0, slope_v_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::raycast_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
