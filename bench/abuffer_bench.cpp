// SPDX-License-Identifier: Apache-2.0
// The A-buffer on four shifted, translucent copies of a model at 1920 x 1080, the scene that depth peeling is measured
// on, by sub-samples of a pixel. Colours are those of the triangles under one light, worked out in the measured time.
#include <benchmark/benchmark.h>
#include <frontmost/frontmost.h>

#include <array>

namespace {

using namespace frontmost;

constexpr const char* model_names[] = {"reference/teapot/teapot.obj", "organic/stanford-bunny.obj"};
constexpr std::array<int, 4> grids{0, 2, 4, 8};

/// The model four times, a twelfth of its bounds' diagonal apart.
Scene four_copies(const std::string& path) {
  Scene scene = load(path);
  const Surfaces one(scene);
  const glm::dvec3 step = glm::dvec3(one.bounds().high - one.bounds().low) * (0.25 / 3);
  const std::vector<Instance> instances = scene.instances;
  for (int copy = 1; copy < 4; ++copy)
    for (Instance instance : instances) {
      instance.world_from_mesh[3] += glm::dvec4(step * double(copy), 0);
      scene.instances.push_back(instance);
    }
  return scene;
}

/// The corners of the first copy's box just fit, seen from direction (3, 2, 4) at 45 degrees.
View fit(const Box& box) {
  const glm::dvec3 centre = box.centre();
  View view;
  view.width = 1920;
  view.height = 1080;
  view.world_from_eye = look_at(glm::dvec3(3, 2, 4), glm::dvec3(0), {0, 1, 0});
  const double ty = std::tan(0.39269908169872414), tx = ty * view.width / view.height;
  double distance = 0, nearest = 1e30, farthest = -1e30;
  for (int k = 0; k < 8; ++k) {
    const glm::dvec3 p =
        glm::dvec3(k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y, k & 4 ? box.high.z : box.low.z) -
        centre;
    const double z = glm::dot(p, view.forward());
    distance =
        std::max({distance, std::abs(glm::dot(p, view.right())) / tx - z, std::abs(glm::dot(p, view.up())) / ty - z});
    nearest = std::min(nearest, z);
    farthest = std::max(farthest, z);
  }
  view.world_from_eye[3] = glm::dvec4(centre - view.forward() * 1.05 * distance, 1);
  view.projection = make_frustum(-tx, tx, -ty, ty, {1, 2});
  const double margin = 0.01 * (farthest - nearest), along = 1.05 * distance;
  view.projection.clip = {along + nearest - margin, along + farthest + margin};
  return view;
}

struct Stage {
  explicit Stage(int model)
      : scene(four_copies(std::string(FRONTMOST_MODELS "/") + model_names[model])), surfaces(scene) {
    view = fit(surfaces.bounds(0));
  }
  /// Lambert under a light at the camera's upper left, by triangle.
  void paint() {
    const glm::vec3 light = glm::normalize(glm::vec3(-view.forward() + 0.5 * view.up() - 0.3 * view.right()));
    colors.resize(surfaces.primitive_count());
    std::size_t id = 0;
    for (const Instance& instance : scene.instances) {
      const Mesh& mesh = scene.meshes[instance.mesh];
      for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 n =
            glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
        const float length = glm::length(n);
        colors[id++] =
            glm::vec4(glm::vec3(0.15f + 0.85f * std::abs(glm::dot(n, light)) / (length > 0 ? length : 1)), 0.4f);
      }
    }
  }
  Scene scene;
  Surfaces surfaces;
  View view;
  std::vector<glm::vec4> colors;
};

void picture(benchmark::State& state) {
  Stage stage(int(state.range(0)));
  const AbufferOptions options{grids[std::size_t(state.range(1))], 1.0f};
  Resolver resolver;
  stage.paint();
  resolver.draw(stage.surfaces, stage.view, stage.colors, options, {.threads = 1});
  for (auto _ : state) {
    stage.paint();
    const Execution execution{.threads = 1, .isa = Isa(state.range(2)), .watch = nullptr};
    benchmark::DoNotOptimize(resolver.draw(stage.surfaces, stage.view, stage.colors, options, execution).red.data());
  }
}
BENCHMARK(picture)->ArgsProduct({{0, 1}, {0, 2, 3}, {0}})->Unit(benchmark::kMillisecond)->Iterations(5);
BENCHMARK(picture)->ArgsProduct({{0, 1}, {0, 3}, {1, 2, 3}})->Unit(benchmark::kMillisecond)->Iterations(3);

/// Sheets that fill the picture; all threads.
void stack(benchmark::State& state) {
  Mesh mesh;
  const int layers = int(state.range(0));
  for (int i = 0; i < layers; ++i) {
    const float z = -float(i) / float(layers);
    const auto n = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {{-9, -9, z}, {9, -9, z}, {9, 9, z}, {-9, 9, z}});
    mesh.triangles.insert(mesh.triangles.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
  }
  Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({"stack", 0, glm::dmat4(1.0)});
  const Surfaces surfaces(scene);
  View view;
  view.width = int(state.range(1));
  view.height = view.width * 9 / 16;
  view.world_from_eye = look_at({0, 0, 1}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_projection(1, 16.0 / 9, {0.5, 3});
  const std::vector<glm::vec4> colors(surfaces.primitive_count(), glm::vec4(0.5f, 0.5f, 0.5f, 0.01f));
  for (auto _ : state) benchmark::DoNotOptimize(resolve(surfaces, view, colors, {int(state.range(2))}).red.data());
}
BENCHMARK(stack)->Args({500, 1920, 0})->Args({100, 3840, 0})->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
