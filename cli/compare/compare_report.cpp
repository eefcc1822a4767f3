// SPDX-License-Identifier: Apache-2.0
// Prints the figures twice: as a table with a column for each method, rounded, and as JSON, not rounded.
#include "cli/compare/compare_report.h"

#include <fmt/format.h>
#include <frontmost/version.h>

#include <algorithm>

#include "cli/console.h"

namespace frontmost::cli {
namespace {

constexpr Difference explained_causes[] = {Difference::edge, Difference::depth, Difference::translucent};

/// Returns a line: a label, and a cell for each method under its name. A column is at least as wide as its method's
/// name.
template <class Cell>
std::string row_of(const Comparisons& all, std::string_view what, const Cell& cell) {
  constexpr std::size_t least = 13, gap = 2;
  std::string text = fmt::format("{:24}", what);
  for (const Compared& compared : all.methods)
    text += fmt::format("{:>{}}", cell(compared), std::max(least, compared.run.method->name.size() + gap));
  return text + '\n';
}

Json stages_json(const MethodRun& run) {
  Json json = Json::object();
  for (const Stage& stage : run.stages) {
    const bool is_single = stage.times.size() == 1 && stage.name != "visible";
    json[stage.name] = is_single ? Json(stage.times.front()) : times_json(stage.times);
  }
  return json;
}

Json method_json(const Comparisons& all, const Compared& compared) {
  const MethodRun& run = compared.run;
  Json explained = Json::object();
  for (const Difference cause : explained_causes) explained[std::string(name(cause))] = compared.agreement.count(cause);
  Json json = {{"method", run.method->name},
               {"runs", run.runs()},
               {"timings_ms", stages_json(run)},
               {"peak_bytes", run.peak_bytes},
               {"primitives", run.answer.primitives},
               {"samples", all.view.sample_count()},
               {"covered_samples", covered_samples(run.answer.visible)},
               {"differing", compared.agreement.differing()},
               {"explained", std::move(explained)},
               {"wrong_by_design", compared.wrong_by_design()},
               {"unexplained", compared.unexplained()}};
  if (run.lists) {
    json["fragments"] = run.lists->fragments;
    json["longest_list"] = run.lists->longest;
  }
  return json;
}

Json culling_json(const CullingRun& culling) {
  return {{"timings_ms", {{"index", culling.prepare}, {"cull", times_json(culling.times)}}},
          {"objects", culling.objects()},
          {"outside", culling.outside},
          {"hidden", culling.hidden},
          {"may_be_seen", culling.open},
          {"seen", culling.seen},
          {"wrong", culling.wrong}};
}

}  // namespace

std::vector<std::string> stage_names(const std::vector<Compared>& methods) {
  std::vector<std::string> names;
  for (const Compared& compared : methods) {
    // A stage that other methods lack goes before the stage that follows it in this method.
    auto place = names.begin();
    for (const Stage& stage : compared.run.stages) {
      const auto found = std::find(names.begin(), names.end(), stage.name);
      place = (found != names.end() ? found : names.insert(place, stage.name)) + 1;
    }
  }
  return names;
}

std::string mebibytes(std::uint64_t bytes) { return fmt::format("{:.1f} MiB", double(bytes) / (1024 * 1024)); }

std::string_view spots(const View& view) { return view.samples == 1 ? "pixels" : "samples"; }

std::string grid_of(const View& view, std::string_view times) {
  std::string text = fmt::format("{} {} {} pixels", view.width, times, view.height);
  if (view.samples > 1) text += fmt::format(", {} samples each", view.samples);
  return text;
}

std::string runs_of(const Comparisons& all) {
  const int runs = all.settings.compare.most_runs();
  std::string text = fmt::format("medians of {} run{}", runs, runs == 1 ? "" : "s");
  const auto is_short = [&](const Compared& c) { return c.run.runs() < std::size_t(runs); };
  if (std::any_of(all.methods.begin(), all.methods.end(), is_short)) text += ", fewer of what takes over 2 s";
  return text;
}

std::uint64_t covered_samples(const Visible& visible) {
  return std::uint64_t(std::count_if(visible.primitives.begin(), visible.primitives.end(),
                                     [](PrimitiveId id) { return id != no_primitive; }));
}

std::string culling_text(const Comparisons& all) {
  const CullingRun& c = all.culling;
  std::string text = fmt::format(
      "Occlusion culling: of {} object{} {} outside of the view, {} certainly hidden, {} may be seen ({} seen at a "
      "sample); {:.2f} ms, and {:.2f} ms before the first view.",
      grouped(c.objects()), c.objects() == 1 ? "" : "s", c.outside == 1 ? "1 is" : grouped(c.outside) + " are",
      grouped(c.hidden), grouped(c.open), c.seen == 1 ? "1 is" : grouped(c.seen) + " are", median(c.times), c.prepare);
  if (c.wrong > 0)
    text += fmt::format(" {} of what it leaves out is seen: a mistake. Please report this model.", grouped(c.wrong));
  return text;
}

std::string compare_text(const Comparisons& all) {
  std::string text = fmt::format("{} triangles, {}, {}\n\n", grouped(all.surfaces.primitive_count()),
                                 grid_of(all.view, "x"), runs_of(all));
  text += row_of(all, "", [](const Compared& c) { return std::string(c.run.method->name); });
  for (const std::string& stage : stage_names(all.methods))
    text += row_of(all, stage + ", ms", [&](const Compared& c) {
      const std::optional<double> time = c.run.median_of(stage);
      return time ? fmt::format("{:.2f}", *time) : std::string();
    });
  text += row_of(all, "memory", [](const Compared& c) { return mebibytes(c.run.peak_bytes); });
  text += row_of(all, "primitives", [](const Compared& c) { return grouped(c.run.answer.primitives); });
  text += row_of(all, "samples", [&](const Compared&) { return grouped(all.view.sample_count()); });
  text += row_of(all, "  covered", [](const Compared& c) { return grouped(covered_samples(c.run.answer.visible)); });
  text +=
      row_of(all, "fragments", [](const Compared& c) { return c.run.lists ? grouped(c.run.lists->fragments) : ""; });
  text += row_of(all, "  most of a pixel",
                 [](const Compared& c) { return c.run.lists ? grouped(c.run.lists->longest) : ""; });
  text += row_of(all, fmt::format("{} that differ", spots(all.view)),
                 [](const Compared& c) { return grouped(c.agreement.differing()); });
  for (const auto& [label, cause] :
       {std::pair("  edge in 1/128 pixel", Difference::edge), std::pair("  depths too close", Difference::depth),
        std::pair("  translucent", Difference::translucent)})
    text += row_of(all, label, [&, counted = cause](const Compared& c) { return grouped(c.agreement.count(counted)); });
  text += row_of(all, "  wrong by design", [](const Compared& c) { return grouped(c.wrong_by_design()); });
  text += row_of(all, "  unexplained", [](const Compared& c) { return grouped(c.unexplained()); });
  text += '\n' + culling_text(all) + '\n';
  if (!all.settings.compare.explain) return text;
  text += '\n';
  for (const std::string& sentence : advice(all)) text += sentence + '\n';
  return text;
}

Json compare_json(const Comparisons& all) {
  Json json = {{"frontmost", FRONTMOST_VERSION},
               {"model", all.settings.model},
               {"isa", name(all.settings.run.isa)},
               {"threads", all.settings.run.threads},
               {"runs", all.settings.compare.most_runs()},
               {"triangles", all.surfaces.primitive_count()},
               {"width", all.view.width},
               {"height", all.view.height},
               {"samples", all.view.samples}};
  json["methods"] = Json::array();
  for (const Compared& compared : all.methods) json["methods"].push_back(method_json(all, compared));
  json["occlusion_culling"] = culling_json(all.culling);
  if (all.settings.compare.explain) json["advice"] = advice(all);
  json["files"] = all.files;
  return json;
}

}  // namespace frontmost::cli
