// SPDX-License-Identifier: Apache-2.0
// frontmost sight: whether one point sees another, for one pair of points or a file of them.
#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/json_numbers.h"
#include "cli/model.h"
#include "cli/places.h"
#include "cli/rays/number_lines.h"
#include "cli/rays/ray_scene.h"

namespace frontmost::cli {
namespace {

/// In the coordinates of the model's file.
struct Pair {
  glm::dvec3 from, to;
};

std::vector<Pair> read_pairs(const std::string& path) {
  std::vector<Pair> pairs;
  const std::vector<double> n = read_number_lines(path, {6, "six numbers make a pair of points"});
  pairs.reserve(n.size() / 6);
  for (std::size_t i = 0; i < n.size(); i += 6)
    pairs.push_back({glm::dvec3(n[i], n[i + 1], n[i + 2]), glm::dvec3(n[i + 3], n[i + 4], n[i + 5])});
  return pairs;
}

std::vector<Pair> pairs_of(const SightSettings& sight) {
  if (sight.pairs && (sight.from || sight.to)) throw UsageError("--pairs and --from, --to are two ways to say it");
  if (sight.pairs) return read_pairs(*sight.pairs);
  if (!sight.from || !sight.to) throw UsageError("give --from and --to, or --pairs");
  return {{*sight.from, *sight.to}};
}

std::vector<Segment> segments_of(const std::vector<Pair>& pairs, const glm::dvec3& origin) {
  std::vector<Segment> segments;
  for (const Pair& pair : pairs) segments.push_back({pair.from - origin, pair.to - origin});
  return segments;
}

/// What stands in the way.
struct Blocked {
  RayElement by;
  std::string object;
  glm::dvec3 point;
  double distance;
};

Blocked blocked_by(const CurvedHit& hit, const Segment& pair, const RayScene& rays) {
  const glm::dvec3 from(pair.from), along = glm::dvec3(pair.to) - from;
  const RayElement by = rays.element(hit.primitive);
  return {by, rays.scene().instances[by.instance].name, from + hit.t * along, hit.t * glm::length(along)};
}

Json pair_json(const CurvedHit& hit, const Segment& pair, const RayScene& rays) {
  const glm::dvec3& origin = rays.scene().origin;
  Json json = {
      {"from", to_json(in_file(pair.from, origin))}, {"to", to_json(in_file(pair.to, origin))}, {"clear", !hit}};
  if (!hit) return json;
  const Blocked blocked = blocked_by(hit, pair, rays);
  json["object"] = blocked.by.instance;
  json["name"] = blocked.object;
  json[std::string(blocked.by.kind)] = blocked.by.number;
  json["point"] = to_json(in_file(blocked.point, origin));
  json["distance"] = blocked.distance;
  return json;
}

std::string pair_text(const CurvedHit& hit, const Segment& pair, const RayScene& rays) {
  if (!hit) return "clear\n";
  const Blocked blocked = blocked_by(hit, pair, rays);
  const std::string name = blocked.object.empty() ? "" : " (" + printable_name(blocked.object) + ")";
  return fmt::format("blocked by object {}{}, {} {}, at {}, distance {:.6g}\n", blocked.by.instance, name,
                     blocked.by.kind, blocked.by.number, place_text(blocked.point, rays.scene().origin),
                     blocked.distance);
}

}  // namespace

int run_sight(const Settings& settings) {
  const std::vector<Pair> given = pairs_of(settings.sight);
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  const Scene scene = load_model(settings, execution, progress);
  const Surfaces surfaces(scene, execution);
  const std::vector<Segment> pairs = segments_of(given, scene.origin);
  const OwnRayScene index(surfaces, execution);
  const RayScene rays = index.get();
  const std::vector<CurvedHit> hits = rays.closest(pairs, execution);
  progress.clear();
  Json list = Json::array();
  std::string text;
  std::size_t clear = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    clear += !hits[i];
    if (settings.run.json) {
      list.push_back(pair_json(hits[i], pairs[i], rays));
    } else {
      text += pair_text(hits[i], pairs[i], rays);
    }
  }
  if (settings.run.json)
    text = dump({{"model", settings.model}, {"pairs", std::move(list)}, {"clear", clear}, {"of", pairs.size()}});
  print(text);
  return exit_done;
}

}  // namespace frontmost::cli
