// SPDX-License-Identifier: Apache-2.0
#include "shade/shadow/key_shadows.h"

#include "shade/layers/opaque_part.h"

namespace frontmost::shading {
namespace {

/// What throws shadows: the surfaces, or those of their opaque part.
class Casters {
 public:
  Casters(const Surfaces& all, const Execution& execution) : all_(all) {
    if (!has_see_through(all.scene())) return;
    scene_ = opaque_part(all.scene());
    opaque_.emplace(scene_, execution);
  }

  [[nodiscard]] const Surfaces& surfaces() const { return opaque_ ? *opaque_ : all_; }
  [[nodiscard]] bool are_all() const { return !opaque_; }

 private:
  const Surfaces& all_;
  Scene scene_;
  std::optional<Surfaces> opaque_;
};

}  // namespace

KeyShadows::KeyShadows(const ShadedPicture& picture, const glm::vec3& to_key, const Execution& execution) {
  const ShadeOptions& options = picture.options;
  const View& view = picture.input.visible.view;
  if (options.shadows == Shadows::off) return;
  if (options.shadows == Shadows::map && picture.input.seen_by_light) {
    map_.emplace(*picture.input.seen_by_light, view.eye(), execution);
    return;
  }
  const Casters casters(picture.surfaces, execution);
  if (options.shadows == Shadows::map) {
    map_.emplace(casters.surfaces(), picture.input.visible, glm::dvec3(to_key), execution);
    return;
  }
  if (!casters.are_all() || !picture.input.index) index_.emplace(casters.surfaces(), execution);
  rays_.emplace(index_ ? *index_ : *picture.input.index, picture.samples, to_key, execution.isa);
  if (!casters.are_all()) rays_->forget_ids();
}

}  // namespace frontmost::shading
