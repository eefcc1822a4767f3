// SPDX-License-Identifier: Apache-2.0
// Culling of clusters, as many at a time as the vector holds: by the frustum, over the eight corners of their boxes,
// and by facing.

#include "zbuffer/cull.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/cull_kernel.cpp"
#include "base/isa.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<DF>;
using VF = hn::Vec<DF>;
using MF = hn::Mask<DF>;

// A vertex and its box are transformed by the same formula, but round differently. Relative to the sum of the absolute
// values of all terms, either errs by less than 6 * 2^-24; this is four times the sum of both.
constexpr float kRoundingBound = 48.0f / 16777216.0f;

/// One row of the transform. `offset_terms` is the sum of the absolute values of what makes the offset.
struct RowTerms {
  float a, b, c, offset, offset_terms;
};

/// What of the eye a float cannot hold. No float, hence no vertex, is nearer to the eye in any coordinate.
glm::vec3 RestOfEye(const ScreenTransform& t, const View& view) {
  return glm::vec3(view.eye() - glm::dvec3(t.eye[0], t.eye[1], t.eye[2]));
}

RowTerms MakeRow(const std::array<float, 3>& row, float offset, const glm::vec3& rest) {
  const glm::vec3 terms = glm::abs(glm::vec3(row[0], row[1], row[2]) * rest);
  const float sum = terms.x + terms.y + terms.z;
  return {row[0], row[1], row[2], offset, std::abs(offset) + 2 * sum};
}

struct Vector3 {
  VF x, y, z;
};

struct Reach {
  VF ax, ay, az;  // the greatest |position - eye| over the box, by axis
};

HWY_INLINE VF Row(const RowTerms& row, VF dx, VF dy, VF dz) {
  const DF d;
  const VF x = hn::Mul(hn::Set(d, row.a), dx), y = hn::Mul(hn::Set(d, row.b), dy), z = hn::Mul(hn::Set(d, row.c), dz);
  return hn::Add(hn::Add(hn::Add(x, y), z), hn::Set(d, row.offset));
}

HWY_INLINE VF Margin(const RowTerms& row, const Reach& reach) {
  const DF d;
  const VF x = hn::Mul(hn::Abs(hn::Set(d, row.a)), reach.ax), y = hn::Mul(hn::Abs(hn::Set(d, row.b)), reach.ay);
  const VF z = hn::Mul(hn::Abs(hn::Set(d, row.c)), reach.az), w = hn::Set(d, row.offset_terms);
  return hn::Mul(hn::Set(d, kRoundingBound), hn::Add(hn::Add(x, y), hn::Add(z, w)));
}

/// Pixel of a coordinate from the image's centre in 1/256 pixel, clamped to [0, last].
HWY_INLINE hn::Vec<DI> ToPixel(VF from_centre, std::int32_t centre, std::int32_t last) {
  const DF d;
  const VF limit = hn::Set(d, float(kGuardBand));
  const VF clamped = hn::Min(hn::Max(from_centre, hn::Neg(limit)), limit);
  const DI di;
  const auto fixed = hn::Add(hn::ConvertTo(di, hn::Floor(clamped)), hn::Set(di, centre));
  return hn::Min(hn::Max(hn::ShiftRight<8>(fixed), hn::Zero(di)), hn::Set(di, last));
}

// Facing. What decides is the sign of the area of the snapped triangle, and snapping can turn a triangle over. It can
// not where every corner moves by at most e and no altitude of the triangle on the screen is less than 2 e: on the way
// the corners would have to come to lie on one line, which would have passed within e of all three.
//
// How high is it on the screen? Let a triangle with normal N (|N| is twice its area), corners P, Q, R, the eye at E,
// and f the lesser of the scales of x and y, in snapped units per unit at distance 1; W(P) is the planar distance of P.
// Twice its area on the screen, scaled alike both ways, is f^2 |N.(P-E)| / (W(P) W(Q) W(R)). The edge PQ becomes
// f |(P-E) W(Q) - (Q-E) W(P)| / (W(P) W(Q)) long, and the numerator, a cross product of the axis and (P-E)x(Q-E), is at
// most f |P-E| |PQ|. Hence the altitude on the image of PQ is at least
//     f |N.(P-E)| / (|PQ| |P-E| W(R))  >=  f * altitude * sine / W,
// where `altitude` is the triangle's least in space, `sine` that of the angle between its plane and the ray to P, and W
// the greatest planar distance; a greater scale in one direction makes nothing thinner. In parallel projection it is
// the same with W = 1 and the axis for the ray.
//
// Over a cluster: for p in the box and the cone's axis A, m = min A.(p-E) is taken at a corner, and with |p-E| <= R all
// rays make an angle of cosine at least m/R with A. A normal may lean by the cone's half angle from A, so its cosine to
// the ray, the sine above, is at least cos m/R - sin sqrt(1 - (m/R)^2).
//
// Margins: that cosine may be less by kFacingRounding, which is kConeRounding and what rounding here adds (a few
// 2^-24). The corner's error is at most what pads the pixel rectangle, which counts snapping twice and rounding four
// times. This leaves a factor of two for poses that are a rotation only to 1e-4.
constexpr float kFacingRounding = kConeRounding + 1.0f / 1024.0f;

/// The ray to what faces away, and what the altitude on the screen is compared with.
struct Rays {
  Vector3 low, high;  // range of p - E over the box; in parallel projection the axis, twice
  VF farthest;        // |p - E|, at most
  VF needed;          // altitude * sine, at least
};

class FacingCull {
 public:
  FacingCull(const ConeArrays& cones, Culling culling)
      : cones_(cones), sign_(culling == Culling::front ? -1.0f : 1.0f) {}

  /// Clusters of which no triangle faces the side that is to be seen. NaN compares false, which keeps the cluster.
  [[nodiscard]] HWY_INLINE MF TurnedAway(std::size_t i, const Rays& rays) const {
    const DF d;
    const VF sign = hn::Set(d, sign_), one = hn::Set(d, 1.0f), zero = hn::Zero(d);
    const VF x = hn::Mul(hn::Load(d, cones_.x.data() + i), sign);
    const VF y = hn::Mul(hn::Load(d, cones_.y.data() + i), sign);
    const VF z = hn::Mul(hn::Load(d, cones_.z.data() + i), sign);
    const VF along_x = hn::Min(hn::Mul(x, rays.low.x), hn::Mul(x, rays.high.x));
    const VF along_y = hn::Min(hn::Mul(y, rays.low.y), hn::Mul(y, rays.high.y));
    const VF along_z = hn::Min(hn::Mul(z, rays.low.z), hn::Mul(z, rays.high.z));
    const VF m = hn::Div(hn::Add(hn::Add(along_x, along_y), along_z), rays.farthest);
    const VF cosine = hn::Load(d, cones_.cosine.data() + i);
    const VF lean = hn::Mul(hn::Sub(one, hn::Mul(cosine, cosine)), hn::Sub(one, hn::Mul(m, m)));
    const VF sine = hn::Sub(hn::Mul(cosine, m), hn::Sqrt(hn::Max(lean, zero)));
    const VF certain = hn::Mul(hn::Sub(sine, hn::Set(d, kFacingRounding)), hn::Load(d, cones_.altitude.data() + i));
    return hn::And(hn::Gt(m, zero), hn::Gt(certain, rays.needed));
  }

 private:
  const ConeArrays& cones_;
  float sign_;
};

class Cull {
 public:
  Cull(const CullInput& input, const ScreenTransform& transform, const View& for_view)
      : t(transform), view(for_view), boxes(input.boxes), cones(input.cones), rest(RestOfEye(transform, for_view)) {
    const Projection& p = view.projection;
    const double x = view.width / (p.right - p.left), y = view.height / (p.top - p.bottom);
    inverse_scale = float(1 / (std::min(x, y) * kSubPixels));
  }

  HWY_INLINE void Group(std::size_t i, CullResult& out) const {
    const DF d;
    const DI di;
    const VF lx = hn::Load(d, boxes.low_x.data() + i), hx = hn::Load(d, boxes.high_x.data() + i);
    const VF ly = hn::Load(d, boxes.low_y.data() + i), hy = hn::Load(d, boxes.high_y.data() + i);
    const VF lz = hn::Load(d, boxes.low_z.data() + i), hz = hn::Load(d, boxes.high_z.data() + i);
    const VF ex = hn::Set(d, t.eye[0]), ey = hn::Set(d, t.eye[1]), ez = hn::Set(d, t.eye[2]);
    const VF xs[2] = {hn::Sub(lx, ex), hn::Sub(hx, ex)};
    const VF ys[2] = {hn::Sub(ly, ey), hn::Sub(hy, ey)};
    const VF zs[2] = {hn::Sub(lz, ez), hn::Sub(hz, ez)};
    const Reach reach{hn::Max(hn::Abs(xs[0]), hn::Abs(xs[1])), hn::Max(hn::Abs(ys[0]), hn::Abs(ys[1])),
                      hn::Max(hn::Abs(zs[0]), hn::Abs(zs[1]))};
    const VF x_margin = Margin(x_row, reach), y_margin = Margin(y_row, reach), d_margin = Margin(d_row, reach);

    // Over the corners: range of D, the greatest signed distance to each side of the frustum, range of X/W and Y/W.
    const VF half_x = hn::Set(d, float(t.centre_x)), half_y = hn::Set(d, float(t.centre_y));
    const VF infinity = hn::Set(d, std::numeric_limits<float>::infinity());
    VF d_min = infinity, d_max = hn::Neg(infinity);
    VF left = d_max, right = d_max, top = d_max, bottom = d_max;
    VF x_min = infinity, x_max = d_max, y_min = infinity, y_max = d_max;
    for (int corner = 0; corner < 8; ++corner) {
      const VF dx = xs[corner & 1], dy = ys[(corner >> 1) & 1], dz = zs[corner >> 2];
      const VF x = Row(x_row, dx, dy, dz), y = Row(y_row, dx, dy, dz), depth = Row(d_row, dx, dy, dz);
      const VF w = t.orthographic ? hn::Set(d, 1.0f) : depth;
      d_min = hn::Min(d_min, depth);
      d_max = hn::Max(d_max, depth);
      const VF wx = hn::Mul(half_x, w), wy = hn::Mul(half_y, w);
      left = hn::Max(left, hn::Add(wx, x));
      right = hn::Max(right, hn::Sub(wx, x));
      top = hn::Max(top, hn::Add(wy, y));
      bottom = hn::Max(bottom, hn::Sub(wy, y));
      const VF inverse = hn::Div(hn::Set(d, 1.0f), w);
      const VF sx = hn::Mul(x, inverse), sy = hn::Mul(y, inverse);
      x_min = hn::Min(x_min, sx);
      x_max = hn::Max(x_max, sx);
      y_min = hn::Min(y_min, sy);
      y_max = hn::Max(y_max, sy);
    }

    // Outside: strictly, and by more than rounding can explain. NaN compares false, which keeps the cluster.
    const VF w_margin = t.orthographic ? hn::Zero(d) : d_margin;
    const VF x_slack = hn::Neg(hn::Add(x_margin, hn::Mul(half_x, w_margin)));
    const VF y_slack = hn::Neg(hn::Add(y_margin, hn::Mul(half_y, w_margin)));
    const VF nearest_d = hn::Sub(d_min, d_margin), farthest_d = hn::Add(d_max, d_margin);
    const VF near = hn::Set(d, t.near), far = hn::Set(d, t.far);
    // One pixel more on every side: samples sit inside pixels, and snapping moves by half a unit.
    const VF pixel = hn::Set(d, 2.0f * kSubPixels);
    const VF x_out = hn::Sub(x_slack, hn::Mul(pixel, hn::Abs(farthest_d)));
    const VF y_out = hn::Sub(y_slack, hn::Mul(pixel, hn::Abs(farthest_d)));
    const VF x_limit = t.orthographic ? hn::Sub(x_slack, pixel) : x_out;
    const VF y_limit = t.orthographic ? hn::Sub(y_slack, pixel) : y_out;
    MF outside = hn::Or(hn::Lt(farthest_d, near), hn::Gt(nearest_d, far));
    outside = hn::Or(outside, hn::Or(hn::Lt(left, x_limit), hn::Lt(right, x_limit)));
    outside = hn::Or(outside, hn::Or(hn::Lt(top, y_limit), hn::Lt(bottom, y_limit)));
    outside = hn::Or(outside, hn::Lt(hx, lx));  // empty

    // Whole: between the planes, and within the guard band, with the margins.
    const VF w_min = t.orthographic ? hn::Set(d, 1.0f) : nearest_d;
    const VF inverse_min = hn::Div(hn::Set(d, 1.0f), w_min);
    const VF x_most = hn::Max(hn::Abs(x_min), hn::Abs(x_max)), y_most = hn::Max(hn::Abs(y_min), hn::Abs(y_max));
    const VF round = hn::Set(d, kRoundingBound);
    const VF one = hn::Set(d, 1.0f);
    const VF x_pad = hn::Add(
        hn::Add(hn::Mul(hn::Add(x_margin, hn::Mul(x_most, w_margin)), inverse_min), hn::Mul(x_most, round)), one);
    const VF y_pad = hn::Add(
        hn::Add(hn::Mul(hn::Add(y_margin, hn::Mul(y_most, w_margin)), inverse_min), hn::Mul(y_most, round)), one);
    const VF guard = hn::Set(d, float(kGuardBand));
    MF whole = hn::And(hn::Ge(nearest_d, near), hn::Le(farthest_d, far));
    whole = hn::And(whole, hn::And(hn::Lt(hn::Add(x_most, x_pad), guard), hn::Lt(hn::Add(y_most, y_pad), guard)));

    // No key is greater than that of the nearest distance, give or take its own rounding.
    const VF key =
        t.orthographic ? hn::Mul(hn::Sub(far, nearest_d), hn::Set(d, t.inverse_range)) : hn::Mul(near, inverse_min);
    hn::StoreU(hn::Mul(key, hn::Set(d, 1.0f + kRoundingBound)), d, out.nearest.data() + i);

    hn::StoreU(ToPixel(hn::Sub(x_min, x_pad), t.centre_x, view.width - 1), di, out.x0.data() + i);
    hn::StoreU(ToPixel(hn::Add(x_max, x_pad), t.centre_x, view.width - 1), di, out.x1.data() + i);
    hn::StoreU(ToPixel(hn::Sub(y_min, y_pad), t.centre_y, view.height - 1), di, out.y0.data() + i);
    hn::StoreU(ToPixel(hn::Add(y_max, y_pad), t.centre_y, view.height - 1), di, out.y1.data() + i);

    HWY_ALIGN std::int32_t fates[hn::MaxLanes(DI())];
    const auto apart = hn::Set(di, std::int32_t(ClusterFate::apart));
    const auto fate = hn::IfThenElse(hn::RebindMask(di, whole), hn::Set(di, std::int32_t(ClusterFate::whole)), apart);
    if (cones != nullptr) {
      const Vector3 low{xs[0], ys[0], zs[0]}, high{xs[1], ys[1], zs[1]};
      const VF error = hn::Sqrt(hn::Add(hn::Mul(x_pad, x_pad), hn::Mul(y_pad, y_pad)));
      const Rays rays = t.orthographic ? ParallelRays(error) : RaysFromEye(low, high, error, farthest_d);
      outside = hn::Or(outside, hn::And(whole, FacingCull(*cones, view.culling).TurnedAway(i, rays)));
    }
    hn::Store(hn::IfThenZeroElse(hn::RebindMask(di, outside), fate), di, fates);
    for (std::size_t k = 0; k < hn::Lanes(di); ++k) out.fate[i + k] = static_cast<std::uint8_t>(fates[k]);
  }

 private:
  /// `low` and `high` are from the eye as a float, `error` is of a corner on the screen.
  [[nodiscard]] HWY_INLINE Rays RaysFromEye(const Vector3& low, const Vector3& high, VF error, VF farthest_d) const {
    const DF d;
    const VF rest_x = hn::Set(d, rest.x), rest_y = hn::Set(d, rest.y), rest_z = hn::Set(d, rest.z);
    Rays rays;
    rays.low = {hn::Sub(low.x, rest_x), hn::Sub(low.y, rest_y), hn::Sub(low.z, rest_z)};
    rays.high = {hn::Sub(high.x, rest_x), hn::Sub(high.y, rest_y), hn::Sub(high.z, rest_z)};
    const VF x = hn::Max(hn::Abs(rays.low.x), hn::Abs(rays.high.x));
    const VF y = hn::Max(hn::Abs(rays.low.y), hn::Abs(rays.high.y));
    const VF z = hn::Max(hn::Abs(rays.low.z), hn::Abs(rays.high.z));
    rays.farthest = hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z)));
    rays.needed = hn::Mul(hn::Mul(error, farthest_d), hn::Set(d, 2 * inverse_scale));
    return rays;
  }
  [[nodiscard]] HWY_INLINE Rays ParallelRays(VF error) const {
    const DF d;
    const Vector3 axis{hn::Set(d, t.d_row[0]), hn::Set(d, t.d_row[1]), hn::Set(d, t.d_row[2])};
    const float length = glm::length(glm::vec3(t.d_row[0], t.d_row[1], t.d_row[2]));
    return {axis, axis, hn::Set(d, length), hn::Mul(error, hn::Set(d, 2 * inverse_scale))};
  }

  const ScreenTransform& t;
  const View& view;
  const BoxArrays& boxes;
  const ConeArrays* cones;
  glm::vec3 rest;
  float inverse_scale;  // units at distance 1 per snapped unit
  RowTerms x_row = MakeRow(t.x_row, t.x_offset, rest);
  RowTerms y_row = MakeRow(t.y_row, t.y_offset, rest);
  RowTerms d_row = MakeRow(t.d_row, t.d_offset, rest);
};

void CullRange(const CullInput& input, const ScreenTransform& transform, const View& view, std::size_t begin,
               std::size_t end, CullResult& result) {
  const Cull cull(input, transform, view);
  for (std::size_t i = begin; i < end; i += hn::Lanes(DF())) cull.Group(i, result);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::zbuffer_detail {

FRONTMOST_KERNELS(CullRange);

void CullResult::resize(std::size_t cluster_count) {
  const std::size_t padded = (cluster_count + Cluster::lanes - 1) / Cluster::lanes * Cluster::lanes;
  fate.resize(padded);
  for (auto* side : {&x0, &y0, &x1, &y1}) side->resize(padded);
  nearest.resize(padded);
}

void cull_clusters(const CullInput& input, const ScreenTransform& transform, const View& view, Isa isa,
                   std::size_t begin, std::size_t end, CullResult& result) {
  kernel_for(CullRangeKernels, isa)(input, transform, view, begin, end, result);
}

}  // namespace frontmost::zbuffer_detail
#endif  // HWY_ONCE
