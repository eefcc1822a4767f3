// SPDX-License-Identifier: Apache-2.0
// The z-buffer draws from clusters or, while there are none, from the scene's own arrays. Tests ask for both.
#pragma once

#include "base/float_environment.h"
#include "frontmost/zbuffer.h"
#include "support/same_visible.h"
#include "zbuffer/direct/direct_frame.h"

namespace frontmost::test {

inline Visible draw_clusters(const Surfaces& surfaces, const View& view, const Execution& execution = {}) {
  ZBuffer buffer;
  buffer.draw(surfaces, view, execution);
  return buffer.take();
}

/// What both show, which must be the same.
inline Visible draw_both_ways(const Surfaces& surfaces, const View& view, const Execution& execution = {}) {
  Visible visible = draw_clusters(surfaces, view, execution);
  const IeeeScope ieee;
  expect_same(visible, zbuffer_detail::draw_directly(surfaces.placed(), view, execution));
  return visible;
}

}  // namespace frontmost::test
