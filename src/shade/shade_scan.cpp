// SPDX-License-Identifier: Apache-2.0
// Pictures of scans: plain ones, since what shades a Visible relies on rays that are affine over the screen.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "frontmost/shade.h"
#include "shade/colorists.h"

namespace frontmost {
namespace {

using namespace shading;

constexpr float kAmbient = 0.2f;  ///< what is seen edge-on keeps this part of its colour

/// The ranges between which a picture of depths goes from bright to dark.
glm::vec2 range_limits(const RangeScan& scan) {
  glm::vec2 limits(std::numeric_limits<float>::infinity(), 0);
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    if (scan.primitives[i] == no_primitive) continue;
    limits.x = std::min(limits.x, scan.ranges[i]);
    limits.y = std::max(limits.y, scan.ranges[i]);
  }
  return limits;
}

/// Factors of the material and of the corners, without textures.
glm::vec3 base_color(const Scene& scene, const PrimitiveSource& source) {
  const Mesh& mesh = scene.meshes[source.mesh];
  const std::uint32_t material = mesh.material_of(source.triangle);
  glm::vec3 color = material < scene.materials.size() ? glm::vec3(scene.materials[material].base_color) : glm::vec3(1);
  if (!mesh.colors.empty() && !mesh.is_curved()) {
    const glm::uvec3& c = mesh.corners(mesh.colors, source.triangle);
    color *= glm::vec3(mesh.colors.values[c.x] + mesh.colors.values[c.y] + mesh.colors.values[c.z]) / 3.0f;
  }
  return glm::clamp(color, glm::vec3(0), glm::vec3(1));
}

/// Triangles, as rays met them.
struct FlatSurface {
  const Surfaces& surfaces;
  const RangeScan& scan;

  [[nodiscard]] const Scene& scene() const { return surfaces.scene(); }
  [[nodiscard]] PrimitiveSource source(PrimitiveId id) const { return surfaces.source(id); }
  /// In doubles, which no float coordinate overflows. Of any length.
  [[nodiscard]] glm::dvec3 normal(std::size_t ray) const {
    const std::array<glm::vec3, 3> p = surfaces.corners(scan.primitives[ray]);
    const glm::dvec3 a(p[0]);
    return glm::cross(glm::dvec3(p[1]) - a, glm::dvec3(p[2]) - a);
  }
};

struct CurvedSurface {
  const CurvedIndex& index;
  const Scene& of;
  const CurvedScan& met;

  [[nodiscard]] const Scene& scene() const { return of; }
  [[nodiscard]] PrimitiveSource source(PrimitiveId id) const { return index.source(id); }
  [[nodiscard]] glm::dvec3 normal(std::size_t ray) const { return met.normals[ray]; }
};

/// Of unit length, on the side that the ray comes from.
glm::dvec3 turned_against(const glm::dvec3& direction, const glm::dvec3& normal) {
  const double length = glm::length(normal);
  if (!(length > 0)) return -direction;
  return glm::dot(normal, direction) > 0 ? -normal / length : normal / length;
}

/// The colour of one pixel, linear.
template <class Surface>
class ScanColorist {
 public:
  ScanColorist(const Surface& surface, const RangeScan& scan, Shading shading)
      : surface_(surface), scan_(scan), shading_(shading) {
    if (shading == Shading::uv) throw Error(ErrorCode::unsupported, "shading uv: not for scans");
    if (shading == Shading::depth) limits_ = range_limits(scan);
  }

  [[nodiscard]] glm::vec3 at(int x, int y) const {
    const std::size_t i = scan_.index(x, y);
    if (shading_ == Shading::depth) return glm::vec3(linear_of_shown(0.95f - 0.85f * nearness(scan_.ranges[i])));
    const PrimitiveSource source = surface_.source(scan_.primitives[i]);
    if (shading_ == Shading::ids) return linear_of_shown(color_of_object(source.instance));
    const glm::vec3 base = base_color(surface_.scene(), source);
    if (shading_ == Shading::flat) return base;
    const glm::dvec3 direction = glm::normalize(glm::dvec3(ray_of(scan_.camera, x, y).direction));
    const glm::dvec3 normal = turned_against(direction, surface_.normal(i));
    if (shading_ == Shading::normals) return linear_of_shown(glm::vec3(normal * 0.5 + 0.5));
    return base * (kAmbient + (1 - kAmbient) * float(std::abs(glm::dot(normal, direction))));
  }

 private:
  [[nodiscard]] float nearness(float range) const {
    return limits_.y > limits_.x ? (range - limits_.x) / (limits_.y - limits_.x) : 0.0f;
  }

  Surface surface_;
  const RangeScan& scan_;
  Shading shading_;
  glm::vec2 limits_{0};
};

glm::vec4 background_of(const ShadeOptions& options) {
  return options.background ? glm::vec4(linear_of_shown(*options.background), 1.0f) : glm::vec4(0);
}

template <class Surface>
Image shade_scan(const Surface& surface, const RangeScan& scan, const ShadeOptions& options,
                 const Execution& execution) {
  const ScanColorist<Surface> colorist(surface, scan, options.shading);
  const glm::vec4 background = background_of(options);
  Image image{scan.width, scan.height, {}};
  for (const char* name : {"R", "G", "B", "A"}) image.channels.push_back({name, Buffer<float>(scan.ranges.size())});
  constexpr std::size_t rows_at_once = 4;
  parallel_for(execution, std::size_t(scan.height), rows_at_once, [&](std::size_t begin, std::size_t end) {
    for (int y = int(begin); y < int(end); ++y)
      for (int x = 0; x < scan.width; ++x) {
        const std::size_t i = scan.index(x, y);
        const bool seen = scan.primitives[i] != no_primitive;
        const glm::vec4 color = seen ? glm::vec4(colorist.at(x, y), 1.0f) : background;
        for (int k = 0; k < 4; ++k) image.channels[std::size_t(k)].floats()[i] = color[k];
      }
  });
  return image;
}

}  // namespace

Image shade(const Surfaces& surfaces, const RangeScan& scan, const ShadeOptions& options, const Execution& execution) {
  return shade_scan(FlatSurface{surfaces, scan}, scan, options, execution);
}

Image shade(const CurvedIndex& index, const Scene& scene, const CurvedScan& scan, const ShadeOptions& options,
            const Execution& execution) {
  return shade_scan(CurvedSurface{index, scene, scan}, scan.scan, options, execution);
}

}  // namespace frontmost
