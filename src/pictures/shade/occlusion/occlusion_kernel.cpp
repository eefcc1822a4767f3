// SPDX-License-Identifier: Apache-2.0
// A vector of fragments steps along the same slices of the depth map. Step sizes grow with the distance, because near
// surfaces hide most. A rise counts less the farther away it is, and nothing from the radius on.

#include "shade/occlusion/depth_occlusion.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/occlusion/occlusion_kernel.cpp"
#include <algorithm>
#include <cmath>

#include "base/highway-inl.h"
#include "base/isa.h"
// After Highway: a block of its own.
#include "base/lane_types-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::HWY_NAMESPACE;
namespace {

/// Cosines and sines of the slices' angles, which are odd multiples of pi / 16.
constexpr float kOne = 0.98078528f, kThree = 0.83146961f, kFive = 0.55557023f, kSeven = 0.19509032f;
constexpr float kSlices[][2] = {{kOne, kSeven},  {kThree, kFive},  {kFive, kThree},  {kSeven, kOne},
                                {-kSeven, kOne}, {-kFive, kThree}, {-kThree, kFive}, {-kOne, kSeven}};
constexpr int kSteps = 8;            ///< per side
constexpr float kMostOfSide = 0.5f;  ///< greatest distance of a step, as a part of the picture's longer side

struct EyeVector {
  VF x, y, z;
};

HWY_INLINE VF Dot(const EyeVector& a, const EyeVector& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE EyeVector Scaled(const EyeVector& a, VF by) {
  return {hn::Mul(a.x, by), hn::Mul(a.y, by), hn::Mul(a.z, by)};
}
HWY_INLINE EyeVector Less(const EyeVector& a, const EyeVector& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE EyeVector Cross(const EyeVector& a, const EyeVector& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
HWY_INLINE EyeVector AlongAxes(const OcclusionGrid& grid, const Lane3& lane, int i) {
  const DF d;
  const EyeVector v{hn::LoadU(d, lane.x.values + i), hn::LoadU(d, lane.y.values + i), hn::LoadU(d, lane.z.values + i)};
  const auto along = [&](const glm::vec3& axis) HWY_ATTR { return Dot(v, {All(axis.x), All(axis.y), All(axis.z)}); };
  return {along(grid.right), along(grid.up), along(grid.back)};
}
HWY_INLINE VF Clamped(VF value) { return hn::Max(All(-1), hn::Min(value, All(1))); }
HWY_INLINE VF Root(VF value) { return hn::Sqrt(hn::Max(value, All(0))); }

/// Returns the arc cosine, to 7e-5. (M. Abramowitz, I. Stegun. Handbook of Mathematical Functions. 1964: 4.4.45.)
HWY_INLINE VF AngleOf(VF cosine) {
  const VF x = hn::Abs(cosine);
  VF sum = hn::Add(hn::Mul(x, All(-0.0187293f)), All(0.0742610f));
  sum = hn::Sub(hn::Mul(x, sum), All(0.2121144f));
  sum = hn::Mul(Root(hn::Sub(All(1), x)), hn::Add(hn::Mul(x, sum), All(1.5707288f)));
  return hn::IfThenElse(hn::Lt(cosine, All(0)), hn::Sub(All(3.14159265f), sum), sum);
}

/// The fragments whose occlusion is computed, in the eye's axes.
struct Points {
  EyeVector at, normal, to_viewer;
  VF facing;            ///< the cosine between `normal` and `to_viewer`
  VF x, y;              ///< on the screen
  VF reach_x, reach_y;  ///< the radius on the screen, in pixels
};

HWY_INLINE Points PointsOf(const OcclusionGrid& grid, const FragmentBatch& batch, int i) {
  const DF d;
  const Geometry& g = batch.geometry;
  Points p{AlongAxes(grid, g.position, i),
           AlongAxes(grid, g.plane_normal, i),
           AlongAxes(grid, g.to_viewer, i),
           All(0),
           hn::LoadU(d, batch.coverage.screen.x.values + i),
           hn::LoadU(d, batch.coverage.screen.y.values + i),
           All(0),
           All(0)};
  p.facing = Dot(p.normal, p.to_viewer);
  const VF radius = All(grid.radius);
  const VF slope = grid.is_parallel ? radius : hn::Div(radius, hn::Max(hn::Neg(p.at.z), All(1e-30f)));
  const VF most = All(kMostOfSide * float(std::max(grid.width, grid.height)));
  p.reach_x = hn::Min(hn::Mul(slope, All(1 / grid.step.x)), most);
  p.reach_y = hn::Min(hn::Mul(slope, All(-1 / grid.step.y)), most);
  return p;
}

/// Returns the horizon, raised if the surface at the screen position (x, y) rises above it. A horizon is the cosine of
/// its angle from the line of sight.
HWY_INLINE VF Raised(const OcclusionGrid& grid, const Points& p, VF x, VF y, VF low, VF horizon) {
  const DF d;
  const DI di;
  MF counts = hn::And(hn::And(hn::Ge(x, All(0)), hn::Ge(y, All(0))),
                      hn::And(hn::Lt(x, All(float(grid.width))), hn::Lt(y, All(float(grid.height)))));
  const VI column = hn::ConvertTo(di, hn::IfThenElseZero(counts, x));
  const VI row = hn::ConvertTo(di, hn::IfThenElseZero(counts, y));
  const VF depth = hn::GatherIndex(d, grid.depths, hn::Add(hn::Mul(row, hn::Set(di, grid.width)), column));
  const VF across = hn::Add(All(grid.first.x), hn::Mul(hn::ConvertTo(d, column), All(grid.step.x)));
  const VF upwards = hn::Add(All(grid.first.y), hn::Mul(hn::ConvertTo(d, row), All(grid.step.y)));
  const VF scale = grid.is_parallel ? All(1) : depth;
  const EyeVector to = Less({hn::Mul(across, scale), hn::Mul(upwards, scale), hn::Neg(depth)}, p.at);
  const VF squared = Dot(to, to), limit = All(grid.radius * grid.radius);
  counts = hn::And(counts, hn::And(hn::Lt(squared, limit), hn::Gt(squared, All(0))));
  const VF length = hn::Sqrt(hn::IfThenElse(counts, squared, All(1)));
  const VF cosine = Clamped(hn::Div(Dot(to, p.to_viewer), length));
  // Pixels do not lie exactly in the slice. So the rise is measured over the fragment's plane, in the slice in which
  // the pixel lies.
  const VF above = hn::Sub(hn::Div(Dot(to, p.normal), length), hn::Mul(cosine, p.facing));
  const VF flat = hn::Mul(hn::Mul(p.facing, p.facing), hn::Max(hn::Sub(All(1), hn::Mul(cosine, cosine)), All(0)));
  const VF own_low = hn::Div(hn::Neg(above), hn::Sqrt(hn::Max(hn::Add(flat, hn::Mul(above, above)), All(1e-30f))));
  const VF part = hn::Div(squared, limit);
  const VF nearness = hn::Sub(All(1), hn::Mul(part, part));
  const VF risen = hn::Add(low, hn::Mul(hn::Sub(cosine, own_low), nearness));
  return hn::IfThenElse(hn::And(counts, hn::Gt(risen, horizon)), risen, horizon);
}

/// The normal's projection to a slice, as an angle from the line of sight towards the slice's side.
struct SliceNormal {
  VF length, cosine, sine, angle;
};

HWY_INLINE SliceNormal NormalWithin(const Points& p, const EyeVector& side) {
  const VF along = Dot(side, p.to_viewer);
  const EyeVector across = Cross(side, p.to_viewer);
  const VF squared = hn::Max(hn::Sub(All(1), hn::Mul(along, along)), All(1e-12f));
  const EyeVector within = Less(p.normal, Scaled(across, hn::Div(Dot(p.normal, across), squared)));
  SliceNormal n;
  n.length = Root(Dot(within, within));
  n.cosine = Clamped(hn::Div(Dot(within, p.to_viewer), hn::Max(n.length, All(1e-12f))));
  const VF towards = Dot(Less(side, Scaled(p.to_viewer, along)), within);
  n.sine = hn::CopySign(Root(hn::Sub(All(1), hn::Mul(n.cosine, n.cosine))), towards);
  n.angle = hn::CopySign(AngleOf(n.cosine), towards);
  return n;
}

/// Returns four times the sky between the line of sight and a horizon on the given side, 1 or -1.
HWY_INLINE VF SkyUpTo(VF horizon, float side, const SliceNormal& n) {
  const VF c = Clamped(horizon), s = hn::Mul(All(side), Root(hn::Sub(All(1), hn::Mul(c, c))));
  const VF angle = hn::Mul(All(side), AngleOf(c));
  const VF twice_c = hn::Sub(hn::Mul(All(2), hn::Mul(c, c)), All(1)), twice_s = hn::Mul(All(2), hn::Mul(s, c));
  const VF turned = hn::Add(hn::Mul(twice_c, n.cosine), hn::Mul(twice_s, n.sine));
  return hn::Sub(hn::Add(n.cosine, hn::Mul(All(2), hn::Mul(angle, n.sine))), turned);
}

/// Returns the share of the sky that nothing hides.
HWY_INLINE VF FreeSky(const OcclusionGrid& grid, const Points& p) {
  VF sky = All(0), whole = All(0);
  for (const auto& [c, s] : kSlices) {
    const SliceNormal n = NormalWithin(p, {All(c), All(s), All(0)});
    const VF low[2] = {hn::Neg(n.sine), n.sine};
    VF horizon[2] = {low[0], low[1]};
    const VF x = hn::Mul(All(c), p.reach_x), y = hn::Mul(All(-s), p.reach_y);
    // The first step is at least a pixel, so that it does not hit the fragment itself.
    const VF longest = hn::Max(hn::Max(hn::Abs(x), hn::Abs(y)), All(1e-12f));
    for (int step = 0; step < kSteps; ++step) {
      const float part = (float(step) + 0.5f) / kSteps;
      const VF scale = hn::Max(All(part * part), hn::Div(All(float(step) + 1), longest));
      const VF dx = hn::Mul(x, scale), dy = hn::Mul(y, scale);
      horizon[0] = Raised(grid, p, hn::Add(p.x, dx), hn::Add(p.y, dy), low[0], horizon[0]);
      horizon[1] = Raised(grid, p, hn::Sub(p.x, dx), hn::Sub(p.y, dy), low[1], horizon[1]);
    }
    const auto count = [&](const VF(&up_to)[2]) HWY_ATTR {
      return hn::Mul(n.length, hn::Add(SkyUpTo(up_to[0], 1, n), SkyUpTo(up_to[1], -1, n)));
    };
    sky = hn::Add(sky, count(horizon));
    whole = hn::Add(whole, count(low));
  }
  return hn::Min(hn::Div(sky, hn::Max(whole, All(1e-12f))), All(1));
}

}  // namespace

void Darken(const OcclusionGrid& grid, FragmentBatch& batch) {
  const DF d;
  float* const occlusion = batch.material.occlusion.values;
  for (int i = 0; i < batch.coverage.count; i += int(hn::Lanes(d))) {
    const VF hidden = hn::Sub(All(1), FreeSky(grid, PointsOf(grid, batch, i)));
    const VF left = hn::Sub(All(1), hn::Mul(hidden, All(grid.strength)));
    hn::StoreU(hn::Mul(hn::LoadU(d, occlusion + i), left), d, occlusion + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::shading {

FRONTMOST_KERNELS(Darken);

void check_ambient_occlusion(const ShadeOptions& options) {
  if (!options.light.ambient_occlusion) return;
  const auto [strength, radius] = *options.light.ambient_occlusion;
  if (!(strength >= 0 && strength <= 1))
    throw Error(ErrorCode::bad_argument, "ambient occlusion", "the strength must be from 0 to 1");
  if (radius && !(*radius > 0 && std::isfinite(*radius)))
    throw Error(ErrorCode::bad_argument, "ambient occlusion", "the radius must be above 0");
}

double default_occlusion_radius(const Surfaces& surfaces) {
  constexpr double part = 0.1;  // share of the subject's size: covers corners of a room, not the whole room
  const Box subject = find_subject(surfaces).bounds;
  return subject.is_empty() ? 1.0 : std::max(part * double(subject.diagonal()), 1e-30);
}

void DepthOcclusion::find(const Visible& visible, int samples, const OcclusionReach& reach) {
  const View& view = visible.view;
  const std::size_t count = view.pixel_count();
  if (depths_.size() != count) depths_ = Buffer<float>(count);
  for (std::size_t i = 0; i < count; ++i)
    depths_[i] = visible.primitives[i] == no_primitive ? std::numeric_limits<float>::infinity()
                                                       : depth_of_key(view, visible.keys[i]);
  const Projection& sides = view.projection;
  const glm::dvec2 step((sides.right - sides.left) / view.width, (sides.bottom - sides.top) / view.height);
  const glm::dvec2 sample = glm::dvec2(sample_offsets(samples)[0]) / 256.0;
  grid_ = {view.width,
           view.height,
           depths_.data(),
           sides.orthographic,
           glm::vec3(view.right()),
           glm::vec3(view.up()),
           glm::vec3(-view.forward()),
           glm::vec2(glm::dvec2(sides.left, sides.top) + step * sample),
           glm::vec2(step),
           float(reach.radius),
           float(reach.strength)};
}

void DepthOcclusion::darken(FragmentBatch& batch, Isa isa) const { kernel_for(DarkenKernels, isa)(grid_, batch); }

}  // namespace frontmost::shading
#endif  // HWY_ONCE
