// SPDX-License-Identifier: Apache-2.0
// What happened at one pixel: kept work is done again for that pixel alone, and every fragment is recorded. The kernels
// record the fragments that reach a test; triangles that are culled, clipped or outside the scissor before are found
// here, one by one.

#include <algorithm>

#include "submit/stream.h"

namespace frontmost::gl_detail {

using namespace zbuffer_detail;

namespace {

/// A triangle as it was submitted, before clipping, if all its vertices are before the eye. Its vertices are oriented.
struct WholeTriangle {
  TriangleRecord record;
  bool is_clockwise;

  [[nodiscard]] bool covers(int x, int y) const {
    bool is_covered = false;
    visit_covered(record, {x, y, x, y}, glm::ivec2(kSubPixels / 2), [&](int, int) { is_covered = true; });
    return is_covered;
  }
};

[[nodiscard]] std::optional<WholeTriangle> whole_triangle(const Batch& b, const int (&vertices)[3]) {
  WholeTriangle triangle{};
  for (int k = 0; k < 3; ++k) {
    const int v = vertices[k];
    const float w = b.clip(3)[v];
    if (!(w > 1e-30f)) return std::nullopt;
    for (int axis = 0; axis < 2; ++axis) {
      const float at = b.clip(axis)[v] / w * b.state->window_scale[axis] + b.state->window_offset[axis];
      if (!(std::abs(at) < float(1 << 23))) return std::nullopt;
      (axis == 0 ? triangle.record.x : triangle.record.y)[k] = std::int32_t(std::nearbyint(at));
    }
  }
  const std::int64_t area = doubled_area(triangle.record);
  if (area == 0) return std::nullopt;
  triangle.is_clockwise = area < 0;
  if (area < 0) {
    std::swap(triangle.record.x[1], triangle.record.x[2]);
    std::swap(triangle.record.y[1], triangle.record.y[2]);
  }
  return triangle;
}

/// The triangles that cover the pixel and lose it before any test.
void find_lost(const Batch& b, const PixelProbe& probe, std::vector<FragmentEvent>& events) {
  using Verdict = FragmentEvent::Verdict;
  const DrawState& d = *b.state;
  const DrawBounds& window = d.viewport;
  const bool is_outside = probe.x < window.x0 || probe.x > window.x1 || probe.y < window.y0 || probe.y > window.y1;
  for (int t = 0; t < b.triangle_count; ++t) {
    const int vertices[3] = {b.corners[0][std::size_t(t)], b.corners[1][std::size_t(t)], b.corners[2][std::size_t(t)]};
    const auto whole = whole_triangle(b, vertices);
    if (!whole || !whole->covers(probe.x, probe.y)) continue;
    FragmentEvent event{b.first_id + std::uint32_t(t), Verdict::culled};
    event.state = &d;
    event.is_back = whole->is_clockwise == (d.state.polygon.front_face == GL_CCW);
    for (const int v : vertices) event.planes |= b.out_codes()[v];
    const bool is_culled =
        d.culls_all || (d.culling != Culling::none && (d.culling == Culling::front) == whole->is_clockwise);
    const auto is_in_rest = [&] {
      const auto singles = b.placed.singles();
      return std::any_of(singles.begin(), singles.end(), [&](const SingleTriangle& s) {
        return s.record.id >> 1 == std::uint32_t(t) && WholeTriangle{s.record, false}.covers(probe.x, probe.y);
      });
    };
    if (is_culled)
      event.verdict = Verdict::culled;
    else if (is_outside)
      event.verdict = Verdict::scissored;
    else if (event.planes != 0 && !is_in_rest())
      event.verdict = Verdict::clipped;
    else
      continue;
    events.push_back(event);
  }
}

}  // namespace

void PrimitiveStream::keep_draws(DrawInput& input, bool keep) {
  finish(input);
  if (keep == keeps_) return;
  keeps_ = keep;
  if (!keep) color_before_ = depth_before_ = {};
  forget_draws(input);
  input.frame.ids = keep ? Buffer<std::uint32_t>(input.frame.color.size(), no_primitive) : Buffer<std::uint32_t>();
}

/// Drops kept work, because the colors are cleared, and counts anew.
void PrimitiveStream::forget_draws(DrawInput& input) {
  if (keeps_) {
    run(input);
    color_before_ = input.frame.color;
    depth_before_ = input.frame.depth;
  }
  kept_.clear();
  names_.clear();
  next_id_ = next_draw_ = 0;
}

PrimitiveName PrimitiveStream::name_of(std::uint32_t id) const {
  const auto after =
      std::upper_bound(names_.begin(), names_.end(), id, [](std::uint32_t i, const IdRange& r) { return i < r.id; });
  if (after == names_.begin()) return {no_primitive, no_primitive};
  const IdRange& range = *std::prev(after);
  return {range.draw, range.primitive + (range.unit == 0 ? 0 : (id - range.id) / std::uint32_t(range.unit))};
}

std::vector<FragmentEvent> PrimitiveStream::explain(DrawInput& input, int x, int y) {
  finish(input);
  Frame& frame = input.frame;
  std::vector<FragmentEvent> events;
  if (x < 0 || y < 0 || x >= frame.width || y >= frame.height || kept_.empty()) return events;
  const std::size_t at = frame.at(x, y);
  if (color_before_.size() != frame.color.size()) return events;  // the frame has another size since
  const std::uint32_t color = frame.color[at], depth = frame.depth[at], id = frame.ids[at];
  frame.color[at] = color_before_[at];
  frame.depth[at] = depth_before_[at];
  for (const Work& work : kept_) {
    const View& grid = work.state->grid;
    if (grid.width != frame.width || grid.height != frame.height) continue;
    PixelProbe probe{x, y, {}};
    if (work.batch) find_lost(*work.batch, probe, probe.events);
    paint({frame, nullptr, &probe},
          Tile(std::size_t(y / kTileSize) * Tile::tiles_across(grid) + std::size_t(x / kTileSize), grid), work);
    std::stable_sort(probe.events.begin(), probe.events.end(),
                     [](const auto& a, const auto& b) { return a.id < b.id; });
    events.insert(events.end(), probe.events.begin(), probe.events.end());
  }
  frame.color[at] = color;
  frame.depth[at] = depth;
  frame.ids[at] = id;
  return events;
}

}  // namespace frontmost::gl_detail
