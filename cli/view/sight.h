// SPDX-License-Identifier: Apache-2.0
// Finding what is visible: in every pixel of a view, by the default z-buffer, by rays, or by a depth buffer with the
// state that the user asked for; and along single rays, which meet the curved surfaces of a model themselves.
#pragma once

#include <frontmost/curved.h>
#include <frontmost/depth_buffer.h>
#include <frontmost/image.h>
#include <frontmost/raycast.h>

#include <optional>
#include <string_view>

#include "cli/settings.h"

namespace frontmost::cli {

struct SeenView {
  Visible visible;
  Buffer<float> window_depths;  ///< of a depth buffer, in the order of Visible; empty without one
};

/// The state with its defaults filled in, which --reversed changes.
[[nodiscard]] DepthState depth_state(const DepthSettings& settings);
[[nodiscard]] double depth_clear(const DepthSettings& settings);

/// By rays where there is an index.
[[nodiscard]] SeenView look_at_surfaces(const Surfaces& surfaces, const View& view, const DepthSettings& settings,
                                        const Execution& execution, const RayIndex* index = nullptr);

/// "D8", "LESS" and so on, as on the command line.
[[nodiscard]] std::string_view name(DepthFormat format);
[[nodiscard]] std::string_view name(DepthFunc func);

/// An element that rays meet, by its object.
struct RayElement {
  std::uint32_t instance = 0;
  std::string_view kind;  ///< "triangle", "sphere" or "patch"
  std::uint32_t number = 0;
};

/// Borrows an index of the surfaces' triangles, or one of their scene, whichever is not null.
struct RayScene {
  const Surfaces& surfaces;
  const RayIndex* triangles = nullptr;
  const CurvedIndex* curved = nullptr;

  [[nodiscard]] const Scene& scene() const { return surfaces.scene(); }
  /// Normals are empty without curved surfaces.
  [[nodiscard]] CurvedScan scan(const RayCamera& camera, const Execution& execution) const;
  [[nodiscard]] std::vector<CurvedHit> closest(std::span<const Segment> segments, const Execution& execution) const;
  [[nodiscard]] PrimitiveSource source(PrimitiveId id) const;
  [[nodiscard]] RayElement element(PrimitiveId id) const;
  [[nodiscard]] Image ids(const RangeScan& scan, IdKind kind) const;
  [[nodiscard]] Buffer<float> incidences(const CurvedScan& scan, const Execution& execution) const;
};

/// The index of whatever the scene has, for single rays.
class OwnRayScene {
 public:
  OwnRayScene(const Surfaces& surfaces, const Execution& execution);
  [[nodiscard]] RayScene get() const {
    return {surfaces_, triangles_ ? &*triangles_ : nullptr, curved_ ? &*curved_ : nullptr};
  }

 private:
  const Surfaces& surfaces_;
  std::optional<RayIndex> triangles_;
  std::optional<CurvedIndex> curved_;
};

}  // namespace frontmost::cli
