// SPDX-License-Identifier: Apache-2.0
// frontmost sight: whether one point sees another, for one pair of points or for a file of pairs.
//
//   from o-------------------x - - - - - o to      clear, or blocked: by which object, and where (x)
//
// Users give points in the coordinates of the model's file; points of the library are relative to the scene's origin.
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/inputs.h"
#include "cli/json.h"
#include "cli/option.h"
#include "cli/rays/ray_files.h"
#include "cli/view/camera_report.h"
#include "cli/view/sight.h"

namespace frontmost::cli {
namespace {

constexpr Option sight_options[] = {
    {"from", 0, "X,Y,Z", "First point, in the model's own coordinates.", Group::sight, for_sight,
     [](Settings& s, const Given& g) { s.sight.from = parse_vector(g.text); }},
    {"to", 0, "X,Y,Z", "Second point.", Group::sight, for_sight,
     [](Settings& s, const Given& g) { s.sight.to = parse_vector(g.text); }},
    {"pairs", 0, "FILE",
     "File of pairs of points: six numbers a line, separated by blanks or commas; # starts a comment.", Group::sight,
     for_sight, [](Settings& s, const Given& g) { s.sight.pairs = g.file_name(); }},
};

/// A pair of points in the coordinates of the model's file.
struct PointPair {
  glm::dvec3 from, to;
};

std::vector<PointPair> read_pairs(const std::string& path) {
  std::vector<PointPair> pairs;
  const std::vector<double> n = read_number_lines(path, {6, "a pair of points needs six numbers"});
  pairs.reserve(n.size() / 6);
  for (std::size_t i = 0; i < n.size(); i += 6)
    pairs.push_back({glm::dvec3(n[i], n[i + 1], n[i + 2]), glm::dvec3(n[i + 3], n[i + 4], n[i + 5])});
  return pairs;
}

std::vector<PointPair> pairs_of(const SightSettings& sight) {
  if (sight.pairs && (sight.from || sight.to)) throw UsageError("--pairs excludes --from and --to");
  if (sight.pairs) return read_pairs(*sight.pairs);
  if (!sight.from || !sight.to) throw UsageError("give --from and --to, or --pairs");
  return {{*sight.from, *sight.to}};
}

std::vector<Segment> segments_of(std::span<const PointPair> pairs, const glm::dvec3& origin) {
  std::vector<Segment> segments;
  for (const PointPair& pair : pairs) segments.push_back({pair.from - origin, pair.to - origin});
  return segments;
}

/// The obstacle: a triangle of an object.
struct Blocked {
  PrimitiveSource by;
  std::string object;
  glm::dvec3 point;
  double distance;
};

Blocked blocked_by(const RayHit& hit, const Segment& pair, const RayScene& rays) {
  const glm::dvec3 from(pair.from), along = glm::dvec3(pair.to) - from;
  const PrimitiveSource by = rays.surfaces.source(hit.primitive);
  return {by, rays.scene().instances[by.instance].name, from + hit.t * along, hit.t * glm::length(along)};
}

Json pair_json(const RayHit& hit, const Segment& pair, const RayScene& rays) {
  const glm::dvec3& origin = rays.scene().origin;
  Json json = {
      {"from", to_json(in_file(pair.from, origin))}, {"to", to_json(in_file(pair.to, origin))}, {"clear", !hit}};
  if (!hit) return json;
  const Blocked blocked = blocked_by(hit, pair, rays);
  json["object"] = blocked.by.instance;
  json["name"] = blocked.object;
  json["triangle"] = blocked.by.triangle;
  json["point"] = to_json(in_file(blocked.point, origin));
  json["distance"] = blocked.distance;
  return json;
}

std::string pair_text(const RayHit& hit, const Segment& pair, const RayScene& rays) {
  if (!hit) return "clear\n";
  const Blocked blocked = blocked_by(hit, pair, rays);
  const std::string name = blocked.object.empty() ? "" : " (" + printable_name(blocked.object) + ")";
  return fmt::format("blocked by object {}{}, triangle {}, at {}, distance {:.6g}\n", blocked.by.instance, name,
                     blocked.by.triangle, place_text(blocked.point, rays.scene().origin), blocked.distance);
}

/// Calls `use` with each pair and the hit between its points, in order. Pairs are processed in blocks, so that memory
/// does not grow with their number.
template <class Use>
void for_each_pair(std::span<const PointPair> pairs, const RayScene& rays, const Execution& execution, const Use& use) {
  constexpr std::size_t at_once = 1 << 16;
  for (std::size_t begin = 0; begin < pairs.size(); begin += at_once) {
    stop_if_interrupted();
    const std::span<const PointPair> part = pairs.subspan(begin, std::min(at_once, pairs.size() - begin));
    const std::vector<Segment> segments = segments_of(part, rays.scene().origin);
    const std::vector<RayHit> hits = rays.closest(segments, execution);
    for (std::size_t i = 0; i < part.size(); ++i) use(hits[i], segments[i]);
  }
}

void print_json(const Settings& settings, std::span<const PointPair> pairs, const RayScene& rays,
                const Execution& execution) {
  JsonListPrinter printer({{"model", settings.model}}, "pairs");
  std::size_t clear = 0;
  for_each_pair(pairs, rays, execution, [&](const RayHit& hit, const Segment& pair) {
    clear += !hit;
    printer.add(pair_json(hit, pair, rays));
  });
  printer.finish({{"clear", clear}, {"of", pairs.size()}});
}

void print_text(std::span<const PointPair> pairs, const RayScene& rays, const Execution& execution) {
  constexpr std::size_t enough = 1 << 16;
  std::string text;
  for_each_pair(pairs, rays, execution, [&](const RayHit& hit, const Segment& pair) {
    text += pair_text(hit, pair, rays);
    if (text.size() < enough) return;
    print(text);
    text.clear();
  });
  print(text);
}

}  // namespace

std::span<const Option> sight_option_table() { return sight_options; }

int run_sight(const Settings& settings) {
  const std::vector<PointPair> pairs = pairs_of(settings.sight);
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  const Scene scene = load_model(settings, execution, progress);
  const Surfaces surfaces(scene, execution);
  const RayIndex index(surfaces, execution);
  const RayScene rays{surfaces, index};
  progress.clear();
  if (settings.run.json)
    print_json(settings, pairs, rays, execution);
  else
    print_text(pairs, rays, execution);
  return exit_done;
}

}  // namespace frontmost::cli
