// SPDX-License-Identifier: Apache-2.0
// Which triangles a view leaves out by the way they face, for all methods.
#pragma once

#include "frontmost/view.h"
#include "surfaces/material_sides.h"

namespace frontmost {

/// View::culling, carried to the triangles of a scene.
class FacingRule {
 public:
  /// Borrows `sides`. Null, as of what has no triangles: all are one-sided.
  FacingRule(Culling culling, const MaterialSides* sides) : culling_(culling) {
    if (culling != Culling::material) return;
    if (sides && !sides->bits.empty())
      double_sided_ = sides->bits.data();
    else
      culling_ = sides && sides->are_all_double ? Culling::none : Culling::back;
  }

  /// Culling::material only where materials of both kinds occur.
  [[nodiscard]] Culling culling() const { return culling_; }
  /// Whether a triangle that is seen from this side is left.
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
