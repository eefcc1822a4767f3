// SPDX-License-Identifier: Apache-2.0
// A scene made of the triangles that were kept of a stream.
#pragma once

#include "frontmost/stream.h"
#include "stream/kept_triangles.h"

namespace frontmost {

struct Excerpt::Parts {
  Parts(Scene kept, const Execution& execution) : scene(std::move(kept)), surfaces(scene, execution) {}
  const Scene scene;
  const Surfaces surfaces;
};

namespace streaming {

/// Ascending.
[[nodiscard]] std::vector<PrimitiveId> ids_of(const KeptPieces& kept);
/// `frame` with the triangles that were kept, in the order of the stream.
[[nodiscard]] Scene scene_of(Scene frame, KeptPieces kept);

}  // namespace streaming
}  // namespace frontmost
