// SPDX-License-Identifier: Apache-2.0
// What a picture of materials is made of: what a Visible shows and, where materials can be seen through, all layers.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "shade/canvas/canvas.h"
#include "shade/layers/layers.h"
#include "shade/prepared_scene.h"

namespace frontmost::shading {

/// All that a picture is made from.
struct PictureRequest {
  PreparedScene& scene;
  const ShadeInput& input;
  const ShadeOptions& options;
  const Execution& execution;
};

class ShownMaterials {
 public:
  /// Makes ready what the scene does not have yet.
  explicit ShownMaterials(const PictureRequest& request);
  ~ShownMaterials() { scene_.large = std::move(large_); }
  ShownMaterials(const ShownMaterials&) = delete;
  ShownMaterials& operator=(const ShownMaterials&) = delete;

  /// Where a fragment's samples lie within its pixel, in 1/256.
  [[nodiscard]] std::span<const glm::ivec2> samples() const {
    return layers_ ? std::span(layer_samples_) : sample_offsets(input_.view().samples);
  }

  /// Precondition: with layers.
  [[nodiscard]] DeepImage deep(const Surfaces& surfaces, const FragmentShader::Colorist& colorist,
                               const Execution& execution) const;
  void paint(const Painting& painting, const Execution& execution) const;

 private:
  void find_front(const PictureRequest& request, bool wants_normals);
  void find_layers(const PictureRequest& request, bool wants_normals);
  /// Whether nothing can be seen through that is seen in a tile, so that what is visible there is all that is seen.
  [[nodiscard]] bool shows_front_alone(const abuffer_detail::Rectangle& tile) const;

  const ShadeInput& input_;
  PreparedScene& scene_;
  std::optional<abuffer_detail::FragmentPass> layers_;
  std::vector<glm::ivec2> layer_samples_;
  bool takes_front_ = false;  ///< what is visible where no layers are needed: they are found at the same samples
  BitSet large_;              ///< primitives that are worth a smooth normal where the model has none
  std::optional<TriangleSource> source_;
};

}  // namespace frontmost::shading
