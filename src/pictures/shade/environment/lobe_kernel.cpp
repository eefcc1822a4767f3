// SPDX-License-Identifier: Apache-2.0

#include "shade/environment/lobe.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/environment/lobe_kernel.cpp"
#include <algorithm>
#include <array>

#include "base/highway-inl.h"
#include "base/isa.h"
// After Highway: a block of its own.
#include "shade/environment/octahedral_lookup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading {
namespace HWY_NAMESPACE {
namespace {

constexpr int kTexelsAtOnce = 64;

struct DirectionLanes {
  float x[kTexelsAtOnce], y[kTexelsAtOnce], z[kTexelsAtOnce];
};

/// The normals of consecutive texels of a row, and two directions across each.
struct Frames {
  DirectionLanes normal, across, along;
  int count;
};

/// Computes both directions from the normal.
void FindFrames(Frames& frames) {
  for (int i = 0; i < frames.count; ++i) {
    const Direction n{frames.normal.x[i], frames.normal.y[i], frames.normal.z[i]};
    // Chooses an axis that is roughly perpendicular to the normal.
    const bool is_upright = std::abs(n.y) > 0.7f;
    const float x = is_upright ? 0.0f : n.z, y = is_upright ? -n.z : 0.0f, z = is_upright ? n.y : -n.x;
    const float scale = 1.0f / std::sqrt(x * x + y * y + z * z);
    const Direction a{x * scale, y * scale, z * scale};
    frames.across.x[i] = a.x;
    frames.across.y[i] = a.y;
    frames.across.z[i] = a.z;
    frames.along.x[i] = n.y * a.z - n.z * a.y;
    frames.along.y[i] = n.z * a.x - n.x * a.z;
    frames.along.z[i] = n.x * a.y - n.y * a.x;
  }
}

struct Squares {
  std::int32_t first[kTexelsAtOnce];
  float x[kTexelsAtOnce], y[kTexelsAtOnce];
};

void FindSquares(const Frames& frames, const glm::vec3& towards, std::int32_t size, Squares& squares) {
  const float across = towards.x, along = towards.y, ahead = towards.z;
  for (int i = 0; i < frames.count; ++i) {
    const Direction d{across * frames.across.x[i] + along * frames.along.x[i] + ahead * frames.normal.x[i],
                      across * frames.across.y[i] + along * frames.along.y[i] + ahead * frames.normal.y[i],
                      across * frames.across.z[i] + along * frames.along.z[i] + ahead * frames.normal.z[i]};
    const TexelSquare square = texel_square(octahedral_place(d), size);
    squares.first[i] = square.first;
    squares.x[i] = square.x;
    squares.y[i] = square.y;
  }
}

}  // namespace

void BlurTexels(std::span<const OctahedralMap> maps, std::span<const LobeDirection> lobe, const glm::vec3* normals,
                int count, float* out) {
  const DTexels d;
  Frames frames;
  frames.count = count;
  for (int i = 0; i < count; ++i) {
    frames.normal.x[i] = normals[i].x;
    frames.normal.y[i] = normals[i].y;
    frames.normal.z[i] = normals[i].z;
  }
  FindFrames(frames);
  alignas(64) float sums[kTexelsAtOnce * kPairLanes] = {};
  Squares squares;
  for (const LobeDirection& direction : lobe) {
    const OctahedralMap& map = maps[std::size_t(direction.map)];
    FindSquares(frames, direction.towards, map.size(), squares);
    for (int i = 0; i < count; ++i) {
      VTexels sum[kTexelParts];
      float* const place = sums + i * kPairLanes;
      for (int part = 0; part < kTexelParts; ++part) sum[part] = hn::Load(d, place + part * kTexelLanes);
      AddSquare(map.texels(), OctahedralMap::channels * map.stride(), {squares.first[i], squares.x[i], squares.y[i]},
                direction.weight, sum);
      for (int part = 0; part < kTexelParts; ++part) hn::Store(sum[part], d, place + part * kTexelLanes);
    }
  }
  for (int i = 0; i < count; ++i) {
    const float* const columns = sums + i * kPairLanes;
    for (int k = 0; k < OctahedralMap::channels; ++k)
      out[OctahedralMap::channels * i + k] = columns[k] + columns[k + OctahedralMap::channels];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::shading {

FRONTMOST_KERNELS(BlurTexels);

void blur_row(std::span<const OctahedralMap> maps, std::span<const LobeDirection> lobe, int y, OctahedralMap& out,
              Isa isa) {
  constexpr int texels_at_once = 64;
  std::array<glm::vec3, texels_at_once> normals;
  for (int begin = 0; begin < out.size(); begin += texels_at_once) {
    const int count = std::min(texels_at_once, out.size() - begin);
    for (int i = 0; i < count; ++i)
      normals[std::size_t(i)] = glm::normalize(octahedron_point(out.size(), begin + i, y));
    kernel_for(BlurTexelsKernels, isa)(maps, lobe, normals.data(), count, out.texel(begin, y));
  }
}

}  // namespace frontmost::shading
#endif  // HWY_ONCE
