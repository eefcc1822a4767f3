// SPDX-License-Identifier: Apache-2.0
// Surfaces and their visibility: the z-buffer, rays for a view, planes of depths and ids.
#include <frontmost/image.h>
#include <frontmost/raycast.h>
#include <frontmost/scene.h>
#include <frontmost/zbuffer.h>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/held.h"
#include "python/running.h"

namespace frontmost::python {
namespace {

using namespace py::literals;

std::shared_ptr<HeldSurfaces> surfaces_of(const HeldScene& held, int threads, const py::object& progress) {
  const std::shared_ptr<KeptScene> scene = held.scene;
  return run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(scene->reading);
    return std::make_shared<HeldSurfaces>(scene, execution);
  });
}

ArrayShape plane_of(const View& view) { return {view.height, view.width}; }

/// The shape of planes with all samples: [sample][y][x].
ArrayShape planes_of(const View& view) { return {view.samples, view.height, view.width}; }

/// One number for each pixel, from the source of its first sample's triangle; no_index if the sample sees nothing.
template <class NumberOf>
py::array_t<std::uint32_t> numbers_of_sources(const HeldVisible& held, const NumberOf& number_of) {
  Buffer<std::uint32_t> out(held.visible->view.pixel_count());
  run(1, py::none(), [&](const Execution&) {
    const std::shared_lock lock(held.of->scene->reading);
    const Surfaces& surfaces = held.of->surfaces;
    PrimitiveId last = no_primitive;
    std::uint32_t number = no_index;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const PrimitiveId id = held.visible->primitives[i];
      if (id != last) {
        last = id;
        number = id == no_primitive ? no_index : number_of(surfaces.scene(), surfaces.source(id));
      }
      out[i] = number;
    }
  });
  return owned(std::move(out), plane_of(held.visible->view));
}

py::array_t<std::uint32_t> ids_of(const HeldVisible& held, IdKind kind) {
  Image image = run(0, py::none(), [&](const Execution&) {
    const std::shared_lock lock(held.of->scene->reading);
    return id_image(held.of->surfaces, *held.visible, kind);
  });
  return owned(std::move(image.channels[0].integers()), plane_of(held.visible->view));
}

py::object depth_of(HeldVisible& held) {
  if (!held.depth.is_none()) return held.depth;
  Image image = run(0, py::none(), [&](const Execution&) { return depth_image(*held.visible); });
  held.depth = owned(std::move(image.channels[0].floats()), plane_of(held.visible->view));
  return held.depth;
}

/// Moves one object to a pose, or several objects to as many poses.
void move_objects(const std::shared_ptr<HeldSurfaces>& held, const py::object& object, const py::object& pose,
                  int threads) {
  const KeptScene& scene = *held->scene;
  std::vector<Surfaces::Placement> placements;
  const auto add = [&](const py::handle& one, const py::handle& its) {
    const std::uint32_t number = object_of(scene, one);
    placements.push_back({number, placed_by(matrix(its, "pose"), scene, scene.meshes[scene.instances[number].mesh])});
  };
  if (py::isinstance<py::str>(object) || !py::hasattr(object, "__len__")) {
    add(object, pose);
  } else {
    const py::list objects(object), poses(pose);
    if (objects.size() != poses.size()) throw py::value_error("pose: must be one for each object");
    for (std::size_t i = 0; i < objects.size(); ++i) add(objects[i], poses[i]);
  }
  if (scene.surfaces_count > 1)
    throw Error(ErrorCode::bad_argument, "object", "other surfaces show this scene too; make these of scene.copy()");
  held->moves += 1;
  run(threads, py::none(), [&](const Execution& execution) {
    const std::unique_lock lock(held->scene->reading);
    held->surfaces.move(*held->scene, placements, execution);
  });
}

py::array_t<float> bounds_of(const Box& box) {
  py::array_t<float> result(ArrayShape{2, 3});
  for (int axis = 0; axis < 3; ++axis) {
    result.mutable_at(0, axis) = box.low[axis];
    result.mutable_at(1, axis) = box.high[axis];
  }
  return result;
}

void bind_planes(py::class_<HeldVisible>& visible) {
  visible
      .def_property_readonly(
          "view", [](const HeldVisible& v) { return v.visible->view; }, doc("Visible.view"))
      .def_property_readonly(
          "surfaces", [](const HeldVisible& v) { return v.of; }, doc("Visible.surfaces"))
      .def_property_readonly("depth", &depth_of, doc("Visible.depth"))
      .def_property_readonly(
          "primitive",
          [](const HeldVisible& v) {
            return view_of(v.visible->primitives.data(), plane_of(v.visible->view), v.visible);
          },
          doc("Visible.primitive"))
      .def_property_readonly(
          "key",
          [](const HeldVisible& v) { return view_of(v.visible->keys.data(), plane_of(v.visible->view), v.visible); },
          doc("Visible.key"))
      .def_property_readonly(
          "primitives",
          [](const HeldVisible& v) {
            return view_of(v.visible->primitives.data(), planes_of(v.visible->view), v.visible);
          },
          doc("Visible.primitives"))
      .def_property_readonly(
          "keys",
          [](const HeldVisible& v) { return view_of(v.visible->keys.data(), planes_of(v.visible->view), v.visible); },
          doc("Visible.keys"))
      .def_property_readonly(
          "object", [](const HeldVisible& v) { return ids_of(v, IdKind::object); }, doc("Visible.object"))
      .def_property_readonly(
          "material", [](const HeldVisible& v) { return ids_of(v, IdKind::material); }, doc("Visible.material"))
      .def_property_readonly(
          "face",
          [](const HeldVisible& v) {
            return numbers_of_sources(v, [](const Scene& scene, const PrimitiveSource& source) {
              return scene.meshes[source.mesh].face_of(source.triangle);
            });
          },
          doc("Visible.face"))
      .def_property_readonly(
          "triangle",
          [](const HeldVisible& v) {
            return numbers_of_sources(v, [](const Scene&, const PrimitiveSource& source) { return source.triangle; });
          },
          doc("Visible.triangle"))
      .def(
          "content_hash", [](const HeldVisible& v) { return content_hash(*v.visible); }, doc("Visible.content_hash"))
      .def("__repr__", [](const HeldVisible& v) {
        const View& view = v.visible->view;
        std::size_t seen = 0;
        for (std::size_t i = 0; i < view.pixel_count(); ++i) seen += v.visible->primitives[i] != no_primitive;
        return "Visible: " + std::to_string(view.width) + "x" + std::to_string(view.height) + " pixels, " +
               std::to_string(seen) + " of them see something";
      });
}

}  // namespace

void bind_surfaces(py::module_& m) {
  py::class_<HeldSurfaces, std::shared_ptr<HeldSurfaces>> surfaces(m, "Surfaces", doc("Surfaces"));
  py::class_<HeldVisible> visible(m, "Visible", doc("Visible"));
  bind_planes(visible);
  surfaces.def(py::init(&surfaces_of), "scene"_a, py::kw_only(), "threads"_a = 0, "progress"_a = py::none())
      .def(
          "zbuffer",
          [](const std::shared_ptr<HeldSurfaces>& held, const View& view, int threads, const py::object& progress) {
            return held_visible(
                held, run(threads, progress, [&](const Execution& execution) { return held->draw(view, execution); }));
          },
          "view"_a, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(), doc("Surfaces.zbuffer"))
      .def(
          "raycast",
          [](const std::shared_ptr<HeldSurfaces>& held, const View& view, int threads, const py::object& progress) {
            return held_visible(held, run(threads, progress, [&](const Execution& execution) {
                                  const std::shared_lock lock(held->scene->reading);
                                  return held->share(raycast(held->surfaces, view, execution));
                                }));
          },
          "view"_a, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(), doc("Surfaces.raycast"))
      .def("move", &move_objects, "object"_a, "pose"_a, py::kw_only(), "threads"_a = 0, doc("Surfaces.move"))
      .def_property_readonly(
          "scene", [](const HeldSurfaces& held) { return HeldScene{held.scene}; }, doc("Surfaces.scene"))
      .def_property_readonly(
          "triangle_count", [](const HeldSurfaces& held) { return held.surfaces.primitive_count(); },
          doc("Surfaces.triangle_count"))
      .def_property_readonly(
          "bounds", [](const HeldSurfaces& held) { return bounds_of(held.surfaces.bounds()); }, doc("Surfaces.bounds"))
      .def("__repr__", [](const HeldSurfaces& held) {
        return "Surfaces of '" + printable_text(held.scene->name) +
               "': " + std::to_string(held.surfaces.primitive_count()) + " triangles";
      });
}

}  // namespace frontmost::python
