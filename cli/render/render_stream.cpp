// SPDX-License-Identifier: Apache-2.0
#include <frontmost/pictures.h>

#include "cli/render/output_writer.h"
#include "cli/render/render_view.h"
#include "cli/stopwatch.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

StreamNeeds needs_of(const Job& job, const SightPlan& plan, const LightOptions& light) {
  const bool picture = plan.picture_samples.has_value();
  const bool lit = picture && job.output.shading == Shading::lit;
  const bool shows_normals = lit || (picture && job.output.shading == Shading::normals);
  const bool has_shadows = picture && has_key_light(job) && job.output.shadows != Shadows::off;
  return {has_shadows, shows_normals || wants(job, OutputKind::normals), light, nullptr};
}

void check_one_pass(const Job& job, const StreamNeeds& needs, const Stream& stream) {
  const auto refuse = [](const char* advice) {
    throw Error(ErrorCode::unsupported, "standard input and pipes can be read only once", advice);
  };
  if (stream.can_repeat()) return;
  if (depends_on_model(job.view))
    refuse("give the camera (--camera-position with --camera-focal-point, or --pose), --near and --far");
  // Smooth normals may need no further pass; look() decides.
  if (needs.key_light) refuse("shadows need another pass; use --no-shadows, or --shading flat, depth, ids or uv");
}

/// Returns a scene with these bounds, which suffice for framing.
Scene scene_of(const Box& bounds, const glm::dvec3& origin) {
  Scene scene;
  scene.origin = origin;
  if (bounds.is_empty()) return scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = {bounds.low, bounds.high};
  mesh.triangles = {glm::uvec3(0), glm::uvec3(1)};
  scene.instances.emplace_back();
  return scene;
}

/// Returns the view without a model. It has the direction, shape and size of the final view.
View view_of_nothing(const Job& job, const Stream& stream, const Execution& execution) {
  Scene nothing;
  nothing.up = stream.scene().up;
  nothing.origin = stream.scene().origin;
  // The outline must include the whole model, so zoom is applied later.
  ViewSettings settings = job.view;
  if (depends_on_model(settings)) settings.zoom = 1;
  return resolve_view(settings, Surfaces(nothing, execution));
}

/// Returns the camera that the whole model determines.
View find_view(const Job& job, const View& of_nothing, Stream& stream, const Execution& execution) {
  if (!depends_on_model(job.view)) return of_nothing;
  const Scene outline = stream.outline(of_nothing, FrameOptions().margin, execution);
  return resolve_view(job.view, Surfaces(outline, execution));
}

}  // namespace

ViewResult render_streamed_view(const Job& job, Stream& stream, const StreamContext& context) {
  const View of_nothing = view_of_nothing(job, stream, context.execution);
  const SightPlan plan = plan_sights(job, context.run, context.keep_picture, of_nothing);
  StreamNeeds needs = needs_of(job, plan, context.environments.light(job.output.light, context.execution));
  check_one_pass(job, needs, stream);
  ViewResult result;
  result.name = job.name;
  const Stopwatch watch;
  result.view = find_view(job, of_nothing, stream, context.execution);
  BlankReason blank_reason(result.view);
  needs.unseen = [&](CornerSpan triangles) { blank_reason.add(triangles); };
  Excerpt excerpt = stream.look(views_of(result.view, plan), needs, context.execution);
  result.timings.visible.push_back(watch.milliseconds());
  if (context.ranks) blank_reason.gather(*context.ranks);
  if (context.ranks && context.ranks->number() != 0) return result;
  const Scene bounds = scene_of(stream.bounds(), stream.scene().origin);
  result.target = focal_point_of(job.view, result.view, Surfaces(bounds, context.execution));

  Sights sights;
  sights.shared = plan.shared;
  if (plan.picture_samples) sights.picture = SeenView{std::move(excerpt.visible.front()), {}};
  if (plan.maps && !plan.shared) sights.maps = SeenView{std::move(excerpt.visible.back()), {}};
  sights.stream_ids = &excerpt.stream_ids;
  sights.blank_reason = &blank_reason;
  if (excerpt.seen_by_light) sights.seen_by_light = &*excerpt.seen_by_light;
  Shader shader(excerpt.surfaces());
  finish_view(job,
              {excerpt.surfaces(), shader, context.environments, context.run, context.execution, context.keep_picture},
              sights, result);
  return result;
}

}  // namespace frontmost::cli
