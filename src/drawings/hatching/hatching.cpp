// SPDX-License-Identifier: Apache-2.0
// Each line of a set, or row of dots, is intersected with every triangle that it passes. Then it is cut:
//
//    eye's view     visible parts of the segment     an occluder grid and a cutter, as for edges
//    normals        dark parts of these by the angle a quadratic function along each line
//    light's view   lit parts of these               the same as for the eye
//
// Normals of a triangle are computed only if a line in it is visible. The pieces of one line are sorted along it and
// united where they overlap or continue in the next triangle. A dot is drawn if the darkness at its place reaches the
// limit of that place.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <tuple>

#include "base/parallel.h"
#include "base/pool.h"
#include "base/work_limit.h"
#include "frontmost/lines.h"
#include "hatching/dot_grid.h"
#include "hatching/rows.h"
#include "lines/hiding/hidden_parts.h"
#include "lines/lists.h"
#include "lines/strokes/parts.h"

namespace frontmost {
namespace {

using namespace lines_detail;

constexpr std::size_t triangles_per_part = 256, triangles_per_poll = 16;
constexpr std::size_t most_pieces = std::size_t(1) << 26, pieces_per_tally = 1 << 16;
constexpr std::uint32_t lines_per_poll = 256;
/// The most boxes of triangles that lines are compared with.
constexpr std::uint64_t most_boxes = std::uint64_t(1) << 33, most_boxes_of_triangle = 1 << 14;

/// \returns the unit direction to the light.
glm::dvec3 light_of(const ToneOptions& tone, const View& view) {
  if (!(tone.crease_angle >= 0 && tone.crease_angle <= std::numbers::pi))
    throw Error(ErrorCode::bad_argument, "hatch", "the crease angle must be from 0 to pi");
  if (!tone.to_light) return glm::normalize(-0.48 * view.right() + 0.68 * view.up() - 0.72 * view.forward());
  const double length = glm::length(*tone.to_light);
  if (!(length > 1e-100 && length < 1e100))
    throw Error(ErrorCode::bad_argument, "hatch", "to_light must be a finite vector other than 0");
  return *tone.to_light / length;
}

View view_from_light(const Surfaces& surfaces, const glm::dvec3& to_light) {
  FrameOptions options;
  options.orthographic = true;
  options.forward = -to_light;
  options.objects = FramedObjects::all;
  return frame(surfaces, 1024, 1024, options);
}

/// Coincident triangles hide no more and have no other lines than one of them, so only the first is kept.
SeenMesh see_once(const WeldedMesh& mesh, const std::vector<std::uint32_t>& twins, const Sight& sight,
                  const Execution& execution) {
  SeenMesh seen = see(mesh, sight, execution);
  for (const std::uint32_t twin : twins) seen.facing[twin] = 0;
  return seen;
}

std::vector<std::uint32_t> twins_of(const WeldedMesh& mesh, const View& view, const Surfaces& surfaces,
                                    const Execution& execution) {
  LineOptions none;
  none.boundaries = none.silhouettes = none.borders = none.creases = false;
  return find_features(see(mesh, Sight(view), execution), surfaces, none, execution).twins;
}

/// A piece of line `line` of a set, from `begin` to `end` in pixels along the line; a dot has no length.
struct HatchPiece {
  std::uint32_t set;
  std::int32_t line;
  double begin, end;
  std::uint32_t instance;

  friend bool operator<(const HatchPiece& a, const HatchPiece& b) {
    return std::tie(a.set, a.line, a.begin, a.end, a.instance) < std::tie(b.set, b.line, b.begin, b.end, b.instance);
  }
};

/// A view with its occluders.
struct Scenery {
  /// `twins` are triangles that coincide with others.
  Scenery(const WeldedMesh& mesh, const std::vector<std::uint32_t>& twins, const View& its_view,
          const Execution& execution)
      : view(its_view),
        sight(view),
        seen(see_once(mesh, twins, sight, execution)),
        grid(seen, view, false, execution),
        occlusion{sight, view, grid, shadow_kernels(execution.isa), false, false} {}

  Scenery(const Scenery&) = delete;  // members refer to each other
  Scenery& operator=(const Scenery&) = delete;

  const View view;
  const Sight sight;
  const SeenMesh seen;
  const OccluderGrid grid;
  const EdgeOccluders occlusion;
};

/// A scene that answers how dark it is along lines. Borrows the surfaces.
struct TonedScene {
  /// \throws Error bad_argument for options out of range.
  TonedScene(const Surfaces& its_surfaces, const View& view, const ToneOptions& tone, const Execution& execution)
      : surfaces(its_surfaces),
        to_light(light_of(tone, view)),
        mesh(weld(surfaces, execution)),
        twins(twins_of(mesh, view, surfaces, execution)),
        eye(mesh, twins, view, execution),
        normals(eye.seen, surfaces, tone.crease_angle, execution) {
    if (tone.casts_shadows) light.emplace(mesh, twins, view_from_light(surfaces, to_light), execution);
  }

  const Surfaces& surfaces;
  const glm::dvec3 to_light;
  const WeldedMesh mesh;
  const std::vector<std::uint32_t> twins;
  const Scenery eye;
  std::optional<Scenery> light;  ///< empty if shadows are off
  const CornerNormals normals;
};

struct HatchTask {
  const std::vector<HatchSet>& sets;
  bool by_instance = true;
  const DotGrid* dots = nullptr;  ///< dots of sets[0]: then pieces are dots
  /// One bit for each set of a material; the last entry is for triangles without material. Empty: all have all sets.
  std::vector<std::uint32_t> sets_by_material{};
};

/// Hatches one triangle after another. Not for several threads at once.
class Hatcher {
 public:
  Hatcher(const TonedScene& scene, const HatchTask& task, const std::vector<HatchRows>& rows, WorkLimit& work)
      : scene_(scene), task_(task), rows_(rows), work_(work), seen_(scene.eye.occlusion) {
    if (scene.light) lit_.emplace(scene.light->occlusion);
  }

  /// Counts the work since the last call. \throws Error limit_exceeded, cancelled.
  void tell() {
    work_.add(seen_.take_work() + (lit_ ? lit_->take_work() : 0), [this] {
      return "too many of " + std::to_string(scene_.mesh.triangles.size()) + " triangles lie over each other";
    });
  }

  void hatch(std::uint32_t number, std::vector<HatchPiece>& pieces) {
    if (scene_.eye.seen.facing[number] == 0) return;
    HatchedTriangle triangle{number, scene_.mesh.triangles[number], {}, {}};
    for (int k = 0; k < 3; ++k) {
      triangle.places[k] = scene_.mesh.positions[triangle.vertices[k]];
      triangle.in_eye[k] = scene_.eye.sight.in_eye(triangle.places[k]);
    }
    has_normals_ = false;
    const std::uint32_t instance =
        task_.by_instance ? scene_.surfaces.source(scene_.mesh.ids[number]).instance : no_index;
    const std::uint32_t sets = sets_of(number);
    for (std::uint32_t set = 0; set < rows_.size(); ++set) {
      if ((sets >> set & 1) == 0) continue;
      const HatchRows::Range range = rows_[set].range_of(triangle);
      for (std::int32_t line = range.first; line <= range.last; ++line) {
        // A triangle may fill a very large picture.
        if (++lines_ % lines_per_poll == 0) tell();
        const std::optional<HatchSegment> segment = rows_[set].segment(triangle, line);
        if (segment)
          (this->*(task_.dots ? &Hatcher::add_dots : &Hatcher::add_pieces))(*segment, {set, line, 0, 0, instance},
                                                                            pieces);
      }
    }
  }

 private:
  /// A possible dot: its position along the line, and along the segment.
  struct Dot {
    double along, t, below;
  };

  /// One bit for each set with which the triangle's material is hatched.
  [[nodiscard]] std::uint32_t sets_of(std::uint32_t triangle) const {
    if (task_.sets_by_material.empty()) return ~0u;
    const PrimitiveSource source = scene_.surfaces.source(scene_.mesh.ids[triangle]);
    const std::uint32_t material = scene_.surfaces.scene().meshes[source.mesh].material_of(source.triangle);
    return task_.sets_by_material[std::min<std::size_t>(material, task_.sets_by_material.size() - 1)];
  }

  void add_pieces(const HatchSegment& segment, HatchPiece piece, std::vector<HatchPiece>& pieces) {
    find_normals(segment.edge.own[0]);
    const double below = task_.sets[piece.set].below;
    find_dark({HatchSegment::at(segment.from, normals_), HatchSegment::at(segment.to, normals_)}, scene_.to_light,
              below, dark_);
    const bool is_all_dark = dark_.size() == 1 && dark_[0].begin == 0 && dark_[0].end == 1;
    const bool may_be_in_shadow = is_towards_light_ && below > 0 && !is_all_dark;
    if (dark_.empty() && !may_be_in_shadow) return;
    cut(segment.edge);
    if (parts_.empty()) return;
    if (may_be_in_shadow) add_shadows(segment.edge);
    for (const DrawnPart& part : parts_)
      for (const Interval& dark : dark_) {
        const Interval shown{std::max(part.begin, dark.begin), std::min(part.end, dark.end)};
        if (!(shown.begin < shown.end)) continue;
        const double begin = along(segment.edge, shown.begin, piece), end = along(segment.edge, shown.end, piece);
        piece.begin = std::min(begin, end);
        piece.end = std::max(begin, end);
        pieces.push_back(piece);
      }
  }

  /// Appends the dots of the segment that are visible and dark enough.
  void add_dots(const HatchSegment& segment, HatchPiece piece, std::vector<HatchPiece>& pieces) {
    find_dots(segment.edge, piece);
    if (dots_.empty()) return;
    find_normals(segment.edge.own[0]);
    const NormalAlong normal{HatchSegment::at(segment.from, normals_), HatchSegment::at(segment.to, normals_)};
    cut(segment.edge);
    dark_.clear();
    if (is_towards_light_ && !parts_.empty()) add_shadows(segment.edge);
    for (const Dot& dot : dots_) {
      const auto holds = [&](const auto& part) { return part.begin <= dot.t && dot.t < part.end; };
      if (std::none_of(parts_.begin(), parts_.end(), holds)) continue;
      const bool is_in_shadow = std::any_of(dark_.begin(), dark_.end(), holds);
      const double brightness = is_in_shadow ? 0 : std::max(0.0, normal.cosine_at(dot.t, scene_.to_light));
      if (!(brightness < dot.below)) continue;
      piece.begin = piece.end = dot.along;
      pieces.push_back(piece);
    }
  }

  /// Finds the possible dots between the ends of the segment.
  void find_dots(const SightedEdge& edge, const HatchPiece& piece) {
    dots_.clear();
    const Sight& sight = scene_.eye.sight;
    const glm::dvec3 from = sight.in_eye(edge.from), to = sight.in_eye(edge.to);
    const double w0 = sight.to_weight(from, to, 0), w1 = sight.to_weight(from, to, 1);
    const bool is_before_eye = w0 > 0 && w1 > 0;
    const HatchRows& row = rows_[piece.set];
    const double a = row.along(glm::dvec2(sight.to_screen(from))), b = row.along(glm::dvec2(sight.to_screen(to)));
    if (!std::isfinite(a) || !std::isfinite(b)) return;
    const double low = is_before_eye ? std::min(a, b) : -1e300, high = is_before_eye ? std::max(a, b) : 1e300;
    task_.dots->for_each(piece.line, low, high, [&](double along, double below) {
      // A linear function on the screen is not linear along the segment.
      const double part = w0 * (along - a), rest = w1 * (b - along), t = part / (part + rest);
      if (t >= 0 && t < 1) dots_.push_back({along, t, below});
    });
  }

  void cut(const SightedEdge& edge) {
    parts_.clear();
    seen_.cut(edge, 0, parts_);
    std::erase_if(parts_, [](const DrawnPart& part) { return part.hidden_by != 0; });
  }

  /// Normals on the visible side. A triangle that faces away from the light gets no shadows: its smooth normals give
  /// what brightness is left near the terminator.
  void find_normals(std::uint32_t triangle) {
    if (has_normals_) return;
    has_normals_ = true;
    normals_ = scene_.normals.of(triangle);
    const int facing = scene_.eye.seen.facing[triangle];
    if (facing < 0)
      for (glm::dvec3& normal : normals_) normal = -normal;
    is_towards_light_ = scene_.light && scene_.light->seen.facing[triangle] == facing;
  }

  void add_shadows(const SightedEdge& edge) {
    shadows_.clear();
    lit_->cut(edge, 0, shadows_);
    for (const DrawnPart& part : shadows_)
      if (part.hidden_by != 0) dark_.push_back({part.begin, part.end});
  }

  [[nodiscard]] double along(const SightedEdge& edge, double t, const HatchPiece& piece) const {
    const Sight& sight = scene_.eye.sight;
    // The point is within the view; rounding may put it outside for triangles that are very much larger.
    glm::dvec3 in_eye = sight.in_eye(place_between(edge.from, edge.to, t));
    in_eye.z = std::max(in_eye.z, sight.near());
    const HatchRows& row = rows_[piece.set];
    return row.within_picture(piece.line, row.along(glm::dvec2(sight.to_screen(in_eye))));
  }

  const TonedScene& scene_;
  const HatchTask task_;
  const std::vector<HatchRows>& rows_;
  WorkLimit& work_;
  std::uint32_t lines_ = 0;
  EdgeCutter seen_;
  std::optional<EdgeCutter> lit_;
  bool has_normals_ = false, is_towards_light_ = false;
  std::array<glm::dvec3, 3> normals_{};
  std::vector<Interval> dark_;
  std::vector<DrawnPart> parts_, shadows_;
  std::vector<Dot> dots_;
};

/// The pieces of all lines, in any order.
std::vector<HatchPiece> pieces_of(const TonedScene& scene, const HatchTask& task, const std::vector<HatchRows>& rows,
                                  const Execution& execution) {
  const std::size_t count = scene.mesh.triangles.size();
  std::vector<std::vector<HatchPiece>> lists((count + triangles_per_part - 1) / triangles_per_part);
  Pool<Hatcher> hatchers;
  WorkLimit work(execution, most_boxes + most_boxes_of_triangle * count, "hatch");
  std::atomic<std::size_t> done{0}, found{0};
  parallel_for(execution, count, triangles_per_part, [&](std::size_t begin, std::size_t end) {
    const auto hatcher = hatchers.borrow([&] { return std::make_unique<Hatcher>(scene, task, rows, work); });
    std::vector<HatchPiece>& list = lists[begin / triangles_per_part];
    std::size_t counted = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (i % triangles_per_poll == 0) hatcher->tell();
      hatcher->hatch(std::uint32_t(i), list);
      // A single triangle may have as many pieces as there are triangles before it, for every line.
      if (list.size() - counted < pieces_per_tally && i + 1 < end) continue;
      if ((found += list.size() - counted) > most_pieces)
        throw Error(ErrorCode::limit_exceeded, "hatch",
                    "more than " + std::to_string(most_pieces) + " pieces of lines");
      counted = list.size();
    }
    hatcher->tell();
    report_progress(execution, "hatching", 0.2 + 0.7 * double(done += end - begin) / double(count));
  });
  return joined(lists);
}

constexpr std::size_t most_sets = 16;
constexpr double touching = 0.01;  // pixels: a smaller gap is no gap

/// Sorts pieces, removes overlaps, and joins pieces that touch.
std::vector<HatchPiece> united(std::vector<HatchPiece> pieces) {
  std::sort(pieces.begin(), pieces.end());
  std::vector<HatchPiece> whole;
  for (HatchPiece piece : pieces) {
    if (!whole.empty() && whole.back().set == piece.set && whole.back().line == piece.line) {
      HatchPiece& last = whole.back();
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

/// Orders the lines of each set and instance separately.
std::vector<HatchLine> in_pen_order(std::vector<HatchLine> lines, const Execution& execution) {
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
  for (const Chain& chain : nearest_first(std::move(chains), never, execution)) {
    const HatchLine& like = of_rank[chain.rank];
    lines.push_back({chain.points.front(), chain.points.back(), like.set, like.instance});
  }
  return lines;
}

/// The bits of HatchTask::sets_by_material.
std::vector<std::uint32_t> sets_by_material(const std::vector<HatchSet>& sets, std::size_t materials) {
  const auto is_everywhere = [](const HatchSet& set) { return set.materials.empty(); };
  if (std::all_of(sets.begin(), sets.end(), is_everywhere)) return {};
  std::vector<std::uint32_t> bits(materials + 1);
  for (std::size_t i = 0; i < sets.size(); ++i) {
    for (const std::uint32_t material : sets[i].materials)
      if (material < materials) bits[material] |= 1u << i;
    if (!is_everywhere(sets[i])) continue;
    for (std::uint32_t& all : bits) all |= 1u << i;
  }
  return bits;
}

void check(const HatchOptions& options) {
  const auto refuse = [](const char* what) { throw Error(ErrorCode::bad_argument, "hatch", what); };
  if (options.sets.size() > most_sets) refuse("more than 16 sets");
  for (const HatchSet& set : options.sets) {
    if (!(std::abs(set.angle) <= 1e3)) refuse("the angle must be from -1000 to 1000 radians");
    if (!(set.spacing >= 0.5 && set.spacing <= 1e5)) refuse("the spacing must be from 0.5 to 100000 pixels");
    if (!(std::abs(set.offset) <= 1e6)) refuse("the offset must be from -1000000 to 1000000 pixels");
    if (!(set.below >= -1 && set.below <= 1)) refuse("the brightness must be from -1 to 1");
  }
  if (!(options.shortest >= 0 && options.shortest <= 1000)) refuse("the shortest line must be from 0 to 1000 pixels");
}

constexpr double most_dots = 2e7;

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
  const TonedScene scene(surfaces, view, options.tone, execution);
  report_progress(execution, "hatching", 0.2);
  std::vector<HatchRows> rows;
  for (const HatchSet& set : options.sets) rows.emplace_back(set, view);
  std::vector<HatchLine> lines;
  const HatchTask task{options.sets, options.by_instance, nullptr,
                       sets_by_material(options.sets, surfaces.scene().materials.size())};
  for (const HatchPiece& piece : united(pieces_of(scene, task, rows, execution))) {
    if (piece.end - piece.begin < options.shortest) continue;
    const HatchRows& row = rows[piece.set];
    lines.push_back({row.point(piece.line, piece.begin), row.point(piece.line, piece.end), piece.set, piece.instance});
  }
  if (options.nearest_first) lines = in_pen_order(std::move(lines), execution);
  report_progress(execution, "hatching", 1);
  return lines;
}

std::vector<Stipple> stipple(const Surfaces& surfaces, const View& view, const StippleOptions& options,
                             const Execution& execution) {
  validate(view);
  if (!(options.spacing >= 0.5 && options.spacing <= 1000))
    throw Error(ErrorCode::bad_argument, "stipple", "the spacing must be from 0.5 to 1000 pixels");
  if (double(view.width) * view.height / (options.spacing * options.spacing) > most_dots)
    throw Error(ErrorCode::limit_exceeded, "stipple", "more than 20000000 dots would fit; give a larger spacing");
  const IeeeScope ieee;
  report_progress(execution, "hatching", 0);
  const TonedScene scene(surfaces, view, options.tone, execution);
  report_progress(execution, "hatching", 0.2);
  const double cell = DotGrid::cell_of(options.spacing);
  const std::vector<HatchSet> sets = {{0, cell, cell / 2, 1}};
  const std::vector<HatchRows> rows = {HatchRows(sets[0], view)};
  const DotGrid grid(options.spacing, view.width);
  std::vector<HatchPiece> pieces = pieces_of(scene, {sets, options.by_instance, &grid}, rows, execution);
  std::sort(pieces.begin(), pieces.end());
  // Coincident dots of coinciding surfaces become one.
  const auto is_same = [](const HatchPiece& a, const HatchPiece& b) { return a.line == b.line && a.begin == b.begin; };
  pieces.erase(std::unique(pieces.begin(), pieces.end(), is_same), pieces.end());
  std::vector<Stipple> dots;
  dots.reserve(pieces.size());
  for (const HatchPiece& piece : pieces) dots.push_back({rows[0].point(piece.line, piece.begin), piece.instance});
  if (options.nearest_first) {
    std::vector<HatchLine> lines;  // without length
    lines.reserve(dots.size());
    for (const Stipple& dot : dots) lines.push_back({dot.at, dot.at, 0, dot.instance});
    lines = in_pen_order(std::move(lines), execution);
    for (std::size_t i = 0; i < dots.size(); ++i) dots[i] = {lines[i].from, lines[i].instance};
  }
  report_progress(execution, "hatching", 1);
  return dots;
}

}  // namespace frontmost
