// SPDX-License-Identifier: Apache-2.0
// Poses, shares, masks and depths as BOP's tools read them: in millimetres, in the coordinates of the model files.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/dataset_files.h"
#include "frontmost/zbuffer.h"

namespace frontmost::datasets {
namespace {

constexpr double tolerance_mm = 15;  // the tolerance of bop_toolkit's visibility tests

double millimetres_per_unit(const Scene& scene) { return 1000 * scene.source.metres_per_unit.value_or(0.001); }

/// Adding 0 turns -0 into 0.
Json vector_json(const glm::dvec3& v) { return Json::array({v.x + 0.0, v.y + 0.0, v.z + 0.0}); }

Json rows_json(const glm::dmat3& m) {
  Json json = Json::array();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) json.push_back(m[column][row] + 0.0);
  return json;
}

/// Converts a matrix for points relative to `origin` into one for points relative to zero.
glm::dmat4 from_zero(glm::dmat4 m, const glm::dvec3& origin) {
  m[3] = m * glm::dvec4(-origin, 1);
  return m;
}

glm::dmat4 camera_from_world(const DatasetView& view) {
  return pose_of(view.visible.view.world_from_eye, PoseConvention::opencv_world_to_camera);
}

Json camera_json(const DatasetView& view, double millimetres, double depth_scale) {
  const View& camera = view.visible.view;
  const Intrinsics k = intrinsics_of(camera.projection, camera.width, camera.height, PixelRule::centre_at_integer);
  const glm::dmat4 pose = from_zero(camera_from_world(view), view.surfaces.scene().origin);
  return {{"cam_K", {k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1}},
          {"depth_scale", depth_scale},
          {"cam_R_w2c", rows_json(glm::dmat3(pose))},
          {"cam_t_w2c", vector_json(glm::dvec3(pose[3]) * millimetres)}};
}

/// The category's number. Objects without a category are numbered after the highest category, by mesh.
std::uint64_t object_number(const Scene& scene, const Instance& instance) {
  if (instance.category != no_index) return scene.categories[instance.category].number;
  std::uint64_t highest = 0;
  for (const Category& category : scene.categories) highest = std::max<std::uint64_t>(highest, category.number);
  return highest + instance.mesh + 1;
}

/// \throws Error unsupported for an object that is stretched or mirrored: BOP's poses hold rotation and translation
/// alone.
Json pose_json(const DatasetView& view, std::uint32_t object, double millimetres) {
  const Scene& scene = view.surfaces.scene();
  const Instance& instance = scene.instances[object];
  const glm::dmat4 pose =
      from_zero(camera_from_world(view) * instance.world_from_mesh, scene.meshes[instance.mesh].origin);
  const double scale = std::cbrt(glm::determinant(glm::dmat3(pose)));
  const glm::dmat3 turn = glm::dmat3(pose) * (1 / scale), rest = glm::transpose(turn) * turn - glm::dmat3(1.0);
  double most = 0;
  for (int column = 0; column < 3; ++column) most = std::max(most, glm::length(rest[column]));
  if (!(scale > 0 && most < 1e-4))
    throw Error(ErrorCode::unsupported, "bop",
                "object " + std::to_string(object) + " (" + printable_text(instance.name) +
                    ") is stretched or mirrored, which BOP's poses cannot be; leave it out");
  return {{"cam_R_m2c", rows_json(turn)},
          {"cam_t_m2c", vector_json(glm::dvec3(pose[3]) * millimetres)},
          {"obj_id", object_number(scene, instance)}};
}

/// A box as in bop_toolkit: its size is the distance from the first pixel to the last, one less than the number of
/// pixels.
Json bop_box(const PixelBox& box, bool is_seen) {
  return is_seen ? Json::array({box.x, box.y, box.width - 1, box.height - 1}) : Json::array({-1, -1, -1, -1});
}

/// Marks as visible the pixels whose object lies at most 15 mm behind the seen surface, along the ray.
void mark_within_tolerance(const DatasetView& view, ObjectInFrame& object, const Image& seen,
                           const Execution& execution) {
  const Scene& scene = view.surfaces.scene();
  Scene alone;
  alone.meshes = {scene.meshes[scene.instances[object.number].mesh]};
  alone.instances = {scene.instances[object.number]};
  alone.instances[0].mesh = 0;
  alone.materials = scene.materials;
  alone.textures = scene.textures;
  alone.categories = scene.categories;
  const Surfaces surfaces(alone, execution);
  const Image distances = ray_distance_image(zbuffer(surfaces, view.visible.view, execution));
  const double most = tolerance_mm / millimetres_per_unit(scene);
  const PixelBox& box = object.mask.box;
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x) {
      MaskPixel& pixel = object.mask.pixels[std::size_t(y) * std::size_t(box.width) + std::size_t(x)];
      if (pixel == MaskPixel::outside) continue;
      const std::size_t at = std::size_t(box.y + y) * std::size_t(seen.width) + std::size_t(box.x + x);
      const double behind = double(distances.channels[0].floats()[at]) - double(seen.channels[0].floats()[at]);
      pixel = behind <= most ? MaskPixel::visible : MaskPixel::hidden;
    }
}

SampleSet visible_of(const PixelMask& mask) {
  SampleSet set;
  int x0 = mask.box.width, y0 = mask.box.height, x1 = -1, y1 = -1;
  for (int y = 0; y < mask.box.height; ++y)
    for (int x = 0; x < mask.box.width; ++x) {
      if (mask.at(mask.box.x + x, mask.box.y + y) != MaskPixel::visible) continue;
      ++set.count;
      x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = y;
    }
  if (set.count > 0) set.box = {mask.box.x + x0, mask.box.y + y0, x1 - x0 + 1, y1 - y0 + 1};
  return set;
}

Json info_json(const ObjectAccount& account, const PixelMask& mask) {
  const SampleSet seen = visible_of(mask);
  return {{"px_count_all", account.alone.count},
          {"px_count_valid", account.in_frame.count},
          {"px_count_visib", seen.count},
          {"visib_fract", double(seen.count) / double(account.alone.count)},
          {"bbox_obj", bop_box(account.alone.box, seen.count > 0)},
          {"bbox_visib", bop_box(seen.box, seen.count > 0)}};
}

/// Millimetres for one step of the depth file: the least power of ten, from 0.1 on, with which all depths fit.
double depth_scale_of(const Image& depths, double millimetres) {
  double farthest = 0, scale = 0.1;
  for (const float depth : depths.channels[0].floats())
    if (std::isfinite(depth)) farthest = std::max(farthest, double(depth) * millimetres);
  while (farthest / scale > 65535) scale *= 10;
  return scale;
}

void append_element(std::string& list, const Json& json) { list += (list.empty() ? "" : ", ") + json.dump(); }

/// A line for each view, as bop_toolkit writes them.
void append_view(std::string& file, std::size_t view, const std::string& text) {
  file += (file.empty() ? "  \"" : ",\n  \"") + std::to_string(view) + "\": " + text;
}

}  // namespace

void BopFolder::begin_view(const DatasetView& view, const Execution& execution) {
  if (view.visible.view.projection.orthographic)
    throw Error(ErrorCode::unsupported, "bop",
                "the view is a parallel projection; BOP stores perspective cameras only");
  millimetres_ = millimetres_per_unit(view.surfaces.scene());
  const Image depths = depth_image(view.visible);
  if (visible_ == BopVisible::bop19) distances_ = ray_distance_image(view.visible);
  const double scale = depth_scale_of(depths, millimetres_);
  SaveOptions options;
  options.depth_scale = millimetres_ / scale;
  folder_.add("depth/" + six_digits(view_) + ".png", depths, options, execution);
  append_view(cameras_, view_, camera_json(view, millimetres_, scale).dump());
  object_ = 0;
  poses_.clear();
  infos_.clear();
}

void BopFolder::add(const DatasetView& view, ObjectInFrame object, const Execution& execution) {
  if (visible_ == BopVisible::bop19) mark_within_tolerance(view, object, distances_, execution);
  const std::string name = "/" + six_digits(view_) + "_" + six_digits(object_++) + ".png";
  const View& camera = view.visible.view;
  folder_.add("mask" + name, mask_image(object.mask, MaskPart::whole, camera), {}, execution);
  folder_.add("mask_visib" + name, mask_image(object.mask, MaskPart::visible, camera), {}, execution);
  append_element(poses_, pose_json(view, object.number, millimetres_));
  append_element(infos_, info_json(view.accounts.objects[object.number], object.mask));
}

void BopFolder::end_view() {
  append_view(all_poses_, view_, "[" + poses_ + "]");
  append_view(all_infos_, view_, "[" + infos_ + "]");
  ++view_;
}

std::vector<std::string> BopFolder::finish() {
  const auto add = [&](const char* name, const std::string& views) { folder_.add(name, "{\n" + views + "\n}\n"); };
  add("scene_camera.json", cameras_);
  add("scene_gt.json", all_poses_);
  add("scene_gt_info.json", all_infos_);
  return folder_.finish();
}

}  // namespace frontmost::datasets
