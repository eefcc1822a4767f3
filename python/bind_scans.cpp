// SPDX-License-Identifier: Apache-2.0
// Cameras that need rays: panorama, fisheye, laser scanners.
#include <frontmost/raycast.h>

#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/held.h"
#include "python/pictures.h"
#include "python/rays.h"
#include "python/running.h"
#include "python/shade_words.h"
#include "python/view_words.h"

namespace frontmost::python {
namespace {

using namespace py::literals;

/// Python's RangeScan, with the index that its rays were cast in.
struct HeldScan {
  std::shared_ptr<HeldRayIndex> by;
  std::shared_ptr<const RangeScan> scan;

  [[nodiscard]] ArrayShape plane() const { return {scan->height, scan->width}; }
  [[nodiscard]] std::size_t size() const { return std::size_t(scan->width) * std::size_t(scan->height); }
};

template <class Model>
RayCamera camera_of(Model model, const py::object& pose, const std::string& convention, int samples) {
  RayCamera camera{std::move(model)};
  if (!pose.is_none())
    camera.world_from_eye = world_from_eye(matrix(pose, "pose"), pose_convention_of(convention));
  else
    camera.world_from_eye = world_from_eye(glm::dmat4(1.0), pose_convention_of(convention));
  camera.samples = samples;
  validate(camera);
  return camera;
}

/// Two numbers.
glm::dvec2 pair_of(const py::object& given, const std::string& name) {
  const auto ends = numbers<double>(given, name, {2});
  return {ends.data()[0], ends.data()[1]};
}

RayCamera within(RayCamera camera, const py::object& ranges) {
  const glm::dvec2 ends = pair_of(ranges, "ranges");
  camera.nearest = ends.x;
  camera.farthest = ends.y;
  validate(camera);
  return camera;
}

RayCamera lidar_of(const py::object& elevations, int steps, const py::object& azimuths, const py::object& ranges,
                   const py::object& pose, const std::string& convention) {
  const auto given = numbers<double>(elevations, "elevations", {-1});
  Lidar lidar;
  lidar.steps = steps;
  for (py::ssize_t i = 0; i < given.size(); ++i) lidar.elevations.push_back(glm::radians(given.data()[i]));
  const glm::dvec2 ends = glm::radians(pair_of(azimuths, "azimuths"));
  lidar.first_azimuth = ends.x;
  lidar.last_azimuth = ends.y;
  return within(camera_of(std::move(lidar), pose, convention, 1), ranges);
}

RayCamera pattern_of(const py::object& directions, const py::object& ranges, const py::object& pose,
                     const std::string& convention) {
  const auto given = numbers<float>(directions, "directions", {-1, 3});
  RayPattern pattern;
  for (py::ssize_t i = 0; i < given.shape(0); ++i)
    pattern.directions.emplace_back(given.at(i, 0), given.at(i, 1), given.at(i, 2));
  return within(camera_of(std::move(pattern), pose, convention, 1), ranges);
}

HeldScan scan_of(const std::shared_ptr<HeldRayIndex>& held, const RayCamera& camera, int threads,
                 const py::object& progress) {
  held->check_current();
  return {held, run(threads, progress, [&](const Execution& execution) {
            const std::shared_lock lock(held->reading);
            return std::make_shared<const RangeScan>(scan(held->index, camera, execution));
          })};
}

/// Points of the hits, (height, width, 3), in the space that `out_from_world` maps to; NaN without a hit.
Array<double> points_of(const HeldScan& held, const glm::dmat4& out_from_world) {
  Array<double> points(ArrayShape{held.scan->height, held.scan->width, 3});
  double* out = points.mutable_data();
  run(1, py::none(), [&](const Execution&) {
    for (int y = 0; y < held.scan->height; ++y)
      for (int x = 0; x < held.scan->width; ++x, out += 3) {
        const bool met = held.scan->primitives[held.scan->index(x, y)] != no_primitive;
        glm::dvec3 at(std::numeric_limits<double>::quiet_NaN());
        if (met) at = glm::dvec3(out_from_world * glm::dvec4(point_of(*held.scan, x, y), 1));
        std::memcpy(out, &at.x, 3 * sizeof(double));
      }
  });
  return points;
}

py::object scan_ids(const HeldScan& held, IdKind kind) {
  Image image = run(0, py::none(), [&](const Execution&) {
    return id_image(held.by->of->surfaces, {held.scan->width, held.scan->height},
                    {held.scan->primitives.data(), held.size()}, kind);
  });
  return plane_array(std::move(image.channels[0]), image.width, image.height);
}

py::object incidences_of(const HeldScan& held) {
  held.by->check_current();
  auto angles = run(0, py::none(), [&](const Execution& execution) {
    const std::shared_lock moving(held.by->of->scene->reading), lock(held.by->reading);
    return incidence_angles(*held.scan, held.by->of->surfaces, execution);
  });
  return owned(std::move(angles), held.plane());
}

Image shaded_scan(const HeldScan& held, const ShadeOptions& options, int threads, const py::object& progress) {
  held.by->check_current();
  return run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock moving(held.by->of->scene->reading), lock(held.by->reading);
    return shade(held.by->of->surfaces, ScanInput{held.scan.get(), &held.by->index}, options, execution);
  });
}

void bind_cameras(py::module_& m) {
  const py::tuple any_range = py::make_tuple(0.0, std::numeric_limits<double>::infinity());
  py::class_<RayCamera>(m, "RayCamera", doc("RayCamera"))
      .def_static(
          "panorama",
          [](int width, int height, const py::object& pose, const std::string& convention, int samples) {
            return camera_of(Panorama{width, height}, pose, convention, samples);
          },
          "width"_a = 2048, "height"_a = 1024, py::kw_only(), "pose"_a = py::none(), "convention"_a = "opengl",
          "samples"_a = 1, doc("RayCamera.panorama"))
      .def_static(
          "fisheye",
          [](int width, int height, double fov, const py::object& pose, const std::string& convention, int samples) {
            return camera_of(Fisheye{width, height, glm::radians(fov)}, pose, convention, samples);
          },
          "width"_a = 1024, "height"_a = 1024, py::kw_only(), "fov"_a = 180.0, "pose"_a = py::none(),
          "convention"_a = "opengl", "samples"_a = 1, doc("RayCamera.fisheye"))
      .def_static("lidar", &lidar_of, "elevations"_a, "steps"_a = 1024, py::kw_only(),
                  "azimuths"_a = py::make_tuple(0.0, 360.0), "ranges"_a = any_range, "pose"_a = py::none(),
                  "convention"_a = "opengl", doc("RayCamera.lidar"))
      .def_static("pattern", &pattern_of, "directions"_a, py::kw_only(), "ranges"_a = any_range, "pose"_a = py::none(),
                  "convention"_a = "opengl", doc("RayCamera.pattern"))
      .def(
          "looking",
          [](const RayCamera& camera, const py::object& eye, const py::object& target, const py::object& up) {
            RayCamera turned = camera;
            turned.world_from_eye = look_at(point(eye, "eye"), point(target, "target"), point(up, "up"));
            return turned;
          },
          "eye"_a, "target"_a, "up"_a = py::make_tuple(0, 1, 0), doc("RayCamera.looking"))
      .def(
          "pose",
          [](const RayCamera& camera, const std::string& convention) {
            return array_of(pose_of(camera.world_from_eye, pose_convention_of(convention)));
          },
          "convention"_a = "opengl", doc("RayCamera.pose"))
      .def_readonly("samples", &RayCamera::samples, doc("RayCamera.samples"))
      .def_property_readonly(
          "shape",
          [](const RayCamera& camera) {
            const glm::ivec2 grid = grid_of(camera);
            return py::make_tuple(grid.y, grid.x);
          },
          doc("RayCamera.shape"))
      .def("__repr__", [](const RayCamera& camera) {
        const glm::ivec2 grid = grid_of(camera);
        return "RayCamera of " + std::to_string(grid.x) + "x" + std::to_string(grid.y) + " rays";
      });
}

}  // namespace

void bind_scans(py::module_& m) {
  bind_cameras(m);
  py::class_<HeldScan> scanned(m, "RangeScan", doc("RangeScan"));
  scanned
      .def_property_readonly(
          "camera", [](const HeldScan& s) { return s.scan->camera; }, doc("RangeScan.camera"))
      .def_property_readonly(
          "range", [](const HeldScan& s) { return view_of(s.scan->ranges.data(), s.plane(), s.scan); },
          doc("RangeScan.range"))
      .def_property_readonly(
          "primitive", [](const HeldScan& s) { return view_of(s.scan->primitives.data(), s.plane(), s.scan); },
          doc("RangeScan.primitive"))
      .def_property_readonly(
          "object", [](const HeldScan& s) { return scan_ids(s, IdKind::object); }, doc("RangeScan.object"))
      .def_property_readonly(
          "material", [](const HeldScan& s) { return scan_ids(s, IdKind::material); }, doc("RangeScan.material"))
      .def_property_readonly(
          "depth",
          [](const HeldScan& s) {
            auto planes =
                run(0, py::none(), [&](const Execution& execution) { return planar_depths(*s.scan, execution); });
            return owned(std::move(planes), s.plane());
          },
          doc("RangeScan.depth"))
      .def_property_readonly(
          "points", [](const HeldScan& s) { return points_of(s, glm::dmat4(1.0)); }, doc("RangeScan.points"))
      .def_property_readonly(
          "robot_points",
          [](const HeldScan& s) {
            return points_of(s, pose_of(s.scan->camera.world_from_eye, PoseConvention::robot_world_to_camera));
          },
          doc("RangeScan.robot_points"))
      .def_property_readonly("incidence", &incidences_of, doc("RangeScan.incidence"))
      .def("__repr__", [](const HeldScan& s) {
        return "RangeScan of " + std::to_string(s.scan->width) + "x" + std::to_string(s.scan->height) + " rays";
      });
  bind_shading(scanned, "shade", doc("RangeScan.shade"),
               [](const HeldScan& s, const ShadeOptions& options, int threads, const py::object& progress) {
                 return bitmap_array(shaded_scan(s, options, threads, progress));
               });
  bind_shading(scanned, "shade_linear", doc("RangeScan.shade_linear"),
               [](const HeldScan& s, const ShadeOptions& options, int threads, const py::object& progress) {
                 return stacked(shaded_scan(s, options, threads, progress), {"R", "G", "B", "A"});
               });
  py::class_<HeldRayIndex, std::shared_ptr<HeldRayIndex>>(m.attr("RayIndex"))
      .def("scan", &scan_of, "camera"_a, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(),
           doc("RayIndex.scan"));
  m.def(
      "ring_elevations",
      [](int rings, double lowest, double highest) {
        Array<double> out(rings < 0 ? 0 : rings);
        const auto found = ring_elevations(rings, glm::radians(lowest), glm::radians(highest));
        for (std::size_t i = 0; i < found.size(); ++i) out.mutable_data()[i] = glm::degrees(found[i]);
        return out;
      },
      "rings"_a, "lowest"_a, "highest"_a, doc("ring_elevations"));
}

}  // namespace frontmost::python
