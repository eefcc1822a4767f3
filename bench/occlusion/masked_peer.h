// SPDX-License-Identifier: Apache-2.0
// Masked Occlusion Culling, Intel's library, on the same objects.
// J. Hasselgren, M. Andersson, T. Akenine-Möller. Masked Software Occlusion Culling. HPG 2016.
#pragma once

#include <frontmost/frontmost.h>

#include <memory>
#include <vector>

namespace frontmost::bench {

/// Objects, front to back: each is tested by its box, and drawn where that may be seen. Where boxes are on the screen,
/// and their order, is found beside the clock. Whether triangles that turn away are left out: for scenes of closed
/// ones.
class MaskedPeer {
 public:
  virtual ~MaskedPeer() = default;
  virtual void cull() = 0;
  /// Of the last cull(), by instance: 1 where it may be seen.
  [[nodiscard]] virtual const std::vector<std::uint8_t>& seen() const = 0;
  /// As it names its instruction set.
  [[nodiscard]] virtual const char* instructions() const = 0;
};

/// Borrows the surfaces. Null where its source was not there when this was built.
[[nodiscard]] std::unique_ptr<MaskedPeer> make_masked_peer(const Surfaces& surfaces, const View& view,
                                                           bool leaves_out_backs);

}  // namespace frontmost::bench
