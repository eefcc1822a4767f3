// SPDX-License-Identifier: Apache-2.0
// The shared data for the colours of single points.
//
// A picture is shaded at its samples; a figure at the sample places of its pieces, also on polygons that the picture
// does not show. Both use the same triangles, materials, lights and shadows, so a figure has the colours of the picture
// of the same view. Data that all threads share is here; each thread has a FragmentShader for its batches.
#pragma once

#include "shade/colorists.h"
#include "shade/fragment_shader.h"
#include "shade/picture_parts.h"
#include "shade/prepared_scene.h"

namespace frontmost::shading {

/// The triangles of a figure.
struct FigureTriangles {
  BitSet seen;   ///< all triangles of the figure
  BitSet large;  ///< triangles that need a smooth normal if the model has none
};

/// Safe for several threads at once; each has its own FragmentShader.
class PointShader {
 public:
  /// Borrows all but the options; prepares whatever the scene lacks. \throws Error as check_opacity() does.
  PointShader(PreparedScene& scene, const ShadeInput& input, const FigureTriangles& triangles,
              const ShadeOptions& options, const Execution& execution);

  [[nodiscard]] const TriangleSource& source() const { return source_; }
  [[nodiscard]] const FragmentShader::Colorist& colorist() const { return colorist_; }
  [[nodiscard]] float opacity() const { return opacity_; }

 private:
  const TriangleSource source_;
  const Lighting lighting_;
  FragmentShader::Colorist colorist_;
  const float opacity_;
};

}  // namespace frontmost::shading
