// SPDX-License-Identifier: Apache-2.0
// Interpolates from set-up triangles to fragments, a whole vector at a time. The fragments of a vector may lie on
// several triangles. So each value of a triangle is first assembled lane by lane, and then the formula is evaluated
// once:
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

/// The triangles of the fragments in a vector.
class VectorTriangles {
 public:
  VectorTriangles(const std::uint16_t* numbers, const std::vector<TriangleSetup>& setups) {
    const DU d;
    const hn::Rebind<std::uint16_t, DU> d16;
    const VU lanes = hn::PromoteTo(d, hn::LoadU(d16, numbers));
    for (std::uint64_t left = (std::uint64_t(1) << hn::Lanes(d)) - 1; left != 0; ++count_) {
      const std::uint16_t number = numbers[hwy::Num0BitsBelowLS1Bit_Nonzero64(left)];
      const auto is_it = hn::Eq(lanes, hn::Set(d, number));
      left &= ~BitsOf(d, is_it);
      masks_[count_] = hn::RebindMask(DF(), is_it);
      triangles_[count_] = &setups[number];
    }
  }

  /// Returns the value get(triangle) of each lane's triangle.
  template <class Get>
  [[nodiscard]] HWY_INLINE VF operator()(const Get& get) const {
    VF value = All(get(*triangles_[0]));
    for (std::size_t t = 1; t < count_; ++t) value = hn::IfThenElse(masks_[t], All(get(*triangles_[t])), value);
    return value;
  }
  /// Returns the value get(triangle) of each lane's triangle, where the value is a vector of three.
  template <class Get>
  [[nodiscard]] HWY_INLINE VF3 three(const Get& get) const {
    return {(*this)([&](const TriangleSetup& t) { return get(t).x; }),
            (*this)([&](const TriangleSetup& t) { return get(t).y; }),
            (*this)([&](const TriangleSetup& t) { return get(t).z; })};
  }
  [[nodiscard]] HWY_INLINE bool any_smooth() const {
    bool any = false;
    for (std::size_t t = 0; t < count_; ++t) any = any || triangles_[t]->is_smooth;
    return any;
  }

 private:
  std::size_t count_ = 0;
  MF masks_[kMaxLanes];
  const TriangleSetup* triangles_[kMaxLanes];
};

/// The weights that barycentric() of geometry.h returns, for a vector of fragments.
struct Weights {
  VF3 weight;
  VF divisor;
};

HWY_INLINE VF AffineAt(const VectorTriangles& of, std::size_t k, VF dx, VF dy) {
  const VF start = of([k](const TriangleSetup& t) { return t.weight[k].at_reference; });
  const VF step_x = of([k](const TriangleSetup& t) { return t.weight[k].step_x; });
  const VF step_y = of([k](const TriangleSetup& t) { return t.weight[k].step_y; });
  return AtLeastZero(hn::Add(hn::Add(start, hn::Mul(dx, step_x)), hn::Mul(dy, step_y)));
}

HWY_INLINE Weights WeightsAt(const VectorTriangles& of, const Lane2& screen, int i) {
  const DF d;
  const VF dx = hn::Sub(hn::LoadU(d, &screen.x[i]), of([](const TriangleSetup& t) { return t.reference.x; }));
  const VF dy = hn::Sub(hn::LoadU(d, &screen.y[i]), of([](const TriangleSetup& t) { return t.reference.y; }));
  const VF a = AffineAt(of, 0, dx, dy), b = AffineAt(of, 1, dx, dy), c = AffineAt(of, 2, dx, dy);
  const VF sum = hn::Add(hn::Add(a, b), c);
  const MF is_valid = hn::Gt(sum, All(1e-30f));
  const VF divisor = hn::IfThenElse(is_valid, sum, All(1.0f));
  const VF scale = hn::IfThenElseZero(is_valid, hn::Div(All(1.0f), divisor));
  const VF rest = hn::IfThenZeroElse(is_valid, All(1.0f / 3));
  const auto weight = [&](VF value) { return hn::Add(hn::Mul(value, scale), rest); };
  return {{weight(a), weight(b), weight(c)}, divisor};
}

HWY_INLINE VF Between(VF a, VF b, VF c, const VF3& weight) {
  return hn::Add(hn::Add(hn::Mul(a, weight.x), hn::Mul(b, weight.y)), hn::Mul(c, weight.z));
}

/// For each lane, three vectors at the corners of its triangle.
struct VF3Corners {
  VF3 a, b, c;
};
template <class Get>
HWY_INLINE VF3Corners CornersOf(const VectorTriangles& of, const Get& get) {
  return {of.three([&](const TriangleSetup& t) { return get(t)[0]; }),
          of.three([&](const TriangleSetup& t) { return get(t)[1]; }),
          of.three([&](const TriangleSetup& t) { return get(t)[2]; })};
}
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
/// Selects a set of texture coordinates and one of its two axes.
struct CoordinateKind {
  std::uint32_t set;
  float glm::vec2::*axis;
};
HWY_INLINE Coordinate CoordinateAt(const VectorTriangles& of, CoordinateKind kind, const Weights& w) {
  const auto corner = [&](std::size_t k) {
    // Missing coordinates of the first set are zero, so no test is needed.
    return of([=](const TriangleSetup& t) {
      return (kind.set == 0 ? t.texcoord[0][k] : t.texcoord_at(kind.set, k)).*kind.axis;
    });
  };
  const VF a = corner(0), b = corner(1), c = corner(2);
  const VF value = Between(a, b, c, w.weight), scale = hn::Div(All(1.0f), w.divisor);
  const VF from_a = hn::Sub(a, value), from_b = hn::Sub(b, value), from_c = hn::Sub(c, value);
  const auto change = [&](float Affine::*step) {
    const VF first = hn::Mul(from_a, of([step](const TriangleSetup& t) { return t.weight[0].*step; }));
    const VF second = hn::Mul(from_b, of([step](const TriangleSetup& t) { return t.weight[1].*step; }));
    const VF third = hn::Mul(from_c, of([step](const TriangleSetup& t) { return t.weight[2].*step; }));
    return hn::Mul(hn::Add(hn::Add(first, second), third), scale);
  };
  return {value, change(&Affine::step_x), change(&Affine::step_y)};
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
  const Coordinate u = CoordinateAt(of, {place.set, &glm::vec2::x}, w);
  const Coordinate v = CoordinateAt(of, {place.set, &glm::vec2::y}, w);
  Store(u.value, v.value, out.value, place.i);
  if (const PixelSteps* const steps = place.steps) {
    Store(AlongStep(u, steps->x, place.i), AlongStep(v, steps->x, place.i), out.dx, place.i);
    Store(AlongStep(u, steps->y, place.i), AlongStep(v, steps->y, place.i), out.dy, place.i);
    return;
  }
  Store(u.dx, v.dx, out.dx, place.i);
  Store(u.dy, v.dy, out.dy, place.i);
}

/// Stores the interpolated colours. Triangles without colours are exactly white.
void StoreColors(const VectorTriangles& of, const VF3& weight, Geometry& out, int i) {
  Lane* lanes[4] = {&out.color.x, &out.color.y, &out.color.z, &out.alpha};
  const MF has_color = hn::Gt(of([](const TriangleSetup& t) { return float(t.has_color); }), hn::Zero(DF()));
  for (int k = 0; k < 4; ++k) {
    const VF a = of([k](const TriangleSetup& t) { return t.color[0][k]; });
    const VF b = of([k](const TriangleSetup& t) { return t.color[1][k]; });
    const VF c = of([k](const TriangleSetup& t) { return t.color[2][k]; });
    hn::StoreU(hn::IfThenElse(has_color, Between(a, b, c, weight), All(1.0f)), DF(), &(*lanes[k])[i]);
  }
}

/// The attributes that at least one triangle of a batch has.
struct BatchAttributes {
  bool texcoord = false, color = false;
};

void InterpolateVector(const std::vector<TriangleSetup>& setups, int i, const BatchAttributes& attributes,
                       FragmentBatch& batch) {
  Geometry& out = batch.geometry;
  const VectorTriangles of(batch.coverage.triangle + i, setups);
  const Weights w = WeightsAt(of, batch.coverage.screen, i);
  const VF3Corners corners = CornersOf(
      of, [](const TriangleSetup& t) -> const auto& { return t.corner; });
  const VF3 plane = of.three([](const TriangleSetup& t) { return t.plane_normal; });
  const VF3 position = Between(corners, w.weight);
  VF3 normal = plane, lifted = position;
  if (of.any_smooth()) {
    const VF3Corners normals = CornersOf(
        of, [](const TriangleSetup& t) -> const auto& { return t.normal; });
    const MF is_smooth = hn::Gt(of([](const TriangleSetup& t) { return float(t.is_smooth); }), hn::Zero(DF()));
    normal = Chosen(is_smooth, SmoothNormal(normals, plane, w.weight), plane);
    lifted = Chosen(is_smooth, Lifted(corners, normals, position, w.weight), position);
  }
  Store(position, out.position, i);
  Store(plane, out.plane_normal, i);
  Store(normal, out.normal, i);
  Store(lifted, out.smooth_position, i);
  Store(ToEye(position), out.to_viewer, i);
  if (attributes.texcoord) StoreTexcoords(of, w, {i, 0, batch.coverage.steps}, out.texcoord);
  if (attributes.color) StoreColors(of, w.weight, out, i);
}

BatchAttributes AttributesOf(const Coverage& coverage, const std::vector<TriangleSetup>& setups) {
  BatchAttributes attributes;
  for (int i = 0; i < coverage.count; ++i) {
    const TriangleSetup& t = setups[coverage.triangle[i]];
    attributes.texcoord = attributes.texcoord || t.has_texcoord[0];
    attributes.color = attributes.color || t.has_color;
  }
  return attributes;
}

void Fill(std::initializer_list<Lane*> lanes, int count, float value) {
  for (Lane* lane : lanes) std::fill_n(lane->values, count, value);
}

}  // namespace

void Interpolate(const ScreenRays& rays, const std::vector<TriangleSetup>& setups, FragmentBatch& batch) {
  const Coverage& coverage = batch.coverage;
  Geometry& out = batch.geometry;
  const int count = coverage.count;
  const BatchAttributes attributes = AttributesOf(coverage, setups);
  for (int i = 0; i < count; i += int(hn::Lanes(DF()))) InterpolateVector(setups, i, attributes, batch);
  if (!attributes.texcoord)
    Fill({&out.texcoord.value.x, &out.texcoord.value.y, &out.texcoord.dx.x, &out.texcoord.dx.y, &out.texcoord.dy.x,
          &out.texcoord.dy.y},
         count, 0.0f);
  if (!attributes.color) Fill({&out.color.x, &out.color.y, &out.color.z, &out.alpha}, count, 1.0f);
  if (!rays.is_parallel()) return;
  Fill({&out.to_viewer.x}, count, float(-rays.forward().x));
  Fill({&out.to_viewer.y}, count, float(-rays.forward().y));
  Fill({&out.to_viewer.z}, count, float(-rays.forward().z));
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
