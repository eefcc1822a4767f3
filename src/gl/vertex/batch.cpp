// SPDX-License-Identifier: Apache-2.0
#include "vertex/batch.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace frontmost::gl_detail {

using namespace zbuffer_detail;

Batch::Batch()
    : edge_flags(kMostTriangles + 16),
      provoking(kMostTriangles + 16),
      inputs_(std::size_t(kAttributes) * kRoom),
      stride_(2 * kRoom),
      room_(2 * kRoom - 16) {
  outputs_ = Buffer<float>((kVaryings + 9) * stride_);
  for (auto& column : corners) column = Buffer<std::int32_t>(kMostTriangles + 16, 0);
  for (auto& column : small_corners) column = Buffer<std::int32_t>(BatchColumns::room);
}

void Batch::clear(std::shared_ptr<const DrawState> draw_state, Kind primitives) {
  state = std::move(draw_state);
  kind = primitives;
  vertex_count = triangle_count = 0;
  material_runs.clear();
  draws.clear();
  is_continued = false;
  lines.clear();
}

/// Doubles the room for vertices.
void Batch::grow() {
  const std::size_t wider = 2 * stride_;
  Buffer<float> outputs((kVaryings + 9) * wider);
  for (int varying = 0; varying < kVaryings + 9; ++varying)
    std::copy_n(output(varying), vertex_count, outputs.data() + std::size_t(varying) * wider);
  outputs_.swap(outputs);
  stride_ = wider;
  room_ = int(wider) - 16;
}

int Batch::add_between(int a, int b, float t) {
  if (vertex_count == room_) grow();
  const int n = vertex_count++;
  const auto mix = [&](int varying) {
    float* const of = output(varying);
    of[n] = of[a] + t * (of[b] - of[a]);
  };
  for (const int varying : state->varyings) mix(varying);
  if (state->is_two_sided)
    for (int k = 0; k < 7; ++k) mix(kOutBack + k);
  for (int k = 0; k < kClipPlanes; ++k)
    if (state->clip_planes >> k & 1) mix(kOutClip + k);
  for (int axis = 0; axis < 4; ++axis) mix(kVaryings + axis);
  return n;
}

bool Batch::project(int v) {
  const float w = clip(3)[v];
  if (!(w > 1e-30f)) return false;
  const float inverse = 1 / w;
  const auto window = [&](int axis) {
    return clip(axis)[v] * inverse * state->window_scale[axis] + state->window_offset[axis];
  };
  constexpr float kFar = (1 << 22) + 4096;  // beyond the guard planes of the largest frame, whose edges still fit
  for (int axis = 0; axis < 2; ++axis) {
    const float at = window(axis);
    if (!(std::abs(at) < kFar)) return false;
    place(axis)[v] = std::int32_t(std::nearbyint(at));
  }
  window_z()[v] = std::min(std::max(window(2), 0.0f), 1.0f);
  inverse_w()[v] = inverse;
  out_codes()[v] = 0;
  return true;
}

namespace {

constexpr int kPlanes = 6 + kClipPlanes;

/// How far inside a plane of the clip volume a vertex is; `plane` is the number of its out code's bit.
[[nodiscard]] float inside_by(const Batch& b, int plane, int v) {
  if (plane == 0) return b.clip(2)[v] + b.clip(3)[v];
  if (plane == 1) return b.clip(3)[v] - b.clip(2)[v];
  if (plane >= 6) return b.output(kOutClip + plane - 6)[v];
  const glm::vec4& g = b.state->guard[std::size_t(plane - 2)];
  const int axis = (plane - 2) / 2;
  return g[axis] * b.clip(axis)[v] + g.w * b.clip(3)[v];
}

/// The vertex where an edge leaves the volume. The inside vertex comes first, so that two triangles with a common edge
/// find the same place.
[[nodiscard]] int crossing(Batch& b, int plane, int inside, int outside) {
  const float from = inside_by(b, plane, inside), to = inside_by(b, plane, outside);
  return b.add_between(inside, outside, from / (from - to));
}

/// Vertex numbers of a convex polygon.
struct ClippedCorners {
  std::array<int, 3 + kPlanes + 1> corner;
  std::array<bool, 3 + kPlanes + 1> has_edge;  ///< the edge to the next vertex is one of the polygon's
  int count = 0;

  void add(int v, bool edge) {
    if (count == int(corner.size())) return;
    has_edge[std::size_t(count)] = edge;
    corner[std::size_t(count++)] = v;
  }
};

/// What is left of a triangle; nothing if it has no place in the window. Edges that clipping makes are edges of the
/// polygon.
[[nodiscard]] ClippedCorners clipped(Batch& b, const int (&triangle)[3], int edges) {
  ClippedCorners polygon;
  int codes = 0;
  for (int k = 0; k < 3; ++k) {
    polygon.add(triangle[k], (edges >> k & 1) != 0);
    codes |= b.out_codes()[triangle[k]];
  }
  if (codes == 0) return polygon;
  for (int plane = 0; plane < kPlanes && polygon.count >= 3; ++plane) {
    if ((codes >> plane & 1) == 0) continue;
    ClippedCorners kept;
    for (int i = 0; i < polygon.count; ++i) {
      const int v = polygon.corner[std::size_t(i)], next = polygon.corner[std::size_t((i + 1) % polygon.count)];
      const bool is_in = inside_by(b, plane, v) >= 0, next_is_in = inside_by(b, plane, next) >= 0;
      const bool edge = polygon.has_edge[std::size_t(i)];
      if (is_in) kept.add(v, edge);
      if (is_in && !next_is_in) kept.add(crossing(b, plane, v, next), true);
      if (!is_in && next_is_in) kept.add(crossing(b, plane, next, v), edge);
    }
    polygon = kept;
  }
  for (int i = 0; i < polygon.count; ++i)
    if (!b.project(polygon.corner[std::size_t(i)])) return {};
  if (polygon.count < 3) return {};
  return polygon;
}

[[nodiscard]] TriangleRecord record_of(const Batch& b, int v0, int v1, int v2) {
  TriangleRecord r;
  const int v[3] = {v0, v1, v2};
  for (int k = 0; k < 3; ++k) {
    r.x[k] = b.place(0)[v[k]];
    r.y[k] = b.place(1)[v[k]];
    r.key[k] = b.window_z()[v[k]];
  }
  return r;
}

/// glPolygonOffset of what is left of a triangle whose edges or corners are drawn, in steps of depth.
[[nodiscard]] double outline_offset(const Batch& b, const ClippedCorners& rest, bool is_clockwise, GLenum mode) {
  const PolygonState& polygon = b.state->state.polygon;
  if (!b.state->state.capabilities.has(mode == GL_LINE ? Capability::polygon_offset_line
                                                       : Capability::polygon_offset_point))
    return 0;
  for (int k = 2; k < rest.count; ++k) {
    int second = rest.corner[std::size_t(k - 1)], third = rest.corner[std::size_t(k)];
    if (is_clockwise) std::swap(second, third);
    const TriangleRecord record = record_of(b, rest.corner[0], second, third);
    if (doubled_area(record) > 0) return offset_of(polygon, record);
  }
  return double(polygon.offset_units);
}

}  // namespace

void Batch::place_polygons(Isa isa) {
  const DrawState& d = *state;
  const PolygonState& polygon = d.state.polygon;
  lines.clear();
  goes_on_ = false;
  if (d.culls_all || d.viewport.is_empty()) return;
  std::vector<std::uint32_t> apart;
  const bool are_filled = polygon.mode[0] == GL_FILL && polygon.mode[1] == GL_FILL;
  if (are_filled) {
    place_small(*this, apart, isa);
  } else {
    for (int i = 0; i < triangle_count; ++i) apart.push_back(std::uint32_t(i));
  }
  std::uint32_t outlined = ~std::uint32_t(0);  // the last triangle that has lines
  auto is_part_of_last = [&, range = draws.begin()](std::uint32_t t) mutable {
    while (std::next(range) != draws.end() && std::next(range)->first <= int(t)) ++range;
    const int part = int(t) - range->first;
    if (t == 0) return is_continued;
    return t == outlined + 1 && (range->unit == 0 ? part > 0 : part % range->unit > 0);
  };
  std::uint32_t continues = 0;  // whether the next line's stipple does
  for (const std::uint32_t t : apart) {
    const int vertices[3] = {corners[0][t], corners[1][t], corners[2][t]};
    if ((out_codes()[vertices[0]] & out_codes()[vertices[1]] & out_codes()[vertices[2]]) != 0) continue;
    const ClippedCorners rest = clipped(*this, vertices, edge_flags[t]);
    std::int64_t area = 0;
    for (int k = 2; k < rest.count; ++k)
      area +=
          doubled_area(record_of(*this, rest.corner[0], rest.corner[std::size_t(k - 1)], rest.corner[std::size_t(k)]));
    // A triangle without area covers nothing, but its edges may be those of a polygon.
    if (area == 0 && (are_filled || d.culling != Culling::none)) continue;
    const bool is_clockwise = area < 0;
    if (d.culling != Culling::none && (d.culling == Culling::front) == is_clockwise) continue;
    const bool is_back = is_clockwise == (polygon.front_face == GL_CCW);
    const GLenum mode = polygon.mode[is_back ? 1 : 0];
    if (mode == GL_FILL) {
      for (int k = 2; k < rest.count; ++k) {
        std::array<std::int32_t, 3> of{rest.corner[0], rest.corner[std::size_t(k - 1)], rest.corner[std::size_t(k)]};
        if (is_clockwise) std::swap(of[1], of[2]);
        TriangleRecord record = record_of(*this, of[0], of[1], of[2]);
        if (doubled_area(record) <= 0) continue;
        record.id = t << 1 | (is_back ? 1u : 0u);
        placed.append({record, 0, 0});
        single_corners.push_back(of);
      }
      continue;
    }
    const double shift = outline_offset(*this, rest, is_clockwise, mode);
    // The stipple goes on around a quad or polygon, of which this triangle may be a part. The first one of a quad has
    // the edges to its first vertex and from it, in this order.
    continues = is_part_of_last(t) && (t == 0 || continues != 0) ? 1 : 0;
    outlined = t;
    const bool begins_at_last = rest.count == 3 && rest.has_edge[2] && !rest.has_edge[1];
    for (int i = 0; i < rest.count; ++i) {
      const int k = begins_at_last ? (i + 2) % 3 : i;
      if (!rest.has_edge[std::size_t(k)]) continue;
      const int v = rest.corner[std::size_t(k)];
      const int next = mode == GL_LINE ? rest.corner[std::size_t((k + 1) % rest.count)] : v;
      lines.push_back({{v, next}, provoking[t], is_back, mode == GL_POINT, std::exchange(continues, 1), shift, t});
    }
  }
  goes_on_ = continues != 0 && int(outlined) == triangle_count - 1;
}

void Batch::place_lines() {
  const DrawBounds& bounds = state->scissor;
  const DrawBounds& window = state->viewport;
  const WindowRect& view = state->state.viewport.rect;
  std::uint32_t& pixels = last_pixels_;
  std::size_t kept = 0;
  line_rect = {INT32_MAX, INT32_MAX, -1, -1};
  for (WindowLine line : lines) {
    int(&v)[2] = line.vertex;
    if (line.stipple_start == 0) pixels = 0, begins_anew_ = true;
    const int codes[2] = {out_codes()[v[0]], out_codes()[v[1]]};
    if ((codes[0] & codes[1]) != 0) continue;
    bool is_seen = true;
    for (int plane = 0; plane < kPlanes && is_seen; ++plane) {
      if (((codes[0] | codes[1]) >> plane & 1) == 0) continue;
      const bool in[2] = {inside_by(*this, plane, v[0]) >= 0, inside_by(*this, plane, v[1]) >= 0};
      is_seen = in[0] || in[1];
      if (is_seen && in[0] != in[1]) v[in[0] ? 1 : 0] = crossing(*this, plane, v[in[0] ? 0 : 1], v[in[0] ? 1 : 0]);
    }
    if (!is_seen || !project(v[0]) || !project(v[1])) continue;
    const std::int32_t x[2] = {place(0)[v[0]], place(0)[v[1]]}, y[2] = {place(1)[v[0]], place(1)[v[1]]};
    if (line.is_point &&
        (x[0] < std::int64_t(view.x) * 256 || y[0] < std::int64_t(view.y) * 256 ||
         x[0] > (std::int64_t(view.x) + view.width) * 256 || y[0] > (std::int64_t(view.y) + view.height) * 256))
      continue;  // a point goes when its centre is outside
    const auto& main = std::abs(x[1] - x[0]) >= std::abs(y[1] - y[0]) ? x : y;
    line.stipple_start = pixels;
    pixels += std::uint32_t(pixels_between(main[0], main[1]).count());
    const int reach = int(line.is_point ? state->state.point.size : state->state.line.width) / 2 + 2;
    const DrawBounds& limit = line.is_point ? bounds : window;
    const PixelRect rect{std::max((std::min(x[0], x[1]) >> 8) - reach, limit.x0),
                         std::max((std::min(y[0], y[1]) >> 8) - reach, limit.y0),
                         std::min((std::max(x[0], x[1]) >> 8) + reach, limit.x1),
                         std::min((std::max(y[0], y[1]) >> 8) + reach, limit.y1)};
    if (rect.is_empty()) continue;
    line_rect = {std::min(line_rect.x0, rect.x0), std::min(line_rect.y0, rect.y0), std::max(line_rect.x1, rect.x1),
                 std::max(line_rect.y1, rect.y1)};
    line.rect = rect;
    lines[kept++] = line;
    if (!begins_anew_) continued_lines_ = kept;
  }
  lines.resize(kept);
  if (lines.empty()) return;
  const std::size_t across = Tile::tiles_across(state->grid);
  line_lists.make({0, Tile::count(state->grid)}, lines.size(), [&](std::size_t i, const auto& add) {
    const TileRect tiles(lines[i].rect);
    for (int ty = tiles.y0; ty <= tiles.y1; ++ty)
      for (int tx = tiles.x0; tx <= tiles.x1; ++tx) add(std::size_t(ty) * across + std::size_t(tx));
  });
}

double offset_of(const PolygonState& polygon, const TriangleRecord& record) {
  const SteepKeys keys(record);
  // Gradients are by 1/256 pixel. One unit is one step of 24 bits.
  const double slope = std::max(std::abs(keys.gx()), std::abs(keys.gy())) * 256;
  return slope * double(polygon.offset_factor) * kMostDepth + double(polygon.offset_units);
}

void Batch::prepare(Isa isa) {
  transform_vertices(*this, isa);
  placed.clear();
  single_corners.clear();
  if (kind == Kind::triangles) {
    place_polygons(isa);
    placed.list_tiles(state->grid);
  }
  line_rect = {0, 0, -1, -1};
  continued_lines_ = 0, begins_anew_ = false, last_pixels_ = 0;
  if (!lines.empty()) place_lines();
  if (kind == Kind::triangles && !goes_on_) begins_anew_ = true, last_pixels_ = 0;
}

std::uint32_t Batch::continue_stipple(std::uint32_t pixels) {
  for (std::size_t i = 0; i < continued_lines_; ++i) lines[i].stipple_start += pixels;
  return (begins_anew_ ? 0 : pixels) + last_pixels_;
}

}  // namespace frontmost::gl_detail
