// SPDX-License-Identifier: Apache-2.0
// frontmost lidar: the points that a spinning laser, or any pattern of rays from one point, meets.
#include <fmt/format.h>
#include <frontmost/image.h>

#include <algorithm>
#include <filesystem>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/inputs.h"
#include "cli/json.h"
#include "cli/option.h"
#include "cli/outputs.h"
#include "cli/rays/ray_files.h"
#include "cli/stopwatch.h"

namespace frontmost::cli {
namespace {

/// Returns two ascending numbers within limits. \throws UsageError with the text `what` if their order is wrong.
glm::dvec2 ordered_pair(const Given& given, const NumberLimits& limits, const char* what) {
  const std::vector<double> ends = parse_numbers(given.text, 2, limits);
  if (ends[0] > ends[1]) throw UsageError(what);
  return {ends[0], ends[1]};
}

glm::dvec2 azimuths_from(const Given& given) {
  const std::vector<double> ends = parse_numbers(given.text, 2, {-360, 360});
  if (std::abs(ends[1] - ends[0]) > 360) throw UsageError("FROM and TO differ by more than a whole turn");
  return {ends[0], ends[1]};
}

std::vector<double> ring_elevations_from(const Given& given) {
  const std::size_t count = split(given.text, ',').size();
  if (count > 16384) throw UsageError("more than 16384 rings");
  return parse_numbers(given.text, count, {-90, 90});
}

constexpr Option lidar_options[] = {
    {"from", 0, "X,Y,Z", "Position of the scanner, in the model's own coordinates.", Group::lidar, for_lidar,
     [](Settings& s, const Given& g) { s.lidar.from = parse_vector(g.text); }},
    {"forward", 0, "X,Y,Z",
     "Direction of azimuth 0, straight ahead; also an axis, such as +x. By default the viewing direction of --view "
     "front.",
     Group::lidar, for_lidar, [](Settings& s, const Given& g) { s.lidar.forward = parse_direction(g.text); }},
    {"rings", 0, "N", "Number of rings of rays, 1 to 16384; 16 by default.", Group::lidar, for_lidar,
     [](Settings& s, const Given& g) {
       s.lidar.rings = g.integer({1, 16384});
     }},
    {"elevations", 0, "LOW,HIGH", "Lowest and highest ring, in degrees above the horizon; -15,15 by default.",
     Group::lidar, for_lidar,
     [](Settings& s, const Given& g) {
       s.lidar.elevations = ordered_pair(g, {-90, 90}, "the lowest comes first");
     }},
    {"ring-elevations", 0, "DEGREES,...", "Elevation of each ring, in the order of the rows; one or more.",
     Group::lidar, for_lidar, [](Settings& s, const Given& g) { s.lidar.ring_elevations = ring_elevations_from(g); }},
    {"steps", 0, "N", "Number of rays in a ring, which turns to the right, 1 to 16384; 1024 by default.", Group::lidar,
     for_lidar,
     [](Settings& s, const Given& g) {
       s.lidar.steps = g.integer({1, 16384});
     }},
    {"azimuths", 0, "FROM,TO",
     "Azimuths of a ring's first and last ray, in degrees to the right of straight ahead. The ring turns to the left "
     "if TO is less. 0,360 by default; a whole turn repeats no ray.",
     Group::lidar, for_lidar, [](Settings& s, const Given& g) { s.lidar.azimuths = azimuths_from(g); }},
    {"range", 0, "MIN,MAX",
     "Least and greatest range, in the model's units. Points nearer or farther are not written, but hide points behind "
     "them.",
     Group::lidar, for_lidar,
     [](Settings& s, const Given& g) {
       s.lidar.range = ordered_pair(g, {0, 1e30}, "the least comes first");
     }},
    {"directions", 0, "FILE",
     "File of ray directions, in place of rings: three numbers a line, x right, y up, z backwards; # starts a comment.",
     Group::lidar, for_lidar, [](Settings& s, const Given& g) { s.lidar.directions = g.file_name(); }},
    {"robot-axes", 0, "",
     "Read directions and write points in the scanner's own axes, as is usual for robots: x ahead, y left, z up.",
     Group::lidar, for_lidar, [](Settings& s, const Given&) { s.lidar.robot_axes = true; }},
    {"output", 'o', "FILE",
     "Write points (.ply), or a range image with a row for each ring (.exr; .npy holds ranges only).", Group::output,
     for_lidar | may_repeat, [](Settings& s, const Given& g) { s.lidar.outputs.push_back(g.file_name()); }},
};

constexpr int default_rings = 16, default_steps = 1024;
constexpr glm::dvec2 default_elevations{-15, 15};

RayPattern read_directions(const std::string& path, bool robot_axes) {
  RayPattern pattern;
  const std::vector<double> n = read_number_lines(path, {3, "a direction needs three numbers"});
  pattern.directions.reserve(n.size() / 3);
  for (std::size_t i = 0; i < n.size(); i += 3) {
    const glm::vec3& direction = pattern.directions.emplace_back(robot_axes ? glm::dvec3(-n[i + 1], n[i + 2], -n[i])
                                                                            : glm::dvec3(n[i], n[i + 1], n[i + 2]));
    if (direction == glm::vec3(0))
      throw Error(ErrorCode::file_malformed, path, "", fmt::format("direction {} has length 0", i / 3 + 1));
  }
  if (pattern.directions.empty()) throw Error(ErrorCode::file_malformed, path, "", "holds no direction");
  return pattern;
}

void check(const Settings& settings) {
  const LidarSettings& s = settings.lidar;
  if (!s.from) throw UsageError("give --from X,Y,Z, where the scanner stands");
  const bool has_list = !s.ring_elevations.empty();
  if (s.directions && (s.rings || s.steps || s.elevations || s.azimuths || has_list))
    throw UsageError("--directions excludes --rings, --steps, --azimuths, --elevations and --ring-elevations");
  if (has_list && (s.rings || s.elevations)) throw UsageError("--ring-elevations excludes --rings and --elevations");
  if (s.outputs.empty() && !settings.run.json) throw UsageError("nothing to do: give -o FILE or --json");
  for (const std::string& path : s.outputs) {
    const std::string suffix = std::filesystem::path(path).extension().string();
    if (suffix != ".ply" && suffix != ".exr" && suffix != ".npy")
      throw UsageError(path + ": the suffix names no format; use .ply, .exr or .npy");
  }
  check_outputs(s.outputs, input_files(settings));
}

Lidar rings_of(const LidarSettings& s) {
  Lidar lidar;
  lidar.steps = s.steps.value_or(default_steps);
  const glm::dvec2 ends = glm::radians(s.elevations.value_or(default_elevations));
  if (s.ring_elevations.empty()) lidar.elevations = ring_elevations(s.rings.value_or(default_rings), ends.x, ends.y);
  for (const double elevation : s.ring_elevations) lidar.elevations.push_back(glm::radians(elevation));
  if (s.azimuths) {
    lidar.first_azimuth = glm::radians(s.azimuths->x);
    lidar.last_azimuth = glm::radians(s.azimuths->y);
  }
  return lidar;
}

/// Returns the rays in the scanner's own axes.
RayCamera rays_of(const LidarSettings& s) {
  RayCamera camera;
  if (s.directions)
    camera.model = read_directions(*s.directions, s.robot_axes);
  else
    camera.model = rings_of(s);
  if (s.range) {
    camera.nearest = s.range->x;
    camera.farthest = s.range->y;
  }
  return camera;
}

/// Returns the scanner's pose, which is upright in the model.
glm::dmat4 pose_of(const LidarSettings& s, const Surfaces& surfaces) {
  FrameOptions front;
  front.direction = NamedView::front;
  const glm::dvec3 ahead = s.forward.value_or(frame(surfaces, 1, 1, front).forward());
  glm::dmat4 pose = look_at(glm::dvec3(0), glm::normalize(ahead), direction(surfaces.scene().up));
  pose[3] = glm::dvec4(*s.from - surfaces.scene().origin, 1);
  return pose;
}

Image range_image(const RangeScan& scan, const RayScene& rays, const Buffer<float>* incidences) {
  Image image{scan.width, scan.height, {}};
  image.channels.push_back({"distance", scan.ranges});
  if (incidences == nullptr) return image;
  image.channels.push_back({"incidence", *incidences});
  for (const IdKind kind : {IdKind::primitive, IdKind::object}) {
    Image ids = rays.ids(scan, kind);
    image.channels.push_back(std::move(ids.channels.front()));
  }
  return image;
}

void write(const std::string& path, const RangeScan& met, const RayScene& rays, const LidarSettings& settings,
           const Execution& execution) {
  stop_if_interrupted();
  const WritingFiles writing;
  const std::string suffix = std::filesystem::path(path).extension().string();
  if (suffix == ".npy") return save(range_image(met, rays, nullptr), path, {}, execution);
  const Buffer<float> incidences = incidence_angles(met, rays.surfaces, execution);
  if (suffix == ".ply") return save_text(points_ply({met, rays, incidences, settings.robot_axes}), path);
  save(range_image(met, rays, &incidences), path, {}, execution);
}

/// Returns the report, with the number of points that rays meet, in total and by object.
Json report(const Settings& settings, const RangeScan& scan, const RayScene& rays) {
  std::vector<std::uint64_t> points(rays.scene().instances.size());
  std::uint64_t met = 0;
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
  for (std::size_t i = 0; i < scan.primitives.size(); ++i) {
    if (scan.primitives[i] == no_primitive) continue;
    ++met;
    ++points[rays.surfaces.source(scan.primitives[i]).instance];
    nearest = std::min(nearest, double(scan.ranges[i]));
    farthest = std::max(farthest, double(scan.ranges[i]));
  }
  Json json = {{"model", settings.model}, {"from", to_json(*settings.lidar.from)}, {"columns", scan.width},
               {"rows", scan.height},     {"rays", scan.primitives.size()},        {"points", met}};
  json["nearest"] = finite_or_null(nearest);
  json["farthest"] = met > 0 ? Json(farthest) : Json(nullptr);
  json["objects"] = Json::array();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i] == 0) continue;
    json["objects"].push_back({{"object", i}, {"name", rays.scene().instances[i].name}, {"points", points[i]}});
  }
  return json;
}

}  // namespace

std::span<const Option> lidar_option_table() { return lidar_options; }

int run_lidar(const Settings& settings) {
  check(settings);
  RayCamera camera = rays_of(settings.lidar);
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  const Scene scene = load_model(settings, execution, progress, settings.lidar.outputs);
  const Surfaces surfaces(scene, execution);
  camera.world_from_eye = pose_of(settings.lidar, surfaces);
  Stopwatch watch;
  const RayIndex index(surfaces, execution);
  const RayScene rays{surfaces, index};
  const double index_time = watch.milliseconds();
  watch = {};
  const RangeScan result = rays.scan(camera, execution);
  const double scan_time = watch.milliseconds();
  progress.clear();
  for (const std::string& path : settings.lidar.outputs) write(path, result, rays, settings.lidar, execution);
  if (!settings.run.json) return exit_done;
  Json json = report(settings, result, rays);
  json["timings_ms"] = {{"index", index_time}, {"visible", scan_time}};
  print(dump(json));
  return exit_done;
}

}  // namespace frontmost::cli
