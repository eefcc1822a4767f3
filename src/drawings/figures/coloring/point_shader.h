// SPDX-License-Identifier: Apache-2.0
// Everything that the colours of single points are made from.
//
// A picture is shaded where samples are, a figure where its pieces are looked at: at any place, of polygons that a
// picture may not show. Both use the same triangles, materials, lights and shadows, so that a figure has the colours of
// the picture of the same view. What all threads share is here; each thread has a FragmentShader for its batches.
#pragma once

#include "shade/colorists.h"
#include "shade/fragment_shader.h"
#include "shade/picture_parts.h"
#include "shade/prepared_scene.h"

namespace frontmost::shading {

/// Triangles, of a figure.
struct FigureTriangles {
  BitSet seen;   ///< all that the figure holds
  BitSet large;  ///< those worth a smooth normal where the model has none
};

/// For several threads at once: each has a FragmentShader of its own.
class PointShader {
 public:
  /// Borrows all but the options; makes ready what the scene does not have yet. \throws Error as check_opacity().
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
