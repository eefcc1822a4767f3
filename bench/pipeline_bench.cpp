// SPDX-License-Identifier: Apache-2.0
// Each step from scene to picture, on the built-in scenes at 1920 x 1080.
#include <benchmark/benchmark.h>
#include <frontmost/frontmost.h>

namespace {

using namespace frontmost;

constexpr const char* scene_names[] = {"teapot", "spheres", "city", "gallery"};

/// All inputs of the measured step.
struct Stage {
  explicit Stage(const benchmark::State& state, int samples = 1)
      : scene(builtin(scene_names[state.range(0)])), surfaces(scene), view(frame(surfaces, 1920, 1080)) {
    view.samples = samples;
  }
  Scene scene;
  Surfaces surfaces;
  View view;
};

void describe(benchmark::State& state, const Stage& stage) {
  state.SetLabel(scene_names[state.range(0)]);
  state.counters["triangles"] = double(stage.surfaces.primitive_count());
  state.counters["triangles/s"] =
      benchmark::Counter(double(stage.surfaces.primitive_count()), benchmark::Counter::kIsIterationInvariantRate);
}

void surfaces(benchmark::State& state) {
  const Stage stage(state);
  for (auto _ : state) benchmark::DoNotOptimize(Surfaces(stage.scene).primitive_count());
  describe(state, stage);
}

void visible(benchmark::State& state) {
  const Stage stage(state);
  for (auto _ : state) benchmark::DoNotOptimize(zbuffer(stage.surfaces, stage.view).keys.data());
  describe(state, stage);
}

void visible_on_one_thread(benchmark::State& state) {
  const Stage stage(state);
  const Execution execution{.threads = 1, .isa = Isa(state.range(1)), .watch = nullptr};
  for (auto _ : state) benchmark::DoNotOptimize(zbuffer(stage.surfaces, stage.view, execution).keys.data());
  describe(state, stage);
  state.SetLabel(std::string(scene_names[state.range(0)]) + ", " + std::string(name(execution.isa)));
}

void shading(benchmark::State& state) {
  const Stage stage(state, int(state.range(1)));
  const Visible seen = zbuffer(stage.surfaces, stage.view);
  for (auto _ : state) benchmark::DoNotOptimize(shade(stage.surfaces, seen).channels.data());
  describe(state, stage);
  state.SetLabel(std::string(scene_names[state.range(0)]) + ", " + std::to_string(state.range(1)) + " samples");
}

// Saving a PNG on one thread, to compare with the cost of visibility and colour.
void saving_on_one_thread(benchmark::State& state) {
  const Stage stage(state, 4);
  const Bitmap picture = shade_bitmap(stage.surfaces, zbuffer(stage.surfaces, stage.view));
  SaveOptions options;
  options.format = ImageFormat::png;
  Execution execution;
  execution.threads = 1;
  for (auto _ : state) save(picture, "/dev/null", options, execution);
  describe(state, stage);
}

// Every instruction set of this machine: the table of kernels is chosen at run time.
void scenes_and_isas(benchmark::internal::Benchmark* bench) {
  for (const Isa isa : available_isas()) bench->Args({2, std::int64_t(isa)});
}

BENCHMARK(surfaces)->DenseRange(0, 3)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(visible)->DenseRange(0, 3)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(visible_on_one_thread)->Apply(scenes_and_isas)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(shading)->ArgsProduct({{0, 1, 2, 3}, {1, 4}})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(saving_on_one_thread)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);

}  // namespace
