// SPDX-License-Identifier: Apache-2.0
// What single rays meet: the curved surfaces of a model themselves and its other triangles, or triangles alone.
#pragma once

#include <frontmost/curved.h>
#include <frontmost/shade.h>

#include <string_view>

namespace frontmost::cli {

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
  [[nodiscard]] Image shade(const CurvedScan& scan, const ShadeOptions& options, const Execution& execution) const;
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
