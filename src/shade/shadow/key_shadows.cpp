// SPDX-License-Identifier: Apache-2.0
#include "shade/shadow/key_shadows.h"

#include "shade/layers/opaque_part.h"
#include "view/answer.h"

namespace frontmost::shading {
namespace {

/// Of two views of lights, which are orthographic and square.
bool are_equal(const View& a, const View& b) {
  const Projection &p = a.projection, &q = b.projection;
  return a.width == b.width && a.world_from_eye == b.world_from_eye && p.left == q.left && p.right == q.right &&
         p.bottom == q.bottom && p.top == q.top && p.clip.near == q.clip.near && p.clip.far == q.clip.far;
}

/// What callers found of key_light_view(). \throws Error bad_argument.
void check_light(const Visible& seen_by_light) {
  constexpr const char* who = "shade: what the light sees";
  check_planes(seen_by_light, who);
  const View& view = seen_by_light.view;
  if (view.width == view.height && view.width >= 4 * ShadowGrid::block && view.width % ShadowGrid::block == 0 &&
      view.samples == 1 && view.projection.orthographic)
    return;
  throw Error(ErrorCode::bad_argument, std::string(who) + ": must be of a view that key_light_view() gave");
}

}  // namespace

void KeyShadows::find(const ShadedPicture& picture, const glm::vec3& to_key, const Execution& execution) {
  shows_map_ = false;
  rays_.reset();
  const ShadeInput& input = picture.input;
  if (picture.options.shadows == Shadows::off) return;
  if (picture.options.shadows == Shadows::rays) return aim_rays(picture, to_key, execution);
  if (input.seen_by_light) {
    check_light(*input.seen_by_light);
    has_drawn_ = false;
    map_.draw(*input.seen_by_light, execution);
    map_.measure_from(input.visible.view.eye());
  } else {
    draw_map(input.visible, to_key, execution);
  }
  shows_map_ = true;
}

const Surfaces& KeyShadows::casters(const Execution& execution) {
  if (!opaque_ && has_see_through(all_.scene())) {
    opaque_scene_ = opaque_part(all_.scene());
    opaque_.emplace(opaque_scene_, execution);
  }
  return opaque_ ? *opaque_ : all_;
}

void KeyShadows::draw_map(const Visible& visible, const glm::vec3& to_key, const Execution& execution) {
  const Surfaces& surfaces = casters(execution);
  const std::optional<View> light = view_of_light(visible, surfaces.bounds(), glm::dvec3(to_key), execution);
  has_drawn_ = has_drawn_ && light && are_equal(map_.view(), *light);
  if (!light) return map_.clear();
  if (!has_drawn_) {
    // The first map may be the only one: a ZBuffer would make clusters for it.
    if (!surfaces.made_clusters()) {
      Visible planes = zbuffer(surfaces, *light, execution);
      map_.draw(planes, execution);
      light_.give_back(std::move(planes));  // moved planes stay where they are
    } else {
      map_.draw(light_.draw(surfaces, *light, execution), execution);
    }
    has_drawn_ = true;
  }
  map_.measure_from(visible.view.eye());
}

void KeyShadows::aim_rays(const ShadedPicture& picture, const glm::vec3& to_key, const Execution& execution) {
  const Surfaces& surfaces = casters(execution);
  const RayIndex* index = picture.input.index;
  if (opaque_ || !index) {
    if (!index_) index_.emplace(surfaces, execution);
    index = &*index_;
  }
  rays_.emplace(*index, picture.samples, to_key, execution.isa);
  if (opaque_) rays_->forget_ids();
}

}  // namespace frontmost::shading
