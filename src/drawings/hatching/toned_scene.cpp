// SPDX-License-Identifier: Apache-2.0
//    line in a triangle --seen from the eye?--> visible parts --dark?--> dark parts --lit?--> pieces, each for its set
//
// Visibility and lighting are the same question for two eyes: the light's view has its own occluder grid and cutters.
// Normals of a triangle are computed only if a line in it is visible. Coincident triangles are hatched once: all but
// the first count as seen from no side.
#include "hatching/toned_scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "base/pool.h"
#include "base/work_limit.h"
#include "lines/lists.h"

namespace frontmost::lines_detail {
namespace {

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

}  // namespace

Scenery::Scenery(const WeldedMesh& mesh, const std::vector<std::uint32_t>& twins, const View& its_view,
                 const Execution& execution)
    : view(its_view),
      sight(view),
      seen(see_once(mesh, twins, sight, execution)),
      grid(seen, view, false, execution),
      occlusion{mesh, sight, view, grid, shadow_kernels(execution.isa), false, false} {}

TonedScene::TonedScene(const Surfaces& surfaces, const View& view, const ToneOptions& tone, const Execution& execution)
    : surfaces_(surfaces),
      to_light_(light_of(tone, view)),
      mesh_(weld(surfaces, execution)),
      twins_(twins_of(mesh_, view, surfaces, execution)),
      eye_(mesh_, twins_, view, execution),
      normals_(eye_.seen, surfaces, tone.crease_angle, execution) {
  if (tone.casts_shadows) light_.emplace(mesh_, twins_, view_from_light(surfaces, to_light_), execution);
}

/// Hatches one triangle after another. Not for several threads at once.
class TonedScene::Hatcher {
 public:
  Hatcher(const TonedScene& scene, const Task& task, const std::vector<HatchRows>& rows, WorkLimit& work)
      : scene_(scene), task_(task), rows_(rows), work_(work), seen_(scene.eye_.occlusion) {
    if (scene.light_) lit_.emplace(scene.light_->occlusion);
  }

  /// Counts the work since the last call. \throws Error limit_exceeded, cancelled.
  void tell() {
    work_.add(seen_.take_work() + (lit_ ? lit_->take_work() : 0), [this] {
      return "too many of " + std::to_string(scene_.mesh_.triangles.size()) + " triangles lie over each other";
    });
  }

  void hatch(std::uint32_t number, std::vector<HatchPiece>& pieces) {
    if (scene_.eye_.seen.facing[number] == 0) return;
    HatchedTriangle triangle{number, scene_.mesh_.triangles[number], {}, {}};
    for (int k = 0; k < 3; ++k) {
      triangle.places[k] = scene_.mesh_.positions[triangle.vertices[k]];
      triangle.in_eye[k] = scene_.eye_.sight.in_eye(triangle.places[k]);
    }
    has_normals_ = false;
    const std::uint32_t instance =
        task_.by_instance ? scene_.surfaces_.source(scene_.mesh_.ids[number]).instance : no_index;
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
    const PrimitiveSource source = scene_.surfaces_.source(scene_.mesh_.ids[triangle]);
    const std::uint32_t material = scene_.surfaces_.scene().meshes[source.mesh].material_of(source.triangle);
    return task_.sets_by_material[std::min<std::size_t>(material, task_.sets_by_material.size() - 1)];
  }

  void add_pieces(const HatchSegment& segment, HatchPiece piece, std::vector<HatchPiece>& pieces) {
    find_normals(segment.edge.own[0]);
    const double below = task_.sets[piece.set].below;
    find_dark({HatchSegment::at(segment.from, normals_), HatchSegment::at(segment.to, normals_)}, scene_.to_light_,
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
      const double brightness = is_in_shadow ? 0 : std::max(0.0, normal.cosine_at(dot.t, scene_.to_light_));
      if (!(brightness < dot.below)) continue;
      piece.begin = piece.end = dot.along;
      pieces.push_back(piece);
    }
  }

  /// Finds the possible dots between the ends of the segment.
  void find_dots(const SightedEdge& edge, const HatchPiece& piece) {
    dots_.clear();
    const Sight& sight = scene_.eye_.sight;
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
    normals_ = scene_.normals_.of(triangle);
    const int facing = scene_.eye_.seen.facing[triangle];
    if (facing < 0)
      for (glm::dvec3& normal : normals_) normal = -normal;
    is_towards_light_ = scene_.light_ && scene_.light_->seen.facing[triangle] == facing;
  }

  void add_shadows(const SightedEdge& edge) {
    shadows_.clear();
    lit_->cut(edge, 0, shadows_);
    for (const DrawnPart& part : shadows_)
      if (part.hidden_by != 0) dark_.push_back({part.begin, part.end});
  }

  [[nodiscard]] double along(const SightedEdge& edge, double t, const HatchPiece& piece) const {
    // Interpolated from the nearer end, so that both ends are exact.
    const glm::dvec3 place =
        t <= 0.5 ? edge.from + (edge.to - edge.from) * t : edge.to + (edge.from - edge.to) * (1 - t);
    const Sight& sight = scene_.eye_.sight;
    // The point is within the view; rounding may put it outside for triangles that are very much larger.
    glm::dvec3 in_eye = sight.in_eye(place);
    in_eye.z = std::max(in_eye.z, sight.near());
    const HatchRows& row = rows_[piece.set];
    return row.within_picture(piece.line, row.along(glm::dvec2(sight.to_screen(in_eye))));
  }

  const TonedScene& scene_;
  const Task task_;
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

std::vector<HatchPiece> TonedScene::pieces(const Task& task, const std::vector<HatchRows>& rows,
                                           const Execution& execution) const {
  const std::size_t count = mesh_.triangles.size();
  std::vector<std::vector<HatchPiece>> lists((count + triangles_per_part - 1) / triangles_per_part);
  Pool<Hatcher> hatchers;
  WorkLimit work(execution, most_boxes + most_boxes_of_triangle * count, "hatch");
  std::atomic<std::size_t> done{0}, found{0};
  parallel_for(execution, count, triangles_per_part, [&](std::size_t begin, std::size_t end) {
    const auto hatcher = hatchers.borrow([&] { return std::make_unique<Hatcher>(*this, task, rows, work); });
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

}  // namespace frontmost::lines_detail
