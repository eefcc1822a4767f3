// SPDX-License-Identifier: Apache-2.0
// Single rays: hits and obstacles.
#include <frontmost/raycast.h>

#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/held.h"
#include "python/rays.h"
#include "python/running.h"

namespace frontmost::python {
namespace {

using namespace py::literals;

/// Rows of an (n, 3) array, or one row (3,) for all queries.
struct Rows {
  Array<float> values;
  py::ssize_t count;  ///< -1: one row for any number of queries

  [[nodiscard]] glm::vec3 at(py::ssize_t i) const {
    const float* const v = values.data() + (count < 0 ? 0 : 3 * i);
    return {v[0], v[1], v[2]};
  }
};

Rows rows_of(const py::handle& given, const std::string& name) {
  const py::array array = py::array::ensure(given);
  if (array && array.ndim() == 1) return {numbers<float>(given, name, {3}), -1};
  auto values = numbers<float>(given, name, {-1, 3});
  const py::ssize_t count = values.shape(0);
  return {std::move(values), count};
}

/// One query for each pair of rows. \throws py::value_error if the numbers of rows differ.
template <class Query>
std::vector<Query> queries_of(const py::handle& first, const char* first_name, const py::handle& second,
                              const char* second_name) {
  const Rows a = rows_of(first, first_name), b = rows_of(second, second_name);
  if (a.count >= 0 && b.count >= 0 && a.count != b.count)
    throw py::value_error(std::string(second_name) + ": are " + std::to_string(b.count) + ", for " +
                          std::to_string(a.count) + " " + first_name);
  const py::ssize_t count = std::max({a.count, b.count, py::ssize_t(a.count < 0 && b.count < 0 ? 1 : 0)});
  std::vector<Query> queries(static_cast<std::size_t>(count));
  for (py::ssize_t i = 0; i < count; ++i) queries[std::size_t(i)] = {a.at(i), b.at(i)};
  return queries;
}

template <class Query>
HeldHits closest(const std::shared_ptr<HeldRayIndex>& held, const std::vector<Query>& queries, int threads,
                 const py::object& progress) {
  held->check_current();
  std::vector<RayHit> hits(queries.size());
  run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(held->reading);
    closest_hits(held->index, queries, hits, execution);
  });
  return hits_of(held->of, hits);
}

HeldHits closest_hit_of(const std::shared_ptr<HeldRayIndex>& held, const py::object& origins,
                        const py::object& directions, const py::object& end, int threads, const py::object& progress) {
  if (directions.is_none() == end.is_none()) throw py::type_error("directions: either these or end must be given");
  if (end.is_none())
    return closest(held, queries_of<Ray>(origins, "origins", directions, "directions"), threads, progress);
  return closest(held, queries_of<Segment>(origins, "origins", end, "end"), threads, progress);
}

py::tuple all_hits_of(const std::shared_ptr<HeldRayIndex>& held, const py::object& origins,
                      const py::object& directions, const py::object& progress) {
  held->check_current();
  const auto rays = queries_of<Ray>(origins, "origins", directions, "directions");
  Buffer<std::uint64_t> first(rays.size() + 1);
  std::vector<RayHit> hits;
  run(1, progress, [&](const Execution& execution) {
    const std::shared_lock lock(held->reading);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      first[i] = hits.size();
      const std::vector<RayHit> met = all_hits(held->index, rays[i]);
      hits.insert(hits.end(), met.begin(), met.end());
      if (i % 1024 == 0 && execution.watch->cancelled()) throw Error(ErrorCode::cancelled, "cancelled");
    }
    first[rays.size()] = hits.size();
  });
  const auto size = py::ssize_t(first.size());
  return py::make_tuple(hits_of(held->of, hits), owned(std::move(first), {size}));
}

/// Converts bytes of 0 and 1 to an array of bool.
py::object mask_of(Buffer<std::uint8_t>&& answers) {
  const auto size = py::ssize_t(answers.size());
  return owned(std::move(answers), {size}).attr("view")("bool");
}

py::object are_clear_of(const std::shared_ptr<HeldRayIndex>& held, const py::object& start, const py::object& end,
                        int threads, const py::object& progress) {
  held->check_current();
  const auto segments = queries_of<Segment>(start, "start", end, "end");
  Buffer<std::uint8_t> answers(segments.size());
  run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(held->reading);
    are_clear(held->index, segments, {answers.data(), answers.size()}, execution);
  });
  return mask_of(std::move(answers));
}

py::object are_lit_of(const std::shared_ptr<HeldRayIndex>& held, const py::object& primitives,
                      const py::object& weights, const py::object& to_light, int threads, const py::object& progress) {
  held->check_current();
  const std::uint32_t count = held->of->surfaces.primitive_count();
  const auto ids = indices(primitives, "primitives", {-1}, count);
  const auto by = numbers<float>(weights, "weights", {ids.shape(0), 3});
  const glm::vec3 light(point(to_light, "to_light"));
  std::vector<TrianglePoint> points(static_cast<std::size_t>(ids.shape(0)));
  Buffer<std::uint8_t> answers(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float* const w = by.data() + 3 * i;
    if (!(w[0] >= 0 && w[1] >= 0 && w[2] >= 0 && w[0] + w[1] + w[2] > 0))
      throw py::value_error("weights: row " + std::to_string(i) + " is negative, or all zero");
    points[i].primitive = ids.data()[i];
    points[i].weights = {w[0], w[1], w[2]};
  }
  run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock moving(held->of->scene->reading), lock(held->reading);
    for (TrianglePoint& at : points) at.corners = held->of->surfaces.corners(at.primitive);
    are_lit(held->index, points, light, {answers.data(), answers.size()}, execution);
  });
  return mask_of(std::move(answers));
}

std::shared_ptr<HeldRayIndex> index_of(const std::shared_ptr<HeldSurfaces>& of, int threads,
                                       const py::object& progress) {
  return run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(of->scene->reading);
    return std::make_shared<HeldRayIndex>(of, execution);
  });
}

void bind_hits(py::module_& m) {
  py::class_<HeldHits>(m, "Hits", doc("Hits"))
      .def_readonly("primitive", &HeldHits::primitive, doc("Hits.primitive"))
      .def_readonly("t", &HeldHits::t, doc("Hits.t"))
      .def_readonly("is_front", &HeldHits::is_front, doc("Hits.is_front"))
      .def_readonly("object", &HeldHits::object, doc("Hits.object"))
      .def_readonly("face", &HeldHits::face, doc("Hits.face"))
      .def("__len__", [](const HeldHits& hits) { return hits.primitive.size(); })
      .def("__repr__", [](const HeldHits& hits) {
        std::size_t met = 0;
        for (py::ssize_t i = 0; i < hits.primitive.size(); ++i) met += hits.primitive.data()[i] != no_primitive;
        return "Hits: " + std::to_string(hits.primitive.size()) + ", of which " + std::to_string(met) +
               " meet something";
      });
}

}  // namespace

HeldHits hits_of(const std::shared_ptr<HeldSurfaces>& of, const std::vector<RayHit>& hits) {
  const auto count = py::ssize_t(hits.size());
  HeldHits out{py::array_t<std::uint32_t>(count), py::array_t<double>(count), py::array_t<bool>(count),
               py::array_t<std::uint32_t>(count), py::array_t<std::uint32_t>(count)};
  const Surfaces& surfaces = of->surfaces;
  const Scene& scene = *of->scene;
  for (py::ssize_t i = 0; i < count; ++i) {
    const RayHit& hit = hits[std::size_t(i)];
    const PrimitiveSource source = hit ? surfaces.source(hit.primitive) : PrimitiveSource{};
    out.primitive.mutable_data()[i] = hit.primitive;
    out.t.mutable_data()[i] = hit.t;
    out.is_front.mutable_data()[i] = hit.is_front;
    out.object.mutable_data()[i] = source.instance;
    out.face.mutable_data()[i] = hit ? scene.meshes[source.mesh].face_of(source.triangle) : no_index;
  }
  return out;
}

void bind_rays(py::module_& m) {
  bind_hits(m);
  py::class_<HeldRayIndex, std::shared_ptr<HeldRayIndex>>(m, "RayIndex", doc("RayIndex"))
      .def(py::init(&index_of), "surfaces"_a, py::kw_only(), "threads"_a = 0, "progress"_a = py::none())
      .def("closest_hit", &closest_hit_of, "origins"_a, "directions"_a = py::none(), py::kw_only(),
           "end"_a = py::none(), "threads"_a = 0, "progress"_a = py::none(), doc("RayIndex.closest_hit"))
      .def("all_hits", &all_hits_of, "origins"_a, "directions"_a, py::kw_only(), "progress"_a = py::none(),
           doc("RayIndex.all_hits"))
      .def("is_clear", &are_clear_of, "start"_a, "end"_a, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(),
           doc("RayIndex.is_clear"))
      .def("are_lit", &are_lit_of, "primitives"_a, "weights"_a, "to_light"_a, py::kw_only(), "threads"_a = 0,
           "progress"_a = py::none(), doc("RayIndex.are_lit"))
      .def(
          "raycast",
          [](const std::shared_ptr<HeldRayIndex>& held, const View& view, int threads, const py::object& progress) {
            held->check_current();
            return held_visible(held->of, run(threads, progress, [&](const Execution& execution) {
                                  const std::shared_lock lock(held->reading);
                                  return held->of->share(raycast(held->index, view, execution));
                                }));
          },
          "view"_a, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(), doc("RayIndex.raycast"))
      .def(
          "refit",
          [](const std::shared_ptr<HeldRayIndex>& held, int threads) {
            held->moves = held->of->moves;
            run(threads, py::none(), [&](const Execution& execution) {
              const std::shared_lock moving(held->of->scene->reading);
              const std::unique_lock lock(held->reading);
              held->index.refit(held->of->surfaces, execution);
            });
          },
          py::kw_only(), "threads"_a = 0, doc("RayIndex.refit"))
      .def_property_readonly(
          "surfaces", [](const HeldRayIndex& held) { return held.of; }, doc("RayIndex.surfaces"))
      .def("__repr__", [](const HeldRayIndex& held) {
        return "RayIndex of " + std::to_string(held.index.triangle_count()) + " triangles";
      });
}

}  // namespace frontmost::python
