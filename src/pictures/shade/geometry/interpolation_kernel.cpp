// SPDX-License-Identifier: Apache-2.0
// Interpolates from set-up triangles to fragments, a whole vector at a time. The fragments of a vector may lie on
// several triangles. So the values of the lanes' triangles are first turned into one vector for each value, four values
// at a time, and then the formula is evaluated once:
//
//   triangles      A A A B B C C C
//   corner.x       a a a b b c c c
//   formula        x x x x x x x x

#include "shade/geometry/geometry.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/geometry/interpolation_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// After Highway: a block of its own.
#include "base/lane_types-inl.h"
#include "base/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::HWY_NAMESPACE;
namespace {

HWY_INLINE VF AtLeastZero(VF value) {  // 0 for NaN
  return hn::IfThenElseZero(hn::Gt(value, hn::Zero(DF())), value);
}

struct VF3 {
  VF x, y, z;
};

HWY_INLINE VF Dot(const VF3& a, const VF3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE VF3 Minus(const VF3& a, const VF3& b) { return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)}; }
HWY_INLINE VF3 PlusScaled(const VF3& a, const VF3& b, VF scale) {
  return {hn::Add(a.x, hn::Mul(b.x, scale)), hn::Add(a.y, hn::Mul(b.y, scale)), hn::Add(a.z, hn::Mul(b.z, scale))};
}
HWY_INLINE void Store(const VF3& v, Lane3& lanes, int i) {
  const DF d;
  hn::StoreU(v.x, d, &lanes.x[i]);
  hn::StoreU(v.y, d, &lanes.y[i]);
  hn::StoreU(v.z, d, &lanes.z[i]);
}
HWY_INLINE void Store(VF x, VF y, Lane2& lanes, int i) {
  hn::StoreU(x, DF(), &lanes.x[i]);
  hn::StoreU(y, DF(), &lanes.y[i]);
}

/// Four numbers of each lane's triangle.
struct VF4 {
  VF lanes[4];
};

#if HWY_TARGET != HWY_SCALAR
/// Returns blocks of four numbers each, those of every fourth triangle.
template <class D>
HWY_INLINE hn::Vec<D> BlocksOf(D d, const float* const* triangles) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return hn::LoadU(d, *triangles);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, BlocksOf(half, triangles + hn::Lanes(half)), BlocksOf(half, triangles));
  }
}

/// Returns the numbers at the given places, one place for each lane.
HWY_INLINE VF4 Transposed(const float* const* at) {
  const DF d;
  const VF a = BlocksOf(d, at), b = BlocksOf(d, at + 1), c = BlocksOf(d, at + 2), e = BlocksOf(d, at + 3);
  const VF ac = hn::InterleaveLower(d, a, c), be = hn::InterleaveLower(d, b, e);
  const VF ac2 = hn::InterleaveUpper(d, a, c), be2 = hn::InterleaveUpper(d, b, e);
  return {{hn::InterleaveLower(d, ac, be), hn::InterleaveUpper(d, ac, be), hn::InterleaveLower(d, ac2, be2),
           hn::InterleaveUpper(d, ac2, be2)}};
}
#endif

/// The triangles of the fragments in a vector.
class VectorTriangles {
 public:
  VectorTriangles(const std::uint16_t* numbers, const std::vector<TriangleSetup>& setups) {
    for (std::size_t i = 0; i < kMaxLanes; ++i) {
      triangles_[i] = &setups[numbers[i]];
      is_single_ = is_single_ && numbers[i] == numbers[0];
    }
  }

  /// Returns the four numbers that stand at `get(triangle)` of each lane's triangle.
  template <class Get>
  [[nodiscard]] HWY_INLINE VF4 four(const Get& get) const {
    const float* at[kMaxLanes];
    if (is_single_) {
      at[0] = get(*triangles_[0]);
      return {{All(at[0][0]), All(at[0][1]), All(at[0][2]), All(at[0][3])}};
    }
#if HWY_TARGET != HWY_SCALAR
    for (std::size_t i = 0; i < kMaxLanes; ++i) at[i] = get(*triangles_[i]);
    return Transposed(at);
#else
    return {};
#endif
  }
  /// Returns the `count` numbers, at most 12, that stand from `get(triangle)` on.
  template <std::size_t count, class Get>
  HWY_INLINE void numbers(const Get& get, VF (&out)[count]) const {
    static_assert(count % 4 == 0);
    for (std::size_t k = 0; k < count; k += 4) {
      const VF4 four_of = four([&](const TriangleSetup& t) { return get(t) + k; });
      for (std::size_t j = 0; j < 4; ++j) out[k + j] = four_of.lanes[j];
    }
  }

 private:
  const TriangleSetup* triangles_[kMaxLanes];
  bool is_single_ = true;
};

/// The weights that barycentric() of geometry.h returns, for a vector of fragments.
struct Weights {
  VF3 weight;
  VF divisor;
  VF3 step_x, step_y;  ///< changes of the weights, before they are divided
  VU flags;            ///< bytes of truth values, the lowest first: is_smooth, is_backside and has_color
};

HWY_INLINE Weights WeightsAt(const VectorTriangles& of, const Lane2& screen, int i) {
  const DF d;
  VF t[12];  // the members weight, reference, is_smooth, is_backside and has_color
  static_assert(offsetof(TriangleSetup, reference) == 9 * sizeof(float));
  static_assert(offsetof(TriangleSetup, is_smooth) == 11 * sizeof(float));
  static_assert(offsetof(TriangleSetup, has_color) == offsetof(TriangleSetup, is_smooth) + 2);
  of.numbers([](const TriangleSetup& s) { return &s.weight[0].at_reference; }, t);
  const VF dx = hn::Sub(hn::LoadU(d, &screen.x[i]), t[9]), dy = hn::Sub(hn::LoadU(d, &screen.y[i]), t[10]);
  const auto affine = [&](std::size_t k) HWY_ATTR {
    return AtLeastZero(hn::Add(hn::Add(t[k], hn::Mul(dx, t[k + 1])), hn::Mul(dy, t[k + 2])));
  };
  const VF a = affine(0), b = affine(3), c = affine(6);
  const VF sum = hn::Add(hn::Add(a, b), c);
  const MF is_valid = hn::Gt(sum, All(1e-30f));
  const VF divisor = hn::IfThenElse(is_valid, sum, All(1.0f));
  const VF scale = hn::IfThenElseZero(is_valid, hn::Div(All(1.0f), divisor));
  const VF rest = hn::IfThenZeroElse(is_valid, All(1.0f / 3));
  const auto weight = [&](VF value) HWY_ATTR { return hn::Add(hn::Mul(value, scale), rest); };
  return {{weight(a), weight(b), weight(c)}, divisor, {t[1], t[4], t[7]}, {t[2], t[5], t[8]}, hn::BitCast(DU(), t[11])};
}

HWY_INLINE VF Between(VF a, VF b, VF c, const VF3& weight) {
  return hn::Add(hn::Add(hn::Mul(a, weight.x), hn::Mul(b, weight.y)), hn::Mul(c, weight.z));
}

/// For each lane, three vectors at the corners of its triangle.
struct VF3Corners {
  VF3 a, b, c;
};
HWY_INLINE VF3Corners CornersOf(const VF* t) { return {{t[0], t[1], t[2]}, {t[3], t[4], t[5]}, {t[6], t[7], t[8]}}; }
HWY_INLINE VF3 Between(const VF3Corners& corner, const VF3& weight) {
  return {Between(corner.a.x, corner.b.x, corner.c.x, weight), Between(corner.a.y, corner.b.y, corner.c.y, weight),
          Between(corner.a.z, corner.b.z, corner.c.z, weight)};
}

HWY_INLINE VF3 Chosen(MF mask, const VF3& yes, const VF3& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y), hn::IfThenElse(mask, yes.z, no.z)};
}

/// Returns the unit normal interpolated from the corner normals, or that of the plane where the corner normals cancel
/// out.
HWY_INLINE VF3 SmoothNormal(const VF3Corners& normals, const VF3& plane, const VF3& weight) {
  const VF3 n = Between(normals, weight);
  // An interpolation of unit vectors is never longer than 1.
  const VF length2 = Dot(n, n);
  const MF is_valid = hn::Gt(length2, All(1e-12f));
  const VF scale = hn::IfThenElseZero(is_valid, hn::Div(All(1.0f), hn::Sqrt(length2)));
  const VF rest = hn::IfThenZeroElse(is_valid, All(1.0f));
  const auto mixed = [&](VF own, VF of_plane) { return hn::Add(hn::Mul(own, scale), hn::Mul(of_plane, rest)); };
  return {mixed(n.x, plane.x), mixed(n.y, plane.y), mixed(n.z, plane.z)};
}

/// Returns the point, moved towards the curved surface that the corner normals suggest: the mean of its projections
/// onto the corners' tangent planes, outwards only. Shadows looked up there hide the facets along the terminator. (J.
/// Hanika, Hacking the Shadow Terminator, in Ray Tracing Gems II, 2021.)
HWY_INLINE VF3 Lifted(const VF3Corners& corners, const VF3Corners& normals, const VF3& position, const VF3& weight) {
  VF3 lifted = position;
  const auto lift = [&](const VF3& corner, const VF3& normal, VF of_corner) {
    const VF height = Dot(Minus(position, corner), normal);
    lifted = PlusScaled(lifted, normal, hn::Mul(AtLeastZero(hn::Neg(height)), of_corner));
  };
  lift(corners.a, normals.a, weight.x);
  lift(corners.b, normals.b, weight.y);
  lift(corners.c, normals.c, weight.z);
  return lifted;
}

/// Returns the unit vector towards the eye from a point that is relative to the eye.
HWY_INLINE VF3 ToEye(const VF3& p) {
  const VF length2 = Dot(p, p), least = All(1e-36f);
  const VF scale = hn::Div(All(-1.0f), hn::Sqrt(hn::IfThenElse(hn::Gt(length2, least), length2, least)));
  return {hn::Mul(p.x, scale), hn::Mul(p.y, scale), hn::Mul(p.z, scale)};
}

/// One texture coordinate and its change per pixel in x and y: exact derivatives of the quotient.
struct Coordinate {
  VF value, dx, dy;
};
/// Interpolates a coordinate that has these values at the corners.
HWY_INLINE Coordinate CoordinateAt(VF a, VF b, VF c, const Weights& w) {
  const VF value = Between(a, b, c, w.weight), scale = hn::Div(All(1.0f), w.divisor);
  const VF from_a = hn::Sub(a, value), from_b = hn::Sub(b, value), from_c = hn::Sub(c, value);
  const auto change = [&](const VF3& step) HWY_ATTR {
    const VF first = hn::Mul(from_a, step.x), second = hn::Mul(from_b, step.y), third = hn::Mul(from_c, step.z);
    return hn::Mul(hn::Add(hn::Add(first, second), third), scale);
  };
  return {value, change(w.step_x), change(w.step_y)};
}

/// The vector of fragments that begins at `i`, and the requested set of texture coordinates.
struct TexcoordPlace {
  int i;
  std::uint32_t set;
  const PixelSteps* steps;
};

/// Returns the change of a coordinate along a step, from its changes per unit of the screen.
HWY_INLINE VF AlongStep(const Coordinate& c, const Lane2& step, int i) {
  const DF d;
  return hn::Add(hn::Mul(c.dx, hn::LoadU(d, &step.x[i])), hn::Mul(c.dy, hn::LoadU(d, &step.y[i])));
}

HWY_INLINE void StoreTexcoords(const VectorTriangles& of, const Weights& w, TexcoordPlace place, TexcoordLanes& out) {
  VF t[8];  // the coordinates at the corners, and two numbers that follow them
  static_assert(offsetof(TriangleSetup, texcoord) + sizeof(TriangleSetup::texcoord) + 2 * sizeof(float) <=
                sizeof(TriangleSetup));
  of.numbers([&](const TriangleSetup& s) { return &s.texcoord[place.set][0].x; }, t);
  const Coordinate u = CoordinateAt(t[0], t[2], t[4], w), v = CoordinateAt(t[1], t[3], t[5], w);
  Store(u.value, v.value, out.value, place.i);
  if (const PixelSteps* const steps = place.steps) {
    Store(AlongStep(u, steps->x, place.i), AlongStep(v, steps->x, place.i), out.dx, place.i);
    Store(AlongStep(u, steps->y, place.i), AlongStep(v, steps->y, place.i), out.dy, place.i);
    return;
  }
  Store(u.dx, v.dx, out.dx, place.i);
  Store(u.dy, v.dy, out.dy, place.i);
}

/// Returns the lanes where one of the bytes `mask` of the flags is set.
HWY_INLINE MF IsSet(VU flags, std::uint32_t mask) {
  const DU d;
  return hn::RebindMask(DF(), hn::Ne(hn::And(flags, hn::Set(d, mask)), hn::Zero(d)));
}

/// Stores the interpolated colours. Triangles without colours are exactly white.
void StoreColors(const VectorTriangles& of, const Weights& w, Geometry& out, int i) {
  Lane* lanes[4] = {&out.color.x, &out.color.y, &out.color.z, &out.alpha};
  const MF has_color = IsSet(w.flags, 0xFF0000);
  VF t[12];
  of.numbers([](const TriangleSetup& s) { return &s.color[0].x; }, t);
  for (int k = 0; k < 4; ++k)
    hn::StoreU(hn::IfThenElse(has_color, Between(t[k], t[k + 4], t[k + 8], w.weight), All(1.0f)), DF(),
               &(*lanes[k])[i]);
}

void InterpolateVector(const std::vector<TriangleSetup>& setups, int i, FragmentBatch& batch) {
  Geometry& out = batch.geometry;
  const VectorTriangles of(batch.coverage.triangle + i, setups);
  const Weights w = WeightsAt(of, batch.coverage.screen, i);
  VF t[12];  // the members corner and plane_normal
  static_assert(offsetof(TriangleSetup, plane_normal) == offsetof(TriangleSetup, corner) + 9 * sizeof(float));
  of.numbers([](const TriangleSetup& s) { return &s.corner[0].x; }, t);
  const VF3Corners corners = CornersOf(t);
  const VF3 plane{t[9], t[10], t[11]};
  const VF3 position = Between(corners, w.weight);
  VF3 normal = plane, lifted = position;
  const MF is_smooth = IsSet(w.flags, 0xFF);
  if (!hn::AllFalse(DF(), is_smooth)) {
    VF n[12];  // the member normal, and what follows it
    of.numbers([](const TriangleSetup& s) { return &s.normal[0].x; }, n);
    const VF3Corners normals = CornersOf(n);
    normal = Chosen(is_smooth, SmoothNormal(normals, plane, w.weight), plane);
    lifted = Chosen(is_smooth, Lifted(corners, normals, position, w.weight), position);
  }
  Store(position, out.position, i);
  Store(plane, out.plane_normal, i);
  Store(normal, out.normal, i);
  Store(lifted, out.smooth_position, i);
  Store(ToEye(position), out.to_viewer, i);
  if (out.has_texcoord) StoreTexcoords(of, w, {i, 0, batch.coverage.steps}, out.texcoord);
  if (out.has_color) StoreColors(of, w, out, i);
}

void Fill(std::initializer_list<Lane*> lanes, float value) {
  for (Lane* lane : lanes) std::fill(std::begin(lane->values), std::end(lane->values), value);
}

}  // namespace

void Interpolate(const ScreenRays& rays, const std::vector<TriangleSetup>& setups, FragmentBatch& batch) {
  const Coverage& coverage = batch.coverage;
  Geometry& out = batch.geometry;
  bool has_texcoord = false, has_color = false;
  for (int i = 0; i < coverage.count; ++i) {  // without branches, which would depend on the data
    has_texcoord |= setups[coverage.triangle[i]].has_texcoord[0];
    has_color |= setups[coverage.triangle[i]].has_color;
  }
  // Lanes that an earlier batch has filled keep their values.
  TexcoordLanes& uv = out.texcoord;
  if (!has_texcoord && out.has_texcoord) Fill({&uv.value.x, &uv.value.y, &uv.dx.x, &uv.dx.y, &uv.dy.x, &uv.dy.y}, 0.0f);
  if (!has_color && out.has_color) Fill({&out.color.x, &out.color.y, &out.color.z, &out.alpha}, 1.0f);
  out.has_texcoord = has_texcoord;
  out.has_color = has_color;
  for (int i = 0; i < coverage.count; i += int(hn::Lanes(DF()))) InterpolateVector(setups, i, batch);
  if (!rays.is_parallel()) return;
  Fill({&out.to_viewer.x}, float(-rays.forward().x));
  Fill({&out.to_viewer.y}, float(-rays.forward().y));
  Fill({&out.to_viewer.z}, float(-rays.forward().z));
}

void InterpolateTexcoords(const TexcoordRequest& request, TexcoordLanes& out) {
  for (int i = request.begin; i < request.end; i += int(hn::Lanes(DF()))) {
    const VectorTriangles of(request.coverage.triangle + i, request.setups);
    StoreTexcoords(of, WeightsAt(of, request.coverage.screen, i), {i, request.set, request.coverage.steps}, out);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::shading {

FRONTMOST_KERNELS(Interpolate);
FRONTMOST_KERNELS(InterpolateTexcoords);

void interpolate_geometry(const ScreenRays& rays, const std::vector<TriangleSetup>& setups, FragmentBatch& batch,
                          Isa isa) {
  kernel_for(InterpolateKernels, isa)(rays, setups, batch);
}

void interpolate_texcoords(const TexcoordRequest& request, TexcoordLanes& out, Isa isa) {
  kernel_for(InterpolateTexcoordsKernels, isa)(request, out);
}

}  // namespace frontmost::shading
#endif  // HWY_ONCE
