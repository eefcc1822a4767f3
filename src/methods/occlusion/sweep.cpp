// SPDX-License-Identifier: Apache-2.0
#include "occlusion/sweep.h"

#include <algorithm>
#include <utility>

namespace frontmost::occlusion_detail {
namespace {

/// A slab is so many times shorter than the ranges to twice the distance. Objects no longer than four slabs have none.
constexpr int kSlabsOfDouble = 6, kShortSlabs = 4;

/// Whether finding the object's covered cells is not worth the time: an object with more than a triangle for every two
/// cells has hardly any cell without ends.
bool is_dense(const OccluderPart& part, const CellRect& rect) {
  const std::size_t cells = std::size_t(rect.x1 - rect.x0) * std::size_t(rect.y1 - rect.y0);
  return 2 * std::size_t(part.triangle_count) > cells + 64;
}

/// Whether every cell of an object has ends, so that it covers nothing.
bool is_tiny(const CellRect& rect) { return rect.x1 - rect.x0 <= 2 || rect.y1 - rect.y0 <= 2; }

}  // namespace

class Sweep::Run {
 public:
  Run(Sweep& memory, const SweptScene& scene, const SweptView& view, std::span<ObjectSight> sights, CellCover& cover)
      : memory_(memory), scene_(scene), view_(view), sights_(sights), cover_(cover), is_covered_(cover_test(view.isa)) {
    memory.boxes_.resize(scene.tree.item_count());
    memory.next_test_.resize(scene.tree.item_count());
    if (!memory.boxes_.empty()) find_ranges();
    clear_lists();
    std::fill(sights.begin(), sights.end(), ObjectSight::outside);
    cover.begin(view.grid.columns, view.grid.rows);
    memory.scratch_.reached.begin(view.grid.columns, view.grid.rows);
    memory.scratch_.ends.begin(view.grid.columns, view.grid.rows);
  }

  void sweep() {
    if (memory_.boxes_.empty()) return;
    line_up(scene_.tree.top(), -infinite_distance);
    for (std::size_t range = 0; range < memory_.first_test_.size(); ++range) {
      for (std::uint32_t e = memory_.first_event_[range]; e != no_index; e = memory_.events_[e].next)
        cover_by(memory_.events_[e]);
      std::uint32_t& first = memory_.first_test_[range];
      while (first != no_index) test(std::exchange(first, memory_.next_test_[first]));
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

  /// Ranges between the nearest and the farthest object, whether they are on the screen or not.
  void find_ranges() {
    const ScreenTransform& t = view_.grid.transform;
    find_on_screen(view_.grid, scene_.tree.boxes(), {scene_.tree.root(), 1}, memory_.boxes_, view_.isa);
    const ScreenBox& all = memory_.boxes_[scene_.tree.root()];
    const float least = std::max(all.nearest, t.near);
    range_of_ = DistanceRanges(t.orthographic, least, std::min(all.farthest, t.far));
    const int twice = t.orthographic ? range_of_.count() / 8 : range_of_(2 * least) - range_of_(least);
    slab_length_ = std::max(1, twice / kSlabsOfDouble);
  }

  void clear_lists() {
    const std::size_t ranges = std::size_t(range_of_.count()) + 1;
    memory_.first_test_.assign(ranges, no_index);
    memory_.first_event_.assign(ranges, no_index);
    memory_.events_.clear();
    memory_.solid_.clear();
  }

  /// Queues items, none of which is nearer than `distance`.
  void line_up(const ItemRange& items, float distance) {
    find_on_screen(view_.grid, scene_.tree.boxes(), items, memory_.boxes_, view_.isa);
    for (std::uint32_t i = items.first; i < items.end(); ++i) {
      ScreenBox& box = memory_.boxes_[i];
      if (box.rect.is_empty()) continue;
      box.nearest = std::max(box.nearest, distance);
      memory_.next_test_[i] = std::exchange(memory_.first_test_[std::size_t(range_of_(box.nearest))], i);
    }
  }

  void test(std::uint32_t item) {
    const ScreenBox& box = memory_.boxes_[item];
    if (is_covered_(cover_, box.rect, box.nearest)) return hide(item);
    if (!scene_.tree.is_object(item)) return line_up(scene_.tree.items_of(item), box.nearest);
    sights_[scene_.tree.object(item)] = may_be_seen(item, box) ? ObjectSight::may_be_seen : ObjectSight::hidden;
  }

  /// Marks all objects of an item as hidden, except objects outside of the view.
  void hide(std::uint32_t item) {
    const ObjectTree& tree = scene_.tree;
    if (tree.is_object(item) || is_inside(memory_.boxes_[item])) {
      const ItemRange objects = tree.objects_of(item);
      for (std::uint32_t i = objects.first; i < objects.end(); ++i)
        if (!tree.boxes().is_empty(i)) sights_[tree.object(i)] = ObjectSight::hidden;
      return;
    }
    const ItemRange items = tree.items_of(item);
    find_on_screen(view_.grid, tree.boxes(), items, memory_.boxes_, view_.isa);
    for (std::uint32_t i = items.first; i < items.end(); ++i)
      if (!memory_.boxes_[i].rect.is_empty()) hide(i);
  }

  /// Whether the box is certainly within the viewing volume. A box that reaches to the border may go beyond it.
  [[nodiscard]] bool is_inside(const ScreenBox& box) const {
    const CellGrid& grid = view_.grid;
    return box.rect.x0 > 0 && box.rect.y0 > 0 && box.rect.x1 < grid.columns && box.rect.y1 < grid.rows &&
           box.nearest >= grid.transform.near && box.farthest <= grid.transform.far;
  }

  /// Tests, by its own triangles, an object whose box is not covered. Schedules its cover if it may be seen.
  bool may_be_seen(std::uint32_t item, const ScreenBox& box) {
    if (is_tiny(box.rect)) return true;
    const HidingObject it = occluder(item);
    if (it.part.triangle_count == 0 || is_dense(it.part, box.rect)) return true;
    const LongObject::Slabs slabs{range_of_(box.nearest), range_of_(box.farthest), slab_length_};
    if (slabs.last - slabs.first > kShortSlabs * slab_length_) return long_may_be_seen(item, it, slabs);
    put_on_screen(view_.grid, it, memory_.on_screen_);
    const std::size_t first_row = add_rows(box.rect);
    if (is_behind_cover(item, it, memory_.on_screen_, first_row)) return false;
    schedule(slabs.last + 1, {.item = item, .first_row = first_row});
    return true;
  }

  bool long_may_be_seen(std::uint32_t item, const HidingObject& it, const LongObject::Slabs& slabs) {
    if (used_long_objects_ == memory_.long_objects_.size())
      memory_.long_objects_.push_back(std::make_unique<LongObject>());
    LongObject& o = *memory_.long_objects_[used_long_objects_];
    put_on_screen(view_.grid, it, o.on_screen);
    // Nothing is known to lie before an object that reaches to the eye.
    const ScreenBox& box = memory_.boxes_[item];
    if (box.nearest > -infinite_distance) {
      const std::size_t first_row = add_rows(box.rect);
      const bool is_hidden = is_behind_cover(item, it, o.on_screen, first_row);
      memory_.solid_.resize(first_row);
      if (is_hidden) return false;
    }
    o.sort_by_slab(view_.grid, it, range_of_, slabs);
    for (int slab = 0; slab < slabs.count(); ++slab)
      if (o.has_triangles(slab))
        schedule(slabs.behind(slab), {.item = item, .long_object = std::uint32_t(used_long_objects_), .slab = slab});
    ++used_long_objects_;
    return true;
  }

  /// Tests the object, and also finds the cells that it covers.
  bool is_behind_cover(std::uint32_t item, const HidingObject& it, const OccluderOnScreen& on_screen,
                       std::size_t first_row) {
    CoverPass pass{.rect = memory_.boxes_[item].rect, .distance = memory_.boxes_[item].farthest};
    leave_out_culled(item, it.part, pass);
    // Both sides of a closed surface cover the same cells.
    if (it.part.is_closed && on_screen.cut.empty() && pass.clockwise) pass.counter_clockwise = false;
    const bool is_near_open = find_solid({view_.grid, it, on_screen, pass}, memory_.scratch_, cover_,
                                         memory_.solid_.data() + first_row, view_.isa);
    // Snapping may turn a needle, which is then left out although its side faces the eye. A closed object has other
    // triangles before and behind it. With double-sided triangles among one-sided ones, fronts alone do not tell.
    const bool is_mixed = view_.culling == Culling::material && it.part.has_double_sided && it.part.has_one_sided;
    const bool are_all_told =
        culling_of(it.part) == Culling::none || it.part.is_closed || (on_screen.has_certain_turns && !is_mixed);
    return !is_near_open && on_screen.is_told_by_cells && are_all_told;
  }

  void schedule(int range, Event event) {
    // No object is behind the last range, but queries for boxes may be.
    std::uint32_t& first = memory_.first_event_[std::size_t(std::min(range, range_of_.count()))];
    event.next = std::exchange(first, std::uint32_t(memory_.events_.size()));
    memory_.events_.push_back(event);
  }

  void cover_by(const Event& event) {
    const ScreenBox& box = memory_.boxes_[event.item];
    if (event.long_object == no_index) {
      const CoverPass pass{.rect = box.rect, .distance = box.farthest};
      return add_to_cover(pass, memory_.solid_.data() + event.first_row, cover_, view_.isa);
    }
    LongObject& o = *memory_.long_objects_[event.long_object];
    const HidingObject it = occluder(event.item);
    CoverPass pass = o.choose(view_.grid, it, event.slab, box.rect);
    if (pass.rect.is_empty() || is_covered_(cover_, pass.rect, infinite_distance)) return;
    leave_out_culled(event.item, it.part, pass);
    const std::size_t first_row = add_rows(pass.rect);
    std::uint32_t* const solid = memory_.solid_.data() + first_row;
    find_solid({view_.grid, it, o.on_screen, pass}, memory_.scratch_, cover_, solid, view_.isa);
    add_to_cover(pass, solid, cover_, view_.isa);
    memory_.solid_.resize(first_row);
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

  /// The culling under which all remaining triangles certainly hide. If one-sided and double-sided triangles mix, only
  /// fronts remain.
  [[nodiscard]] Culling culling_of(const OccluderPart& part) const {
    if (view_.culling != Culling::material) return view_.culling;
    return part.has_double_sided && !part.has_one_sided ? Culling::none : Culling::back;
  }

  /// \returns the index in solid_ at which the rows of a rectangle begin.
  std::size_t add_rows(const CellRect& rect) {
    const std::size_t first_row = memory_.solid_.size();
    memory_.solid_.resize(first_row + std::size_t(rect.tile_count()) * tile_rows, 0);
    return first_row;
  }

  Sweep& memory_;
  const SweptScene& scene_;
  const SweptView& view_;
  std::span<ObjectSight> sights_;
  CellCover& cover_;
  CoverTest is_covered_;
  DistanceRanges range_of_;
  int slab_length_ = 1;
  std::size_t used_long_objects_ = 0;
};

void Sweep::run(const SweptScene& scene, const SweptView& view, std::span<ObjectSight> sights, CellCover& cover) {
  Run(*this, scene, view, sights, cover).sweep();
}

}  // namespace frontmost::occlusion_detail
