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

#include "base/highway-inl.h"
#include "base/lanes-inl.h"
#include "raycast/query/queries.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using QF = hn::CappedTag<float, kRayLanes>;
using QI = hn::RebindToSigned<QF>;
using QU = hn::RebindToUnsigned<QF>;
using QV = hn::Vec<QF>;
using QM = hn::Mask<QF>;
constexpr std::size_t kQueryLanes = hn::MaxLanes(QF());
constexpr std::uint32_t kAllLanes = (1u << kQueryLanes) - 1;

HWY_INLINE std::uint32_t QueryBits(QM mask) { return std::uint32_t(frontmost::HWY_NAMESPACE::BitsOf(QF(), mask)); }

/// The least and the greatest of three, in every lane.
HWY_INLINE QV Least(const QV (&x)[3]) { return hn::Min(hn::Min(x[0], x[1]), x[2]); }
HWY_INLINE QV Most(const QV (&x)[3]) { return hn::Max(hn::Max(x[0], x[1]), x[2]); }

/// The triangles that a ray's line certainly passes through (`inside`). `front` has a bit for each triangle that the
/// line passes from the front, and is meaningful only where `inside` is true. The line meets a triangle between the
/// places `from` and `to`, if at all.
struct Passes {
  std::uint32_t front;
  QM inside;
  QV from, to;
};

/// A ray as an axis. A place on the ray is its distance from the origin along the world axis that the ray moves most
/// along.
class RayAxis {
 public:
  explicit RayAxis(const Query& query) {
    const float along[3] = {query.direction.x, query.direction.y, query.direction.z};
    const float origin[3] = {query.origin.x, query.origin.y, query.origin.z};
    const float x = std::abs(along[0]), y = std::abs(along[1]), z = std::abs(along[2]);
    // No branch depends on the direction: they would be mispredicted.
    const int y_or_z = 1 + int(z > y);
    z_ = y_or_z & -int(std::max(y, z) > x);
    u_ = z_ == 2 ? 0 : z_ + 1, v_ = z_ == 0 ? 2 : z_ - 1;
    sign_ = std::copysign(1.0f, along[z_]);
    length_ = std::abs(along[z_]);
    slope_u_ = along[u_] / along[z_];
    slope_v_ = along[v_] / along[z_];
    origin_u_ = origin[u_], origin_v_ = origin[v_], origin_z_ = origin[z_];
  }

  [[nodiscard]] float place_of(float t) const { return t * length_; }
  [[nodiscard]] float t_of(float place) const { return place / length_; }

  /// Triangles sheared along the ray: how their edges turn about the axis, and the vertices' places on it.
  struct Edges {
    QV turn[3], z[3];
    QV least, most;         ///< of the turns
    QV size, error, bound;  ///< of all coordinates; error bounds of places and of turns
  };
  [[nodiscard]] HWY_INLINE Edges EdgesOf(const RayLeaf& leaf, std::size_t first) const {
    const QF d;
    QV u[3], v[3];
    Edges edges;
    QV(&z)[3] = edges.z;
    for (int k = 0; k < 3; ++k) {
      const auto from_origin = [&](int axis, float origin) HWY_ATTR {
        return hn::Sub(hn::Load(d, leaf.corner[k][axis] + first), hn::Set(d, origin));
      };
      z[k] = from_origin(z_, origin_z_);
      u[k] = hn::Sub(from_origin(u_, origin_u_), hn::Mul(z[k], hn::Set(d, slope_u_)));
      v[k] = hn::Sub(from_origin(v_, origin_v_), hn::Mul(z[k], hn::Set(d, slope_v_)));
    }
    const auto turn = [&](int a, int b) HWY_ATTR { return hn::Sub(hn::Mul(u[a], v[b]), hn::Mul(v[a], u[b])); };
    edges.turn[0] = turn(1, 2), edges.turn[1] = turn(2, 0), edges.turn[2] = turn(0, 1);
    const QV wide = hn::Max(Size(u), Size(v)), deep = Size(z);
    edges.size = hn::Max(wide, deep);
    edges.error = hn::Mul(hn::Add(wide, deep), hn::Set(d, 0x1p-20f));
    const QV product = hn::Mul(hn::Add(wide, edges.error), edges.error);
    edges.bound = hn::Add(hn::Mul(product, hn::Set(d, 8.0f)), hn::Set(d, 0x1p-140f));
    edges.least = Least(edges.turn);
    edges.most = Most(edges.turn);
    return edges;
  }

  /// Returns a bit for each triangle that the line may meet. It misses the triangle if two edges certainly turn in
  /// different directions.
  [[nodiscard]] static HWY_INLINE std::uint32_t MayPass(const Edges& edges) {
    const QM missed = hn::And(hn::Gt(edges.most, edges.bound), hn::Lt(edges.least, hn::Neg(edges.bound)));
    return ~QueryBits(missed) & kAllLanes;
  }

  /// Finds where the line meets the triangles: it does if all edges turn about the axis in one direction.
  [[nodiscard]] HWY_INLINE Passes Pass(const Edges& edges) const {
    const QF d;
    const QV(&e)[3] = edges.turn;
    const QV bound = edges.bound, below = hn::Neg(bound), total = hn::Add(hn::Add(e[0], e[1]), e[2]);
    const QM right = hn::Lt(edges.most, below);
    Passes passes;
    passes.front = QueryBits(right) ^ (sign_ < 0 ? kAllLanes : 0);
    passes.inside = hn::And(Serves(edges.size, total), hn::Or(hn::Gt(edges.least, bound), right));
    // The place is the mean of the vertices' places, weighted by turns, each of which may be wrong by `bound`.
    QV z[3];
    for (int k = 0; k < 3; ++k) z[k] = hn::Mul(edges.z[k], hn::Set(d, sign_));
    const QV share = hn::Div(hn::Set(d, 1.0f), total);
    const QV sum = hn::Add(hn::Add(hn::Mul(e[0], z[0]), hn::Mul(e[1], z[1])), hn::Mul(e[2], z[2]));
    const QV nearest = Least(z), farthest = Most(z), place = hn::Mul(sum, share);
    const QV wrong = hn::Mul(hn::Mul(hn::Sub(farthest, nearest), bound), hn::Mul(hn::Abs(share), hn::Set(d, 12.0f)));
    const QV slack = hn::Add(wrong, edges.error);
    const QM inside = passes.inside;
    passes.from = hn::Sub(hn::IfThenElse(inside, hn::Max(hn::Sub(place, slack), nearest), nearest), edges.error);
    passes.to = hn::Add(hn::IfThenElse(inside, hn::Min(hn::Add(place, slack), farthest), farthest), edges.error);
    return passes;
  }

 private:
  /// Returns the triangles that the error bounds hold for. Their sizes are so small that no product overflows and no
  /// turn is NaN, which Least() and Most() may ignore. Their turns are so great that underflow stays within the bounds.
  static HWY_INLINE QM Serves(QV size, QV total) {
    const QF d;
    return hn::And(hn::Lt(size, hn::Set(d, 0x1p40f)), hn::Gt(hn::Abs(total), hn::Set(d, 0x1p-80f)));
  }
  static HWY_INLINE QV Size(const QV (&x)[3]) { return hn::Max(hn::Max(hn::Abs(x[0]), hn::Abs(x[1])), hn::Abs(x[2])); }

  float origin_u_, origin_v_, origin_z_;
  int z_, u_, v_;  ///< the axis that the ray moves most along, and the other two
  float sign_, length_;
  float slope_u_, slope_v_;
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::raycast_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
