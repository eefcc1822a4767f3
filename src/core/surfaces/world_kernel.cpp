// SPDX-License-Identifier: Apache-2.0
// From mesh coordinates to world coordinates, many vertices at once: in doubles, each product and sum in the order of
// to_world(), and rounded once, so that the bits are the same.

#include "surfaces/placed_scene.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surfaces/world_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/lane_types-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// On targets without vectors, Highway converts doubles beyond the range of floats to the greatest float, not to
// infinity.
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128

void PlaceVertices(const glm::dmat4& m, std::span<const glm::vec3> from, glm::vec3* to) {
  for (std::size_t i = 0; i < from.size(); ++i) to[i] = to_world(m, from[i]);
}

#else

/// The transform of one axis.
template <class DD>
class WorldRow {
 public:
  using V = hn::Vec<DD>;

  HWY_INLINE WorldRow(const glm::dmat4& m, int row)
      : x_(hn::Set(DD(), m[0][row])),
        y_(hn::Set(DD(), m[1][row])),
        z_(hn::Set(DD(), m[2][row])),
        offset_(hn::Set(DD(), m[3][row])) {}

  [[nodiscard]] HWY_INLINE V operator()(V x, V y, V z) const {
    return hn::Add(hn::Add(hn::Add(hn::Mul(x_, x), hn::Mul(y_, y)), hn::Mul(z_, z)), offset_);
  }

 private:
  V x_, y_, z_, offset_;
};

void PlaceVertices(const glm::dmat4& m, std::span<const glm::vec3> from, glm::vec3* to) {
  using DD = hn::Repartition<double, DF>;
  const DF d;
  const hn::Half<DF> half;
  const DD dd;
  const WorldRow<DD> rows[3] = {{m, 0}, {m, 1}, {m, 2}};
  const auto place = [&](const float* p, float* q) HWY_ATTR {
    VF x, y, z, world[3];
    hn::LoadInterleaved3(d, p, x, y, z);
    const auto x0 = hn::PromoteTo(dd, hn::LowerHalf(half, x)), x1 = hn::PromoteTo(dd, hn::UpperHalf(half, x));
    const auto y0 = hn::PromoteTo(dd, hn::LowerHalf(half, y)), y1 = hn::PromoteTo(dd, hn::UpperHalf(half, y));
    const auto z0 = hn::PromoteTo(dd, hn::LowerHalf(half, z)), z1 = hn::PromoteTo(dd, hn::UpperHalf(half, z));
    for (int axis = 0; axis < 3; ++axis)
      world[axis] =
          hn::Combine(d, hn::DemoteTo(half, rows[axis](x1, y1, z1)), hn::DemoteTo(half, rows[axis](x0, y0, z0)));
    hn::StoreInterleaved3(world[0], world[1], world[2], d, q);
  };
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= from.size(); i += lanes) place(&from[i].x, &to[i].x);
  if (i == from.size()) return;
  glm::vec3 rest[kMaxLanes];
  for (std::size_t k = 0; k < lanes; ++k) rest[k] = from[HWY_MIN(i + k, from.size() - 1)];
  place(&rest[0].x, &rest[0].x);
  std::copy_n(rest, from.size() - i, to + i);
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace frontmost
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost {

FRONTMOST_KERNELS(PlaceVertices);

void place_vertices(const glm::dmat4& world_from_mesh, std::span<const glm::vec3> from, glm::vec3* to, Isa isa) {
  kernel_for(PlaceVerticesKernels, isa)(world_from_mesh, from, to);
}

}  // namespace frontmost
#endif  // HWY_ONCE
