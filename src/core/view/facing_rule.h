// SPDX-License-Identifier: Apache-2.0
// Tells which triangles all methods cull because of the side that a view sees.
#pragma once

#include "frontmost/view.h"
#include "surfaces/material_sides.h"

namespace frontmost {

/// View::culling, applied to the triangles of a scene.
class FacingRule {
 public:
  /// Borrows `sides`. Null, as without triangles, means that all triangles are one-sided.
  FacingRule(Culling culling, const MaterialSides* sides) : culling_(culling) {
    if (culling != Culling::material) return;
    if (sides && !sides->bits.empty())
      double_sided_ = sides->bits.data();
    else
      culling_ = sides && sides->are_all_double ? Culling::none : Culling::back;
  }

  /// The culling that applies; Culling::material only if one-sided and double-sided materials both occur.
  [[nodiscard]] Culling culling() const { return culling_; }
  /// Whether a triangle that is seen from this side is kept.
  [[nodiscard]] bool keeps(PrimitiveId id, bool is_front) const {
    switch (culling_) {
      case Culling::none: return true;
      case Culling::back: return is_front;
      case Culling::front: return !is_front;
      case Culling::both: break;
      case Culling::material: return is_front || (double_sided_[id / 32] >> (id % 32) & 1) != 0;
    }
    return false;
  }

 private:
  Culling culling_;
  const std::uint32_t* double_sided_ = nullptr;
};

}  // namespace frontmost
