// SPDX-License-Identifier: Apache-2.0
// Intel's library Masked Occlusion Culling, on the same objects.
// J. Hasselgren, M. Andersson, T. Akenine-Möller. Masked Software Occlusion Culling. HPG 2016.
#pragma once

#include <frontmost/frontmost.h>

#include <memory>
#include <vector>

namespace frontmost::bench {

/// Culls objects front to back: tests each by its box, and draws it if the box may be seen. Boxes on the screen and
/// their order are computed off the clock. `leaves_out_backs` skips triangles that face away, for scenes of closed
/// meshes.
class MaskedPeer {
 public:
  virtual ~MaskedPeer() = default;
  virtual void cull() = 0;
  /// By instance, 1 if the last cull() found that it may be seen.
  [[nodiscard]] virtual const std::vector<std::uint8_t>& seen() const = 0;
  /// The library's name of its instruction set.
  [[nodiscard]] virtual const char* instructions() const = 0;
};

/// Borrows the surfaces. Null if the build had no source of the library.
[[nodiscard]] std::unique_ptr<MaskedPeer> make_masked_peer(const Surfaces& surfaces, const View& view,
                                                           bool leaves_out_backs);

}  // namespace frontmost::bench
