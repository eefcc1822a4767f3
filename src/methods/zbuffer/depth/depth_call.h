// SPDX-License-Identifier: Apache-2.0
// A draw call of a depth buffer. A DepthState becomes rules for one view and one format, once a call. The kernel draws
// placed triangles into one tile by these rules.
//
//    DepthState, view, format --rules_for()--> DepthRules: a line from keys to depths, three flags for eight functions
//    triangle --offset_of()--> its polygon offset                  depth of a sample = limited(line(key) + offset)
//
// So the kernel depends on numbers only: on no depth function, no direction of depths, and no format, except for
// whether depths are floats.
#pragma once

#include <span>

#include "frontmost/zbuffer.h"
#include "view/screen_cutout.h"
#include "view/screen_transform.h"
#include "zbuffer/place/submission.h"

namespace frontmost::zbuffer_detail {

/// Window depth of a key: at_zero + slope * key, limited to [low, high], in double. The depth of a sample is this depth
/// plus the offset, limited to [0, 1].
struct DepthMap {
  double at_zero, slope;
  double low, high;  ///< the depth range, in order

  [[nodiscard]] double of(float key) const {
    const double depth = at_zero + slope * double(key);
    return depth < low ? low : depth > high ? high : depth;
  }
};

struct DepthRules {
  DepthMap map;
  DepthFormat format;
  bool passes_less, passes_equal, passes_greater;
  bool mask;
  PolygonOffset offset;

  [[nodiscard]] bool has_offset() const { return offset.factor != 0 || offset.units != 0; }
  /// Polygon offset of a triangle with key gradient (gx, gy) per 1/256 pixel. `key_low` and `key_high` bound the keys
  /// of its whole visible part.
  [[nodiscard]] double offset_of(double gx, double gy, float key_low, float key_high) const;
};

/// The rules of a state. \throws Error bad_argument naming the value that is out of range.
[[nodiscard]] DepthRules rules_for(const DepthState& state, DepthFormat format, const ScreenTransform& transform);

/// The planes of a depth buffer, [sample][y][x].
struct DepthPlanes {
  std::uint32_t* stored;
  PrimitiveId* primitives;
  float* keys;
  int width, height;
  std::span<const glm::ivec2> samples;
};

/// The input that all tiles of a draw call share.
struct DepthCall {
  DepthPlanes planes;
  DepthRules rules;
  PrimitiveId id_offset;
  const Cutouts* cutouts;  ///< null if no triangle has holes; nothing is drawn through holes
  const ScreenRays& rays;
};

/// Draws the triangles of a batch that touch a tile, one after the other; touches no pixel of other tiles.
void draw_depths(const DepthCall& call, const Tile& tile, const OrderedBatch& batch, Isa isa);

}  // namespace frontmost::zbuffer_detail
