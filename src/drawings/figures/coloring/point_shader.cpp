// SPDX-License-Identifier: Apache-2.0
// The shading of a picture without its pixels. Shadows are computed at points anywhere in a pixel, in groups, like
// samples of a picture. Depth colours need the range of depths in the picture, which the input holds.
#include "figures/coloring/point_shader.h"

namespace frontmost::shading {
namespace {

/// A point has one sample, at its own place.
constexpr glm::ivec2 kAtPoint[] = {{0, 0}};

/// The scene's triangles, with smooth normals of the large ones.
const TriangleStore& smoothed(PreparedScene& scene, const BitSet& large, const Execution& execution) {
  scene.triangles.smooth(large, execution);
  return scene.triangles;
}

/// The lighting of lit figures; empty for others.
Lighting lighting_of(PreparedScene& scene, const ShadeInput& input, const ShadeOptions& options,
                     const Execution& execution) {
  check_light(options.light);
  if (options.light.shows_environment)
    throw Error(ErrorCode::unsupported, "figure", "an environment cannot be shown as background");
  if (options.shading != Shading::lit) return {};
  return lighting_for(input.first().view, scene.surfaces.scene().up, options.light,
                      scene.environment(options.light, execution));
}

Lit lit_at_points(PreparedScene& scene, const ShadeInput& input, const ShadeOptions& options, const Lighting& lighting,
                  const Execution& execution) {
  Lit lit = lit_by(lighting, {input, options, kAtPoint}, scene, execution);
  lit.occlusion = scene.find_occlusion(input, options, execution);
  scene.shadows.ask_at_points();
  return lit;
}

}  // namespace

PointShader::PointShader(PreparedScene& scene, const ShadeInput& input, const FigureTriangles& triangles,
                         const ShadeOptions& options, const Execution& execution)
    : source_(smoothed(scene, triangles.large, execution), input.first().view, &triangles.large),
      lighting_(lighting_of(scene, input, options, execution)),
      opacity_(shows_materials(options.shading) ? options.opacity : 1.0f) {
  check_opacity(options);
  check_ambient_occlusion(options);
  scene.make_materials_ready(triangles.seen, execution);
  switch (options.shading) {
    case Shading::lit: colorist_ = lit_at_points(scene, input, options, lighting_, execution); break;
    case Shading::flat: colorist_ = Flat{scene.materials, execution.isa}; break;
    case Shading::normals: colorist_ = Normals{scene.materials, execution.isa}; break;
    case Shading::ids: colorist_ = Ids{}; break;
    case Shading::uv: colorist_ = Texcoords{}; break;
    case Shading::depth: {
      const DepthRange range = depth_range(input.first(), execution);
      colorist_ = Depths{glm::vec3(input.first().view.forward()), range.nearest, range.farthest};
      break;
    }
  }
}

}  // namespace frontmost::shading
