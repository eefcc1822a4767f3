// SPDX-License-Identifier: Apache-2.0
// A scene folder of BOP with one image, number 0: https://github.com/thodan/bop_toolkit, docs/bop_datasets_format.md.
//
//    scene_camera.json  scene_gt.json  scene_gt_info.json  depth/000000.png  mask/000000_*.png  mask_visib/000000_*.png
//
// All files are written into a hidden folder first and moved when they are whole.
#include <fmt/format.h>
#include <frontmost/io.h>
#include <frontmost/zbuffer.h>

#include <algorithm>

#include "cli/console.h"
#include "cli/failure.h"
#include "cli/report/report_files.h"
#include "cli/staged_folder.h"

namespace frontmost::cli {
namespace {

constexpr double tolerance_mm = 15;  // of bop_toolkit's tests of visibility

/// Of an object with samples in the picture.
struct BopObject {
  std::uint32_t object;
  PixelMask mask;
};

double millimetres_per_unit(const Scene& scene) { return 1000 * scene.source.metres_per_unit.value_or(0.001); }

Json rows_json(const glm::dmat3& m) {
  Json json = Json::array();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) json.push_back(m[column][row] + 0.0);
  return json;
}

/// Of points that are told from an origin, as `m` is, a matrix for those that are told from zero.
glm::dmat4 from_zero(glm::dmat4 m, const glm::dvec3& origin) {
  m[3] = m * glm::dvec4(-origin, 1);
  return m;
}

/// From the world as the model's file has it.
glm::dmat4 camera_from_file(const ReportRun& run) {
  return from_zero(pose_of(run.view().world_from_eye, PoseConvention::opencv_world_to_camera), run.scene().origin);
}

Json camera_json(const ReportRun& run, double millimetres, double depth_scale) {
  const View& view = run.view();
  const Intrinsics k = intrinsics_of(view.projection, view.width, view.height, PixelRule::centre_at_integer);
  const glm::dmat4 pose = camera_from_file(run);
  return {{"cam_K", {k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1}},
          {"depth_scale", depth_scale},
          {"cam_R_w2c", rows_json(glm::dmat3(pose))},
          {"cam_t_w2c", to_json(glm::dvec3(pose[3]) * millimetres)}};
}

/// The category's number; objects without a category are counted on from the highest of these, by mesh.
std::uint64_t object_number(const Scene& scene, const Instance& instance) {
  if (instance.category != no_index) return scene.categories[instance.category].number;
  std::uint64_t highest = 0;
  for (const Category& category : scene.categories) highest = std::max<std::uint64_t>(highest, category.number);
  return highest + instance.mesh + 1;
}

/// \throws Error unsupported where an object is stretched or mirrored: BOP's poses turn and move.
Json pose_json(const ReportRun& run, std::uint32_t object, double millimetres) {
  const Instance& instance = run.scene().instances[object];
  const glm::dmat4 pose =
      from_zero(pose_of(run.view().world_from_eye, PoseConvention::opencv_world_to_camera) * instance.world_from_mesh,
                run.scene().meshes[instance.mesh].origin);
  const double scale = std::cbrt(glm::determinant(glm::dmat3(pose)));
  const glm::dmat3 turn = glm::dmat3(pose) * (1 / scale), rest = glm::transpose(turn) * turn - glm::dmat3(1.0);
  double most = 0;
  for (int column = 0; column < 3; ++column) most = std::max(most, glm::length(rest[column]));
  if (!(scale > 0 && most < 1e-4))
    throw Error(ErrorCode::unsupported,
                fmt::format("object {} ({}) is stretched or mirrored, which BOP's poses cannot be", object,
                            printable_name(instance.name)));
  return {{"cam_R_m2c", rows_json(turn)},
          {"cam_t_m2c", to_json(glm::dvec3(pose[3]) * millimetres)},
          {"obj_id", object_number(run.scene(), instance)}};
}

/// As bop_toolkit has it: from the first pixel to the last, which is one less than their number.
Json bop_box(const PixelBox& box, bool is_seen) {
  return is_seen ? Json::array({box.x, box.y, box.width - 1, box.height - 1}) : Json::array({-1, -1, -1, -1});
}

/// What is marked visible becomes what lies at most 15 mm behind what is seen, along the ray.
void mark_within_tolerance(const ReportRun& run, BopObject& object, const Image& seen, const Execution& execution) {
  Scene alone;
  alone.meshes = {run.scene().meshes[run.scene().instances[object.object].mesh]};
  alone.instances = {run.scene().instances[object.object]};
  alone.instances[0].mesh = 0;
  alone.materials = run.scene().materials;
  alone.textures = run.scene().textures;
  alone.categories = run.scene().categories;
  const Surfaces surfaces(alone, execution);
  const Image distances = ray_distance_image(zbuffer(surfaces, run.view(), execution));
  const double most = tolerance_mm / millimetres_per_unit(run.scene());
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

Json info_json(const ReportRun& run, const BopObject& object) {
  const ObjectAccount& account = run.accounts.objects[object.object];
  const SampleSet seen = visible_of(object.mask);
  return {{"px_count_all", account.alone.count},
          {"px_count_valid", account.in_frame.count},
          {"px_count_visib", seen.count},
          {"visib_fract", double(seen.count) / double(account.alone.count)},
          {"bbox_obj", bop_box(account.alone.box, seen.count > 0)},
          {"bbox_visib", bop_box(seen.box, seen.count > 0)}};
}

/// Millimetres that a step of the file stands for: the least power of ten, from 0.1 on, with which all depths fit.
double depth_scale_of(const Image& depths, double millimetres) {
  double farthest = 0, scale = 0.1;
  for (const float depth : depths.channels[0].floats())
    if (std::isfinite(depth)) farthest = std::max(farthest, double(depth) * millimetres);
  while (farthest / scale > 65535) scale *= 10;
  return scale;
}

std::string mask_name(const char* folder, std::size_t number) {
  return fmt::format("{}/000000_{:06}.png", folder, number);
}

class BopWriter {
 public:
  BopWriter(const ReportRun& run, const StagedFolder& staged, const Execution& execution)
      : run_(run), staged_(staged), execution_(execution), millimetres_(millimetres_per_unit(run.scene())) {}

  /// \returns the names of all files.
  [[nodiscard]] std::vector<std::string> write() {
    const Image depths = depth_image(run_.visible), distances = ray_distance_image(run_.visible);
    const double scale = depth_scale_of(depths, millimetres_);
    Json poses = Json::array(), infos = Json::array();
    PixelMasks masks(run_.surfaces, run_.visible, execution_);
    for (std::uint32_t i = 0; i < run_.accounts.objects.size(); ++i) {
      if (run_.accounts.objects[i].in_frame.count == 0) continue;
      BopObject object{i, masks.of(i)};
      if (run_.settings.report.bop_visible == BopVisible::bop19)
        mark_within_tolerance(run_, object, distances, execution_);
      add(mask_name("mask", poses.size()), mask_image(object.mask, MaskPart::whole, run_.view()), {});
      add(mask_name("mask_visib", poses.size()), mask_image(object.mask, MaskPart::visible, run_.view()), {});
      poses.push_back(pose_json(run_, i, millimetres_));
      infos.push_back(info_json(run_, object));
      stop_if_interrupted();
    }
    SaveOptions options;
    options.depth_scale = millimetres_ / scale;
    add("depth/000000.png", depths, options);
    add("scene_camera.json", camera_json(run_, millimetres_, scale));
    add("scene_gt.json", std::move(poses));
    add("scene_gt_info.json", std::move(infos));
    return std::move(names_);
  }

 private:
  void add(const std::string& name, const Image& image, const SaveOptions& options) {
    save(image, staged_.path(name), options, execution_);
    names_.push_back(name);
  }
  void add(const std::string& name, Json of_image) {
    save_text(dump(Json{{"0", std::move(of_image)}}), staged_.path(name));
    names_.push_back(name);
  }

  const ReportRun& run_;
  const StagedFolder& staged_;
  const Execution& execution_;
  double millimetres_;
  std::vector<std::string> names_;
};

}  // namespace

std::vector<std::string> write_bop_scene(const ReportRun& run, const std::string& folder, const Execution& execution) {
  return write_folder(folder, {"depth", "mask", "mask_visib"},
                      [&](const StagedFolder& staged) { return BopWriter(run, staged, execution).write(); });
}

}  // namespace frontmost::cli
