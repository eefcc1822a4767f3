// SPDX-License-Identifier: Apache-2.0
#include "submit/stream.h"

#include <algorithm>
#include <cstdlib>

#include "base/parallel.h"
#include "fragments/painter.h"

namespace frontmost::gl_detail {

using zbuffer_detail::PixelRect;
using zbuffer_detail::Tile;
using zbuffer_detail::TileRect;

namespace {

/// Batches that wait until tiles are drawn by several threads. More of them leave the cache: 64 took a third longer.
constexpr std::size_t kMostWaiting = 12;

[[nodiscard]] Batch::Kind kind_of(GLenum mode) {
  if (mode == GL_POINTS) return Batch::Kind::points;
  return mode == GL_LINES || mode == GL_LINE_STRIP || mode == GL_LINE_LOOP ? Batch::Kind::lines
                                                                           : Batch::Kind::triangles;
}

}  // namespace

PrimitiveStream::PrimitiveStream() {
  if (const char* threads = std::getenv("FRONTMOST_GL_THREADS"))
    execution.threads = std::clamp(std::atoi(threads), 0, 1024);
  if (const char* wanted = std::getenv("FRONTMOST_GL_ISA"))
    for (const Isa isa : available_isas())
      if (name(isa) == wanted) execution.isa = isa;
}
PrimitiveStream::~PrimitiveStream() = default;

void PrimitiveStream::begin(DrawInput& input, GLenum mode) {
  const Batch::Kind kind = kind_of(mode);
  if (!open_ || is_stale_ || open_->kind != kind) open_batch(input, kind);
  mode_ = mode;
  is_open_ = true;
  is_continued_ = false;
  first_ = count_;
  name_primitives(next_draw_++, 0);
  set_limit();
}

/// Says that the batch's next primitives belong to a draw, the first of them with this number.
void PrimitiveStream::name_primitives(std::uint32_t draw, std::uint32_t primitive) {
  const bool is_polygon = open_->kind == Batch::Kind::triangles;
  const int unit = mode_ == GL_POLYGON ? 0 : mode_ == GL_QUADS || mode_ == GL_QUAD_STRIP ? 2 : 1;
  open_->draws.push_back({is_polygon ? open_->triangle_count : int(open_->lines.size()), draw, primitive, unit});
}

void PrimitiveStream::vertex(DrawInput& input) {
  if (count_ == limit_) carry_on(input);
  const auto& values = input.state.current.values;
  for (const Input& of : inputs_) of.column[count_] = values[std::size_t(of.attribute)];
  ++count_;
}

void PrimitiveStream::end(DrawInput& input) {
  assemble(true);
  is_open_ = false;
  if (count_ + 16 > Batch::kMostVertices || open_->triangle_count + 8 > Batch::kMostTriangles) close_batch(input);
}

void PrimitiveStream::material_changes(DrawInput& input) {
  is_stale_ = true;
  if (is_open_ && state_->is_lit) open_->material_runs.push_back({count_, input.state.lighting.materials});
}

void PrimitiveStream::open_batch(DrawInput& input, Batch::Kind kind) {
  close_batch(input);
  if (is_stale_ || !state_) {
    state_ = snapshot(input);
    is_stale_ = false;
  }
  if (spare_.empty()) {
    open_ = std::make_unique<Batch>();
  } else {
    open_ = std::move(spare_.back());
    spare_.pop_back();
  }
  open_->clear(state_, kind);
  inputs_.clear();
  for (const int attribute : {int(kX), int(kY), int(kZ), int(kW)})
    inputs_.push_back({open_->input(attribute), attribute});
  for (const int attribute : state_->inputs) inputs_.push_back({open_->input(attribute), attribute});
  count_ = 0;
}

void PrimitiveStream::close_batch(DrawInput& input) {
  if (!open_) return;
  open_->vertex_count = count_;
  open_->first_id = next_id_;
  next_id_ += std::uint32_t(open_->triangle_count) + std::uint32_t(open_->lines.size());
  if (keeps_)
    for (const DrawRange& d : open_->draws)
      names_.push_back({open_->first_id + std::uint32_t(d.first), d.draw, d.primitive, d.unit});
  const bool is_empty = open_->triangle_count == 0 && open_->lines.empty();
  if (is_empty)
    spare_.push_back(std::move(open_));
  else
    submit(input, {std::move(open_), state_, 0, nullptr});
  open_.reset();
}

/// Finds after how many vertices the batch is full.
void PrimitiveStream::set_limit() {
  const int room = Batch::kMostTriangles - open_->triangle_count - 2;
  int more = Batch::kMostVertices;
  switch (mode_) {
    case GL_TRIANGLES: more = 3 * room; break;
    case GL_QUADS: more = 2 * room; break;
    case GL_TRIANGLE_STRIP:
    case GL_TRIANGLE_FAN:
    case GL_QUAD_STRIP:
    case GL_POLYGON: more = room; break;
    default: break;
  }
  limit_ = std::min(count_ + std::max(more, 0), Batch::kMostVertices);
  // Whole primitives only, so that nothing but strips and fans is cut.
  const int unit = mode_ == GL_TRIANGLES                                                       ? 3
                   : mode_ == GL_QUADS                                                         ? 4
                   : mode_ == GL_TRIANGLE_STRIP || mode_ == GL_QUAD_STRIP || mode_ == GL_LINES ? 2
                                                                                               : 1;
  limit_ = first_ + (limit_ - first_) / unit * unit;
}

void PrimitiveStream::carry_on(DrawInput& input) {
  assemble(false);
  // The vertices with which the primitive goes on.
  std::vector<int> kept;
  const int n = count_ - first_;
  switch (mode_) {
    case GL_TRIANGLE_STRIP:
    case GL_QUAD_STRIP:
      if (n >= 2) kept = {count_ - 2, count_ - 1};
      break;
    case GL_TRIANGLE_FAN:
    case GL_POLYGON:
    case GL_LINE_LOOP:
      if (n >= 1) kept.push_back(first_);
      if (n >= 2) kept.push_back(count_ - 1);
      break;
    case GL_LINE_STRIP:
      if (n >= 1) kept.push_back(count_ - 1);
      break;
    default: break;
  }
  std::vector<float> values;
  for (const int v : kept)
    for (const Input& of : inputs_) values.push_back(of.column[v]);
  const bool has_drawn = n >= 3 || (n >= 2 && kind_of(mode_) == Batch::Kind::lines);
  // Materials of glMaterial between begin() and end() go on, too.
  std::vector<MaterialChange> runs;
  if (const auto& all = open_->material_runs; !all.empty()) {
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const auto after =
          std::find_if(all.begin(), all.end(), [&](const MaterialChange& run) { return run.first > kept[i]; });
      runs.push_back({int(i), after == all.begin() ? state_->state.lighting.materials : std::prev(after)->materials});
    }
    runs.push_back({int(kept.size()), all.back().materials});
  }
  const DrawRange& range = open_->draws.back();
  const int made =
      (open_->kind == Batch::Kind::triangles ? open_->triangle_count : int(open_->lines.size())) - range.first;
  const PrimitiveName name{range.draw, range.primitive + std::uint32_t(range.unit == 0 ? 0 : made / range.unit)};
  const bool was_stale = is_stale_;
  is_stale_ = false;  // the state is that of begin()
  open_batch(input, open_->kind);
  is_stale_ = was_stale;
  open_->material_runs = runs;
  const float* value = values.data();
  for (std::size_t i = 0; i < kept.size(); ++i, ++count_)
    for (const Input& of : inputs_) of.column[count_] = *value++;
  name_primitives(name.draw, name.primitive);
  first_ = 0;
  is_continued_ |= has_drawn;
  open_->is_continued = is_continued_ && mode_ == GL_POLYGON;
  set_limit();
}

void PrimitiveStream::add_triangle(int a, int b, int c, int edges, int provoking) {
  const auto n = std::size_t(open_->triangle_count++);
  open_->corners[0][n] = a;
  open_->corners[1][n] = b;
  open_->corners[2][n] = c;
  open_->edge_flags[n] = std::uint8_t(edges);
  open_->provoking[n] = provoking;
}

void PrimitiveStream::add_line(int a, int b, int provoking, bool continues) {
  open_->lines.push_back({{a, b}, provoking, false, false, continues ? 1u : 0u, 0, std::uint32_t(open_->lines.size())});
}

/// Makes triangles and lines of the vertices between begin() and here. Edges are bits: 1 from the first vertex to the
/// second, 2 to the third, 4 back to the first.
void PrimitiveStream::assemble(bool is_last) {
  const int f = first_, n = count_ - first_;
  Batch& b = *open_;
  const bool has_flags =
      std::find(state_->inputs.begin(), state_->inputs.end(), int(kEdgeFlag)) != state_->inputs.end();
  const auto flag = [&](int v) { return has_flags && b.input(kEdgeFlag)[v] != 0 ? 1 : 0; };
  switch (mode_) {
    case GL_POINTS:
      for (int i = f; i < f + n; ++i) b.lines.push_back({{i, i}, i, false, true, 0, 0, std::uint32_t(b.lines.size())});
      break;
    case GL_LINES:
      for (int i = 0; i + 1 < n; i += 2) add_line(f + i, f + i + 1, f + i + 1, false);
      break;
    case GL_LINE_STRIP:
      for (int i = 0; i + 1 < n; ++i) add_line(f + i, f + i + 1, f + i + 1, i > 0 || is_continued_);
      break;
    case GL_LINE_LOOP: {
      // A loop that began in an earlier batch has its first vertex, and the vertex where it goes on.
      const int start = is_continued_ ? 1 : 0;
      for (int i = start; i + 1 < n; ++i) add_line(f + i, f + i + 1, f + i + 1, i > 0);
      if (is_last && n >= 2) add_line(f + n - 1, f, f, true);
      break;
    }
    case GL_TRIANGLES:
      for (int i = 0; i + 2 < n; i += 3) {
        const int v = f + i;
        add_triangle(v, v + 1, v + 2, flag(v) | flag(v + 1) << 1 | flag(v + 2) << 2, v + 2);
      }
      break;
    case GL_TRIANGLE_STRIP:
      // A batch ends after an even number of vertices, so that the winding goes on. The provoking vertex stays last.
      for (int i = 0; i + 2 < n; ++i) {
        const int v = f + i;
        add_triangle(v + i % 2, v + 1 - i % 2, v + 2, 7, v + 2);
      }
      break;
    case GL_TRIANGLE_FAN:
      for (int i = 1; i + 1 < n; ++i) add_triangle(f, f + i, f + i + 1, 7, f + i + 1);
      break;
    case GL_QUADS:
      for (int i = 0; i + 3 < n; i += 4) {
        const int v = f + i;
        add_triangle(v, v + 1, v + 3, flag(v) | flag(v + 3) << 2, v + 3);
        add_triangle(v + 1, v + 2, v + 3, flag(v + 1) | flag(v + 2) << 1, v + 3);
      }
      break;
    case GL_QUAD_STRIP:
      for (int i = 0; i + 3 < n; i += 2) {
        const int v = f + i;
        add_triangle(v, v + 1, v + 3, 1 | 2, v + 3);
        add_triangle(v, v + 3, v + 2, 2 | 4, v + 3);
      }
      break;
    case GL_POLYGON:
      for (int i = 1; i + 1 < n; ++i) {
        const bool is_first = i == 1 && !is_continued_, closes = is_last && i + 2 == n;
        add_triangle(f, f + i, f + i + 1,
                     (is_first ? flag(f) : 0) | flag(f + i) << 1 | (closes ? flag(f + i + 1) << 2 : 0), f);
      }
      break;
    default: break;
  }
}

void PrimitiveStream::clear(DrawInput& input, GLbitfield mask) {
  close_batch(input);
  auto state = snapshot(input);
  const DrawBounds& s = state->scissor;
  const bool is_whole = s.x0 == 0 && s.y0 == 0 && s.x1 == input.frame.width - 1 && s.y1 == input.frame.height - 1;
  if ((mask & GL_COLOR_BUFFER_BIT) != 0 && is_whole && state->color_mask == 0xFFFFFFFF) forget_draws(input);
  submit(input, {nullptr, std::move(state), mask, nullptr});
}

void PrimitiveStream::draw(DrawInput& input, PixelRectangle&& rectangle) {
  close_batch(input);
  auto kept = std::make_unique<PixelRectangle>(std::move(rectangle));
  if (keeps_) names_.push_back({next_id_, next_draw_, 0, 0});
  ++next_draw_;
  submit(input, {nullptr, snapshot(input), 0, std::move(kept), next_id_++});
}

void PrimitiveStream::finish(DrawInput& input) {
  close_batch(input);
  run(input);
}

void PrimitiveStream::submit(DrawInput& input, Work&& work) {
  queue_.push_back(std::move(work));
  if (thread_count(execution) == 1) return run(input);
  if (queue_.size() < kMostWaiting) return;
  settle();
  in_errand_.swap(queue_);
  errand_.emplace(Crew::of_process(), [this, &frame = input.frame] {
    try {
      draw_all(frame, in_errand_);
    } catch (...) {
      error_ = std::current_exception();
    }
  });
}

namespace {

void clear_tile(const PaintTarget& target, const Tile& tile, const DrawState& d, GLbitfield mask) {
  Frame& frame = target.frame;
  PixelRect rect{std::max(d.scissor.x0, tile.x), std::max(d.scissor.y0, tile.y),
                 std::min(d.scissor.x1, tile.x + tile.width - 1), std::min(d.scissor.y1, tile.y + tile.height - 1)};
  if (const PixelProbe* p = target.probe) rect = zbuffer_detail::common_part(rect, {p->x, p->y, p->x, p->y});
  if (rect.is_empty()) return;
  const State& s = d.state;
  std::uint32_t color = 0, depth = 0, depth_mask = 0;
  for (int k = 0; k < 4; ++k) color |= std::uint32_t(std::nearbyint(s.color.clear[k] * 255)) << (8 * k);
  if ((mask & GL_DEPTH_BUFFER_BIT) != 0 && s.depth.mask) {
    depth_mask |= 0xFFFFFF00;
    depth |= std::uint32_t(std::nearbyint(s.depth.clear * kMostDepth)) << 8;
  }
  if ((mask & GL_STENCIL_BUFFER_BIT) != 0) {
    depth_mask |= s.stencil.write_mask & 255;
    depth |= std::uint32_t(s.stencil.clear) & 255;
  }
  const auto fill = [&](Buffer<std::uint32_t>& plane, std::uint32_t value, std::uint32_t bits) {
    if (bits == 0) return;
    for (int y = rect.y0; y <= rect.y1; ++y) {
      std::uint32_t* const row = plane.data() + frame.at(rect.x0, y);
      const int count = rect.x1 - rect.x0 + 1;
      if (bits == 0xFFFFFFFF)
        std::fill_n(row, count, value);
      else
        for (int i = 0; i < count; ++i) row[i] = (row[i] & ~bits) | (value & bits);
    }
  };
  fill(frame.color, color, (mask & GL_COLOR_BUFFER_BIT) != 0 ? d.color_mask : 0);
  fill(frame.depth, depth, depth_mask);
  if (!frame.ids.empty()) fill(frame.ids, no_primitive, (mask & GL_COLOR_BUFFER_BIT) != 0 ? 0xFFFFFFFF : 0);
}

}  // namespace

void PrimitiveStream::draw_all(Frame& frame, const std::vector<Work>& works) {
  if (works.empty() || frame.width == 0) return;
  parallel_for(execution, works.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (works[i].batch) works[i].batch->prepare(execution.isa);
  });
  for (const Work& work : works)
    if (work.batch) stipple_pixels_ = work.batch->continue_stipple(stipple_pixels_);
  std::atomic<std::uint64_t> passed{0};
  const PaintTarget target{frame, counts_samples ? &passed : nullptr, nullptr};
  const View& grid = works[0].state->grid;
  parallel_for(execution, Tile::count(grid), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t number = begin; number < end; ++number) {
      const Tile tile(number, grid);
      for (const Work& work : works) paint(target, tile, work);
    }
  });
  samples_passed += passed;
}

void PrimitiveStream::run(DrawInput& input) {
  settle();
  draw_all(input.frame, queue_);
  in_errand_.swap(queue_);
  settle();
}

void PrimitiveStream::settle() {
  errand_.reset();
  for (Work& work : in_errand_)
    if (keeps_)
      kept_.push_back(std::move(work));
    else if (work.batch)
      spare_.push_back(std::move(work.batch));
  in_errand_.clear();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void PrimitiveStream::paint(const PaintTarget& target, const Tile& tile, const Work& work) const {
  const auto touches = [&](const PixelRect& r) {
    return !r.is_empty() && TileRect(r).holds(tile.column(), tile.row());
  };
  if (work.cleared != 0) return clear_tile(target, tile, *work.state, work.cleared);
  if (work.rectangle) return paint_rectangle(target, tile, *work.state, *work.rectangle, work.id, execution.isa);
  if (work.batch->placed.is_in(tile) || touches(work.batch->line_rect))
    paint_batch(target, tile, *work.batch, execution.isa);
}

}  // namespace frontmost::gl_detail
