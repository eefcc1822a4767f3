// SPDX-License-Identifier: Apache-2.0
// The sweep from the eye outwards: ranges of distances, long objects, and the queue of tests and covers.
#include "occlusion/sweep.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/memory.h"

namespace frontmost::occlusion_detail {
constexpr float infinite_distance = std::numeric_limits<float>::infinity();

/// Numbers for planar distances, so that counting can sort by distance: a farther distance has an equal or greater
/// number.
class DistanceRanges {
 public:
  static constexpr int most = 4096;

  DistanceRanges() = default;
  /// Makes ranges of the distances from `least` to `greatest`. In perspective distances must be positive, and farther
  /// ranges are longer; in parallel projection all ranges have one length. Distances outside have the first or the last
  /// number.
  DistanceRanges(bool orthographic, float least, float greatest) : orthographic_(orthographic), least_(least) {
    if (!(least < greatest)) return;
    if (orthographic) {
      per_unit_ = float(most - 1) / (greatest - least);
      count_ = most;
      return;
    }
    const std::uint32_t bits = bits_as<std::uint32_t>(greatest) - bits_as<std::uint32_t>(least);
    while (bits >> shift_ >= std::uint32_t(most)) ++shift_;
    count_ = int(bits >> shift_) + 1;
  }

  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] int operator()(float distance) const {
    if (!(distance > least_)) return 0;
    // min() takes the limit first, and so returns it if the distance overflows and its share is NaN.
    if (orthographic_) return int(std::min(float(count_ - 1), (distance - least_) * per_unit_));
    // Positive floats are in the order of their bits, which grow like a logarithm.
    const std::uint32_t bits = bits_as<std::uint32_t>(distance) - bits_as<std::uint32_t>(least_);
    return std::min(int(bits >> shift_), count_ - 1);
  }
  /// Returns a lower bound of all distances with this number or a greater one, for numbers from 0 to count().
  [[nodiscard]] float least_of(int number) const {
    // The bound is nearer than the border by more than the rounding of operator().
    if (orthographic_) return per_unit_ > 0 ? least_ + (float(number) - 0.01f) / per_unit_ : least_;
    return bits_as<float>(bits_as<std::uint32_t>(least_) + (std::uint32_t(number) << shift_));
  }

 private:
  bool orthographic_ = false;
  float least_ = 0, per_unit_ = 0;
  int shift_ = 0, count_ = 1;
};

namespace {

/// At most so many cuts are made for one object; no triangle is cut if more would be needed.
constexpr std::size_t kMostCuts = 1 << 13;

/// A triangle is worth cutting if it begins at least so many slabs before the slab of its farthest vertex, and is at
/// least so many cells wide and high.
constexpr int kLeastSlabs = 12, kLeastCells = 8;
/// Triangles are cut for every third slab, except for slabs nearer than 1/64 of the distance of the object's far end.
constexpr int kSlabsBetweenCuts = 3, kMostSlabs = 36;

bool is_cut_for(int slab) { return slab % kSlabsBetweenCuts == 0; }

glm::uvec3 corners_of(const HidingObject& occluder, std::uint32_t triangle) {
  return occluder.mesh.triangles[occluder.part.first_triangle + triangle] - occluder.part.first_vertex;
}

/// The least rectangle around points on the screen.
class ScreenExtent {
 public:
  template <class Place>
  void include(const Place& place) {
    low_ = glm::min(low_, glm::ivec2(place.x, place.y));
    high_ = glm::max(high_, glm::ivec2(place.x, place.y));
  }
  void include(const ClippedPolygon& polygon) {
    for (int i = 0; i < polygon.count; ++i) include(polygon.corners[std::size_t(i)]);
  }
  /// The cells of the extent within a rectangle.
  [[nodiscard]] CellRect cells(const CellGrid& grid, const CellRect& rect) const {
    if (low_.x > high_.x) return {};
    const auto cell = [&](std::int32_t v, std::int32_t centre) {
      return int(std::floor(float(v + centre) * grid.cells_per_unit));
    };
    const ScreenTransform& t = grid.transform;
    return {std::max(rect.x0, cell(low_.x, t.centre_x)), std::max(rect.y0, cell(low_.y, t.centre_y)),
            std::min(rect.x1, cell(high_.x, t.centre_x) + 1), std::min(rect.y1, cell(high_.y, t.centre_y) + 1)};
  }

 private:
  glm::ivec2 low_ = glm::ivec2(std::numeric_limits<std::int32_t>::max());
  glm::ivec2 high_ = glm::ivec2(std::numeric_limits<std::int32_t>::min());
};

/// kSlabsOfDouble slabs reach from a distance to twice this distance. Objects of at most kShortSlabs slabs are not
/// divided.
constexpr int kSlabsOfDouble = 6, kShortSlabs = 4;

/// Returns whether finding the object's covered cells is not worth the time. An object with more than a triangle for
/// every two cells has hardly any cell without ends.
bool is_dense(const OccluderPart& part, const CellRect& rect) {
  const std::size_t cells = std::size_t(rect.x1 - rect.x0) * std::size_t(rect.y1 - rect.y0);
  return 2 * std::size_t(part.triangle_count) > cells + 64;
}

/// Returns whether every cell of an object has ends, so that the object covers nothing.
bool is_tiny(const CellRect& rect) { return rect.x1 - rect.x0 <= 2 || rect.y1 - rect.y0 <= 2; }

}  // namespace

/// An object that reaches far into depth, such as the walls around the eye. As a whole it would cover nothing before
/// the sweep has passed its far end, so it covers slab by slab:
///
///    eye  |  slab 0  |  slab 1  |  slab 2  |        a triangle belongs to the slab of its farthest vertex
///         \___________/\_________/\________/
///
/// Triangles have ends at the border of two slabs, so cells along the border would stay open. Therefore the triangles
/// of a slab cover together with the triangles of nearer slabs that share a vertex with them; the ends then lie within
/// covered cells. A triangle that reaches through several slabs, such as half of a floor, covers in every third of
/// these slabs, as far as the slab's far side, which cuts it like a far plane.
class LongObject {
 public:
  /// The object's triangles on the screen. put_on_screen() must fill it before other calls.
  OccluderOnScreen on_screen;

  /// The ranges [first, last], divided into slabs of `length` ranges each.
  struct Slabs {
    int first, last, length;
    [[nodiscard]] int count() const { return (last - first) / length + 1; }
    [[nodiscard]] int of(int range) const { return (std::clamp(range, first, last) - first) / length; }
    /// The first range that lies wholly behind a slab.
    [[nodiscard]] int behind(int slab) const { return std::min(first + (slab + 1) * length, last + 1); }
  };

  /// Sorts the triangles into slabs.
  void sort_by_slab(const CellGrid& grid, const HidingObject& occluder, const DistanceRanges& range_of,
                    const Slabs& slabs) {
    const std::size_t count = on_screen.triangles.size(), slab_count = std::size_t(slabs.count());
    find_far_sides(grid, range_of, slabs);
    slabs_.resize(count);
    slab_begin_.assign(slab_count + 2, 0);
    for (std::size_t t = 0; t < count; ++t) {
      const float farthest = on_screen.triangles[t].farthest;
      std::size_t slab = std::size_t(slabs.of(range_of(farthest)));
      while (farthest > far_sides_[slab]) ++slab;
      slabs_[t] = std::uint16_t(slab);
      ++slab_begin_[slab + 2];
    }
    for (std::size_t s = 2; s < slab_begin_.size(); ++s) slab_begin_[s] += slab_begin_[s - 1];
    // Filling moves each slab's beginning to its end, which is where the next slab begins.
    by_slab_.resize(count);
    for (std::uint32_t t = 0; t < count; ++t) by_slab_[slab_begin_[std::size_t(slabs_[t]) + 1]++] = t;
    marks_.assign(count, 0);
    find_reaching(grid, occluder, range_of, slabs);
  }
  [[nodiscard]] bool has_triangles(int slab) const {
    const bool has_whole = slab_begin_[std::size_t(slab) + 1] > slab_begin_[std::size_t(slab)];
    return has_whole || (slab >= first_reached_ && is_cut_for(slab));
  }
  /// Returns the pass for a slab: the triangles that cover in it, and their cells within `rect`. Borrows from this
  /// object until the next call.
  [[nodiscard]] CoverPass choose(const CellGrid& grid, const HidingObject& occluder, int slab, const CellRect& rect) {
    const auto begin = by_slab_.begin() + slab_begin_[std::size_t(slab)];
    const auto end = by_slab_.begin() + slab_begin_[std::size_t(slab) + 1];
    whole_.assign(begin, end);
    cut_.clear();
    screen_->far = std::min(grid.transform.far, far_sides_[std::size_t(slab)]);
    screen_->inverse_range = 1.0f / (screen_->far - screen_->near);
    for (const std::uint32_t t : whole_) marks_[t] = std::uint16_t(slab + 1);
    if (is_cut_for(slab)) choose_cut(occluder, slab);
    const std::size_t cut_by_slab = cut_.size();
    for (auto t = begin; t != end; ++t) choose_around(occluder, slab, *t);
    for (std::size_t i = 0; i < cut_by_slab; ++i) choose_around(occluder, slab, cut_[i].triangle);
    // Triangles that the view cuts are not whole either, and belong to cut_.
    const auto is_cut = [&](std::uint32_t t) { return on_screen.triangles[t].is_cut; };
    if (!on_screen.cut.empty()) whole_.erase(std::remove_if(whole_.begin(), whole_.end(), is_cut), whole_.end());
    for (const ClippedTriangle& cut : on_screen.cut)
      if (slabs_[cut.triangle] <= slab && marks_[cut.triangle] == slab + 1) cut_.push_back(cut);
    float farthest = cut_by_slab > 0 ? screen_->far : -infinite_distance;
    for (const std::uint32_t t : whole_) farthest = std::max(farthest, on_screen.triangles[t].farthest);
    for (std::size_t i = cut_by_slab; i < cut_.size(); ++i)
      farthest = std::max(farthest, on_screen.triangles[cut_[i].triangle].farthest);
    chosen_ = {whole_, cut_, marks_, std::uint16_t(slab + 1), &*screen_};
    return {.rect = rect_of_chosen(grid, occluder, rect), .distance = farthest, .chosen = &chosen_};
  }

 private:
  /// A triangle that covers in several slabs.
  struct Reaching {
    std::uint32_t triangle;
    int first_slab;
  };
  /// Finds a far side for each slab: despite rounding, any point nearer than the far side has a smaller distance range
  /// than any point behind the slab.
  void find_far_sides(const CellGrid& grid, const DistanceRanges& range_of, const Slabs& slabs) {
    float rounding = 0;
    for (const glm::vec3& world : on_screen.world) {
      const float its = distance_rounding(grid.transform, world);
      if (its < infinite_distance) rounding = std::max(rounding, its);
    }
    far_sides_.resize(std::size_t(slabs.count()));
    for (int slab = 0; slab < slabs.count(); ++slab)
      far_sides_[std::size_t(slab)] = range_of.least_of(slabs.behind(slab)) - 2 * rounding;
    far_sides_.back() = infinite_distance;
    screen_ = grid.transform;
  }
  void find_reaching(const CellGrid& grid, const HidingObject& occluder, const DistanceRanges& range_of,
                     const Slabs& slabs) {
    reaching_.clear();
    std::size_t cuts = 0;
    auto cut = on_screen.cut.begin();
    for (std::uint32_t t = 0; t < slabs_.size(); ++t) {
      while (cut != on_screen.cut.end() && cut->triangle < t) ++cut;
      if (slabs_[t] < kLeastSlabs || on_screen.triangles[t].turn == ScreenTurn::none) continue;
      const bool is_cut = on_screen.triangles[t].is_cut;
      const glm::uvec3 corners = corners_of(occluder, t);
      float nearest = infinite_distance;
      ScreenExtent extent;
      for (int k = 0; k < 3; ++k) {
        const VertexOnScreen& v = on_screen.vertices[corners[k]];
        nearest = std::min(nearest, is_cut ? grid.transform.near : v.distance);
        if (!is_cut) extent.include(v);
      }
      if (is_cut) extent.include(cut->polygon);
      const int first_slab = std::max(slabs.of(range_of(nearest)), slabs.count() - kMostSlabs);
      const CellRect cells = extent.cells(grid, {0, 0, grid.columns, grid.rows});
      if (slabs_[t] - first_slab < kLeastSlabs || cells.x1 - cells.x0 < kLeastCells ||
          cells.y1 - cells.y0 < kLeastCells)
        continue;
      reaching_.push_back({t, first_slab});
      cuts += std::size_t(slabs_[t] - first_slab) / kSlabsBetweenCuts;
    }
    if (cuts > kMostCuts) reaching_.clear();
    first_reached_ = slabs.count();
    for (const Reaching& r : reaching_) first_reached_ = std::min(first_reached_, r.first_slab);
  }
  /// Chooses triangles that reach through a slab, cut at the slab's far side.
  void choose_cut(const HidingObject& occluder, int slab) {
    if (!(screen_->far > screen_->near)) return;
    for (const Reaching& r : reaching_) {
      if (r.first_slab > slab || slabs_[r.triangle] <= slab) continue;
      const glm::uvec3 c = corners_of(occluder, r.triangle);
      const ClippedTriangle cut{
          r.triangle, clip_triangle(*screen_, {on_screen.world[c.x], on_screen.world[c.y], on_screen.world[c.z]})};
      if (turn_of(cut.polygon) != on_screen.triangles[r.triangle].turn) continue;
      marks_[r.triangle] = std::uint16_t(slab + 1);
      cut_.push_back(cut);
    }
  }
  /// Chooses triangles of nearer slabs that share a vertex with `triangle`. Corners at which both neighbours of the
  /// triangle are of the slab are left out.
  void choose_around(const HidingObject& occluder, int slab, std::uint32_t triangle) {
    const std::uint32_t first = occluder.part.first_triangle;
    const auto mark = std::uint16_t(slab + 1);
    const auto is_of_slab = [&](std::uint32_t t) { return t == no_index || slabs_[t - first] == slab; };
    const glm::uvec3& beyond = occluder.mesh.neighbours[first + triangle];
    for (int corner = 0; corner < 3; ++corner) {
      if (is_of_slab(beyond[corner]) && is_of_slab(beyond[corner == 0 ? 2 : corner - 1])) continue;
      occluder.mesh.visit_around(first + triangle, corner, [&](std::uint32_t around) {
        const std::uint32_t own = around - first;
        if (slabs_[own] >= slab || marks_[own] == mark) return;
        marks_[own] = mark;
        whole_.push_back(own);
      });
    }
  }
  [[nodiscard]] CellRect rect_of_chosen(const CellGrid& grid, const HidingObject& occluder,
                                        const CellRect& rect) const {
    ScreenExtent extent;
    for (const std::uint32_t t : whole_)
      for (int k = 0; k < 3; ++k) extent.include(on_screen.vertices[corners_of(occluder, t)[k]]);
    for (const ClippedTriangle& cut : cut_) extent.include(cut.polygon);
    return extent.cells(grid, rect);
  }

  std::vector<float> far_sides_;           ///< by slab; infinity for the last slab
  std::vector<std::uint16_t> slabs_;       ///< by triangle
  std::vector<std::uint32_t> by_slab_;     ///< triangles in the order of their slabs
  std::vector<std::uint32_t> slab_begin_;  ///< by slab: where it begins in by_slab_; then the end
  std::vector<Reaching> reaching_;
  int first_reached_ = 0;  ///< the first slab in which a reaching triangle begins
  // State of the current slab.
  std::vector<std::uint32_t> whole_;
  std::vector<ClippedTriangle> cut_;
  std::vector<std::uint16_t> marks_;  ///< by triangle: 1 + the last slab that it was chosen for
  std::optional<ScreenTransform> screen_;
  ChosenTriangles chosen_;
};

/// Memory of sweeps.
struct Sweep::Memory {
  /// A cover that starts at a range: an object with known cells, or a slab of a long object. `next` is the following
  /// event of that range.
  struct Event {
    std::uint32_t item;  ///< an object
    std::uint32_t long_object = no_index;
    int slab = 0;
    std::size_t first_row = 0;  ///< index in `solid`
    std::uint32_t next = no_index;
  };
  std::vector<ScreenBox> boxes;                      ///< by item; valid once the item is queued
  std::vector<std::uint32_t> first_test, next_test;  ///< linked lists of items: first by range, next by item
  std::vector<std::uint32_t> first_event;            ///< by range
  std::vector<Event> events;
  std::vector<std::unique_ptr<LongObject>> long_objects;
  OccluderOnScreen on_screen;
  CoverScratch scratch;
  std::vector<std::uint32_t> solid;  ///< cells of objects that will cover
};

class Sweep::Run {
 public:
  Run(Memory& memory, const SweptScene& scene, const SweptView& view, std::span<ObjectSight> sights, CellCover& cover)
      : memory_(memory), scene_(scene), view_(view), sights_(sights), cover_(cover), is_covered_(cover_test(view.isa)) {
    memory.boxes.resize(scene.tree.item_count());
    memory.next_test.resize(scene.tree.item_count());
    if (!memory.boxes.empty()) find_ranges();
    clear_lists();
    std::fill(sights.begin(), sights.end(), ObjectSight::outside);
    cover.begin(view.grid.columns, view.grid.rows);
    memory.scratch.reached.begin(view.grid.columns, view.grid.rows);
    memory.scratch.ends.begin(view.grid.columns, view.grid.rows);
  }

  void sweep() {
    if (memory_.boxes.empty()) return;
    line_up(scene_.tree.top(), -infinite_distance);
    for (std::size_t range = 0; range < memory_.first_test.size(); ++range) {
      for (std::uint32_t e = memory_.first_event[range]; e != no_index; e = memory_.events[e].next)
        cover_by(memory_.events[e]);
      std::uint32_t& first = memory_.first_test[range];
      while (first != no_index) test(std::exchange(first, memory_.next_test[first]));
    }
  }

 private:
  /// Precondition: the item is an object.
  [[nodiscard]] const CulledObject& object_of(std::uint32_t item) const {
    return scene_.objects[scene_.tree.object(item)];
  }
  [[nodiscard]] HidingObject occluder(std::uint32_t item) const {
    const CulledObject& o = object_of(item);
    const Instance& instance = scene_.scene.instances[o.instance];
    const OccluderMesh& mesh = scene_.meshes[instance.mesh];
    return {mesh, mesh.parts[o.part], instance.world_from_mesh};
  }

  /// Makes ranges between the nearest and the farthest object, whether they are on the screen or not.
  void find_ranges() {
    const ScreenTransform& t = view_.grid.transform;
    find_on_screen(view_.grid, scene_.tree.boxes(), {scene_.tree.root(), 1}, memory_.boxes, view_.isa);
    const ScreenBox& all = memory_.boxes[scene_.tree.root()];
    const float least = std::max(all.nearest, t.near);
    range_of_ = DistanceRanges(t.orthographic, least, std::min(all.farthest, t.far));
    const int twice = t.orthographic ? range_of_.count() / 8 : range_of_(2 * least) - range_of_(least);
    slab_length_ = std::max(1, twice / kSlabsOfDouble);
  }

  void clear_lists() {
    const std::size_t ranges = std::size_t(range_of_.count()) + 1;
    memory_.first_test.assign(ranges, no_index);
    memory_.first_event.assign(ranges, no_index);
    memory_.events.clear();
    memory_.solid.clear();
  }

  /// Queues items, none of which is nearer than `distance`.
  void line_up(const ItemRange& items, float distance) {
    find_on_screen(view_.grid, scene_.tree.boxes(), items, memory_.boxes, view_.isa);
    for (std::uint32_t i = items.first; i < items.end(); ++i) {
      ScreenBox& box = memory_.boxes[i];
      if (box.rect.is_empty()) continue;
      box.nearest = std::max(box.nearest, distance);
      memory_.next_test[i] = std::exchange(memory_.first_test[std::size_t(range_of_(box.nearest))], i);
    }
  }

  void test(std::uint32_t item) {
    const ScreenBox& box = memory_.boxes[item];
    if (is_covered_(cover_, box.rect, box.nearest)) return hide(item);
    if (!scene_.tree.is_object(item)) return line_up(scene_.tree.items_of(item), box.nearest);
    sights_[scene_.tree.object(item)] = may_be_seen(item, box) ? ObjectSight::may_be_seen : ObjectSight::hidden;
  }

  /// Marks all objects of an item as hidden, except objects outside of the view.
  void hide(std::uint32_t item) {
    const ObjectTree& tree = scene_.tree;
    if (tree.is_object(item) || is_inside(memory_.boxes[item])) {
      const ItemRange objects = tree.objects_of(item);
      for (std::uint32_t i = objects.first; i < objects.end(); ++i)
        if (!tree.boxes().is_empty(i)) sights_[tree.object(i)] = ObjectSight::hidden;
      return;
    }
    const ItemRange items = tree.items_of(item);
    find_on_screen(view_.grid, tree.boxes(), items, memory_.boxes, view_.isa);
    for (std::uint32_t i = items.first; i < items.end(); ++i)
      if (!memory_.boxes[i].rect.is_empty()) hide(i);
  }

  /// Returns whether the box is certainly within the viewing volume. A box that reaches to the border may go beyond it.
  [[nodiscard]] bool is_inside(const ScreenBox& box) const {
    const CellGrid& grid = view_.grid;
    return box.rect.x0 > 0 && box.rect.y0 > 0 && box.rect.x1 < grid.columns && box.rect.y1 < grid.rows &&
           box.nearest >= grid.transform.near && box.farthest <= grid.transform.far;
  }

  /// Tests an object, whose box is not covered, by its own triangles. Schedules its cover if it may be seen.
  bool may_be_seen(std::uint32_t item, const ScreenBox& box) {
    if (is_tiny(box.rect)) return true;
    const HidingObject it = occluder(item);
    if (it.part.triangle_count == 0 || is_dense(it.part, box.rect)) return true;
    const LongObject::Slabs slabs{range_of_(box.nearest), range_of_(box.farthest), slab_length_};
    if (slabs.last - slabs.first > kShortSlabs * slab_length_) return long_may_be_seen(item, it, slabs);
    put_on_screen(view_.grid, it, memory_.on_screen);
    const std::size_t first_row = add_rows(box.rect);
    if (is_behind_cover(item, it, memory_.on_screen, first_row)) return false;
    schedule(slabs.last + 1, {.item = item, .first_row = first_row});
    return true;
  }

  bool long_may_be_seen(std::uint32_t item, const HidingObject& it, const LongObject::Slabs& slabs) {
    if (used_long_objects_ == memory_.long_objects.size())
      memory_.long_objects.push_back(std::make_unique<LongObject>());
    LongObject& o = *memory_.long_objects[used_long_objects_];
    put_on_screen(view_.grid, it, o.on_screen);
    // An object that reaches to the eye is not tested, because no cover is certainly nearer.
    const ScreenBox& box = memory_.boxes[item];
    if (box.nearest > -infinite_distance) {
      const std::size_t first_row = add_rows(box.rect);
      const bool is_hidden = is_behind_cover(item, it, o.on_screen, first_row);
      memory_.solid.resize(first_row);
      if (is_hidden) return false;
    }
    o.sort_by_slab(view_.grid, it, range_of_, slabs);
    for (int slab = 0; slab < slabs.count(); ++slab)
      if (o.has_triangles(slab))
        schedule(slabs.behind(slab), {.item = item, .long_object = std::uint32_t(used_long_objects_), .slab = slab});
    ++used_long_objects_;
    return true;
  }

  /// Returns whether the object is hidden by the cover, and finds the cells that it covers itself.
  bool is_behind_cover(std::uint32_t item, const HidingObject& it, const OccluderOnScreen& on_screen,
                       std::size_t first_row) {
    CoverPass pass{.rect = memory_.boxes[item].rect, .distance = memory_.boxes[item].farthest};
    leave_out_culled(item, it.part, pass);
    // Both sides of a closed surface cover the same cells.
    if (it.part.is_closed && on_screen.cut.empty() && pass.clockwise) pass.counter_clockwise = false;
    const bool is_near_open = find_solid({view_.grid, it, on_screen, pass}, memory_.scratch, cover_,
                                         memory_.solid.data() + first_row, view_.isa);
    // Snapping may turn a needle over, which is then culled although its visible side faces the eye. A closed object
    // has other triangles in front of the needle and behind it. If double-sided and one-sided triangles mix, fronts
    // alone do not tell whether the object is hidden.
    const bool is_mixed = view_.culling == Culling::material && it.part.has_double_sided && it.part.has_one_sided;
    const bool are_all_told =
        culling_of(it.part) == Culling::none || it.part.is_closed || (on_screen.has_certain_turns && !is_mixed);
    return !is_near_open && on_screen.is_told_by_cells && are_all_told;
  }

  void schedule(int range, Memory::Event event) {
    // No object is behind the last range, but queries for boxes may be.
    std::uint32_t& first = memory_.first_event[std::size_t(std::min(range, range_of_.count()))];
    event.next = std::exchange(first, std::uint32_t(memory_.events.size()));
    memory_.events.push_back(event);
  }

  void cover_by(const Memory::Event& event) {
    const ScreenBox& box = memory_.boxes[event.item];
    if (event.long_object == no_index) {
      const CoverPass pass{.rect = box.rect, .distance = box.farthest};
      return add_to_cover(pass, memory_.solid.data() + event.first_row, cover_, view_.isa);
    }
    LongObject& o = *memory_.long_objects[event.long_object];
    const HidingObject it = occluder(event.item);
    CoverPass pass = o.choose(view_.grid, it, event.slab, box.rect);
    if (pass.rect.is_empty() || is_covered_(cover_, pass.rect, infinite_distance)) return;
    leave_out_culled(event.item, it.part, pass);
    const std::size_t first_row = add_rows(pass.rect);
    std::uint32_t* const solid = memory_.solid.data() + first_row;
    find_solid({view_.grid, it, o.on_screen, pass}, memory_.scratch, cover_, solid, view_.isa);
    add_to_cover(pass, solid, cover_, view_.isa);
    memory_.solid.resize(first_row);
  }

  /// Leaves out triangles that the view culls by their facing.
  void leave_out_culled(std::uint32_t item, const OccluderPart& part, CoverPass& pass) const {
    const Culling culling = culling_of(part);
    // Fronts are counter-clockwise on the screen; a mirrored instance has the reverse order of vertices.
    const bool is_mirrored = scene_.mirrored[object_of(item).instance] != 0;
    bool& fronts = is_mirrored ? pass.clockwise : pass.counter_clockwise;
    bool& backs = is_mirrored ? pass.counter_clockwise : pass.clockwise;
    if (culling == Culling::front || culling == Culling::both) fronts = false;
    if (culling == Culling::back || culling == Culling::both) backs = false;
  }

  /// Returns the culling with which all remaining triangles certainly hide. If one-sided and double-sided triangles
  /// mix, only fronts remain.
  [[nodiscard]] Culling culling_of(const OccluderPart& part) const {
    if (view_.culling != Culling::material) return view_.culling;
    return part.has_double_sided && !part.has_one_sided ? Culling::none : Culling::back;
  }

  /// Adds empty rows for a rectangle. \returns the index in Memory::solid at which they begin.
  std::size_t add_rows(const CellRect& rect) {
    const std::size_t first_row = memory_.solid.size();
    memory_.solid.resize(first_row + std::size_t(rect.tile_count()) * tile_rows, 0);
    return first_row;
  }

  Memory& memory_;
  const SweptScene& scene_;
  const SweptView& view_;
  std::span<ObjectSight> sights_;
  CellCover& cover_;
  CoverTest is_covered_;
  DistanceRanges range_of_;
  int slab_length_ = 1;
  std::size_t used_long_objects_ = 0;
};

Sweep::Sweep() : memory_(std::make_unique<Memory>()) {}
Sweep::~Sweep() = default;

void Sweep::run(const SweptScene& scene, const SweptView& view, std::span<ObjectSight> sights, CellCover& cover) {
  Run(*memory_, scene, view, sights, cover).sweep();
}

}  // namespace frontmost::occlusion_detail
