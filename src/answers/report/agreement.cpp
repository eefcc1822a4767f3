// SPDX-License-Identifier: Apache-2.0
// Each sample is examined alone first: do the ids differ, are the keys right? Then every triangle of the scene,
// whatever the methods made of it, is compared with the samples that differ, to find a surface that rules an answer
// out.
//
//   samples   --ids differ--> DifferingSample: two claims --every triangle over them--> is a claim ruled out?
//                                                                                    neither: edge or depth
//                                                                                    one:     unexplained
//
// All triangles must be compared. Differing samples are therefore kept in cells of 16 x 16 pixels, in which a triangle
// finds the samples that it may cover. The two triangles of a sample come first. A triangle is skipped in a cell if it
// misses the cell, or if it is farther than the farthest remaining claim everywhere in the cell.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "frontmost/precision.h"
#include "geometry/buckets.h"
#include "report/sample_square.h"
#include "surfaces/cluster_set.h"
#include "view/facing_rule.h"
#include "view/screen_cutout.h"
#include "view/screen_transform.h"

namespace frontmost {
namespace {

constexpr std::size_t kRowGrain = 8, kTriangleGrain = 256, kSampleGrain = 1024;
// Side length of the cells of differing samples, in pixels.
constexpr int kCell = 16;

bool are_finite(const std::array<glm::vec3, 3>& corners) {
  return is_finite(corners[0]) && is_finite(corners[1]) && is_finite(corners[2]);
}

/// The input of a comparison: one view of one scene.
struct Question {
  const Surfaces& surfaces;
  const View& view;
  const SampleRays rays;
  const ScreenRays screen_rays;
  const std::span<const glm::ivec2> offsets;
  const FacingRule facing;

  [[nodiscard]] SampleSquare square(std::size_t sample) const {
    const std::size_t pixel = sample % view.pixel_count(), width = std::size_t(view.width);
    return SampleSquare(rays, int(pixel % width), int(pixel / width), offsets[sample / view.pixel_count()]);
  }
  /// The triangle of an id. None for invalid ids, and for triangles that are never seen.
  [[nodiscard]] std::optional<ViewedTriangle> triangle(PrimitiveId id) const {
    if (id >= surfaces.primitive_count()) return std::nullopt;
    const std::array<glm::vec3, 3> corners = surfaces.corners(id);
    if (!are_finite(corners)) return std::nullopt;
    return ViewedTriangle(corners, rays);
  }
  [[nodiscard]] bool is_culled(const ViewedTriangle& triangle, PrimitiveId id) const {
    if (facing.culling() == Culling::none) return false;
    const bool is_front = (triangle.facing() < 0) != surfaces.is_mirrored(surfaces.source(id).instance);
    return !facing.keeps(id, is_front);
  }
  /// Whether the ray of a sample passes through a hole of a triangle, decided as the methods decide it.
  [[nodiscard]] bool is_hole(PrimitiveId id, std::size_t sample) const {
    const Cutouts* const cutouts = placed_scene(surfaces).cutouts.get();
    if (!cutouts || !cutouts->has(id)) return false;
    const std::size_t pixel = sample % view.pixel_count(), width = std::size_t(view.width);
    const glm::ivec2 at = glm::ivec2(pixel % width, pixel / width) * kSubPixels + offsets[sample / view.pixel_count()];
    return ScreenCutout((*cutouts)[id], screen_rays).is_hole(at.x, at.y);
  }
  /// How the square meets a triangle as a method sees it. A culled triangle counts as absent, unless it is so thin that
  /// snapping may turn it over. A triangle with a hole at the sample counts as absent, too.
  [[nodiscard]] LineMeeting meeting(const ViewedTriangle& triangle, PrimitiveId id, const SampleSquare& square,
                                    std::size_t sample) const {
    const LineMeeting meeting = triangle.meeting(square);
    if (meeting != LineMeeting::misses && is_hole(id, sample)) return LineMeeting::misses;
    return meeting == LineMeeting::contains && is_culled(triangle, id) ? LineMeeting::misses : meeting;
  }
  /// Converts a key to nearness.
  [[nodiscard]] double nearness_of(float key) const {
    if (view.projection.orthographic) return double(key) * (rays.far() - rays.near()) - rays.far();
    return double(key) / rays.near();
  }
};

/// Checks keys. Keeps the last triangle, since neighbouring samples mostly show the same one.
class KeyCheck {
 public:
  explicit KeyCheck(const Question& question) : question_(question) {}

  [[nodiscard]] bool is_right(PrimitiveId id, float key, const SampleSquare& square) {
    if (id == no_primitive) return key == 0;
    if (id != id_) {
      triangle_ = question_.triangle(id);
      id_ = id;
    }
    if (!triangle_) return false;
    const double nearness = question_.nearness_of(key);
    const NearnessRange range = triangle_->nearness(square);
    return nearness >= range.least.low - triangle_->resolution(range.least.low) &&
           nearness <= range.greatest.high + triangle_->resolution(range.greatest.high);
  }

 private:
  const Question& question_;
  std::optional<ViewedTriangle> triangle_;
  PrimitiveId id_ = no_primitive;
};

/// The claim of one answer at a sample that differs.
struct Claim {
  PrimitiveId id;
  std::optional<ViewedTriangle> triangle;  ///< none: nothing is shown
  LineMeeting meeting = LineMeeting::contains;
  /// Lower bound of the nearness that is_surely_nearer() requires of a nearer triangle.
  double nearness = -std::numeric_limits<double>::infinity();
};

/// A sample where the answers differ, with the claims of both.
struct DifferingSample {
  std::size_t number;
  SampleSquare square;
  std::array<Claim, 2> claims;
};

/// For both claims of every sample: true if the scene rules the claim out. Values only change from false to true.
using RuledOut = std::vector<std::array<std::atomic<bool>, 2>>;

/// The samples that differ, in cells of the screen.
class DifferenceMap {
 public:
  DifferenceMap(const Question& question, const std::vector<DifferingSample>& samples, const RuledOut& ruled_out,
                const Execution& execution)
      : question_(question),
        view_(question.view),
        columns_((view_.width + kCell - 1) / kCell),
        rows_((view_.height + kCell - 1) / kCell),
        numbers_(
            std::size_t(columns_) * std::size_t(rows_), samples.size(),
            [&](std::size_t i, const auto& add) { add(cell_of(samples[i]), i); }, execution),
        farthest_(numbers_.count(), std::numeric_limits<double>::infinity()) {
    squares_.reserve(farthest_.size());
    for (int y = 0; y < rows_; ++y)
      for (int x = 0; x < columns_; ++x)
        squares_.emplace_back(question.rays, glm::ivec2(x, y) * kCell, glm::ivec2(x, y) * kCell + (kCell - 1));
    for (std::size_t i = 0; i < samples.size(); ++i)
      for (std::size_t k = 0; k < 2; ++k)
        if (double& farthest = farthest_[cell_of(samples[i])]; !ruled_out[i][k])
          farthest = std::min(farthest, samples[i].claims[k].nearness);
  }

  /// Visits the samples of each cell that a triangle and its rectangle on the screen, in pixels, both meet. Skips cells
  /// in which the triangle is behind all claims.
  template <class Visit>
  void in_rect(const glm::dvec2& low, const glm::dvec2& high, const std::array<glm::vec3, 3>& corners,
               const Visit& visit) const {
    std::optional<ViewedTriangle> triangle;
    const auto cell = [](double at, int count) { return int(std::clamp(std::floor(at / kCell), 0.0, count - 1.0)); };
    if (high.x < 0 || high.y < 0 || low.x > view_.width || low.y > view_.height) return;
    const int last_x = cell(high.x, columns_), last_y = cell(high.y, rows_);
    for (int y = cell(low.y, rows_); y <= last_y; ++y)
      for (int x = cell(low.x, columns_); x <= last_x; ++x) {
        const std::size_t c = std::size_t(y) * std::size_t(columns_) + std::size_t(x);
        if (numbers_[c].empty()) continue;
        if (!triangle) triangle.emplace(corners, question_.rays);
        if (triangle->nearness(squares_[c]).greatest.high < farthest_[c]) continue;
        if (triangle->meeting(squares_[c]) == LineMeeting::misses) continue;
        for (const std::size_t number : numbers_[c]) visit(number, *triangle);
      }
  }

 private:
  [[nodiscard]] std::size_t cell_of(const DifferingSample& sample) const {
    const std::size_t pixel = sample.number % view_.pixel_count(), width = std::size_t(view_.width);
    return pixel / width / kCell * std::size_t(columns_) + pixel % width / kCell;
  }

  const Question& question_;
  const View& view_;
  int columns_, rows_;
  const Buckets<std::size_t> numbers_;  ///< numbers of the samples that differ, by cell
  std::vector<double> farthest_;        ///< by cell: nearness of the farthest of the remaining claims
  std::vector<SampleSquare> squares_;   ///< by cell: a square around the squares of all of its samples
};

/// A rectangle of the screen, in pixels, around the visible part of a triangle.
struct ScreenRect {
  glm::dvec2 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
};

ScreenRect rect_of(const std::array<glm::vec3, 3>& corners, const View& view, const glm::dmat4& eye_from_world) {
  const Projection& p = view.projection;
  std::array<glm::dvec3, 3> c;
  for (std::size_t i = 0; i < 3; ++i) c[i] = glm::dvec3(eye_from_world * glm::dvec4(corners[i], 1));
  ScreenRect rect;
  const auto include = [&](const glm::dvec3& at) {
    const double scale = p.orthographic ? 1 : -1 / at.z;
    const glm::dvec2 place((at.x * scale - p.left) / (p.right - p.left) * view.width,
                           (p.top - at.y * scale) / (p.top - p.bottom) * view.height);
    rect.low = glm::min(rect.low, place);
    rect.high = glm::max(rect.high, place);
  };
  const double near = -0.99 * p.clip.near;  // with a margin, because the keys decide at the plane
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 &a = c[i], &b = c[(i + 1) % 3];
    if (p.orthographic || a.z <= near) include(a);
    if (!p.orthographic && (a.z <= near) != (b.z <= near)) include(a + (near - a.z) / (b.z - a.z) * (b - a));
  }
  // A margin of one pixel, many times what doubles and the squares need.
  return {rect.low - 1.0, rect.high + 1.0};
}

/// Rules out claims of a sample that triangle `id` contradicts, if the triangle surely covers the sample.
void rule_out_by(const Question& question, PrimitiveId id, const ViewedTriangle& triangle,
                 const DifferingSample& sample, std::array<std::atomic<bool>, 2>& ruled_out) {
  const auto is_open = [&](std::size_t i) {
    return sample.claims[i].id != id && !ruled_out[i].load(std::memory_order_relaxed);
  };
  if (!is_open(0) && !is_open(1)) return;
  const double nearness = triangle.nearness(sample.square).least.high;
  bool is_there = false;
  for (std::size_t i = 0; i < 2; ++i) {
    const Claim& claim = sample.claims[i];
    if (!is_open(i) || nearness < claim.nearness) continue;
    is_there = is_there || question.meeting(triangle, id, sample.square, sample.number) == LineMeeting::contains;
    if (!is_there) return;
    if (!claim.triangle || is_surely_nearer(triangle, *claim.triangle, sample.square))
      ruled_out[i].store(true, std::memory_order_relaxed);
  }
}

void compare_all_triangles(const Question& question, const std::vector<DifferingSample>& samples, RuledOut& ruled_out,
                           const Execution& execution) {
  if (samples.empty()) return;
  parallel_for(execution, samples.size(), kSampleGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (const Claim& claim : samples[i].claims)
        if (claim.triangle) rule_out_by(question, claim.id, *claim.triangle, samples[i], ruled_out[i]);
  });
  const DifferenceMap map(question, samples, ruled_out, execution);
  const glm::dmat4 eye_from_world = glm::inverse(question.view.world_from_eye);
  parallel_for(execution, question.surfaces.primitive_count(), kTriangleGrain, [&](std::size_t begin, std::size_t end) {
    for (auto id = PrimitiveId(begin); id < end; ++id) {
      const std::array<glm::vec3, 3> corners = question.surfaces.corners(id);
      if (!are_finite(corners)) continue;
      const ScreenRect rect = rect_of(corners, question.view, eye_from_world);
      map.in_rect(rect.low, rect.high, corners, [&](std::size_t number, const ViewedTriangle& triangle) {
        rule_out_by(question, id, triangle, samples[number], ruled_out[number]);
      });
    }
  });
}

DifferingSample differing_sample(const Question& question, std::size_t number, PrimitiveId a, PrimitiveId b) {
  DifferingSample sample{number, question.square(number), {Claim{a, {}}, Claim{b, {}}}};
  for (Claim& claim : sample.claims) {
    if (claim.id == no_primitive) continue;
    claim.triangle = question.triangle(claim.id);
    if (claim.triangle) claim.nearness = claim.triangle->nearness(sample.square).greatest.low;
    claim.meeting =
        claim.triangle ? question.meeting(*claim.triangle, claim.id, sample.square, number) : LineMeeting::misses;
  }
  return sample;
}

Difference verdict(const DifferingSample& sample, const std::array<std::atomic<bool>, 2>& ruled_out) {
  bool all_contain = true;
  for (std::size_t i = 0; i < 2; ++i) {
    const Claim& claim = sample.claims[i];
    if (ruled_out[i] || claim.meeting == LineMeeting::misses) return Difference::unexplained;
    all_contain = all_contain && claim.meeting == LineMeeting::contains && claim.id != no_primitive;
  }
  return all_contain ? Difference::depth : Difference::edge;
}

/// Marks samples with different ids as `edge` for now, and samples with a wrong key as `unexplained`.
void look_at_samples(const Question& question, const Visible& a, const Visible& b, const Execution& execution,
                     Agreement& result) {
  const std::size_t width = std::size_t(question.view.width), rows = question.view.sample_count() / width;
  parallel_for(execution, rows, kRowGrain, [&](std::size_t begin, std::size_t end) {
    std::array<KeyCheck, 2> checks{KeyCheck(question), KeyCheck(question)};
    for (std::size_t i = begin * width; i < end * width; ++i) {
      Difference& difference = result.differences[i];
      const PrimitiveId ids[] = {a.primitives[i], b.primitives[i]};
      const float keys[] = {a.keys[i], b.keys[i]};
      difference = ids[0] == ids[1] ? Difference::none : Difference::edge;
      // The most frequent case.
      if (ids[0] == no_primitive && ids[1] == no_primitive && keys[0] == 0 && keys[1] == 0) continue;
      const SampleSquare square = question.square(i);
      for (std::size_t k = 0; k < 2; ++k)
        if (!checks[k].is_right(ids[k], keys[k], square)) difference = Difference::unexplained;
    }
  });
}

std::vector<DifferingSample> differing_samples(const Question& question, const Visible& a, const Visible& b,
                                               const Agreement& result) {
  std::vector<DifferingSample> samples;
  for (std::size_t i = 0; i < result.differences.size(); ++i)
    if (result.differences[i] == Difference::edge)
      samples.push_back(differing_sample(question, i, a.primitives[i], b.primitives[i]));
  return samples;
}

void check_views(const Visible& a, const Visible& b) {
  const View &v = a.view, &w = b.view;
  const std::size_t count = v.sample_count();
  if (v.width != w.width || v.height != w.height || v.samples != w.samples || v.world_from_eye != w.world_from_eye ||
      a.primitives.size() != count || b.primitives.size() != count || a.keys.size() != count || b.keys.size() != count)
    throw Error(ErrorCode::bad_argument, "agreement",
                "the two results were made for different views; both must have the same view");
}

}  // namespace

std::string_view name(Difference difference) {
  constexpr std::string_view kNames[] = {"none", "edge", "depth", "translucent", "unexplained"};
  return kNames[std::size_t(difference)];
}

std::uint64_t Agreement::differing() const {
  std::uint64_t sum = 0;
  for (const Difference d : {Difference::edge, Difference::depth, Difference::translucent, Difference::unexplained})
    sum += count(d);
  return sum;
}

Agreement check_agreement(const Surfaces& surfaces, const Visible& a, const Visible& b, const Execution& execution) {
  validate(a.view);
  check_views(a, b);
  const IeeeScope ieee;
  Agreement result;
  result.view = a.view;
  result.differences = Buffer<Difference>(a.primitives.size());
  const Question question{surfaces,
                          result.view,
                          SampleRays(a.view),
                          ScreenRays(a.view),
                          sample_offsets(a.view.samples),
                          FacingRule(a.view.culling, placed_scene(surfaces).sides.get())};
  look_at_samples(question, a, b, execution, result);
  const std::vector<DifferingSample> samples = differing_samples(question, a, b, result);
  RuledOut ruled_out(samples.size());
  compare_all_triangles(question, samples, ruled_out, execution);
  for (std::size_t i = 0; i < samples.size(); ++i)
    result.differences[samples[i].number] = verdict(samples[i], ruled_out[i]);
  for (const Difference difference : result.differences) ++result.counts[std::size_t(difference)];
  return result;
}

void see_through(Agreement& agreement, const Surfaces& surfaces, const Visible& front, const Visible& behind) {
  check_views(front, behind);
  if (agreement.differences.size() != front.primitives.size())
    throw Error(ErrorCode::bad_argument, "agreement",
                "the layers were made for different views; all must have the same view");
  const Scene& scene = surfaces.scene();
  const auto lets_light_through = [&](PrimitiveId id) {
    if (id >= surfaces.primitive_count()) return false;
    const PrimitiveSource source = surfaces.source(id);
    const std::uint32_t material = scene.meshes[source.mesh].material_of(source.triangle);
    return material != no_index && scene.materials[material].is_see_through();
  };
  for (std::size_t i = 0; i < agreement.differences.size(); ++i) {
    Difference& difference = agreement.differences[i];
    if (difference != Difference::none || behind.primitives[i] == no_primitive) continue;
    --agreement.counts[std::size_t(difference)];
    difference = lets_light_through(front.primitives[i]) ? Difference::translucent : Difference::unexplained;
    ++agreement.counts[std::size_t(difference)];
  }
}

}  // namespace frontmost
