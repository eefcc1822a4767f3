// SPDX-License-Identifier: Apache-2.0
#include "cli/render/json_report.h"

#include <fmt/format.h>
#include <frontmost/base.h>
#include <frontmost/version.h>

#include <algorithm>

#include "cli/render/output_writer.h"
#include "cli/values.h"
#include "cli/view/camera_report.h"
#include "cli/view/sight.h"

namespace frontmost::cli {
namespace {

// Returns a hash as text, because JSON numbers above 2^53 lose bits in many readers.
std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

Json seen_json(const Seen& seen, const View& view) {
  Json objects = Json::array();
  for (const SeenObject& object : seen.objects) {
    objects.push_back({{"object", object.instance}, {"name", object.name}, {"covered_pixels", object.pixels}});
  }
  return {{"hash", hash_text(seen.hash)},
          {"pixels", view.pixel_count()},
          {"covered_pixels", seen.pixels},
          {"objects", std::move(objects)}};
}

Json reference_json(const ReferenceResult& reference) {
  Json json = {{"file", reference.path},
               {"passed", reference.passed},
               {"largest_difference", finite_or_null(reference.largest_difference)},
               {"mean_difference", finite_or_null(reference.mean_difference)},
               {"differing_pixels", reference.differing_pixels}};
  if (!reference.difference_path.empty()) json["difference_file"] = reference.difference_path;
  return json;
}

void add_timings(const Timings& timings, Json& json) {
  json["visible"] = times_json(timings.visible);
  if (timings.visible_maps) json["visible_maps"] = *timings.visible_maps;
  if (timings.edges) json["edges"] = *timings.edges;
  json["shade"] = timings.shade;
  json["save"] = timings.save;
}

Json depth_json(const DepthSettings& settings) {
  const DepthState state = depth_state(settings);
  return {{"format", name(settings.format)},
          {"func", name(state.func)},
          {"mask", state.mask},
          {"clear", depth_clear(settings)},
          {"range", {state.range_near, state.range_far}},
          {"polygon_offset", {state.offset.factor, state.offset.units}},
          {"reversed", state.nearer_is_greater}};
}

/// Returns the camera of a view. Entries that only pinholes have are left out for other cameras.
Json view_camera_json(const ViewResult& result, const glm::dvec3& origin) {
  Json json = camera_json(result.view, result.target, origin);
  if (result.camera_model == CameraModel::pinhole) return json;
  for (const char* key :
       {"flags", "sides", "field_of_view_degrees", "intrinsics", "near", "far", "projection_matrices"})
    json.erase(key);
  const bool is_fisheye = result.camera_model == CameraModel::fisheye;
  json["projection"] = is_fisheye ? "fisheye" : "panorama";
  if (is_fisheye) json["field_of_view_degrees"] = result.fisheye_angle;
  return json;
}

Json light_json(const LightSettings& light) {
  constexpr std::string_view tone_mappings[] = {"none", "aces", "khronos"};
  const LightOptions& options = light.options;
  Json json = {{"environment", light.environment.value_or("studio")},
               {"environment_angle_degrees", options.environment_angle * degrees_per_radian},
               {"exposure", options.exposure},
               {"tone_mapping", tone_mappings[int(options.tone_mapping)]}};
  if (options.direction) json["light_direction"] = to_json(*options.direction);
  if (options.intensity) json["light_intensity"] = *options.intensity;
  return json;
}

/// Returns the options that determine the look of a view's pictures, with their defaults.
Json look_json(const OutputSettings& output) {
  constexpr std::string_view shadings[] = {"lit", "flat", "normals", "depth", "ids", "uv"};
  constexpr std::string_view lights[] = {"key", "file", "both", "none"}, shadows[] = {"off", "map", "rays"};
  Json json = {{"shading", shadings[int(output.shading)]},
               {"blend", output.blend == Blend::srgb ? "srgb" : "linear"},
               {"opacity", output.opacity}};
  if (output.shading != Shading::lit) return json;
  json["lights"] = lights[int(output.lights.value_or(Lights::key))];
  json["shadows"] = shadows[int(output.shadows)];
  json["ambient_occlusion"] = output.ambient_occlusion;
  json.update(light_json(output.light));
  return json;
}

Json view_json(const Job& job, const ViewResult& result, const glm::dvec3& origin) {
  Json json = {{"name", result.name}, {"view", view_camera_json(result, origin)}};
  if (writes_colors(job)) json["look"] = look_json(job.output);
  if (result.depth.is_used) json["depth_buffer"] = depth_json(result.depth);
  if (result.seen) json["seen"] = seen_json(*result.seen, result.view);
  json["files"] = Json::array();
  for (const Result& file : result.results) {
    Json& one = json["files"].emplace_back(Json{{"what", file.what}, {"path", file.path}});
    if (file.what == figure_name) one["method"] = "painter";
    if (file.hash) one["hash"] = hash_text(*file.hash);
  }
  if (result.reference) json["reference"] = reference_json(*result.reference);
  json["warnings"] = result.warnings;
  return json;
}

/// Whether files were written, and all of them are polygons.
bool has_only_figures(const std::vector<ViewResult>& views) {
  bool has_any = false;
  for (const ViewResult& view : views)
    for (const Result& file : view.results) {
      if (file.what != figure_name) return false;
      has_any = true;
    }
  return has_any;
}

/// Returns the name of the method that made the picture.
std::string_view method_name(const Settings& settings, const ModelFacts& model, const std::vector<ViewResult>& views) {
  const auto is_pinhole = [](const ViewResult& view) { return view.camera_model == CameraModel::pinhole; };
  if (!views.empty() && std::none_of(views.begin(), views.end(), is_pinhole)) return "raycast";
  if (has_only_figures(views)) return "painter";
  constexpr std::string_view names[] = {"zbuffer", "raycast", "abuffer"};
  const bool is_seen_through = model.lets_light_through && !settings.view.depth.is_used;
  const bool needs_layers = is_seen_through || settings.output.opacity < 1 || settings.output.layers;
  return names[int(settings.run.method.value_or(needs_layers ? Method::abuffer : Method::zbuffer))];
}

}  // namespace

Json render_json(const Settings& settings, const ModelFacts& model, const std::vector<Job>& jobs,
                 const std::vector<ViewResult>& views, const RunTimings& timings) {
  Json json = {
      {"frontmost", FRONTMOST_VERSION}, {"model", settings.model}, {"method", method_name(settings, model, views)}};
  json["isa"] = name(settings.run.isa);
  if (!settings.more_models.empty()) json["more_models"] = settings.more_models;
  json["triangles"] = model.triangles;
  json["lights"] = model.lights;
  if (model.passes) json["stream_passes"] = *model.passes;
  Json times = {{"load", timings.load}, {"surfaces", timings.surfaces}};
  if (timings.index) times["index"] = *timings.index;
  if (model.finished_before) json["finished_before"] = *model.finished_before;
  if (settings.run.batch) {
    json["views"] = Json::array();
    for (std::size_t i = 0; i < views.size(); ++i) {
      Json one = view_json(jobs[i], views[i], model.origin);
      add_timings(views[i].timings, one["timings_ms"]);
      json["views"].push_back(std::move(one));
    }
    json["warnings"] = model.warnings;
  } else {
    json.update(view_json(jobs.front(), views.front(), model.origin));
    for (const std::string& warning : model.warnings) json["warnings"].push_back(warning);
    add_timings(views.front().timings, times);
  }
  times["total"] = timings.total;
  json["timings_ms"] = std::move(times);
  return json;
}

std::string hash_lines(const std::vector<ViewResult>& views, bool is_batch) {
  std::string lines;
  for (const ViewResult& view : views) {
    if (!view.seen) continue;  // no hash was asked for
    const std::string prefix = is_batch ? printable_text(view.name) + ":" : "";
    lines += fmt::format("{}visible {}\n", prefix, hash_text(view.seen->hash));
    for (const Result& result : view.results) {
      if (!result.hash) continue;  // polygons have no hash
      lines += fmt::format("{}{} {} {}\n", prefix, result.what, hash_text(*result.hash), printable_text(result.path));
    }
  }
  return lines;
}

}  // namespace frontmost::cli
