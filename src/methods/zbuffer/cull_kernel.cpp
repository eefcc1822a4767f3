// SPDX-License-Identifier: Apache-2.0
// Culls clusters, a vector of clusters at a time: by the frustum, against which the eight corners of their boxes are
// tested, and by facing.
//
// Boxes are stored as columns, so a vector of clusters is tested at once. The same eight corners also give the pixel
// rectangle and the nearest key, by which clusters are ordered and binned afterwards.

#include "zbuffer/frame_plan.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/cull_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/lane_types-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::HWY_NAMESPACE;

// A vertex and its box are transformed by the same formula, but round differently. Each of the two errors is less than
// 6 * 2^-24 of the sum of the absolute values of all terms. This bound is four times the sum of both errors.
constexpr float kRoundingBound = 48.0f / 16777216.0f;

/// One row of the transform. `offset_terms` is what the offset adds to the sum that kRoundingBound is relative to.
struct RowTerms {
  float a, b, c, offset, offset_terms;
};

/// Returns the eye's position minus this position rounded to floats. No float is nearer to the eye in any coordinate
/// than the rounded position, so no vertex is.
glm::vec3 RestOfEye(const ScreenTransform& t, const View& view) {
  return glm::vec3(view.eye() - glm::dvec3(t.eye[0], t.eye[1], t.eye[2]));
}

/// Makes a row. The offset includes the rest of the eye, which was multiplied by the row in doubles and then rounded.
/// Twice the absolute terms of this product bound both errors.
RowTerms MakeRow(const std::array<float, 3>& row, float offset, const glm::vec3& rest) {
  const glm::vec3 terms = glm::abs(glm::vec3(row[0], row[1], row[2]) * rest);
  const float sum = terms.x + terms.y + terms.z;
  return {row[0], row[1], row[2], offset, std::abs(offset) + 2 * sum};
}

struct CullVector {
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

/// Returns the pixel of a coordinate, clamped to [0, last]. The coordinate is in 1/256 pixel from the image's centre.
/// It is limited before conversion, because floats beyond the range of integers convert to different values on
/// different machines.
HWY_INLINE hn::Vec<DI> ToPixel(VF from_centre, std::int32_t centre, std::int32_t last) {
  const DF d;
  const VF limit = hn::Set(d, float(kGuardBand));
  const VF clamped = hn::Min(hn::Max(from_centre, hn::Neg(limit)), limit);
  const DI di;
  const auto fixed = hn::Add(hn::ConvertTo(di, hn::Floor(clamped)), hn::Set(di, centre));
  return hn::Min(hn::Max(hn::ShiftRight<8>(fixed), hn::Zero(di)), hn::Set(di, last));
}

// The sign of the area of the snapped triangle decides its facing, and snapping can turn a triangle over. Snapping
// cannot do so if it moves every vertex by at most e, and no altitude of the triangle on the screen is less than 2 e.
// This is because a triangle turns over only when its vertices pass through one line, and that line is within e of all
// three.
//
// How high is the triangle on the screen? Take a triangle with normal N (|N| is twice its area), vertices P, Q, R, the
// eye at E, and f the lesser of the scales of x and y, in snapped units per unit at distance 1. W(P) is the planar
// distance of P. If x and y are both scaled by f, twice the area on the screen is f^2 |N.(P-E)| / (W(P) W(Q) W(R)). The
// edge PQ
// becomes f |(P-E) W(Q) - (Q-E) W(P)| / (W(P) W(Q)) long. The numerator, a cross product of the axis and (P-E)x(Q-E),
// is at most f |P-E| |PQ|. Hence the altitude on the image of PQ is at least
//     f |N.(P-E)| / (|PQ| |P-E| W(R))  >=  f * altitude * sine / W,
// where `altitude` is the triangle's least altitude in space, `sine` is the sine of the angle between its plane and the
// ray to P, and W is the greatest planar distance. A greater scale in one direction makes no triangle thinner. Parallel
// projection has the same bound with W = 1 and the axis for the ray.
//
// For all triangles of a cluster: let A be the cone's axis, and c and s the cosine and sine of the cone's half angle.
// Over all points p of the box, A.(p-E) takes its minimum m at a corner. With |p-E| <= R, all rays make an angle of
// cosine at least m/R with A. A normal deviates from A by at most the half angle. So the cosine between normal and ray,
// which is the sine above, is at least c m/R - s sqrt(1 - (m/R)^2).
//
// Rounding may lower that cosine by kFacingRounding, the sum of kConeRounding and the rounding here (a few 2^-24). The
// vertex error is at most the padding of the pixel rectangle, which counts snapping twice and rounding four times. This
// leaves a factor of two for poses whose matrix is a rotation only to 1e-4.
constexpr float kFacingRounding = kConeRounding + 1.0f / 1024.0f;

/// The rays from the eye to the points of a box, and the size that a triangle needs so that snapping and rounding
/// cannot turn it over.
struct Rays {
  CullVector low, high;  // range of p - E over the box; in parallel projection both are the axis
  VF farthest;           // upper bound of |p - E|
  VF needed;             // a triangle with a greater altitude * sine is not turned over
};

class FacingCull {
 public:
  FacingCull(const ConeArrays& cones, Culling culling)
      : cones_(cones), sign_(culling == Culling::front ? -1.0f : 1.0f) {}

  /// Returns the clusters whose triangles all face away and are culled. NaN compares false, which keeps the cluster.
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
  explicit Cull(const CullInput& input)
      : t(input.transform),
        view(input.view),
        boxes(input.boxes),
        cones(input.cones),
        rest(RestOfEye(input.transform, input.view)) {
    const Projection& p = view.projection;
    const double x = view.width / (p.right - p.left), y = view.height / (p.top - p.bottom);
    inverse_scale = float(1 / (std::min(x, y) * kSubPixels));
  }

  HWY_INLINE void Group(std::size_t i, CullResult& out) const {
    const DF d;
    const Offsets from_eye = OffsetsOf(i);
    const Margins margin = MarginsOf(from_eye);
    const Extent e = ExtentOf(from_eye, margin);
    const Pads pad = PadsOf(e, margin);
    const MF empty = hn::Lt(hn::Load(d, boxes.high_x.data() + i), hn::Load(d, boxes.low_x.data() + i));
    MF outside = hn::Or(empty, Outside(e, margin));
    const MF whole = Whole(e, pad);
    if (cones != nullptr) {
      const VF error = hn::Sqrt(hn::Add(hn::Mul(pad.x, pad.x), hn::Mul(pad.y, pad.y)));
      const Rays rays = t.orthographic ? ParallelRays(error) : RaysFromEye(from_eye, error, e.farthest);
      outside = hn::Or(outside, hn::And(whole, FacingCull(*cones, view.culling).TurnedAway(i, rays)));
    }
    StorePlace(i, e, pad, out);
    StoreFates(i, outside, whole, out);
  }

 private:
  /// Lower and upper sides of the boxes, relative to the eye rounded to floats.
  struct Offsets {
    VF x[2], y[2], z[2];
  };
  /// Bounds of the rounding of X, Y, D and W.
  struct Margins {
    VF x, y, d, w;
  };
  /// Extremes over the eight corners: of D, with its margin added; of the signed distance to each side of the frustum
  /// (the greatest, positive inside); of X/W and Y/W.
  struct Extent {
    VF nearest, farthest;
    VF left, right, top, bottom;
    VF x_min, x_max, y_min, y_max;
  };
  /// Bounds of the error of X/W and Y/W, snapping included, and 1/W of the nearest point.
  struct Pads {
    VF x, y, inverse_nearest;
  };

  [[nodiscard]] HWY_INLINE Offsets OffsetsOf(std::size_t i) const {
    const DF d;
    const VF ex = hn::Set(d, t.eye[0]), ey = hn::Set(d, t.eye[1]), ez = hn::Set(d, t.eye[2]);
    return {{hn::Sub(hn::Load(d, boxes.low_x.data() + i), ex), hn::Sub(hn::Load(d, boxes.high_x.data() + i), ex)},
            {hn::Sub(hn::Load(d, boxes.low_y.data() + i), ey), hn::Sub(hn::Load(d, boxes.high_y.data() + i), ey)},
            {hn::Sub(hn::Load(d, boxes.low_z.data() + i), ez), hn::Sub(hn::Load(d, boxes.high_z.data() + i), ez)}};
  }

  [[nodiscard]] HWY_INLINE Margins MarginsOf(const Offsets& o) const {
    const Reach reach{hn::Max(hn::Abs(o.x[0]), hn::Abs(o.x[1])), hn::Max(hn::Abs(o.y[0]), hn::Abs(o.y[1])),
                      hn::Max(hn::Abs(o.z[0]), hn::Abs(o.z[1]))};
    const VF depth = Margin(d_row, reach);
    return {Margin(x_row, reach), Margin(y_row, reach), depth, t.orthographic ? hn::Zero(DF()) : depth};
  }

  [[nodiscard]] HWY_INLINE Extent ExtentOf(const Offsets& o, const Margins& margin) const {
    const DF d;
    const VF half_x = hn::Set(d, float(t.centre_x)), half_y = hn::Set(d, float(t.centre_y));
    const VF most = hn::Set(d, std::numeric_limits<float>::infinity()), least = hn::Neg(most);
    Extent e{most, least, least, least, least, least, most, least, most, least};
    for (int corner = 0; corner < 8; ++corner) {
      const VF dx = o.x[corner & 1], dy = o.y[(corner >> 1) & 1], dz = o.z[corner >> 2];
      const VF x = Row(x_row, dx, dy, dz), y = Row(y_row, dx, dy, dz), depth = Row(d_row, dx, dy, dz);
      const VF w = t.orthographic ? hn::Set(d, 1.0f) : depth;
      e.nearest = hn::Min(e.nearest, depth);
      e.farthest = hn::Max(e.farthest, depth);
      // A corner is inside the left side if X >= -W * half the width, and so on. The test has no division, so it also
      // serves corners behind the eye.
      const VF wx = hn::Mul(half_x, w), wy = hn::Mul(half_y, w);
      e.left = hn::Max(e.left, hn::Add(wx, x));
      e.right = hn::Max(e.right, hn::Sub(wx, x));
      e.top = hn::Max(e.top, hn::Add(wy, y));
      e.bottom = hn::Max(e.bottom, hn::Sub(wy, y));
      // These values are meaningless for corners that are not in front of the eye. Whole() then fails because of
      // `nearest`, so the values are not used.
      const VF inverse = hn::Div(hn::Set(d, 1.0f), w);
      const VF sx = hn::Mul(x, inverse), sy = hn::Mul(y, inverse);
      e.x_min = hn::Min(e.x_min, sx);
      e.x_max = hn::Max(e.x_max, sx);
      e.y_min = hn::Min(e.y_min, sy);
      e.y_max = hn::Max(e.y_max, sy);
    }
    e.nearest = hn::Sub(e.nearest, margin.d);
    e.farthest = hn::Add(e.farthest, margin.d);
    return e;
  }

  /// Returns the boxes that lie outside one side of the frustum by more than rounding can explain. NaN compares false,
  /// which keeps the cluster.
  [[nodiscard]] HWY_INLINE MF Outside(const Extent& e, const Margins& margin) const {
    const DF d;
    const VF half_x = hn::Set(d, float(t.centre_x)), half_y = hn::Set(d, float(t.centre_y));
    // Two pixels of margin on every side suffice, because samples lie inside pixels and snapping moves a vertex by half
    // a unit.
    const VF two_pixels = hn::Set(d, 2.0f * kSubPixels);
    const VF pixel = t.orthographic ? two_pixels : hn::Mul(two_pixels, hn::Abs(e.farthest));
    const VF x_limit = hn::Neg(hn::Add(hn::Add(margin.x, hn::Mul(half_x, margin.w)), pixel));
    const VF y_limit = hn::Neg(hn::Add(hn::Add(margin.y, hn::Mul(half_y, margin.w)), pixel));
    const MF beyond = hn::Or(hn::Lt(e.farthest, hn::Set(d, t.near)), hn::Gt(e.nearest, hn::Set(d, t.far)));
    const MF beside = hn::Or(hn::Lt(e.left, x_limit), hn::Lt(e.right, x_limit));
    return hn::Or(beyond, hn::Or(beside, hn::Or(hn::Lt(e.top, y_limit), hn::Lt(e.bottom, y_limit))));
  }

  [[nodiscard]] HWY_INLINE Pads PadsOf(const Extent& e, const Margins& margin) const {
    const DF d;
    const VF inverse = hn::Div(hn::Set(d, 1.0f), t.orthographic ? hn::Set(d, 1.0f) : e.nearest);
    const auto pad = [&](VF most, VF of_row) HWY_ATTR {
      const VF rounding = hn::Mul(hn::Add(of_row, hn::Mul(most, margin.w)), inverse);
      return hn::Add(hn::Add(rounding, hn::Mul(most, hn::Set(d, kRoundingBound))), hn::Set(d, 1.0f));
    };
    return {pad(hn::Max(hn::Abs(e.x_min), hn::Abs(e.x_max)), margin.x),
            pad(hn::Max(hn::Abs(e.y_min), hn::Abs(e.y_max)), margin.y), inverse};
  }

  /// Returns the boxes between the near and far planes and within the guard band, margins included.
  [[nodiscard]] HWY_INLINE MF Whole(const Extent& e, const Pads& pad) const {
    const DF d;
    const VF guard = hn::Set(d, float(kGuardBand));
    const VF x_most = hn::Max(hn::Abs(e.x_min), hn::Abs(e.x_max)), y_most = hn::Max(hn::Abs(e.y_min), hn::Abs(e.y_max));
    const MF between = hn::And(hn::Ge(e.nearest, hn::Set(d, t.near)), hn::Le(e.farthest, hn::Set(d, t.far)));
    return hn::And(between, hn::And(hn::Lt(hn::Add(x_most, pad.x), guard), hn::Lt(hn::Add(y_most, pad.y), guard)));
  }

  /// Stores the pixel rectangle and the nearest key, which is the key of the nearest distance with a margin for
  /// rounding.
  HWY_INLINE void StorePlace(std::size_t i, const Extent& e, const Pads& pad, CullResult& out) const {
    const DF d;
    const DI di;
    const VF key = t.orthographic ? hn::Mul(hn::Sub(hn::Set(d, t.far), e.nearest), hn::Set(d, t.inverse_range))
                                  : hn::Mul(hn::Set(d, t.near), pad.inverse_nearest);
    hn::StoreU(hn::Mul(key, hn::Set(d, 1.0f + kRoundingBound)), d, out.nearest.data() + i);
    hn::StoreU(ToPixel(hn::Sub(e.x_min, pad.x), t.centre_x, view.width - 1), di, out.x0.data() + i);
    hn::StoreU(ToPixel(hn::Add(e.x_max, pad.x), t.centre_x, view.width - 1), di, out.x1.data() + i);
    hn::StoreU(ToPixel(hn::Sub(e.y_min, pad.y), t.centre_y, view.height - 1), di, out.y0.data() + i);
    hn::StoreU(ToPixel(hn::Add(e.y_max, pad.y), t.centre_y, view.height - 1), di, out.y1.data() + i);
  }

  static HWY_INLINE void StoreFates(std::size_t i, MF outside, MF whole, CullResult& out) {
    const DI di;
    HWY_ALIGN std::int32_t fates[hn::MaxLanes(DI())];
    const auto apart = hn::Set(di, std::int32_t(ClusterFate::apart));
    const auto fate = hn::IfThenElse(hn::RebindMask(di, whole), hn::Set(di, std::int32_t(ClusterFate::whole)), apart);
    hn::Store(hn::IfThenZeroElse(hn::RebindMask(di, outside), fate), di, fates);
    for (std::size_t k = 0; k < hn::Lanes(di); ++k) out.fate[i + k] = static_cast<std::uint8_t>(fates[k]);
  }

  /// `error` bounds the error of a vertex on the screen.
  [[nodiscard]] HWY_INLINE Rays RaysFromEye(const Offsets& o, VF error, VF farthest_d) const {
    const DF d;
    const VF rest_x = hn::Set(d, rest.x), rest_y = hn::Set(d, rest.y), rest_z = hn::Set(d, rest.z);
    Rays rays;
    rays.low = {hn::Sub(o.x[0], rest_x), hn::Sub(o.y[0], rest_y), hn::Sub(o.z[0], rest_z)};
    rays.high = {hn::Sub(o.x[1], rest_x), hn::Sub(o.y[1], rest_y), hn::Sub(o.z[1], rest_z)};
    const VF x = hn::Max(hn::Abs(rays.low.x), hn::Abs(rays.high.x));
    const VF y = hn::Max(hn::Abs(rays.low.y), hn::Abs(rays.high.y));
    const VF z = hn::Max(hn::Abs(rays.low.z), hn::Abs(rays.high.z));
    rays.farthest = hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z)));
    rays.needed = hn::Mul(hn::Mul(error, farthest_d), hn::Set(d, 2 * inverse_scale));
    return rays;
  }
  [[nodiscard]] HWY_INLINE Rays ParallelRays(VF error) const {
    const DF d;
    const CullVector axis{hn::Set(d, t.d_row[0]), hn::Set(d, t.d_row[1]), hn::Set(d, t.d_row[2])};
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

void CullRange(const CullInput& input, const ClusterRange& range, CullResult& result) {
  const Cull cull(input);
  for (std::size_t i = range.begin; i < range.end; i += hn::Lanes(DF())) cull.Group(i, result);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::zbuffer_detail {

FRONTMOST_KERNELS(CullRange);

void cull_clusters(const CullInput& input, Isa isa, const ClusterRange& range, CullResult& result) {
  kernel_for(CullRangeKernels, isa)(input, range, result);
}

}  // namespace frontmost::zbuffer_detail
#endif  // HWY_ONCE
