// SPDX-License-Identifier: Apache-2.0
// frontmost precision: the resolution of a depth buffer, alone or for a model.
#include <fmt/format.h>
#include <frontmost/pictures.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/inputs.h"
#include "cli/option.h"
#include "cli/outputs.h"
#include "cli/precision/precision_report.h"
#include "cli/view/sight.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

constexpr Option precision_options[] = {
    {"format", 0, "D8|D16|D24|F32",
     "Format of the depth buffer; without it D16, D24, F32 and reversed F32 are compared.", Group::precision,
     for_precision, [](Settings& s, const Given& g) { s.precision.format = g.choice<DepthFormat>(); }},
    {"infinite", 0, "", "Put the far plane at infinity; short for --far inf.", Group::precision, for_precision,
     [](Settings& s, const Given&) { s.precision.infinite = true; }},
    {"gap", 0, "GAP,DISTANCE", "Print the near plane that resolves GAP at DISTANCE.", Group::precision, for_precision,
     [](Settings& s, const Given& g) {
       const std::vector<double> wanted = parse_numbers(g.text, 2, {1e-300, 1e300});
       s.precision.wanted = glm::dvec2(wanted[0], wanted[1]);
     }},
    {"plot", 0, "FILE", "Write a plot of gap against distance, as SVG.", Group::precision, for_precision,
     [](Settings& s, const Given& g) { s.precision.plot = g.file_name(); }},
    {"heat-map", 0, "FILE",
     "Write a picture of the model with the wrong pixels marked, in the format of the suffix; needs MODEL and "
     "--format.",
     Group::precision, for_precision, [](Settings& s, const Given& g) { s.precision.heat_map = g.file_name(); }},
};

std::vector<std::string> outputs_of(const PrecisionSettings& precision) {
  std::vector<std::string> files;
  for (const auto& file : {precision.plot, precision.heat_map})
    if (file) files.push_back(*file);
  return files;
}

void check(const Settings& settings) {
  const PrecisionSettings& precision = settings.precision;
  const bool has_model = !settings.model.empty();
  check_view_settings(settings.view);
  if (precision.infinite && settings.view.far) throw UsageError("--infinite and --far exclude each other");
  if (!has_model && !settings.view.near) throw UsageError("give --near, or a MODEL to fit it to");
  if (!has_model && !settings.view.far && !precision.infinite)
    throw UsageError("give --far or --infinite, or a MODEL to fit the far plane to");
  if (precision.heat_map && !(has_model && precision.format)) throw UsageError("--heat-map needs a MODEL and --format");
  const std::vector<std::string> files = outputs_of(precision);
  check_outputs(files, input_files(settings));
  if (settings.run.json && std::find(files.begin(), files.end(), "-") != files.end())
    throw UsageError("--json and the output '-' both write to standard output; give a file");
}

ViewSettings with_far(const Settings& settings) {
  ViewSettings view = settings.view;
  if (settings.precision.infinite) view.far = std::numeric_limits<double>::infinity();
  return view;
}

/// Returns the requested buffer, or the buffers in common use.
std::vector<PrecisionResult> buffers_of(const Settings& settings, const Projection& projection) {
  const bool reversed = settings.view.depth.reversed;
  std::vector<PrecisionResult> results;
  const auto add = [&](DepthFormat format, bool is_reversed) {
    results.emplace_back().setup = {projection.clip, format, is_reversed, projection.orthographic};
  };
  if (settings.precision.format) {
    add(*settings.precision.format, reversed);
    return results;
  }
  for (const DepthFormat format : {DepthFormat::d16, DepthFormat::d24, DepthFormat::f32}) add(format, reversed);
  if (!reversed) add(DepthFormat::f32, true);
  return results;
}

DepthFights fights_of(const Surfaces& surfaces, const ExactVisible& exact, const DepthSetup& setup,
                      const Execution& execution) {
  DepthSettings depth;
  depth.is_used = true;
  depth.format = setup.format;
  depth.reversed = setup.reversed;
  return find_depth_fights(surfaces, exact, look_at_surfaces(surfaces, exact.view, depth, execution).visible,
                           execution);
}

void save_heat_map(const PrecisionRun& run, const ExactVisible& exact, const Execution& execution) {
  const Surfaces& surfaces = *run.surfaces;
  const SeenView sight = look_at_surfaces(surfaces, exact.view, {}, execution);
  const Image backdrop =
      shade(surfaces, sight.visible, {.shading = Shading::lit, .background = glm::vec3(0.0f)}, execution);
  SaveOptions options;
  options.format = format_by_suffix(*run.settings.precision.heat_map).value_or(ImageFormat::png);
  options.quality = run.settings.output.quality;
  const WritingFiles writing;
  save(fight_image(*run.results.front().fights, backdrop), *run.settings.precision.heat_map, options, execution);
}

void save_plot(const PrecisionRun& run) {
  const Settings& settings = run.settings;
  const DepthSetup& setup = run.results.front().setup;
  const std::optional<DepthSetup> chosen = settings.precision.format ? std::optional(setup) : std::nullopt;
  const WritingFiles writing;
  save_text(precision_plot(setup.clip, setup.orthographic, chosen, settings.precision.wanted),
            *settings.precision.plot);
}

/// Returns the greatest distance of a box's corners from the eye or from the origin.
double reach_of(const Box& box, const glm::dvec3& eye) {
  const glm::dvec3 low(box.low), high(box.high);
  const auto farthest = [&](const glm::dvec3& from) {
    return glm::length(glm::max(glm::abs(low - from), glm::abs(high - from)));
  };
  return std::max(farthest(eye), farthest(glm::dvec3(0)));
}

/// Checks --gap, after the model has determined the clip planes.
void check_wanted(const Settings& settings, const ClipDistances& clip) {
  const std::optional<glm::dvec2>& wanted = settings.precision.wanted;
  if (!wanted || (wanted->y >= clip.near && wanted->y <= clip.far)) return;
  throw UsageError(
      fmt::format("--gap: the distance {:g} must lie between the near plane at {:g} and the far one at {:g}", wanted->y,
                  clip.near, clip.far));
}

void look_for_remedies(PrecisionRun& run, const ExactVisible& exact, const Execution& execution) {
  PrecisionResult& result = run.results.front();
  result.remedies = try_remedies(*run.surfaces, exact, result.setup, execution);
  if (!result.areas) return;
  for (const FightingObjects& pair : result.areas->objects) {
    if (result.offsets.size() == PrecisionResult::pairs_shown || pair.kind == FightKind::fold) break;
    result.offsets.push_back(find_offset(*run.surfaces, exact, *result.areas, pair, execution));
    stop_if_interrupted();
  }
}

/// Finds fighting faces. If the model is too near the eye, nearly all pairs of faces fight and exceed a limit. The rest
/// of the report is still useful.
void find_areas(const Surfaces& surfaces, const View& view, PrecisionResult& result, const Execution& execution) try {
  result.areas = find_fighting_faces(surfaces, view, result.setup.format, result.setup.reversed, execution);
} catch (const Error& error) {
  if (error.code() != ErrorCode::limit_exceeded) throw;
  result.too_many = error.what();
}

/// Adds the results that need a model.
void fight(PrecisionRun& run, const View& view, const Execution& execution) {
  const ExactVisible exact = find_exact_visible(*run.surfaces, view, execution);
  for (PrecisionResult& result : run.results) {
    result.fights = fights_of(*run.surfaces, exact, result.setup, execution);
    find_areas(*run.surfaces, view, result, execution);
    stop_if_interrupted();
  }
  if (run.results.size() == 1) look_for_remedies(run, exact, execution);
  if (!run.settings.precision.heat_map) return;
  save_heat_map(run, exact, execution);
  run.files.push_back(*run.settings.precision.heat_map);
}

Projection projection_without_model(const Settings& settings) {
  Projection projection;
  projection.orthographic = settings.view.orthographic;
  const ViewSettings view = with_far(settings);
  projection.clip = {*view.near, *view.far};
  return projection;
}

}  // namespace

std::span<const Option> precision_option_table() { return precision_options; }

int run_precision(const Settings& settings) {
  check(settings);
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  std::optional<Scene> scene;
  std::optional<Surfaces> surfaces;
  PrecisionRun run{.settings = settings, .names = {}, .results = {}, .files = {}, .reach = {}};
  if (settings.model.empty()) {
    const Projection projection = projection_without_model(settings);
    check_wanted(settings, projection.clip);
    run.results = buffers_of(settings, projection);
  } else {
    scene = load_model(settings, execution, progress, outputs_of(settings.precision));
    surfaces.emplace(*scene, execution);
    run.surfaces = &*surfaces;
    run.names.emplace(*scene);
    const View view = resolve_view(with_far(settings), *surfaces);
    show_framing_warning(settings, *surfaces, progress);
    check_wanted(settings, view.projection.clip);
    run.results = buffers_of(settings, view.projection);
    run.reach = reach_of(framed_box(*surfaces), view.eye());
    fight(run, view, execution);
  }
  if (settings.precision.plot) {
    save_plot(run);
    run.files.push_back(*settings.precision.plot);
  }
  progress.clear();
  const bool stdout_is_taken = std::find(run.files.begin(), run.files.end(), "-") != run.files.end();
  if (!stdout_is_taken) print(settings.run.json ? dump(precision_json(run)) : precision_text(run));
  return exit_done;
}

}  // namespace frontmost::cli
