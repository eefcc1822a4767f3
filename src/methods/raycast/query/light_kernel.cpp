// SPDX-License-Identifier: Apache-2.0
// Rays towards one light are parallel. Sheared along the light, they are points of a plane, and boxes and triangles
// cast their outlines on it. Up to 64 rays walk the tree together as one rectangle of that plane, above their lowest
// start.
//
//           light                   rays as points       Each ray is a point (u, v) of the sheared plane with a start
//             \   \   \               . . . .            at height d. A triangle is met by the points inside its
//        tri __\___\                 . /\ .              outline whose start lies below it. Vectors decide, with a
//               \   \   \            ./  \.              bound on all rounding, what is certain; stands_before()
//          ______\___\___\ points    '----'              decides the rest. So the answers depend neither on the order
//                                                        of rays nor on the instruction set.

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/exact_vector.h"
#include "raycast/query/queries.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raycast/query/light_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/lanes-inl.h"
#include "raycast/query/ray_axis-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The sheared world: u and v lie across the light, d towards it, and the light's rays run along d.
struct LightAxes {
  int u = 0, v = 1, d = 2;  ///< the world's axes; d is the one that the light moves most along
  float sign = 1;           ///< +1 if the light comes from the positive side
  float slope_u = 0, slope_v = 0;

  explicit LightAxes(const glm::vec3& to_light) {
    const glm::vec3 size = glm::abs(to_light);
    d = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    u = (d + 1) % 3, v = (d + 2) % 3;
    sign = to_light[d] < 0 ? -1.0f : 1.0f;
    slope_u = to_light[u] / size[d];
    slope_v = to_light[v] / size[d];
  }
};

/// Bound on the rounding error of scaled coordinates of size 1: six roundings of up to three terms, and as much again.
constexpr float kShearError = 0x1p-20f;

class LightPacket {
 public:
  LightPacket(const RayTree& tree, const LightAim& light)
      : tree_(tree),
        to_light_(light.to_light),
        is_one_way_(light.is_one_way),
        axes_(light.to_light),
        stack_(tree.stack_size() + kRayLanes) {
    tree_size_ = SizeOf(tree.reach);
  }

  /// Stores whether each point is lit. \returns how often exact arithmetic decided about a ray within the triangle's
  /// box in the plane.
  std::uint64_t Find(std::span<const TrianglePoint> points, std::uint8_t* lit) {
    decided_ = 0;
    points_ = points;
    Place();
    Walk();
    for (std::size_t i = 0; i < points.size(); ++i) lit[i] = std::uint8_t(waiting_[i] != 0 || is_clear_[i]);
    return decided_;
  }

 private:
  /// A rectangle of the sheared plane, and the range of the starts' heights.
  struct Bounds {
    float low_u, high_u, low_v, high_v, low_d, high_d;
  };

  static float SizeOf(const glm::vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

  /// Scales by a power of two, so that nothing overflows and products keep their digits.
  void SetScale(float size) {
    int exponent = 0;
    std::frexp(size, &exponent);
    scale_ = float(std::ldexp(1.0, std::clamp(-exponent, -126, 126)));
  }

  /// Finds which starts are valid, their positions, and the scale.
  void Measure(glm::dvec3* position) {
    float size = tree_size_;
    waiting_count_ = 0;
    std::fill_n(waiting_, kLightRays, 0);  // a last packet that is not full has unused rays
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const TrianglePoint& point = points_[i];
      is_clear_[i] = !is_valid(point);
      waiting_[i] = is_clear_[i] ? 0 : -1;
      ids_[i] = point.primitive;
      if (is_clear_[i]) continue;
      ++waiting_count_;
      position[i] = position_of(point);
      size = std::max(size, SizeOf(point.lift));
      // Neighbours mostly lie on the same triangle.
      if (i > 0 && !is_clear_[i - 1] && point.corners == points_[i - 1].corners) continue;
      for (const glm::vec3& corner : point.corners) size = std::max(size, SizeOf(corner));
    }
    SetScale(size);
  }

  /// Places the rays in the sheared plane. Rays without a valid start are lit; they and unused rays are placed at a
  /// valid start.
  void Place() {
    glm::dvec3 position[kLightRays];
    Measure(position);
    if (waiting_count_ == 0) return;
    const std::size_t some = std::size_t(std::find(waiting_, waiting_ + points_.size(), -1) - waiting_);
    origin_ = glm::vec3(position[some] * double(scale_));
    alignas(64) float at[3][kLightRays];
    for (std::size_t i = 0; i < kLightRays; ++i) {
      const bool is_used = i < points_.size() && !is_clear_[i];
      const glm::dvec3 p = position[is_used ? i : some] * double(scale_) - glm::dvec3(origin_);
      for (std::size_t axis = 0; axis < 3; ++axis) at[axis][i] = float(p[int(axis)]);
    }
    Shear(at);
    block_count_ = (points_.size() + kQueryLanes - 1) / kQueryLanes;
    bounds_ = block_[0] = BoundsOf(0);
    for (std::size_t i = 1; i < block_count_; ++i) {
      const Bounds b = block_[i] = BoundsOf(i * kQueryLanes);
      bounds_ = {std::min(bounds_.low_u, b.low_u), std::max(bounds_.high_u, b.high_u),
                 std::min(bounds_.low_v, b.low_v), std::max(bounds_.high_v, b.high_v),
                 std::min(bounds_.low_d, b.low_d), std::max(bounds_.high_d, b.high_d)};
    }
  }

  HWY_INLINE void Shear(const float (&at)[3][kLightRays]) {
    const QF d;
    QV reach = hn::Zero(d);
    for (std::size_t i = 0; i < kLightRays; i += kQueryLanes) {
      const QV x = hn::Load(d, at[axes_.u] + i), y = hn::Load(d, at[axes_.v] + i), z = hn::Load(d, at[axes_.d] + i);
      const QV up = hn::Mul(z, hn::Set(d, axes_.sign));
      hn::Store(up, d, d_ + i);
      hn::Store(hn::Sub(x, hn::Mul(up, hn::Set(d, axes_.slope_u))), d, u_ + i);
      hn::Store(hn::Sub(y, hn::Mul(up, hn::Set(d, axes_.slope_v))), d, v_ + i);
      reach = hn::Max(reach, hn::Max(hn::Max(hn::Abs(x), hn::Abs(y)), hn::Abs(z)));
    }
    reach_ = hn::GetLane(hn::MaxOfLanes(d, reach));
    // The second term bounds the rounding of the subtraction of doubles up to 2, which kShearError does not include.
    error_ = kShearError * reach_ + 0x1p-46f;
  }

  /// Bounds of one vector of rays.
  [[nodiscard]] HWY_INLINE Bounds BoundsOf(std::size_t first) const {
    const QF d;
    const auto low = [&](const float* x) HWY_ATTR { return hn::GetLane(hn::MinOfLanes(d, hn::Load(d, x + first))); };
    const auto high = [&](const float* x) HWY_ATTR { return hn::GetLane(hn::MaxOfLanes(d, hn::Load(d, x + first))); };
    return {low(u_) - error_,  high(u_) + error_, low(v_) - error_,
            high(v_) + error_, low(d_) - error_,  high(d_) + error_};
  }

  void Walk() {
    if (waiting_count_ == 0) return;
    std::size_t count = 1;
    stack_[0] = tree_.root;
    while (count > 0 && waiting_count_ > 0) {
      const std::uint32_t child = stack_[--count];
      if (child & kLeafBit) {
        MeetLeaf(tree_.leaf(child));
      } else {
        LookInto(tree_.nodes[child], count);
      }
    }
  }

  [[nodiscard]] HWY_INLINE QV FromOrigin(const float* from, int axis) const {
    const QF d;
    return hn::Sub(hn::Mul(hn::Load(d, from), hn::Set(d, scale_)), hn::Set(d, origin_[axis]));
  }

  /// An axis across the light, and the range along it in which outlines matter.
  struct Across {
    int axis;
    float slope, begin, end;
  };

  /// Returns the boxes whose outlines miss the range of `across`. The boxes reach from low_d to high_d towards the
  /// light.
  [[nodiscard]] HWY_INLINE QM Beside(const RayNode& node, std::size_t first, const Across& across, QV low_d,
                                     QV high_d) const {
    const QF d;
    const QV low = FromOrigin(node.low[across.axis] + first, across.axis);
    const QV high = FromOrigin(node.high[across.axis] + first, across.axis);
    const QV a = hn::Mul(low_d, hn::Set(d, across.slope)), b = hn::Mul(high_d, hn::Set(d, across.slope));
    const QV size = hn::Add(hn::Max(hn::Abs(low), hn::Abs(high)), hn::Max(hn::Abs(low_d), hn::Abs(high_d)));
    const QV pad = hn::Mul(size, hn::Set(d, kShearError));
    const QV low_outline = hn::Sub(hn::Sub(low, hn::Max(a, b)), pad);
    const QV high_outline = hn::Add(hn::Sub(high, hn::Min(a, b)), pad);
    return hn::Or(hn::Gt(low_outline, hn::Set(d, across.end)), hn::Lt(high_outline, hn::Set(d, across.begin)));
  }

  HWY_INLINE void LookInto(const RayNode& node, std::size_t& count) {
    const QF d;
    const Bounds& b = bounds_;
    for (std::size_t first = 0; first < node.count; first += kQueryLanes) {
      QV low_d = FromOrigin((axes_.sign > 0 ? node.low : node.high)[axes_.d] + first, axes_.d);
      QV high_d = FromOrigin((axes_.sign > 0 ? node.high : node.low)[axes_.d] + first, axes_.d);
      if (axes_.sign < 0) low_d = hn::Neg(low_d), high_d = hn::Neg(high_d);
      const QV pad = hn::Mul(hn::Max(hn::Abs(low_d), hn::Abs(high_d)), hn::Set(d, kShearError));
      QM outside = hn::Lt(hn::Add(high_d, pad), hn::Set(d, b.low_d));
      // The parts of boxes below all starts cast no shadow on any start.
      low_d = hn::Max(hn::Sub(low_d, pad), hn::Set(d, b.low_d));
      outside = hn::Or(outside, Beside(node, first, {axes_.u, axes_.slope_u, b.low_u, b.high_u}, low_d, high_d));
      outside = hn::Or(outside, Beside(node, first, {axes_.v, axes_.slope_v, b.low_v, b.high_v}, low_d, high_d));
      // A box whose ends are infinities of both signs gives NaN and is visited, because the maximum of NaN and a number
      // depends on the processor.
      outside = hn::And(outside, hn::Eq(high_d, high_d));
      const std::uint32_t used = (1u << std::min(kQueryLanes, node.count - first)) - 1;
      for (std::uint32_t inside = ~QueryBits(outside) & used; inside != 0; inside &= inside - 1)
        stack_[count++] = node.child[first + hwy::Num0BitsBelowLS1Bit_Nonzero32(inside)];
    }
  }

  /// Eight triangles in the sheared plane. `may_meet` has a mask for each vector of rays: the triangles that it may
  /// meet.
  struct Sheared {
    alignas(64) float u[3][kRayLanes], v[3][kRayLanes], d[3][kRayLanes], reach[kRayLanes];
    std::uint32_t may_meet[kLightRays / kQueryLanes];
  };

  void MeetLeaf(const RayLeaf& leaf) {
    Sheared sheared;
    for (std::size_t first = 0; first < kRayLanes && waiting_count_ > 0; first += kQueryLanes) {
      std::uint32_t lanes = Shear(leaf, first, sheared);
      for (; lanes != 0; lanes &= lanes - 1)
        MeetTriangle(leaf, sheared, first, hwy::Num0BitsBelowLS1Bit_Nonzero32(lanes));
    }
  }

  /// \returns the lanes whose outline may hold a ray.
  HWY_INLINE std::uint32_t Shear(const RayLeaf& leaf, std::size_t first, Sheared& to) const {
    const QF d;
    QV u[3], v[3], up[3], reach = hn::Zero(d);
    for (std::size_t k = 0; k < 3; ++k) {
      const QV x = FromOrigin(leaf.corner[k][axes_.u] + first, axes_.u);
      const QV y = FromOrigin(leaf.corner[k][axes_.v] + first, axes_.v);
      const QV z = FromOrigin(leaf.corner[k][axes_.d] + first, axes_.d);
      reach = hn::Max(hn::Max(reach, hn::Abs(x)), hn::Max(hn::Abs(y), hn::Abs(z)));
      up[k] = hn::Mul(z, hn::Set(d, axes_.sign));
      u[k] = hn::Sub(x, hn::Mul(up[k], hn::Set(d, axes_.slope_u)));
      v[k] = hn::Sub(y, hn::Mul(up[k], hn::Set(d, axes_.slope_v)));
      hn::Store(up[k], d, to.d[k] + first);
      hn::Store(u[k], d, to.u[k] + first);
      hn::Store(v[k], d, to.v[k] + first);
    }
    hn::Store(reach, d, to.reach + first);
    const QV pad = hn::Mul(reach, hn::Set(d, kShearError));
    const QV low_u = hn::Sub(Least(u), pad), high_u = hn::Add(Most(u), pad);
    const QV low_v = hn::Sub(Least(v), pad), high_v = hn::Add(Most(v), pad), high_d = hn::Add(Most(up), pad);
    const std::uint32_t used = UsedLanes(leaf, first);
    std::uint32_t any = 0;
    for (std::size_t i = 0; i < block_count_; ++i) {
      const Bounds& b = block_[i];
      const QM beside_u = hn::Or(hn::Gt(low_u, hn::Set(d, b.high_u)), hn::Lt(high_u, hn::Set(d, b.low_u)));
      const QM beside_v = hn::Or(hn::Gt(low_v, hn::Set(d, b.high_v)), hn::Lt(high_v, hn::Set(d, b.low_v)));
      const QM outside = hn::Or(hn::Or(beside_u, beside_v), hn::Lt(high_d, hn::Set(d, b.low_d)));
      any |= to.may_meet[i] = ~QueryBits(outside) & used;
    }
    return any;
  }

  static HWY_INLINE std::uint32_t UsedLanes(const RayLeaf& leaf, std::size_t first) {
    const QU du;
    return QueryBits(hn::RebindMask(QF(), hn::Ne(hn::Load(du, leaf.id + first), hn::Set(du, no_primitive))));
  }

  /// One triangle, in the form that all rays share.
  struct Outline {
    float u[3], v[3], d[3];
    float edge_error, side_error;  ///< error bounds of a turn about an edge, and of six times the volume of the
                                   ///< tetrahedron with a start
    bool is_above;                 ///< true if all of the triangle is above all starts
    float high_d;                  ///< greatest height of the triangle
    float pad;                     ///< error bound of coordinates

    [[nodiscard]] bool box_holds(float x, float y) const {
      const auto holds = [&](const float(&at)[3], float value) {
        return value >= std::min({at[0], at[1], at[2]}) - pad && value <= std::max({at[0], at[1], at[2]}) + pad;
      };
      return holds(u, x) && holds(v, y);
    }
  };

  [[nodiscard]] Outline OutlineOf(const Sheared& from, std::size_t lane) const {
    Outline t;
    for (std::size_t k = 0; k < 3; ++k) t.u[k] = from.u[k][lane], t.v[k] = from.v[k][lane], t.d[k] = from.d[k][lane];
    // No difference of two coordinates is greater than `most`, or wrong by more than `error`.
    const float own_error = kShearError * from.reach[lane];
    t.pad = own_error;
    const float most = 2 * (from.reach[lane] + reach_), error = own_error + error_ + 0x1p-23f * most;
    // A turn is a difference of two products of differences. Each of the four factors is wrong by at most `error`, and
    // two products and their difference round once. The last term stands for underflow.
    t.edge_error = 8 * (most + error) * error + 0x1p-140f;
    t.side_error = 64 * most * (most + error) * error + 0x1p-140f;
    t.is_above = std::min({t.d[0], t.d[1], t.d[2]}) - own_error > bounds_.high_d;
    t.high_d = std::max({t.d[0], t.d[1], t.d[2]}) + own_error + error_;
    return t;
  }

  void MeetTriangle(const RayLeaf& leaf, const Sheared& sheared, std::size_t first_lane, std::size_t index) {
    const std::size_t lane = first_lane + index;
    const Outline outline = OutlineOf(sheared, lane);
    for (std::size_t block = 0; block < block_count_; ++block) {
      if ((sheared.may_meet[block] >> index & 1) == 0) continue;
      const std::size_t first = block * kQueryLanes;
      const Answer answer = MeetRays(outline, leaf.id[lane], first);
      for (std::uint32_t bits = QueryBits(answer.met); bits != 0; bits &= bits - 1)
        Meet(leaf, lane, first + hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
      for (std::uint32_t bits = QueryBits(answer.doubtful); bits != 0; bits &= bits - 1)
        Decide(leaf, lane, outline, first + hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
    }
  }

  struct Answer {
    QM met, doubtful;
  };

  HWY_INLINE Answer MeetRays(const Outline& t, PrimitiveId id, std::size_t first) const {
    const QF d;
    const QU du;
    const QI di;
    // A ray skips its own triangle. Rays that have met a triangle stay dark, and skip all other triangles.
    const QM waiting = hn::RebindMask(d, hn::MaskFromVec(hn::Load(di, waiting_ + first)));
    const QM others = hn::RebindMask(d, hn::Ne(hn::Load(du, ids_ + first), hn::Set(du, id)));
    const QV height = hn::Load(d, d_ + first);
    const QM asked = hn::And(hn::And(waiting, others), hn::Le(height, hn::Set(d, t.high_d)));
    QV u[3], v[3], w[3];
    for (int k = 0; k < 3; ++k) {
      u[k] = hn::Sub(hn::Set(d, t.u[k]), hn::Load(d, u_ + first));
      v[k] = hn::Sub(hn::Set(d, t.v[k]), hn::Load(d, v_ + first));
      w[k] = hn::Sub(hn::Set(d, t.d[k]), height);
    }
    const auto turn = [&](int a, int b) HWY_ATTR { return hn::Sub(hn::Mul(u[a], v[b]), hn::Mul(v[a], u[b])); };
    const QV e[3] = {turn(1, 2), turn(2, 0), turn(0, 1)};
    const QV least = hn::Min(hn::Min(e[0], e[1]), e[2]), most = hn::Max(hn::Max(e[0], e[1]), e[2]);
    const QV bound = hn::Set(d, t.edge_error), below = hn::Neg(bound);
    const QM beside = hn::And(hn::Gt(most, bound), hn::Lt(least, below));
    const QM left = hn::Gt(least, bound), right = hn::Lt(most, below);
    const QM inside = hn::Or(left, right), asked_about = hn::AndNot(beside, asked);
    if (t.is_above) return {hn::And(inside, asked_about), hn::AndNot(inside, asked_about)};
    const QV volume = hn::Add(hn::Add(hn::Mul(e[0], w[0]), hn::Mul(e[1], w[1])), hn::Mul(e[2], w[2]));
    const QV upwards = hn::IfThenElse(right, hn::Neg(volume), volume);
    const QV side = hn::Set(d, t.side_error);
    const QM met = hn::And(inside, hn::Gt(upwards, side)), under = hn::And(inside, hn::Lt(upwards, hn::Neg(side)));
    return {hn::And(met, asked_about), hn::AndNot(hn::Or(met, under), asked_about)};
  }

  void Darken(std::size_t ray) {
    waiting_[ray] = 0;
    --waiting_count_;
  }

  /// Handles a triangle that the ray certainly passes through. A lifted point may be below its own triangle.
  void Meet(const RayLeaf& leaf, std::size_t lane, std::size_t ray) {
    const TrianglePoint& point = points_[ray];
    if ((point.lift == glm::vec3(0) || !is_own(leaf.corners_of(lane), point)) && !Passes(leaf, lane, ray)) Darken(ray);
  }

  HWY_NOINLINE void Decide(const RayLeaf& leaf, std::size_t lane, const Outline& outline, std::size_t ray) {
    // Only rays within the triangle's box are counted, because whether others come here depends on the width of
    // vectors.
    decided_ += outline.box_holds(u_[ray], v_[ray]);
    if (stands_before(leaf.corners_of(lane), points_[ray], to_light_) && !Passes(leaf, lane, ray)) Darken(ray);
  }

  /// Returns whether light passes the triangle where the ray meets it: through a hole, or from behind.
  [[nodiscard]] HWY_INLINE bool Passes(const RayLeaf& leaf, std::size_t lane, std::size_t ray) const {
    if (is_one_way_ && !tree_.sides->is_double(leaf.id[lane]) && !FacesLight(leaf.corners_of(lane))) return true;
    const Cutouts* const cutouts = tree_.cutouts.get();
    if (!cutouts || !cutouts->has(leaf.id[lane])) return false;
    return (*cutouts)[leaf.id[lane]].is_hole_at(passed_point(leaf.corners_of(lane), points_[ray], to_light_));
  }

  [[nodiscard]] HWY_NOINLINE bool FacesLight(const std::array<glm::vec3, 3>& corners) const {
    const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
    return sign_of_determinant({b, a}, {c, a}, {glm::dvec3(to_light_)}) > 0;
  }

  const RayTree& tree_;
  const glm::vec3 to_light_;
  const bool is_one_way_;
  LightAxes axes_;
  std::vector<std::uint32_t> stack_;
  float tree_size_;
  std::span<const TrianglePoint> points_;
  // The rays, in scaled coordinates from the origin.
  alignas(64) float u_[kLightRays], v_[kLightRays], d_[kLightRays];
  alignas(64) PrimitiveId ids_[kLightRays];
  alignas(64) std::int32_t waiting_[kLightRays];  ///< -1: nothing met so far
  bool is_clear_[kLightRays];
  std::size_t waiting_count_ = 0;
  std::uint64_t decided_ = 0;
  float scale_ = 1, error_ = 0, reach_ = 0;
  glm::vec3 origin_{0};
  Bounds bounds_{}, block_[kLightRays / kQueryLanes];  ///< bounds of all rays, and of each vector
  std::size_t block_count_ = 0;
};

std::uint64_t FindLit(const RayTree& tree, std::span<const TrianglePoint> points, const LightAim& light,
                      std::span<std::uint8_t> answers) {
  LightPacket packet(tree, light);
  std::uint64_t decided = 0;
  for (std::size_t first = 0; first < points.size(); first += kLightRays)
    decided += packet.Find(points.subspan(first, std::min(kLightRays, points.size() - first)), answers.data() + first);
  return decided;
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::raycast_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::raycast_detail {

FRONTMOST_KERNELS(FindLit);

std::uint64_t find_lit(const RayTree& tree, std::span<const TrianglePoint> points, const LightAim& light,
                       std::span<std::uint8_t> answers, Isa isa) {
  const glm::vec3& to_light = light.to_light;
  const bool is_direction = is_finite(to_light) && to_light != glm::vec3(0);
  if (tree.root != no_index && is_direction) return kernel_for(FindLitKernels, isa)(tree, points, light, answers);
  std::fill_n(answers.data(), answers.size(), std::uint8_t(1));
  return 0;
}

}  // namespace frontmost::raycast_detail
#endif  // HWY_ONCE
