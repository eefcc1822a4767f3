// SPDX-License-Identifier: Apache-2.0
// The room's own checks, and what materials say of primitives.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "abuffer/plan/crowd.h"
#include "frontmost/abuffer.h"

namespace frontmost::abuffer_detail {

/// \throws Error bad_argument.
void validate(const AbufferOptions& options);

/// By primitive, how far it hides what is behind.
class Opacities {
 public:
  Opacities(const Surfaces& surfaces, float opacity, const Execution& execution);

  [[nodiscard]] float of(PrimitiveId id) const { return values_.empty() ? all_ : std::abs(values_[id]); }
  /// What it hides at least, whatever its texture says.
  [[nodiscard]] float least(PrimitiveId id) const { return std::max(values_.empty() ? all_ : values_[id], 0.0f); }
  /// Nothing is seen through it, whatever its texture says.
  [[nodiscard]] bool is_opaque(PrimitiveId id) const { return (values_.empty() ? all_ : values_[id]) >= 1.0f; }

 private:
  float all_;
  std::vector<float> values_;  // none: all the same. Negative: 1, but a texture may cut holes into it
};

/// Of triangles at one place those in front of an opaque one, and it. As long as the opacities are where they are.
[[nodiscard]] inline CopyRule copy_rule(const Opacities& opacities) {
  return {[&opacities](PrimitiveId id) { return opacities.is_opaque(id); }};
}

}  // namespace frontmost::abuffer_detail
