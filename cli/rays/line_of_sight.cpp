// SPDX-License-Identifier: Apache-2.0
// frontmost sight: whether one point sees another, for one pair of points or a file of them.
#include <fmt/format.h>
#include <frontmost/raycast.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/interruption.h"
#include "cli/json_numbers.h"
#include "cli/model.h"
#include "cli/rays/number_lines.h"

namespace frontmost::cli {
namespace {

std::vector<Segment> read_pairs(const std::string& path) {
  std::vector<Segment> pairs;
  for (const std::vector<double>& n : read_number_lines(path, {6, "six numbers make a pair of points"}))
    pairs.push_back({glm::dvec3(n[0], n[1], n[2]), glm::dvec3(n[3], n[4], n[5])});
  return pairs;
}

std::vector<Segment> pairs_of(const SightSettings& sight) {
  if (sight.pairs && (sight.from || sight.to)) throw UsageError("--pairs and --from, --to are two ways to say it");
  if (sight.pairs) return read_pairs(*sight.pairs);
  if (!sight.from || !sight.to) throw UsageError("give --from and --to, or --pairs");
  return {{*sight.from, *sight.to}};
}

/// What stands in the way.
struct Blocked {
  PrimitiveSource source;
  std::string object;
  glm::dvec3 point;
  double distance;
};

Blocked blocked_by(const RayHit& hit, const Segment& pair, const Surfaces& surfaces) {
  const glm::dvec3 from(pair.from), along = glm::dvec3(pair.to) - from;
  const PrimitiveSource source = surfaces.source(hit.primitive);
  return {source, surfaces.scene().instances[source.instance].name, from + hit.t * along, hit.t * glm::length(along)};
}

Json pair_json(const RayHit& hit, const Segment& pair, const Surfaces& surfaces) {
  Json json = {{"from", to_json(pair.from)}, {"to", to_json(pair.to)}, {"clear", !hit}};
  if (!hit) return json;
  const Blocked by = blocked_by(hit, pair, surfaces);
  json["object"] = by.source.instance;
  json["name"] = by.object;
  json["triangle"] = by.source.triangle;
  json["point"] = to_json(by.point);
  json["distance"] = by.distance;
  return json;
}

std::string pair_text(const RayHit& hit, const Segment& pair, const Surfaces& surfaces) {
  if (!hit) return "clear\n";
  const Blocked by = blocked_by(hit, pair, surfaces);
  const std::string name = by.object.empty() ? "" : " (" + printable_name(by.object) + ")";
  return fmt::format("blocked by object {}{}, triangle {}, at {:.6g},{:.6g},{:.6g}, distance {:.6g}\n",
                     by.source.instance, name, by.source.triangle, by.point.x, by.point.y, by.point.z, by.distance);
}

}  // namespace

int run_sight(const Settings& settings) {
  const std::vector<Segment> pairs = pairs_of(settings.sight);
  catch_interruptions(settings.run.timeout);
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  const Scene scene = load_model(settings, execution, progress);
  const Surfaces surfaces(scene, execution);
  const RayIndex index(surfaces, execution);
  std::vector<RayHit> hits(pairs.size());
  closest_hits(index, pairs, hits, execution);
  progress.clear();
  Json list = Json::array();
  std::string text;
  std::size_t clear = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    clear += !hits[i];
    if (settings.run.json) {
      list.push_back(pair_json(hits[i], pairs[i], surfaces));
    } else {
      text += pair_text(hits[i], pairs[i], surfaces);
    }
  }
  if (settings.run.json)
    text = dump({{"model", settings.model}, {"pairs", std::move(list)}, {"clear", clear}, {"of", pairs.size()}});
  print(text);
  return exit_done;
}

}  // namespace frontmost::cli
