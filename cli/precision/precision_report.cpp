// SPDX-License-Identifier: Apache-2.0
// Prints tables of gaps: for one buffer with the parts of the gaps, or for several buffers side by side. With a model,
// lists the fighting objects, too.
#include "cli/precision/precision_report.h"

#include <fmt/format.h>
#include <frontmost/version.h>

#include <algorithm>
#include <span>
#include <tuple>

#include "cli/console.h"
#include "cli/view/sight.h"

namespace frontmost::cli {
namespace {

constexpr std::size_t pairs_shown = PrecisionResult::pairs_shown;

std::string gap_text(double gap) { return std::isfinite(gap) ? fmt::format("{:.3g}", gap) : "none"; }

std::string object_name(const PrecisionRun& run, std::uint32_t instance) {
  if (instance == no_index) return "(nothing)";
  return (*run.names)[instance];
}

/// Returns the table of a single buffer, with details.
std::string table_of(const PrecisionRun& run, const DepthSetup& setup) {
  std::string text = fmt::format("{:>12}  {:>12}  {:>12}  {:>12}  {:>14}  {:>11}\n", "distance", "of format",
                                 "of positions", "smallest gap", "gap / distance", "values used");
  for (const double distance : round_distances(setup.clip)) {
    const double gap = certain_gap(setup, distance, run.reach);
    const std::string share = std::isfinite(gap) && distance > 0 ? fmt::format("{:.1e}", gap / distance) : "";
    text += fmt::format("{:>12.6g}  {:>12}  {:>12}  {:>12}  {:>14}  {:>9.2f} %\n", distance,
                        gap_text(resolvable_gap(setup, distance)), gap_text(rounding_gap(setup, distance, run.reach)),
                        gap_text(gap), share, 100 * share_of_values(setup, distance));
  }
  return text;
}

/// Returns the table of several buffers, side by side.
std::string table_of(const PrecisionRun& run) {
  std::string text = fmt::format("{:>12}  {:>12}", "distance", "of positions");
  for (const PrecisionResult& result : run.results) text += fmt::format("  {:>12}", setup_name(result.setup));
  text += '\n';
  for (const double distance : round_distances(run.clip())) {
    text += fmt::format("{:>12.6g}  {:>12}", distance,
                        gap_text(rounding_gap(run.results.front().setup, distance, run.reach)));
    for (const PrecisionResult& result : run.results)
      text += fmt::format("  {:>12}", gap_text(certain_gap(result.setup, distance, run.reach)));
    text += '\n';
  }
  return text;
}

std::string reach_text(const PrecisionRun& run) {
  const std::string reach = run.reach                                ? fmt::format("within {:.3g} of it", *run.reach)
                            : run.results.front().setup.orthographic ? "within twice the planes' distances"
                                                                     : "within twice their distance";
  return fmt::format(
      "\n"
      "A gap is the format's step plus the rounding of positions and transforms, for surfaces that face the eye\n"
      "and have their vertices {}. Slanted surfaces need the change of their depth over 1/256 pixel in addition.\n",
      reach);
}

/// Returns the near plane that resolves the wanted gap, including the rounding of positions.
std::optional<double> near_for(const PrecisionRun& run, const DepthSetup& setup) {
  const glm::dvec2 wanted = *run.settings.precision.wanted;
  const double rounding = rounding_gap(setup, wanted.y, run.reach);
  // Rounding also shifts the distance at which the format is evaluated, and grows with this distance. Both effects are
  // below this share.
  constexpr double slack = 4e-6;
  const double left_over = wanted.x * (1 - slack) - rounding;
  if (left_over <= 0) return std::nullopt;
  return near_for_gap(setup, std::min(wanted.y + rounding, setup.clip.far), left_over);
}

std::string wanted_text(const PrecisionRun& run) {
  const glm::dvec2 wanted = *run.settings.precision.wanted;
  std::string text = fmt::format("\nto tell {:g} apart at {:g}\n", wanted.x, wanted.y);
  for (const PrecisionResult& result : run.results) {
    const DepthSetup& setup = result.setup;
    const std::optional<double> near = near_for(run, setup);
    text += fmt::format("  {:14}", setup_name(setup));
    if (rounding_gap(setup, wanted.y, run.reach) >= wanted.x)
      text += fmt::format("no format resolves it: rounding of positions alone adds {:.3g}\n",
                          rounding_gap(setup, wanted.y, run.reach));
    else if (!near)
      text += "no near plane will do\n";
    if (near && *near == 0) text += "any near plane resolves it\n";
    if (near && *near > 0)
      text += fmt::format("near {:.4g} or farther{}\n", *near, *near <= setup.clip.near ? ": it is" : "");
  }
  return text;
}

std::string fights_text(const PrecisionRun& run) {
  const DepthFights& first = *run.results.front().fights;
  std::string text = fmt::format("\n{} of {} pixels covered", first.covered, first.view.pixel_count());
  if (first.tied > 0) text += fmt::format("; in {}, several surfaces coincide exactly", first.tied);
  text += "\nwrong surface seen\n";
  for (const PrecisionResult& result : run.results) {
    const DepthFights& fights = *result.fights;
    text += fmt::format("  {:14}{:>10} pixels  {:>8.3f} %\n", setup_name(result.setup), fights.wrong,
                        fights.covered > 0 ? 100.0 * double(fights.wrong) / double(fights.covered) : 0.0);
  }
  if (run.results.size() > 1 || first.pairs.empty()) return text;
  text += fmt::format("\n{:>10}  {:>12}  {:28}  {}\n", "pixels", "at most by", "seen", "instead of");
  for (std::size_t i = 0; i < first.pairs.size() && i < pairs_shown; ++i) {
    const FightingPair& pair = first.pairs[i];
    const std::string by = pair.seen == no_index ? "" : fmt::format("{:.3g}", pair.farthest);
    text += fmt::format("{:>10}  {:>12}  {:28}  {}\n", pair.samples, by, object_name(run, pair.seen),
                        pair.seen == pair.nearer ? "(itself)" : object_name(run, pair.nearer));
  }
  if (first.pairs.size() > pairs_shown)
    text += fmt::format("            and {} more pairs; --json lists them\n", first.pairs.size() - pairs_shown);
  return text;
}

std::string_view kind_name(FightKind kind) {
  switch (kind) {
    case FightKind::one_plane: return "one plane";
    case FightKind::fold: return "fold";
    case FightKind::close: return "close";
    case FightKind::clear: return "clear value";
  }
  return "";
}

/// Returns the visible area in square pixels, of all pairs or of one kind.
double visible_area(const FightAreas& areas, std::optional<FightKind> kind) {
  double sum = 0;
  for (const FightingObjects& pair : areas.objects)
    if (!kind || pair.kind == *kind) sum += pair.visible_area;
  return sum;
}

std::string offset_text(const PrecisionRun& run, const std::optional<OffsetRemedy>& remedy) {
  if (!remedy) return "";
  return fmt::format("  offset {:g},{:g} of {} ends it", remedy->offset.factor, remedy->offset.units,
                     object_name(run, remedy->instance));
}

std::string remedies_text(const PrecisionResult& result) {
  std::string text;
  for (const FightRemedy& remedy : result.remedies)
    text += fmt::format("with {}, near {:.6g} and far {:.6g}, {} {} wrong\n", setup_name(remedy.setup),
                        remedy.setup.clip.near, remedy.setup.clip.far, remedy.wrong,
                        remedy.wrong == 1 ? "pixel is" : "pixels are");
  return text;
}

/// Returns the fighting pairs of objects, for a single buffer.
std::string pairs_text(const PrecisionRun& run) {
  const PrecisionResult& result = run.results.front();
  std::string text;
  std::size_t i = 0;
  for (; i < result.offsets.size(); ++i) {
    const FightingObjects& pair = result.areas->objects[i];
    const std::string other = pair.kind == FightKind::clear ? "(nothing is seen)"
                              : pair.first == pair.second   ? "(itself)"
                                                            : object_name(run, pair.second);
    if (i == 0)
      text += fmt::format("\n{:>10}  {:11}  {:>10}  {:>9}  {}\n", "px2", "", "nearest", "gap there", "objects");
    text += fmt::format("{:>10.1f}  {:11}  {:>10.4g}  {:>9}  {}, {}{}\n", pair.visible_area, kind_name(pair.kind),
                        pair.distance, gap_text(pair.gap), object_name(run, pair.first), other,
                        offset_text(run, result.offsets[i]));
  }
  std::size_t others = 0;
  for (const FightingObjects& pair : result.areas->objects) others += pair.kind != FightKind::fold;
  if (others > i) text += fmt::format("            and {} more pairs; --json lists them\n", others - i);
  return text;
}

std::string areas_text(const PrecisionRun& run) {
  std::string text = "\nat risk, in pixels squared     in one plane       close  clear value       folds\n";
  for (const PrecisionResult& result : run.results) {
    if (!result.areas) {
      text += fmt::format("  {:24}too many to count ({})\n", setup_name(result.setup), result.too_many);
      continue;
    }
    const auto area = [&](FightKind kind) { return visible_area(*result.areas, kind); };
    text +=
        fmt::format("  {:24}{:>17.1f}{:>12.1f}{:>13.1f}{:>12.1f}\n", setup_name(result.setup),
                    area(FightKind::one_plane), area(FightKind::close), area(FightKind::clear), area(FightKind::fold));
  }
  const PrecisionResult& first = run.results.front();
  if (run.results.size() > 1) return text;
  return text + (first.areas ? pairs_text(run) : "") + remedies_text(first);
}

Json object_json(const PrecisionRun& run, std::uint32_t instance) {
  if (instance == no_index || !run.surfaces) return nullptr;
  return {{"object", instance}, {"name", run.surfaces->scene().instances[instance].name}};
}

Json fights_json(const PrecisionRun& run, const DepthFights& fights) {
  Json pairs = Json::array();
  for (const FightingPair& pair : fights.pairs) {
    pairs.push_back({{"seen", object_json(run, pair.seen)},
                     {"nearer", object_json(run, pair.nearer)},
                     {"pixels", pair.samples},
                     {"farthest", pair.farthest}});
  }
  return {{"pixels", fights.view.pixel_count()},
          {"covered_pixels", fights.covered},
          {"wrong_pixels", fights.wrong},
          {"tied_pixels", fights.tied},
          {"pairs", std::move(pairs)}};
}

/// Returns the pairs of faces with the largest visible areas.
Json faces_json(const FightAreas& areas) {
  constexpr std::size_t most_faces = 1000;
  std::vector<const FightingFaces*> largest;
  for (const FightingFaces& faces : areas.faces) largest.push_back(&faces);
  const std::size_t count = std::min(largest.size(), most_faces);
  std::partial_sort(largest.begin(), largest.begin() + std::ptrdiff_t(count), largest.end(),
                    [](const FightingFaces* a, const FightingFaces* b) {
                      return std::tuple(-a->visible_area, a->first, a->second) <
                             std::tuple(-b->visible_area, b->first, b->second);
                    });
  Json json = Json::array();
  for (const FightingFaces* faces : std::span(largest).first(count))
    json.push_back({{"kind", kind_name(faces->kind)},
                    {"first", faces->first},
                    {"second", faces->second == no_primitive ? Json(nullptr) : Json(faces->second)},
                    {"area", faces->area},
                    {"visible_area", faces->visible_area},
                    {"distance", faces->distance}});
  return json;
}

Json areas_json(const PrecisionRun& run, const PrecisionResult& result) {
  Json pairs = Json::array();
  for (std::size_t i = 0; i < result.areas->objects.size(); ++i) {
    const FightingObjects& pair = result.areas->objects[i];
    Json json = {{"kind", kind_name(pair.kind)},
                 {"first", object_json(run, pair.first)},
                 {"second", object_json(run, pair.second)},
                 {"areas", pair.areas},
                 {"area", pair.area},
                 {"visible_area", pair.visible_area},
                 {"distance", pair.distance},
                 {"gap", finite_or_null(pair.gap)}};
    if (i < result.offsets.size() && result.offsets[i]) {
      const OffsetRemedy& remedy = *result.offsets[i];
      json["offset"] = {{"object", object_json(run, remedy.instance)},
                        {"factor", remedy.offset.factor},
                        {"units", remedy.offset.units}};
    }
    pairs.push_back(std::move(json));
  }
  Json json = {{"areas", result.areas->faces.size()},
               {"visible_area", visible_area(*result.areas, std::nullopt)},
               {"pairs", std::move(pairs)}};
  if (run.results.size() == 1) json["faces"] = faces_json(*result.areas);
  return json;
}

Json remedies_json(const std::vector<FightRemedy>& remedies) {
  Json json = Json::array();
  for (const FightRemedy& remedy : remedies)
    json.push_back({{"format", name(remedy.setup.format)},
                    {"reversed", remedy.setup.reversed},
                    {"near", remedy.setup.clip.near},
                    {"far", finite_or_null(remedy.setup.clip.far)},
                    {"wrong_pixels", remedy.wrong}});
  return json;
}

Json result_json(const PrecisionRun& run, const PrecisionResult& result) {
  const DepthSetup& setup = result.setup;
  Json json = {{"format", name(setup.format)}, {"reversed", setup.reversed}};
  json["distances"] = Json::array();
  for (const double distance : round_distances(setup.clip)) {
    json["distances"].push_back({{"distance", distance},
                                 {"format_gap", finite_or_null(resolvable_gap(setup, distance))},
                                 {"positions_gap", rounding_gap(setup, distance, run.reach)},
                                 {"gap", finite_or_null(certain_gap(setup, distance, run.reach))},
                                 {"values_used", share_of_values(setup, distance)}});
  }
  if (run.settings.precision.wanted) {
    const std::optional<double> near = near_for(run, setup);
    json["near_for_gap"] = near ? Json(*near) : Json(nullptr);
  }
  if (result.fights) json["fights"] = fights_json(run, *result.fights);
  if (result.areas) json["at_risk"] = areas_json(run, result);
  if (!result.too_many.empty()) json["at_risk"] = {{"refused", result.too_many}};
  if (result.fights && run.results.size() == 1) json["remedies"] = remedies_json(result.remedies);
  return json;
}

}  // namespace

std::string setup_name(const DepthSetup& setup) {
  return fmt::format("{}{}", name(setup.format), setup.reversed ? " reversed" : "");
}

std::string precision_text(const PrecisionRun& run) {
  const ClipDistances& clip = run.clip();
  const bool single = run.results.size() == 1;
  std::string text = single ? setup_name(run.results.front().setup) + ", " : "smallest gap that is always resolved; ";
  text += fmt::format("near {:.6g}, far {}\n\n", clip.near,
                      std::isfinite(clip.far) ? fmt::format("{:.6g}", clip.far) : "infinite");
  text += single ? table_of(run, run.results.front().setup) : table_of(run);
  text += reach_text(run);
  if (run.settings.precision.wanted) text += wanted_text(run);
  if (run.surfaces) text += fights_text(run) + areas_text(run);
  return text;
}

Json precision_json(const PrecisionRun& run) {
  Json json = {{"frontmost", FRONTMOST_VERSION}, {"near", run.clip().near}, {"far", finite_or_null(run.clip().far)}};
  json["projection"] = run.results.front().setup.orthographic ? "orthographic" : "perspective";
  if (run.surfaces) json["model"] = run.settings.model;
  if (const std::optional<glm::dvec2>& wanted = run.settings.precision.wanted)
    json["wanted"] = {{"gap", wanted->x}, {"distance", wanted->y}};
  json["buffers"] = Json::array();
  for (const PrecisionResult& result : run.results) json["buffers"].push_back(result_json(run, result));
  json["files"] = run.files;
  return json;
}

}  // namespace frontmost::cli
