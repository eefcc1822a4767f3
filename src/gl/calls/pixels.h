// SPDX-License-Identifier: Apache-2.0
// Pixels of the frame, for calls that copy them.
#pragma once

#include "calls/context.h"
#include "pixels/formats.h"

namespace frontmost::gl_detail {

[[nodiscard]] inline Transfer transfer_of(const Context& c) { return {c.state.pixel, c.pixel_maps}; }
/// The pixels of `rect` that the frame has.
[[nodiscard]] WindowRect inside_frame(const Frame& frame, const WindowRect& rect);
/// \returns the pixels of `rect`, row by row from the bottom, after the transfer operations; 0 outside the frame. All
/// that was submitted is drawn before. Nothing if there is no memory for them, which is recorded.
[[nodiscard]] std::optional<std::vector<std::uint32_t>> copy_of_frame(Context& c, const WindowRect& rect,
                                                                      PixelKind kind);

}  // namespace frontmost::gl_detail
