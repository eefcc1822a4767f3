// SPDX-License-Identifier: Apache-2.0
// Each line of a set, or row of dots, is intersected with every triangle that it passes, in a segment in space with
// both ends on the triangle's sides. Then it is cut:
//
//    eye's view     visible parts of the segment       an occluder grid and a cutter, as for edges
//    normals        dark parts of these by the angle   a quadratic function along each line
//    light's view   lit parts of these                 the same as for the eye
//
// Brightness is the cosine of the angle between normal and light. Normals are smooth across edges that are no creases,
// and are computed only if a line in the triangle is visible. The pieces of one line are sorted along it and united
// where they overlap or continue in the next triangle. A dot is drawn if it is dark enough at its place.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>

#include "base/parallel.h"
#include "base/pool.h"
#include "base/work_limit.h"
#include "hatching/dot_grid.h"
#include "lines/hiding/hidden_parts.h"
#include "lines/lists.h"
#include "lines/strokes/parts.h"

namespace frontmost {
namespace {

using namespace lines_detail;

/// A triangle that is hatched.
struct HatchedTriangle {
  std::uint32_t number;
  glm::uvec3 vertices;
  glm::dvec3 places[3];
  glm::dvec3 in_eye[3];  ///< as Sight::in_eye()
};

/// A normal that is linear along a segment, from t = 0 to 1; not of unit length in between.
struct NormalAlong {
  glm::dvec3 from, to;

  /// The cosine of the angle to a unit vector.
  [[nodiscard]] double cosine_at(double t, const glm::dvec3& to_light) const {
    const glm::dvec3 n = from + (to - from) * t;
    const double length = glm::length(n);
    return length > 0 ? glm::dot(n, to_light) / length : 0;
  }
};

/// The segment of a line in a triangle. Each end lies between two corners, at a share t of the way from p to q.
struct HatchSegment {
  SightedEdge edge;
  struct Share {
    std::size_t p = 0, q = 0;
    double t = 0;
  } ends[2];

  /// The normal, from those at the corners.
  [[nodiscard]] NormalAlong normal(const std::array<glm::dvec3, 3>& corners) const {
    const auto at = [&](const Share& end) { return corners[end.p] * (1 - end.t) + corners[end.q] * end.t; };
    return {at(ends[0]), at(ends[1])};
  }
};

/// Lines are numbered; number 0 is `HatchSet::offset` from the picture's corner.
class HatchRows {
 public:
  HatchRows(const HatchSet& set, const View& view)
      : size_(view.width, view.height),
        // Sines differ between C libraries in their last bit, but not as floats.
        direction_(glm::normalize(glm::dvec2(float(std::cos(set.angle)), -float(std::sin(set.angle))))),
        across_(-direction_.y, direction_.x),
        spacing_(set.spacing),
        offset_(set.offset),
        near_(view.projection.clip.near),
        is_parallel_(view.projection.orthographic) {
    const Projection& p = view.projection;
    const glm::dvec2 scale(view.width / (p.right - p.left), -view.height / (p.top - p.bottom));
    plane_ = {across_ * scale, -glm::dot(across_, scale * glm::dvec2(p.left, p.top))};
    const glm::dvec2 reach = across_ * size_;
    const double low = std::min(reach.x, 0.0) + std::min(reach.y, 0.0),
                 high = std::max(reach.x, 0.0) + std::max(reach.y, 0.0);
    picture_ = {std::int32_t(std::ceil((low - offset_) / spacing_)),
                std::int32_t(std::floor((high - offset_) / spacing_))};
  }

  struct Range {
    std::int32_t first = 0, last = -1;
  };

  /// The numbers of lines that may pass the triangle within the picture.
  [[nodiscard]] Range range_of(const HatchedTriangle& triangle) const {
    double low = 1e300, high = -1e300;
    for (const glm::dvec3& corner : triangle.in_eye) {
      if (!is_parallel_ && corner.z < near_) return picture_;
      const double height = weighted_height(corner) / weight(corner);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    // One more on each side, because the division rounds; the signs in segment() decide. Clamped before the conversion.
    const auto number = [&](double height) {
      return std::clamp((height - offset_) / spacing_, picture_.first - 2.0, picture_.last + 2.0);
    };
    return {std::max(picture_.first, std::int32_t(std::ceil(number(low))) - 1),
            std::min(picture_.last, std::int32_t(std::floor(number(high))) + 1)};
  }

  /// The segment of the line in the triangle. A vertex on the line counts as above, so that a line passes from triangle
  /// to triangle at one place, to the bit.
  [[nodiscard]] std::optional<HatchSegment> segment(const HatchedTriangle& triangle, std::int32_t line) const {
    double heights[3];
    for (int k = 0; k < 3; ++k)
      heights[k] = weighted_height(triangle.in_eye[k]) - height_of(line) * weight(triangle.in_eye[k]);
    HatchSegment segment;
    glm::dvec3 places[2];
    EndOn on[2];
    int count = 0;
    for (int k = 0; k < 3; ++k) {
      int p = k, q = k == 2 ? 0 : k + 1;
      if ((heights[p] >= 0) == (heights[q] >= 0)) continue;
      // Computed from the lower vertex, for both triangles.
      if (triangle.vertices[p] > triangle.vertices[q]) std::swap(p, q);
      const double from_p = std::abs(heights[p]), t = from_p / (from_p + std::abs(heights[q]));
      const glm::dvec3 &from = triangle.places[p], &to = triangle.places[q];
      places[count] = place_between(from, to, t);
      on[count] = {triangle.vertices[p], triangle.vertices[q]};
      // A place at a vertex lies in all planes of that vertex.
      if (places[count] == from) on[count][1] = on[count][0];
      if (places[count] == to) on[count][0] = on[count][1];
      segment.ends[count++] = {std::size_t(p), std::size_t(q), t};
    }
    if (count < 2 || places[0] == places[1]) return std::nullopt;
    segment.edge = {places[0], places[1], on[0], on[1], {triangle.number, no_index}, slack_of(places[0], places[1])};
    return segment;
  }

  /// The position along the line, in pixels, of a point on it.
  [[nodiscard]] double along(const glm::dvec2& screen) const { return glm::dot(screen, direction_); }

  /// The nearest position along the line within the picture.
  [[nodiscard]] double within_picture(std::int32_t line, double along) const {
    const glm::dvec2 start = point(line, 0);
    for (int axis = 0; axis < 2; ++axis) {
      if (direction_[axis] == 0) continue;
      const double a = -start[axis] / direction_[axis], b = (size_[axis] - start[axis]) / direction_[axis];
      along = std::clamp(along, std::min(a, b), std::max(a, b));
    }
    return along;
  }

  [[nodiscard]] glm::dvec2 point(std::int32_t line, double along) const {
    return across_ * height_of(line) + direction_ * along;
  }

 private:
  [[nodiscard]] double height_of(std::int32_t line) const { return offset_ + line * spacing_; }
  [[nodiscard]] double weight(const glm::dvec3& in_eye) const { return is_parallel_ ? 1 : in_eye.z; }
  /// The distance across the lines in pixels, times the weight.
  [[nodiscard]] double weighted_height(const glm::dvec3& in_eye) const {
    return glm::dot(plane_, {in_eye.x, in_eye.y, weight(in_eye)});
  }

  glm::dvec2 size_;
  glm::dvec2 direction_, across_;  ///< unit length
  double spacing_, offset_, near_;
  bool is_parallel_;
  glm::dvec3 plane_;
  Range picture_;
};

/// Vertex normals of triangles, smooth across edges that are no creases.
class CornerNormals {
 public:
  CornerNormals(const SeenMesh& seen, const Surfaces& surfaces, double crease_angle, const Execution& execution)
      : mesh_(seen.mesh),
        normals_(mesh_.triangles.size()),
        surfaces_(surfaces),
        cosine_(float(std::cos(crease_angle))),
        corners_(corner_table(mesh_, execution)) {
    for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) normals_[i] = normal_of(mesh_, i);
  }

  /// The unit normals at the vertices of a triangle, on the side from which it is counter-clockwise. Vertices with very
  /// many triangles have the triangle's own normal. O(triangles at its vertices).
  [[nodiscard]] std::array<glm::dvec3, 3> of(std::uint32_t triangle) const {
    const glm::dvec3 own = unit_of(normals_[triangle]);
    return {at(triangle, 0, own), at(triangle, 1, own), at(triangle, 2, own)};
  }

 private:
  /// The tip of a cone with more sides is flat: its normal means nothing.
  static constexpr std::size_t most_at_vertex = 256;

  /// The mean by N. Max (Weights for Computing Vertex Normals from Facet Normals, 1999), exact on spheres.
  [[nodiscard]] glm::dvec3 at(std::uint32_t triangle, int corner, const glm::dvec3& own) const {
    const std::uint32_t vertex = mesh_.triangles[triangle][corner];
    const std::span<const Corner> around = corners_[vertex];
    if (around.size() > most_at_vertex) return own;
    const std::uint32_t instance = surfaces_.source(mesh_.ids[triangle]).instance;
    glm::dvec3 sum(0);
    for (const Corner& one : around) {
      const std::uint32_t other = one.triangle();
      const glm::dvec3& normal = normals_[other];
      const double cosine = glm::dot(unit_of(normal), own);
      // Neighbours with the opposite winding are reversed.
      if (other != triangle && (std::abs(cosine) < cosine_ || surfaces_.source(mesh_.ids[other]).instance != instance))
        continue;
      const glm::dvec3 &place = mesh_.positions[vertex], &next = mesh_.positions[one.next(mesh_)],
                       &last = mesh_.positions[one.last(mesh_)];
      const double weight = glm::dot(next - place, next - place) * glm::dot(last - place, last - place);
      if (weight > 0) sum += normal * (std::copysign(1.0, cosine) / weight);
    }
    return unit_of(sum, own);
  }

  const WeldedMesh& mesh_;
  Buffer<glm::dvec3> normals_;
  const Surfaces& surfaces_;
  const double cosine_;
  const CornerTable corners_;
};

/// The intervals in which the cosine is less than `limit`, in order: at most three.
void find_dark(const NormalAlong& normal, const glm::dvec3& to_light, double limit, std::vector<Interval>& dark) {
  dark.clear();
  // (N.L)^2 = limit^2 N.N is a quadratic equation; its roots are where N.L = +-limit |N|.
  const glm::dvec3 step = normal.to - normal.from;
  const double p = glm::dot(normal.from, to_light), q = glm::dot(step, to_light), square = limit * limit;
  const double a = q * q - square * glm::dot(step, step), b = p * q - square * glm::dot(normal.from, step),
               c = p * p - square * glm::dot(normal.from, normal.from);
  double cuts[4] = {0, 1, 1, 1};
  int count = 1;
  const auto cut_at = [&](double t) {
    if (t > 0 && t < 1) cuts[count++] = t;
  };
  if (const double discriminant = b * b - a * c; discriminant > 0) {
    // Each root has two forms; the one without cancellation is used.
    const double sum = -b - std::copysign(std::sqrt(discriminant), b);
    if (a != 0) cut_at(sum / a);
    if (sum != 0) cut_at(c / sum);
  }
  std::sort(cuts + 1, cuts + count);
  cuts[count] = 1;
  for (int i = 0; i < count; ++i) {
    if (!(normal.cosine_at(0.5 * (cuts[i] + cuts[i + 1]), to_light) < limit)) continue;
    if (!dark.empty() && dark.back().end == cuts[i])
      dark.back().end = cuts[i + 1];
    else
      dark.push_back({cuts[i], cuts[i + 1]});
  }
}

constexpr std::size_t triangles_per_part = 256, triangles_per_poll = 16;
constexpr std::size_t most_pieces = std::size_t(1) << 26, pieces_per_tally = 1 << 16;
constexpr std::uint32_t lines_per_poll = 256;
/// Lines are compared with at most `most_boxes` boxes of triangles, and `most_boxes_of_triangle` more for each
/// triangle.
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

/// The seen triangles without twins. Coincident triangles hide no more than one of them and have the same lines, so
/// only the first is kept.
SeenMesh see_once(const WeldedMesh& mesh, const std::vector<std::uint32_t>& twins, const Sight& sight,
                  const Execution& execution) {
  SeenMesh seen = see(mesh, sight, execution);
  for (const std::uint32_t twin : twins) seen.facing[twin] = 0;
  return seen;
}

/// Features have only twins then.
const LineOptions no_edges{.boundaries = false, .silhouettes = false, .borders = false, .creases = false};
/// A piece of line `line` of a set, from `begin` to `end` in pixels along the line; a dot has no length.
struct HatchPiece {
  std::uint32_t set;
  std::int32_t line;
  double begin, end;
  std::uint32_t instance;
  friend auto operator<=>(const HatchPiece&, const HatchPiece&) = default;
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

/// A scene with the data that tells how dark it is along lines. Borrows the surfaces.
struct TonedScene {
  /// \throws Error bad_argument for options out of range.
  TonedScene(const Surfaces& its_surfaces, const View& view, const ToneOptions& tone, const Execution& execution)
      : surfaces(its_surfaces),
        to_light(light_of(tone, view)),
        mesh(weld(surfaces, execution)),
        twins(find_features(see(mesh, Sight(view), execution), corner_table(mesh, execution), surfaces, no_edges,
                            execution)
                  .twins),
        eye(mesh, twins, view, execution),
        normals(eye.seen, surfaces, tone.crease_angle, execution) {
    if (!tone.casts_shadows) return;
    const FrameOptions from_light{.orthographic = true, .forward = -to_light, .objects = FramedObjects::all};
    light.emplace(mesh, twins, frame(surfaces, 1024, 1024, from_light), execution);
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
  const DotGrid* dots = nullptr;  ///< not null: pieces are dots of this grid, in the rows of sets[0]
  /// For each material, one bit for each of its sets; the last entry is for triangles without a material. Empty: all
  /// triangles have all sets.
  std::vector<std::uint32_t> sets_by_material{};
};

/// Hatches one triangle after another. Not for several threads at once.
class Hatcher {
 public:
  Hatcher(const TonedScene& scene, const HatchTask& task, const std::vector<HatchRows>& rows, WorkLimit& work)
      : scene_(scene), task_(task), rows_(rows), work_(work), seen_(scene.eye.occlusion) {
    if (scene.light) lit_.emplace(scene.light->occlusion);
  }

  /// Adds the work since the last call to the work limit. \throws Error limit_exceeded, cancelled.
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
        // One triangle may fill a very large picture, and so have very many lines.
        if (++lines_ % lines_per_poll == 0) tell();
        const std::optional<HatchSegment> segment = rows_[set].segment(triangle, line);
        if (!segment) continue;
        const HatchPiece piece{set, line, 0, 0, instance};
        task_.dots ? add_dots(*segment, piece, pieces) : add_pieces(*segment, piece, pieces);
      }
    }
  }

 private:
  /// A possible dot: its position along the line, its parameter t along the segment, and the brightness below which it
  /// is drawn.
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
    find_dark(segment.normal(normals_), scene_.to_light, below, dark_);
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
    const NormalAlong normal = segment.normal(normals_);
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

  /// Finds the triangle's normals on its visible side. A triangle that faces away from the light gets no shadows,
  /// because its smooth normals give the brightness that is left near the terminator.
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

/// The pieces of all lines, in the order of the triangles.
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

/// Orders the lines of each instance.
std::vector<HatchLine> in_pen_order(std::vector<HatchLine> lines, const Execution& execution) {
  std::stable_sort(lines.begin(), lines.end(),
                   [](const HatchLine& a, const HatchLine& b) { return a.instance < b.instance; });
  std::vector<Chain> chains;
  chains.reserve(lines.size());
  for (const HatchLine& line : lines) chains.push_back({{line.from, line.to}, {}, line.instance, false});
  std::vector<HatchLine> ordered;
  ordered.reserve(lines.size());
  for (const std::uint32_t end : pen_order(chains, execution)) {
    HatchLine& line = ordered.emplace_back(lines[end / 2]);
    if (end % 2 == 1) std::swap(line.from, line.to);
  }
  return ordered;
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
  if (options.sets.size() > 16) refuse("more than 16 sets");
  for (const HatchSet& set : options.sets) {
    if (!(std::abs(set.angle) <= 1e3)) refuse("the angle must be from -1000 to 1000 radians");
    if (!(set.spacing >= 0.5 && set.spacing <= 1e5)) refuse("the spacing must be from 0.5 to 100000 pixels");
    if (!(std::abs(set.offset) <= 1e6)) refuse("the offset must be from -1000000 to 1000000 pixels");
    if (!(set.below >= -1 && set.below <= 1)) refuse("the brightness must be from -1 to 1");
  }
  if (!(options.shortest >= 0 && options.shortest <= 1000)) refuse("the shortest line must be from 0 to 1000 pixels");
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
  if (double(view.width) * view.height / (options.spacing * options.spacing) > 2e7)
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
    for (const Stipple& dot : dots) lines.push_back({dot.at, dot.at, 0, dot.instance});
    lines = in_pen_order(std::move(lines), execution);
    for (std::size_t i = 0; i < dots.size(); ++i) dots[i] = {lines[i].from, lines[i].instance};
  }
  report_progress(execution, "hatching", 1);
  return dots;
}

}  // namespace frontmost
