// SPDX-License-Identifier: Apache-2.0
// The properties of triangles in a view, and the stars of vertices.
//
//    bits of a triangle   turns left along x, y, z | turns right along x, y, z | climbs, by corner and axis | facing
//
// All bits are computed in doubles, without branches, for as many triangles as there are lanes. Facings that rounding
// leaves open are computed again, exactly, one by one.
//
//    corners of a vertex     next:  b c d a    Corner i runs from `next` to `last` around the vertex. Its partner, the
//                            last:  c d a b    triangle beyond that edge, is the corner whose `next` is its `last`.

#include "base/parallel.h"
#include "lines/mesh/mesh.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lines/mesh/mesh_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// After base/highway-inl.h, for each target.
#include "base/lanes-inl.h"
#include "lines/vector3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::lines_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kMostLanes = 8;
using D = hn::CappedTag<double, kMostLanes>;
using DU = hn::RebindToUnsigned<D>;
using DF = hn::Rebind<float, D>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
using Vector3 = Lanes3<V>;

/// Loads one triangle per lane; if there are fewer triangles, the last one fills the other lanes.
HWY_INLINE void Load(const WeldedMesh& mesh, std::size_t begin, std::size_t end, Vector3 (&corners)[3]) {
  HWY_ALIGN float places[9][kMostLanes];
  for (std::size_t i = 0; i < hn::Lanes(D()); ++i) {
    const glm::uvec3& t = mesh.triangles[begin + i < end ? begin + i : end - 1];
    for (int k = 0; k < 3; ++k) {
      const glm::vec3& p = mesh.positions.places[t[k]];
      places[3 * k][i] = p.x, places[3 * k + 1][i] = p.y, places[3 * k + 2][i] = p.z;
    }
  }
  const auto load = [&](int c) HWY_ATTR { return hn::PromoteTo(D(), hn::Load(DF(), places[c])); };
  for (int k = 0; k < 3; ++k) corners[k] = {load(3 * k), load(3 * k + 1), load(3 * k + 2)};
}

/// SeenTriangle::bits.
struct Bits {
  hn::Vec<DU> all;
  int next = 0;

  HWY_INLINE void Set(M mask, int bit) {
    const DU d;
    all = hn::Or(all, hn::IfThenElseZero(hn::RebindMask(d, mask), hn::Set(d, std::uint64_t(1) << bit)));
  }
  HWY_INLINE void Append(M mask) { Set(mask, next++); }
};

/// Appends the bits of SeenTriangle::climbs(). Seen along an axis, the point with the lower coordinate on the next axis
/// is below the other point; if both are equal, the third axis decides.
HWY_INLINE void AppendClimbs(const Vector3 (&p)[3], Bits& bits) {
  M is_below[3][3];  // by corner and axis: whether the corner is below the next corner
  for (int k = 0; k < 3; ++k) {
    const Vector3 &a = p[k], &b = p[k == 2 ? 0 : k + 1];
    const M x = hn::Lt(a.x, b.x), y = hn::Lt(a.y, b.y), z = hn::Lt(a.z, b.z);
    const M same_x = hn::Eq(a.x, b.x), same_y = hn::Eq(a.y, b.y), same_z = hn::Eq(a.z, b.z);
    is_below[k][0] = hn::Or(y, hn::And(same_y, z));
    is_below[k][1] = hn::Or(z, hn::And(same_z, x));
    is_below[k][2] = hn::Or(x, hn::And(same_x, y));
  }
  // The bit is set if the next corner is below this corner and the last corner is above.
  for (int k = 0; k < 3; ++k)
    for (int axis = 0; axis < 3; ++axis)
      bits.Append(hn::Not(hn::Or(is_below[k][axis], is_below[k == 0 ? 2 : k - 1][axis])));
}

HWY_INLINE hn::Vec<DU> BitsOfTriangles(const Vector3 (&p)[3], const BoundedNormals<V>& normal, const Sight& sight) {
  const D d;
  Bits bits{hn::Zero(DU())};
  const auto append_above = [&](V value, V error) HWY_ATTR { bits.Append(hn::Gt(value, error)); };
  append_above(normal.value.x, normal.error.x);
  append_above(normal.value.y, normal.error.y);
  append_above(normal.value.z, normal.error.z);
  append_above(hn::Neg(normal.value.x), normal.error.x);
  append_above(hn::Neg(normal.value.y), normal.error.y);
  append_above(hn::Neg(normal.value.z), normal.error.z);
  AppendClimbs(p, bits);
  const Vector3 to_eye = sight.is_parallel() ? Splat(d, -sight.forward()) : Minus(Splat(d, sight.eye()), p[0]);
  const V value = Dot(normal.value, to_eye), error = normal.ErrorOfDot(to_eye);
  const M is_towards = hn::Gt(value, error), is_away = hn::Lt(value, hn::Neg(error));
  const M is_zero = hn::Eq(error, hn::Zero(d));
  // The two bits hold: 0 away, 1 exactly edge-on, 2 towards, 3 open.
  const M is_open = hn::Not(hn::Or(hn::Or(is_towards, is_away), is_zero));
  bits.Set(hn::Or(is_zero, is_open), SeenTriangle::kFacingShift);
  bits.Set(hn::Or(is_towards, is_open), SeenTriangle::kFacingShift + 1);
  return bits.all;
}

void See(const WeldedMesh& mesh, const Sight& sight, std::size_t begin, std::size_t end, SeenTriangle* seen) {
  const D d;
  const DF df;
  for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
    Vector3 p[3];
    Load(mesh, i, end, p);
    const BoundedNormals<V> normal(Minus(p[1], p[0]), Minus(p[2], p[0]));
    // The product of two squares in this range is finite.
    const V square = Dot(normal.value, normal.value);
    const M is_usual = hn::And(hn::Gt(square, hn::Set(d, 1e-100)), hn::Lt(square, hn::Set(d, 1e100)));
    const V scale = hn::IfThenElseZero(is_usual, hn::Div(hn::Set(d, 1.0), hn::Sqrt(square)));
    const auto scaled = [&](V v) HWY_ATTR { return hn::DemoteTo(df, hn::Mul(v, scale)); };
    HWY_ALIGN SeenTriangle block[kMostLanes];
    const auto bits = hn::TruncateTo(hn::RebindToUnsigned<DF>(), BitsOfTriangles(p, normal, sight));
    hn::StoreInterleaved4(scaled(normal.value.x), scaled(normal.value.y), scaled(normal.value.z), hn::BitCast(df, bits),
                          df, &block[0].normal.x);
    for (std::size_t k = 0; k < hn::Lanes(d) && i + k < end; ++k) seen[i + k] = block[k];
  }
}

using DStar = hn::CappedTag<std::uint32_t, Star::most>;

struct StarCorners {
  std::size_t count;
  HWY_ALIGN std::uint32_t next[Star::most], last[Star::most];
  HWY_ALIGN std::uint32_t partner[Star::most];  ///< index of the corner in the triangle across the edge to `last`
  const SeenTriangle* triangle[Star::most];

  HWY_INLINE StarCorners(const SeenMesh& seen, std::span<const Corner> corners) : count(corners.size()) {
    for (std::size_t i = 0; i < count; ++i) {
      next[i] = corners[i].next(seen.mesh);
      last[i] = corners[i].last(seen.mesh);
      triangle[i] = &seen.triangles[corners[i].triangle()];
    }
  }
  /// Sets the partners. \returns whether all corners are paired.
  HWY_INLINE bool Pair() {
    const DStar d;
    std::uint64_t once = 0, again = 0;
    for (std::size_t b = 0; b < count; b += hn::Lanes(d)) {
      const auto lasts = hn::Load(d, last + b);
      auto partners = hn::Zero(d);
      std::uint64_t found = 0, twice = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const auto is_partner = hn::Eq(lasts, hn::Set(d, next[i]));
        partners = hn::IfThenElse(is_partner, hn::Set(d, std::uint32_t(i)), partners);
        const std::uint64_t bits = frontmost::HWY_NAMESPACE::BitsOf(d, is_partner);
        twice |= found & bits;
        found |= bits;
      }
      hn::Store(partners, d, partner + b);
      once |= found << b;
      again |= twice << b;
    }
    const std::uint64_t all = (std::uint64_t(1) << count) - 1;
    // If some corner is nobody's partner, two corners share a partner.
    std::uint64_t partners = 0, pillows = 0;
    for (std::size_t j = 0; j < count; ++j) {
      partners |= std::uint64_t(1) << partner[j];
      pillows |= std::uint64_t(next[j] == last[partner[j]]);
    }
    return (once & all) == all && (again & all) == 0 && partners == all && pillows == 0;
  }
  HWY_INLINE bool IsSpread(std::span<const Corner> corners) const {
    std::uint32_t turns = 63, once = 0, again = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t climbs = triangle[i]->climbs(corners[i].k());
      turns &= triangle[i]->turns();
      again |= once & climbs;
      once |= climbs;
    }
    return ((turns | turns >> 3) & once & ~again & 7) != 0;
  }
  HWY_INLINE std::uint16_t Asked(std::uint32_t vertex, float least_cosine) const {
    std::uint32_t asked = 0;
    for (std::size_t j = 0; j < count; ++j) {
      const SeenTriangle &a = *triangle[j], &b = *triangle[partner[j]];
      const float cosine = a.normal.x * b.normal.x + a.normal.y * b.normal.y + a.normal.z * b.normal.z;
      const bool is_plain = int(a.facing() == b.facing()) & int(cosine > least_cosine);
      asked |= std::uint32_t(int(last[j] > vertex) & int(!is_plain)) << j;
    }
    return std::uint16_t(asked);
  }
  /// Bits as for Star::asked: edges between different surfaces.
  HWY_INLINE std::uint16_t Borders(std::uint32_t vertex, const WeldedMesh& mesh,
                                   std::span<const Corner> corners) const {
    SurfaceOf surface[Star::most];
    for (std::size_t j = 0; j < count; ++j) surface[j] = mesh.surface_of(corners[j].triangle());
    std::uint32_t found = 0;
    for (std::size_t j = 0; j < count; ++j)
      found |= std::uint32_t(int(last[j] > vertex) & int(!(surface[j] == surface[partner[j]]))) << j;
    return std::uint16_t(found);
  }
};

void Stars(const SeenMesh& seen, const CornerTable& table, const PlainEdges& plain, std::size_t begin, std::size_t end,
           Star* stars) {
  for (std::size_t v = begin; v < end; ++v) {
    Star& star = stars[v - begin];
    star = {false, false, 0};
    const std::span<const Corner> at = table[v];
    if (at.size() > Star::most) continue;
    StarCorners corners(seen, at);
    if (!corners.Pair()) continue;
    const bool asks_all = plain.has_stated && seen.mesh.stated.is_lower_end(v);
    const float least = asks_all ? std::numeric_limits<float>::infinity() : plain.least_cosine;
    star = {true, corners.IsSpread(at), corners.Asked(std::uint32_t(v), least)};
    if (plain.has_borders) star.asked |= corners.Borders(std::uint32_t(v), seen.mesh, at);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::lines_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::lines_detail {

FRONTMOST_KERNELS(See);
FRONTMOST_KERNELS(Stars);

StarsKernel stars_kernel(Isa isa) { return kernel_for(StarsKernels, isa); }

namespace {

constexpr std::size_t kTrianglesPerPart = 4096;

/// The side of a triangle's plane on which the eye is, decided exactly.
int side_of_eye(const WeldedMesh& mesh, std::size_t triangle, const Sight& sight) {
  const glm::uvec3& t = mesh.triangles[triangle];
  const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
  return sign_of_determinant({b, a}, {c, a},
                             sight.is_parallel() ? Leg{glm::dvec3(0), sight.forward()} : Leg{sight.eye(), a});
}

}  // namespace

SeenMesh see(const WeldedMesh& mesh, const Sight& sight, const Execution& execution) {
  const std::size_t count = mesh.triangles.size();
  SeenMesh seen{mesh, sight, Buffer<std::int8_t>(count), Buffer<SeenTriangle>(count)};
  const auto see_triangles = kernel_for(SeeKernels, execution.isa);
  parallel_for(execution, count, kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
    see_triangles(mesh, sight, begin, end, seen.triangles.data());
    for (std::size_t i = begin; i < end; ++i) {
      SeenTriangle& triangle = seen.triangles[i];
      if (triangle.is_open())
        triangle.bits ^= SeenTriangle::kOpen ^ std::uint32_t(side_of_eye(mesh, i, sight) + 1)
                                                   << SeenTriangle::kFacingShift;
      seen.facing[i] = std::int8_t(triangle.facing());
    }
  });
  return seen;
}

}  // namespace frontmost::lines_detail
#endif  // HWY_ONCE
