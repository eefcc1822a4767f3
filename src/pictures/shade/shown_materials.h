// SPDX-License-Identifier: Apache-2.0
// The input of a picture of materials: a Visible and, if materials are see-through, all layers.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "shade/canvas/canvas.h"
#include "shade/layers/layers.h"
#include "shade/prepared_scene.h"

namespace frontmost::shading {

/// Everything from which a picture is made.
struct PictureRequest {
  PreparedScene& scene;
  const ShadeInput& input;
  const ShadeOptions& options;
  const Execution& execution;
};

class ShownMaterials {
 public:
  /// Prepares whatever the scene lacks.
  explicit ShownMaterials(const PictureRequest& request);
  ~ShownMaterials() { scene_.large = std::move(large_); }
  ShownMaterials(const ShownMaterials&) = delete;
  ShownMaterials& operator=(const ShownMaterials&) = delete;

  /// The positions of samples within a pixel, in 1/256.
  [[nodiscard]] std::span<const glm::ivec2> samples() const {
    return layers_ ? std::span(layer_samples_) : sample_offsets(input_.view().samples);
  }

  /// Precondition: the layers were found.
  [[nodiscard]] DeepImage deep(const Surfaces& surfaces, const FragmentShader::Colorist& colorist,
                               const Execution& execution) const;
  void paint(const Painting& painting, const Execution& execution) const;

 private:
  void find_front(const PictureRequest& request, bool wants_normals);
  void find_layers(const PictureRequest& request, bool wants_normals);
  /// Whether all that is seen in a tile is opaque, so that the front alone gives its picture.
  [[nodiscard]] bool shows_front_alone(const abuffer_detail::Rectangle& tile) const;

  const ShadeInput& input_;
  PreparedScene& scene_;
  std::optional<abuffer_detail::FragmentPass> layers_;
  std::vector<glm::ivec2> layer_samples_;
  bool takes_front_ = false;  ///< tiles without see-through parts are painted from the front, which has the same
                              ///< samples
  BitSet large_;              ///< primitives on which a smooth normal is visible, for models without normals
  std::optional<TriangleSource> source_;
};

}  // namespace frontmost::shading
