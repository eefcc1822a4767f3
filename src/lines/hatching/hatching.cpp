// SPDX-License-Identifier: Apache-2.0
#include "frontmost/hatching.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tuple>

#include "base/float_environment.h"
#include "base/parallel.h"
#include "base/pool.h"
#include "lines/hatching/hatch_rows.h"
#include "lines/hidden_parts.h"
#include "lines/joined.h"
#include "lines/strokes/parts.h"

namespace frontmost {
namespace {

using namespace lines_detail;

constexpr std::size_t triangles_per_part = 256, most_sets = 16;
constexpr double touching = 0.01;  // pixels: the same line goes on

/// A piece of line `line` of a set, in pixels along it.
struct Piece {
  std::uint32_t set;
  std::int32_t line;
  double begin, end;
  std::uint32_t instance;

  friend bool operator<(const Piece& a, const Piece& b) {
    return std::tie(a.set, a.line, a.begin, a.end, a.instance) < std::tie(b.set, b.line, b.begin, b.end, b.instance);
  }
};

/// A view, and what hides in it.
struct Scenery {
  Scenery(const WeldedMesh& mesh, const View& its_view, const Execution& execution)
      : view(its_view),
        sight(view),
        seen(see(mesh, sight, execution)),
        grid(seen, view, false, execution),
        occlusion{mesh, sight, view, grid, shadow_kernels(execution.isa), false, false} {}

  Scenery(const Scenery&) = delete;  // it looks at itself
  Scenery& operator=(const Scenery&) = delete;

  const View view;
  const Sight sight;
  const SeenMesh seen;
  const OccluderGrid grid;
  const Occlusion occlusion;
};

View view_from_light(const Surfaces& surfaces, const glm::dvec3& to_light) {
  FrameOptions options;
  options.orthographic = true;
  options.forward = -to_light;
  return frame(surfaces, 1024, 1024, options);
}

/// All that is asked, and nothing that changes.
struct Task {
  const WeldedMesh& mesh;
  const Surfaces& surfaces;
  const Scenery& eye;
  const Scenery* light;  ///< null: nothing stands in it
  glm::dvec3 to_light;
  const CornerNormals& normals;
  const std::vector<HatchSet>& sets;
  const std::vector<HatchRows>& rows;
  bool by_instance;
};

/// Hatches one triangle after another. Not for several threads at once.
class Hatcher {
 public:
  explicit Hatcher(const Task& task) : task_(task), seen_(task.eye.occlusion) {
    if (task.light != nullptr) lit_.emplace(task.light->occlusion);
  }

  void hatch(std::uint32_t number, std::vector<Piece>& pieces) {
    if (task_.eye.seen.facing[number] == 0) return;
    HatchedTriangle triangle{number, task_.mesh.triangles[number], {}, {}};
    for (int k = 0; k < 3; ++k) {
      triangle.places[k] = task_.mesh.positions[triangle.vertices[k]];
      triangle.in_eye[k] = task_.eye.sight.in_eye(triangle.places[k]);
    }
    has_normals_ = false;
    const std::uint32_t instance =
        task_.by_instance ? task_.surfaces.source(task_.mesh.ids[number]).instance : no_index;
    for (std::uint32_t set = 0; set < task_.rows.size(); ++set) {
      const HatchRows::Range range = task_.rows[set].range_of(triangle);
      for (std::int32_t line = range.first; line <= range.last; ++line)
        if (const auto segment = task_.rows[set].segment(triangle, line))
          add_pieces(*segment, {set, line, 0, 0, instance}, pieces);
    }
  }

 private:
  void add_pieces(const HatchSegment& segment, Piece piece, std::vector<Piece>& pieces) {
    find_normals(segment.edge.own[0]);
    const double below = task_.sets[piece.set].below;
    find_dark({HatchSegment::at(segment.from, normals_), HatchSegment::at(segment.to, normals_)}, task_.to_light, below,
              dark_);
    const bool is_all_dark = dark_.size() == 1 && dark_[0].begin == 0 && dark_[0].end == 1;
    const bool may_be_in_shadow = is_towards_light_ && below > 0 && !is_all_dark;
    if (dark_.empty() && !may_be_in_shadow) return;
    parts_.clear();
    seen_.cut(segment.edge, 0, parts_);
    std::erase_if(parts_, [](const DrawnPart& part) { return part.hidden_by != 0; });
    if (parts_.empty()) return;
    if (may_be_in_shadow) add_shadows(segment.edge);
    for (const DrawnPart& part : parts_)
      for (const Interval& dark : dark_) {
        const Interval shown{std::max(part.begin, dark.begin), std::min(part.end, dark.end)};
        if (!(shown.begin < shown.end)) continue;
        const double begin = along(segment.edge, shown.begin, piece.set),
                     end = along(segment.edge, shown.end, piece.set);
        piece.begin = std::min(begin, end);
        piece.end = std::max(begin, end);
        pieces.push_back(piece);
      }
  }

  /// On the side that is seen. A triangle that is turned away from the light has no shadows: its brightness is what is
  /// left at the rim between light and dark.
  void find_normals(std::uint32_t triangle) {
    if (has_normals_) return;
    has_normals_ = true;
    normals_ = task_.normals.of(triangle);
    const int facing = task_.eye.seen.facing[triangle];
    if (facing < 0)
      for (glm::dvec3& normal : normals_) normal = -normal;
    is_towards_light_ = task_.light != nullptr && task_.light->seen.facing[triangle] == facing;
  }

  void add_shadows(const SightedEdge& edge) {
    shadows_.clear();
    lit_->cut(edge, 0, shadows_);
    for (const DrawnPart& part : shadows_)
      if (part.hidden_by != 0) dark_.push_back({part.begin, part.end});
  }

  [[nodiscard]] double along(const SightedEdge& edge, double t, std::uint32_t set) const {
    // From the nearer end, so that both ends are met.
    const glm::dvec3 place =
        t <= 0.5 ? edge.from + (edge.to - edge.from) * t : edge.to + (edge.from - edge.to) * (1 - t);
    const Sight& sight = task_.eye.sight;
    return task_.rows[set].along(glm::dvec2(sight.to_screen(sight.in_eye(place))));
  }

  const Task task_;
  EdgeCutter seen_;
  std::optional<EdgeCutter> lit_;
  bool has_normals_ = false, is_towards_light_ = false;
  std::array<glm::dvec3, 3> normals_{};
  std::vector<Interval> dark_;
  std::vector<DrawnPart> parts_, shadows_;
};

std::vector<Piece> all_pieces(const Task& task, const Execution& execution) {
  const std::size_t count = task.mesh.triangles.size();
  std::vector<std::vector<Piece>> lists((count + triangles_per_part - 1) / triangles_per_part);
  Pool<Hatcher> hatchers;
  std::atomic<std::size_t> done{0};
  parallel_for(execution, count, triangles_per_part, [&](std::size_t begin, std::size_t end) {
    const auto hatcher = hatchers.borrow([&] { return std::make_unique<Hatcher>(task); });
    for (std::size_t i = begin; i < end; ++i) hatcher->hatch(std::uint32_t(i), lists[begin / triangles_per_part]);
    report_progress(execution, "hatching", 0.2 + 0.7 * double(done += end - begin) / double(count));
  });
  return joined(lists);
}

/// Sorted, without what lies on what came before, and joined where it goes on.
std::vector<Piece> united(std::vector<Piece> pieces) {
  std::sort(pieces.begin(), pieces.end());
  std::vector<Piece> whole;
  for (Piece piece : pieces) {
    if (!whole.empty() && whole.back().set == piece.set && whole.back().line == piece.line) {
      Piece& last = whole.back();
      if (last.instance == piece.instance && piece.begin <= last.end + touching) {
        last.end = std::max(last.end, piece.end);
        continue;
      }
      piece.begin = std::max(piece.begin, last.end);
    }
    if (piece.begin < piece.end) whole.push_back(piece);
  }
  return whole;
}

/// Each set and instance by itself.
std::vector<HatchLine> in_pen_order(std::vector<HatchLine> lines) {
  const auto is_before = [](const HatchLine& a, const HatchLine& b) {
    return std::tie(a.set, a.instance) < std::tie(b.set, b.instance);
  };
  std::stable_sort(lines.begin(), lines.end(), is_before);
  std::vector<HatchLine> of_rank;
  std::vector<Chain> chains;
  for (const HatchLine& line : lines) {
    if (of_rank.empty() || is_before(of_rank.back(), line)) of_rank.push_back(line);
    chains.push_back({{line.from, line.to}, {}, std::uint32_t(of_rank.size() - 1), false});
  }
  constexpr double never = -1;
  lines.clear();
  for (const Chain& chain : lines_detail::nearest_first(std::move(chains), never)) {
    const HatchLine& like = of_rank[chain.rank];
    lines.push_back({chain.points.front(), chain.points.back(), like.set, like.instance});
  }
  return lines;
}

void check(const HatchOptions& options) {
  const auto refuse = [](const char* what) { throw Error(ErrorCode::bad_argument, std::string("hatch: ") + what); };
  if (options.sets.size() > most_sets) refuse("more than 16 sets");
  for (const HatchSet& set : options.sets) {
    if (!(std::abs(set.angle) <= 1e3)) refuse("the angle must be from -1000 to 1000 radians");
    if (!(set.spacing >= 0.5 && set.spacing <= 1e5)) refuse("the spacing must be from 0.5 to 100000 pixels");
    if (!(std::abs(set.offset) <= 1e6)) refuse("the offset must be from -1000000 to 1000000 pixels");
    if (!(set.below >= -1 && set.below <= 1)) refuse("the brightness must be from -1 to 1");
  }
  if (!(options.shortest >= 0 && options.shortest <= 1000)) refuse("the shortest line must be from 0 to 1000 pixels");
  if (!(options.tone.crease_angle >= 0 && options.tone.crease_angle <= std::numbers::pi))
    refuse("the crease angle must be from 0 to pi");
  if (!options.tone.to_light) return;
  const double length = glm::length(*options.tone.to_light);
  if (!(length > 1e-100 && length < 1e100)) refuse("the light must come from somewhere");
}

glm::dvec3 light_of(const ToneOptions& tone, const View& view) {
  return glm::normalize(tone.to_light ? *tone.to_light
                                      : -0.48 * view.right() + 0.68 * view.up() - 0.72 * view.forward());
}

}  // namespace

std::vector<HatchSet> hatch_sets(double spacing, double angle) {
  const double crossed = angle + std::numbers::pi / 2;
  return {{angle, spacing, 0, 0.62}, {angle, spacing, spacing / 2, 0.35}, {crossed, spacing, 0, 0.15}};
}

std::vector<HatchLine> hatch(const Surfaces& surfaces, const View& view, const HatchOptions& options,
                             const Execution& execution) {
  validate(view);
  check(options);
  const IeeeScope ieee;
  report_progress(execution, "hatching", 0);
  const WeldedMesh mesh = weld(surfaces, execution);
  if (mesh.triangles.empty() || options.sets.empty()) return {};
  const glm::dvec3 to_light = light_of(options.tone, view);
  const Scenery eye(mesh, view, execution);
  std::optional<Scenery> light;
  if (options.tone.casts_shadows) light.emplace(mesh, view_from_light(surfaces, to_light), execution);
  const CornerNormals normals(eye.seen, surfaces, options.tone.crease_angle);
  std::vector<HatchRows> rows;
  for (const HatchSet& set : options.sets) rows.emplace_back(set, view);
  report_progress(execution, "hatching", 0.2);
  const std::vector<Piece> pieces = united(all_pieces(
      {mesh, surfaces, eye, light ? &*light : nullptr, to_light, normals, options.sets, rows, options.by_instance},
      execution));
  std::vector<HatchLine> lines;
  for (const Piece& piece : pieces) {
    if (piece.end - piece.begin < options.shortest) continue;
    const HatchRows& row = rows[piece.set];
    lines.push_back({row.point(piece.line, piece.begin), row.point(piece.line, piece.end), piece.set, piece.instance});
  }
  if (options.nearest_first) lines = in_pen_order(std::move(lines));
  report_progress(execution, "hatching", 1);
  return lines;
}

}  // namespace frontmost
