// SPDX-License-Identifier: Apache-2.0
#include "cli/view/camera_report.h"

#include <fmt/format.h>

#include <cmath>

#include "cli/values.h"

namespace frontmost::cli {
namespace {

struct NamedDepth {
  std::string_view name;
  DepthConvention convention;
};
constexpr NamedDepth named_depths[] = {{"opengl", opengl_depth},
                                       {"zero_to_one", zero_to_one_depth},
                                       {"reversed", reversed_depth},
                                       {"gortler", gortler_depth}};

bool is_centred(const Projection& p) {
  return std::abs(p.left + p.right) <= 1e-9 * (p.right - p.left) &&
         std::abs(p.bottom + p.top) <= 1e-9 * (p.top - p.bottom);
}

/// Returns the angle between two edges of the picture, in degrees.
double angle(double low, double high) { return (std::atan(high) - std::atan(low)) * degrees_per_radian; }

/// Returns the vertical view angle of a view. For a parallel projection, it is the angle of the picture as seen from
/// the eye's distance to the target.
double view_angle(const View& view, const glm::dvec3& target) {
  const Projection& p = view.projection;
  const double distance = p.orthographic ? glm::distance(view.eye(), target) : 1.0;
  return angle(p.bottom / distance, p.top / distance);
}

Json intrinsics_json(const View& view, PixelRule rule) {
  const Intrinsics k = intrinsics_of(view.projection, view.width, view.height, rule);
  return {{"fx", k.fx},
          {"fy", k.fy},
          {"cx", k.cx},
          {"cy", k.cy},
          {"K", Json::array(
                    {Json::array({k.fx, 0.0, k.cx}), Json::array({0.0, k.fy, k.cy}), Json::array({0.0, 0.0, 1.0})})}};
}

Json poses_json(const glm::dmat4& world_from_eye) {
  Json poses;
  poses["opengl"]["world_from_camera"] = to_json(pose_of(world_from_eye, PoseConvention::opengl_camera_to_world));
  poses["opengl"]["camera_from_world"] = to_json(pose_of(world_from_eye, PoseConvention::opengl_world_to_camera));
  poses["opencv"]["world_from_camera"] = to_json(pose_of(world_from_eye, PoseConvention::opencv_camera_to_world));
  poses["opencv"]["camera_from_world"] = to_json(pose_of(world_from_eye, PoseConvention::opencv_world_to_camera));
  poses["robot"]["world_from_camera"] = to_json(pose_of(world_from_eye, PoseConvention::robot_camera_to_world));
  poses["robot"]["camera_from_world"] = to_json(pose_of(world_from_eye, PoseConvention::robot_world_to_camera));
  return poses;
}

std::string text_of(const glm::dvec3& v) { return fmt::format("{},{},{}", v.x + 0.0, v.y + 0.0, v.z + 0.0); }

std::string text_of(const glm::dmat4& m) {
  std::string text;
  for (int row = 0; row < 4; ++row) {
    text += fmt::format("    {:>12.6g} {:>12.6g} {:>12.6g} {:>12.6g}\n", m[0][row] + 0.0, m[1][row] + 0.0,
                        m[2][row] + 0.0, m[3][row] + 0.0);
  }
  return text;
}

}  // namespace

std::string place_text(const glm::dvec3& in_scene, const glm::dvec3& origin) {
  const glm::dvec3 p = in_file(in_scene, origin);
  return origin == glm::dvec3(0) ? fmt::format("{:.6g},{:.6g},{:.6g}", p.x, p.y, p.z)
                                 : fmt::format("{},{},{}", p.x, p.y, p.z);
}

std::string camera_flags(const View& view, const glm::dvec3& target, const glm::dvec3& origin) {
  const Projection& p = view.projection;
  std::string flags = fmt::format("--resolution {},{} --camera-position {} --camera-focal-point {} --camera-view-up {}",
                                  view.width, view.height, text_of(in_file(view.eye(), origin)),
                                  text_of(in_file(target, origin)), text_of(view.up()));
  if (is_centred(p)) {
    flags += fmt::format(" --camera-view-angle {}", view_angle(view, target));
    if (p.orthographic) flags += " --camera-orthographic";
  } else if (!p.orthographic) {
    const Intrinsics k = intrinsics_of(p, view.width, view.height, PixelRule::centre_at_half);
    flags += fmt::format(" --intrinsics {},{},{},{} --pixel-center half", k.fx, k.fy, k.cx, k.cy);
  }
  return flags + fmt::format(" --near {} --far {}", p.clip.near, p.clip.far);
}

Json camera_json(const View& view, const glm::dvec3& target, const glm::dvec3& origin) {
  const Projection& p = view.projection;
  Json json;
  json["resolution"] = Json::array({view.width, view.height});
  json["projection"] = p.orthographic ? "orthographic" : "perspective";
  json["look_at"] = {{"eye", to_json(in_file(view.eye(), origin))},
                     {"target", to_json(in_file(target, origin))},
                     {"up", to_json(view.up())}};
  json["flags"] = camera_flags(view, target, origin);
  json["poses"] = poses_json(in_file(view.world_from_eye, origin));
  json["sides"] = {{"left", p.left}, {"right", p.right}, {"bottom", p.bottom}, {"top", p.top}};
  if (!p.orthographic) {
    json["field_of_view_degrees"] = {{"horizontal", angle(p.left, p.right)}, {"vertical", angle(p.bottom, p.top)}};
    json["intrinsics"] = {{"pixel_center_half", intrinsics_json(view, PixelRule::centre_at_half)},
                          {"pixel_center_integer", intrinsics_json(view, PixelRule::centre_at_integer)}};
  }
  json["near"] = p.clip.near;
  json["far"] = finite_or_null(p.clip.far);
  for (const NamedDepth& depth : named_depths) {
    json["projection_matrices"][std::string(depth.name)] = {
        {"ndc_at_near", depth.convention.at_near},
        {"ndc_at_far", depth.convention.at_far},
        {"clip_from_eye", to_json(clip_from_eye(p, depth.convention))}};
  }
  return json;
}

std::string camera_text(const View& view, const glm::dvec3& target, const glm::dvec3& origin) {
  const Projection& p = view.projection;
  std::string text =
      fmt::format("resolution  {} x {}\nprojection  {}\neye         {}\ntarget      {}\nup          {}\n", view.width,
                  view.height, p.orthographic ? "orthographic" : "perspective", text_of(in_file(view.eye(), origin)),
                  text_of(in_file(target, origin)), text_of(view.up()));
  text += fmt::format("near, far   {}, {}\n", p.clip.near, p.clip.far);
  if (!p.orthographic) {
    const Intrinsics k = intrinsics_of(p, view.width, view.height, PixelRule::centre_at_integer);
    text += fmt::format("view angle  {:.6g} horizontal, {:.6g} vertical (degrees)\n", angle(p.left, p.right),
                        angle(p.bottom, p.top));
    text += fmt::format(
        "intrinsics  {},{},{},{} (for a first pixel centre at 0,0; for one at 0.5,0.5 add 0.5 to the last two "
        "numbers)\n",
        k.fx, k.fy, k.cx, k.cy);
  }
  const glm::dmat4 world_from_eye = in_file(view.world_from_eye, origin);
  text += "world from camera, opengl (x right, y up, looks down -z)\n" + text_of(world_from_eye);
  text += "camera from world, opencv (x right, y down, looks down +z)\n" +
          text_of(pose_of(world_from_eye, PoseConvention::opencv_world_to_camera));
  return text + "flags       " + camera_flags(view, target, origin) + "\n(--json has every convention)\n";
}

}  // namespace frontmost::cli
