// SPDX-License-Identifier: Apache-2.0
// Views: cameras of all conventions with a grid of pixels, and conversions back.
#include <frontmost/view.h>

#include <cmath>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/held.h"
#include "python/running.h"
#include "python/view_words.h"

namespace frontmost::python {
namespace {

using namespace py::literals;

constexpr double degree = 3.14159265358979323846 / 180;

View checked(View view, int samples, Culling culling) {
  view.samples = samples;
  view.culling = culling;
  validate(view);
  return view;
}

Intrinsics intrinsics_from(const py::handle& given, PixelRule rule) {
  const py::array array = py::array::ensure(given);
  if (array && array.ndim() == 1) {
    const auto values = numbers<double>(given, "K", {4});
    return {values.at(0), values.at(1), values.at(2), values.at(3), rule};
  }
  const auto k = numbers<double>(given, "K", {3, 3});
  for (const auto& [row, column, wanted] : {std::array{0, 1, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 1}})
    if (k.at(row, column) != wanted)
      throw py::value_error("K: element " + std::to_string(row) + ", " + std::to_string(column) + " is not " +
                            std::to_string(wanted) + (row == 0 ? ": cameras have no skew" : ", as in every K"));
  return {k.at(0, 0), k.at(1, 1), k.at(0, 2), k.at(1, 2), rule};
}

View from_intrinsics(const py::object& k, int width, int height, const py::object& pose, const std::string& convention,
                     double near, double far, PixelRule rule, int samples, Culling culling) {
  const PoseConvention meant = pose_convention_of(convention);
  const View view = make_view(intrinsics_from(k, rule), width, height).between(near, far);
  return checked(view.placed(pose.is_none() ? glm::dmat4(1.0) : matrix(pose, "pose"), meant), samples, culling);
}

View looking_at(const py::object& eye, const py::object& target, const py::object& up, int width, int height,
                double fov, double near, double far, int samples, Culling culling) {
  const View view = make_view(fov * degree, width, height).between(near, far);
  return checked(view.looking(point(eye, "eye"), point(target, "target"), point(up, "up")), samples, culling);
}

View orthographic(const py::object& eye, const py::object& target, const py::object& up, int width, int height,
                  double tall, double near, double far, int samples, Culling culling) {
  if (width < 1 || height < 1) throw py::value_error("width, height: must be at least 1");
  const double y = tall / 2, x = y * width / height;
  View view;
  view.width = width;
  view.height = height;
  view.projection = make_orthographic(-x, x, -y, y, {near, far});
  return checked(view.looking(point(eye, "eye"), point(target, "target"), point(up, "up")), samples, culling);
}

/// A box from Surfaces or an array. `name` is the argument's name.
Box box_of(const py::handle& given, const char* name) {
  if (py::isinstance<HeldSurfaces>(given)) return py::cast<const HeldSurfaces&>(given).surfaces.bounds();
  const auto values = numbers<float>(given, name, {2, 3});
  const float* const v = values.data();
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

View framed(const py::object& of, int width, int height, NamedView direction, bool is_orthographic, double fov,
            double margin, const py::object& forward, const py::object& up, const py::object& target,
            FramedObjects objects, int samples, Culling culling) {
  FrameOptions options;
  options.direction = direction;
  options.orthographic = is_orthographic;
  options.min_fov = fov * degree;
  options.margin = margin;
  options.samples = samples;
  options.culling = culling;
  options.objects = objects;
  if (!forward.is_none()) options.forward = point(forward, "forward");
  if (!up.is_none()) options.up = point(up, "up");
  if (!target.is_none()) options.target = point(target, "target");
  if (py::isinstance<HeldSurfaces>(of)) {
    const auto held = py::cast<std::shared_ptr<HeldSurfaces>>(of);
    return run(0, py::none(), [&](const Execution&) {
      const std::shared_lock lock(held->scene->reading);
      return frame(held->surfaces, width, height, options);
    });
  }
  if (!py::isinstance<HeldScene>(of)) {
    const Box bounds = box_of(of, "scene");
    return frame(bounds, Axis::y, width, height, options);
  }
  const std::shared_ptr<const KeptScene> scene = py::cast<HeldScene&>(of).scene;
  return run(0, py::none(),
             [&](const Execution& execution) { return frame(Surfaces(*scene, execution), width, height, options); });
}

Array<double> intrinsics_matrix(const View& view, PixelRule rule) {
  if (view.projection.orthographic)
    throw Error(ErrorCode::bad_argument, "view", "is orthographic, and has no intrinsics");
  const Intrinsics k = intrinsics_of(view.projection, view.width, view.height, rule);
  Array<double> result({3, 3});
  const double rows[3][3] = {{k.fx, 0, k.cx}, {0, k.fy, k.cy}, {0, 0, 1}};
  std::memcpy(result.mutable_data(), rows, sizeof rows);
  return result;
}

DepthConvention depth_convention_of(const std::string& word) {
  if (word == "opengl") return opengl_depth;
  if (word == "gortler") return gortler_depth;
  if (word == "zero_to_one") return zero_to_one_depth;
  if (word == "reversed") return reversed_depth;
  throw py::value_error("depth: '" + word + "' is not one of opengl, gortler, zero_to_one, reversed");
}

std::string described(const View& view) {
  char text[256];
  const glm::dvec3 eye = view.eye(), ahead = view.forward();
  std::snprintf(text, sizeof text, "View of %dx%d pixels from (%g, %g, %g) along (%g, %g, %g), %g to %g%s", view.width,
                view.height, eye.x, eye.y, eye.z, ahead.x, ahead.y, ahead.z, view.projection.clip.near,
                view.projection.clip.far, view.projection.orthographic ? ", orthographic" : "");
  return text;
}

/// The complete state of a view, for pickles and comparisons.
py::tuple state_of(const View& v) {
  const Projection& p = v.projection;
  return py::make_tuple(v.width, v.height, v.samples, v.culling, array_of(v.world_from_eye).attr("tobytes")(),
                        p.orthographic, p.left, p.right, p.bottom, p.top, p.clip.near, p.clip.far);
}

View view_of_state(const py::tuple& state) {
  if (state.size() != 12) throw py::value_error("state: is not that of a View");
  View view;
  view.projection = {py::cast<bool>(state[5]),   py::cast<double>(state[6]),
                     py::cast<double>(state[7]), py::cast<double>(state[8]),
                     py::cast<double>(state[9]), {py::cast<double>(state[10]), py::cast<double>(state[11])}};
  view.width = py::cast<int>(state[0]);
  view.height = py::cast<int>(state[1]);
  const py::object pose = py::module_::import("numpy").attr("frombuffer")(state[4]).attr("reshape")(4, 4);
  view.world_from_eye = matrix(pose, "state");
  return checked(view, py::cast<int>(state[2]), py::cast<Culling>(state[3]));
}

void bind_makers(py::class_<View>& view) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  view.def_static("from_intrinsics", &from_intrinsics, "K"_a, "width"_a, "height"_a, py::kw_only(),
                  "pose"_a = py::none(), "convention"_a = "opencv", "near"_a = 0.1, "far"_a = infinity,
                  "pixel_rule"_a = PixelRule::centre_at_integer, "samples"_a = 1, "culling"_a = Culling::none,
                  doc("View.from_intrinsics"))
      .def_static("look_at", &looking_at, "eye"_a, "target"_a, "up"_a = py::make_tuple(0, 1, 0), py::kw_only(),
                  "width"_a = 640, "height"_a = 480, "fov"_a = 30.0, "near"_a = 0.1, "far"_a = infinity,
                  "samples"_a = 1, "culling"_a = Culling::none, doc("View.look_at"))
      .def_static("orthographic", &orthographic, "eye"_a, "target"_a, "up"_a = py::make_tuple(0, 1, 0), py::kw_only(),
                  "width"_a = 640, "height"_a = 480, "tall"_a = 2.0, "near"_a = 0.1, "far"_a = 1000.0, "samples"_a = 1,
                  "culling"_a = Culling::none, doc("View.orthographic"));
}

void bind_changes(py::class_<View>& view) {
  view.def(
          "placed",
          [](const View& v, const py::object& pose, const std::string& convention) {
            return v.placed(matrix(pose, "pose"), pose_convention_of(convention));
          },
          "pose"_a, "convention"_a = "opencv", doc("View.placed"))
      .def(
          "looking",
          [](const View& v, const py::object& eye, const py::object& target, const py::object& up) {
            return v.looking(point(eye, "eye"), point(target, "target"), point(up, "up"));
          },
          "eye"_a, "target"_a, "up"_a = py::make_tuple(0, 1, 0), doc("View.looking"))
      .def(
          "about", [](const View& v, const py::object& origin) { return v.about(point(origin, "origin")); }, "origin"_a,
          doc("View.about"))
      .def("between", &View::between, "near"_a, "far"_a, doc("View.between"))
      .def(
          "enclosing", [](const View& v, const py::object& bounds) { return v.enclosing(box_of(bounds, "bounds")); },
          "bounds"_a, doc("View.enclosing"))
      .def(
          "sampled", [](const View& v, int samples) { return checked(v, samples, v.culling); }, "samples"_a,
          doc("View.sampled"))
      .def(
          "culled", [](const View& v, Culling culling) { return checked(v, v.samples, culling); }, "culling"_a,
          doc("View.culled"));
}

void bind_numbers(py::class_<View>& view) {
  view.def_readonly("width", &View::width, doc("View.width"))
      .def_readonly("height", &View::height, doc("View.height"))
      .def_readonly("samples", &View::samples, doc("View.samples"))
      .def_readonly("culling", &View::culling, doc("View.culling"))
      .def_property_readonly(
          "is_orthographic", [](const View& v) { return v.projection.orthographic; }, doc("View.is_orthographic"))
      .def_property_readonly(
          "near", [](const View& v) { return v.projection.clip.near; }, doc("View.near"))
      .def_property_readonly(
          "far", [](const View& v) { return v.projection.clip.far; }, doc("View.far"))
      .def_property_readonly(
          "eye", [](const View& v) { return array_of(v.eye()); }, doc("View.eye"))
      .def_property_readonly(
          "forward", [](const View& v) { return array_of(v.forward()); }, doc("View.forward"))
      .def_property_readonly(
          "up", [](const View& v) { return array_of(v.up()); }, doc("View.up"))
      .def_property_readonly(
          "right", [](const View& v) { return array_of(v.right()); }, doc("View.right"))
      .def_property_readonly(
          "K", [](const View& v) { return intrinsics_matrix(v, PixelRule::centre_at_integer); }, doc("View.K"))
      .def("intrinsics", &intrinsics_matrix, "pixel_rule"_a = PixelRule::centre_at_integer, doc("View.intrinsics"))
      .def(
          "pose",
          [](const View& v, const std::string& convention) {
            return array_of(pose_of(v.world_from_eye, pose_convention_of(convention)));
          },
          "convention"_a = "opencv", doc("View.pose"))
      .def(
          "clip_from_eye",
          [](const View& v, const std::string& depth) {
            return array_of(clip_from_eye(v.projection, depth_convention_of(depth)));
          },
          "depth"_a = "opengl", doc("View.clip_from_eye"))
      .def(
          "clip_from_world",
          [](const View& v, const std::string& depth) {
            return array_of(clip_from_eye(v.projection, depth_convention_of(depth)) *
                            pose_of(v.world_from_eye, PoseConvention::opengl_world_to_camera));
          },
          "depth"_a = "opengl", doc("View.clip_from_world"))
      .def(py::pickle(&state_of, &view_of_state))
      .def(
          "__eq__", [](const View& a, const View& b) { return state_of(a).equal(state_of(b)); }, py::is_operator())
      .def("__hash__", [](const View& v) { return py::hash(state_of(v)); })
      .def("__repr__", [](const View& v) { return described(v); });
}

}  // namespace

PoseConvention pose_convention_of(const std::string& word) {
  if (word == "opencv") return PoseConvention::opencv_world_to_camera;
  if (word == "opengl") return PoseConvention::opengl_camera_to_world;
  if (word == "robot") return PoseConvention::robot_camera_to_world;
  return value_of<PoseConvention>(word);
}

void bind_view(py::module_& m) {
  py::class_<View> view(m, "View", doc("View"));
  bind_makers(view);
  bind_changes(view);
  bind_numbers(view);
  m.def("frame", &framed, "scene"_a, "width"_a = 640, "height"_a = 480, py::kw_only(),
        "direction"_a = NamedView::three_quarter, "orthographic"_a = false, "fov"_a = 30.0, "margin"_a = 0.05,
        "forward"_a = py::none(), "up"_a = py::none(), "target"_a = py::none(), "objects"_a = FramedObjects::subject,
        "samples"_a = 1, "culling"_a = Culling::none, doc("frame"));
}

}  // namespace frontmost::python
