// SPDX-License-Identifier: Apache-2.0
// A draw call of a depth buffer: what a DepthState means for one view and one format, worked out once a call, and the
// kernel that draws placed triangles by it into one tile.
//
//    DepthState, view, format --rules_for()--> DepthRules: a line from keys to depths, three flags for eight functions
//    triangle --offset_of()--> its polygon offset                  depth of a sample = limited(line(key) + offset)
//
// The kernel thus knows no depth function, no direction and no format but whether depths are floats: everything else is
// numbers.
#pragma once

#include <span>

#include "frontmost/zbuffer.h"
#include "view/screen_cutout.h"
#include "view/screen_transform.h"
#include "zbuffer/place/submission.h"

namespace frontmost::zbuffer_detail {

/// Window depth of a key: limited(at_zero + slope * key) + offset, in double, limited to [0, 1].
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
  /// Of a triangle with key gradient (gx, gy) per 1/256 pixel; `key_low` and `key_high` of its whole visible part.
  [[nodiscard]] double offset_of(double gx, double gy, float key_low, float key_high) const;
};

/// \throws Error bad_argument naming what is out of range.
[[nodiscard]] DepthRules rules_for(const DepthState& state, DepthFormat format, const ScreenTransform& transform);

/// The planes of a depth buffer, [sample][y][x].
struct DepthPlanes {
  std::uint32_t* stored;
  PrimitiveId* primitives;
  float* keys;
  int width, height;
  std::span<const glm::ivec2> samples;
};

/// What all tiles of a draw call have in common.
struct DepthCall {
  DepthPlanes planes;
  DepthRules rules;
  PrimitiveId id_offset;
  const Cutouts* cutouts;  ///< null where no triangle has holes, through which nothing is drawn
  const ScreenRays& rays;
};

/// Draws what a batch has in a tile, one triangle after the other; touches no pixel of other tiles.
void draw_depths(const DepthCall& call, const Tile& tile, const OrderedBatch& batch, Isa isa);

}  // namespace frontmost::zbuffer_detail
