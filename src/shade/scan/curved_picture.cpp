// SPDX-License-Identifier: Apache-2.0
// Plain pictures of scans that met spheres and patches, which have no corners to interpolate between.
#include <cmath>

#include "base/parallel.h"
#include "frontmost/shade.h"
#include "shade/colorists.h"
#include "shade/scan/scan_picture.h"

namespace frontmost {
namespace {

using namespace shading;

constexpr float kAmbient = 0.2f;  ///< what is seen edge-on keeps this part of its colour

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

/// Of unit length, on the side that the ray comes from.
glm::dvec3 turned_against(const glm::dvec3& direction, const glm::dvec3& normal) {
  const double length = glm::length(normal);
  if (!(length > 0)) return -direction;
  return glm::dot(normal, direction) > 0 ? -normal / length : normal / length;
}

/// The colour of one ray, linear.
class CurvedColorist {
 public:
  CurvedColorist(const CurvedIndex& index, const Scene& scene, const CurvedScan& met, Shading shading)
      : index_(index), scene_(scene), met_(met), shading_(shading) {
    if (shading == Shading::uv) throw Error(ErrorCode::unsupported, "shading uv: not for scans of curved surfaces");
    if (shading == Shading::depth) limits_ = depth_range(met.scan);
  }

  [[nodiscard]] glm::vec3 at(int x, int y, int sample) const {
    const RangeScan& scan = met_.scan;
    const std::size_t i = scan.index(x, y, sample);
    if (shading_ == Shading::depth) return shown_depth(scan.ranges[i], limits_.nearest, limits_.farthest);
    const PrimitiveSource source = index_.source(scan.primitives[i]);
    if (shading_ == Shading::ids) return linear_of_shown(color_of_object(source.instance));
    const glm::vec3 base = base_color(scene_, source);
    if (shading_ == Shading::flat) return base;
    const glm::dvec3 direction = glm::normalize(glm::dvec3(ray_of(scan.camera, x, y, sample).direction));
    const glm::dvec3 normal = turned_against(direction, glm::dvec3(met_.normals[i]));
    if (shading_ == Shading::normals) return linear_of_shown(glm::vec3(normal * 0.5 + 0.5));
    return base * (kAmbient + (1 - kAmbient) * float(std::abs(glm::dot(normal, direction))));
  }

 private:
  const CurvedIndex& index_;
  const Scene& scene_;
  const CurvedScan& met_;
  Shading shading_;
  DepthRange limits_;
};

glm::vec4 background_of(const ShadeOptions& options) {
  return options.background ? glm::vec4(linear_of_shown(*options.background), 1.0f) : glm::vec4(0);
}

}  // namespace

Image shade(const CurvedIndex& index, const Scene& scene, const CurvedScan& met, const ShadeOptions& options,
            const Execution& execution) {
  if (options.opacity < 1.0f)
    throw Error(ErrorCode::unsupported, "opacity: scans of curved surfaces show what is in front alone");
  const RangeScan& scan = met.scan;
  const CurvedColorist colorist(index, scene, met, options.shading);
  const glm::vec4 background = background_of(options);
  const int samples = scan.camera.samples;
  const std::size_t pixels = scan.index(0, 0, 1);
  Image image{scan.width, scan.height, {}};
  for (const char* name : {"R", "G", "B", "A"}) image.channels.push_back({name, Buffer<float>(pixels)});
  constexpr std::size_t rows_at_once = 4;
  parallel_for(execution, std::size_t(scan.height), rows_at_once, [&](std::size_t begin, std::size_t end) {
    for (int y = int(begin); y < int(end); ++y)
      for (int x = 0; x < scan.width; ++x) {
        glm::vec4 sum(0);
        for (int s = 0; s < samples; ++s) {
          const bool seen = scan.primitives[scan.index(x, y, s)] != no_primitive;
          sum += seen ? glm::vec4(colorist.at(x, y, s), 1.0f) : background;
        }
        for (int k = 0; k < 4; ++k) image.channels[std::size_t(k)].floats()[scan.index(x, y)] = sum[k] / float(samples);
      }
  });
  return image;
}

}  // namespace frontmost
