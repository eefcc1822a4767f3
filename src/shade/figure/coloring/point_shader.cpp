// SPDX-License-Identifier: Apache-2.0
#include "shade/figure/coloring/point_shader.h"

namespace frontmost::shading {
namespace {

/// Points have one sample, where they are.
constexpr glm::ivec2 kAtPoint[] = {{0, 0}};

std::unique_ptr<const KeyShadows> shadows_for(const ShadedPicture& picture, const Lighting& lighting,
                                              const Execution& execution) {
  if (picture.options.shading != Shading::lit) return nullptr;
  auto shadows = std::make_unique<KeyShadows>(picture, lighting.to_key, execution);
  shadows->ask_at_points();
  return shadows;
}

}  // namespace

PointShader::PointShader(const Surfaces& surfaces, const ShadeInput& input, const FigureTriangles& triangles,
                         const ShadeOptions& options, const Execution& execution)
    : source_(surfaces, input.visible.view, &triangles.large, execution),
      table_(surfaces.scene(),
             needed_materials(
                 surfaces, [&]() -> const BitSet& { return triangles.seen; }, execution),
             execution),
      lighting_(lighting_for(input.visible.view, surfaces.scene().up)),
      shadows_(shadows_for({surfaces, input, options, kAtPoint}, lighting_, execution)),
      opacity_(shows_materials(options.shading) ? options.opacity : 1.0f) {
  check_opacity(options);
  switch (options.shading) {
    case Shading::lit: colorist_ = Lit{table_, lighting_, shadows_->map(), shadows_->rays(), execution.isa}; break;
    case Shading::flat: colorist_ = Flat{table_}; break;
    case Shading::normals: colorist_ = Normals{table_}; break;
    case Shading::ids: colorist_ = Ids{}; break;
    case Shading::uv: colorist_ = Texcoords{}; break;
    case Shading::depth: {
      const DepthRange range = depth_range(input.visible, execution);
      colorist_ = Depths{glm::vec3(input.visible.view.forward()), range.nearest, range.farthest};
      break;
    }
  }
}

}  // namespace frontmost::shading
