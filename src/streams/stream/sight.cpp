// SPDX-License-Identifier: Apache-2.0
// Draws a piece and merges its answer. Merging holds a lock, and goes only through the pixels that the piece may cover.
// These are few if pieces are parts of a large model.
#include "stream/sight.h"

#include <algorithm>

#include "stream/outline.h"

namespace frontmost::streaming {
namespace {

/// Calls visit(id - first) for every sample whose id is in [first, first + count). Most ids are outside, so a run of
/// samples is tested at once.
template <class Visit>
void for_ids_within(const Visible& visible, PrimitiveId first, std::size_t count, const Visit& visit) {
  constexpr std::size_t run = 64;
  const Buffer<PrimitiveId>& ids = visible.primitives;
  const auto length = PrimitiveId(count);
  for (std::size_t begin = 0; begin < ids.size(); begin += run) {
    const std::size_t end = std::min(begin + run, ids.size());
    bool any = false;
    for (std::size_t i = begin; i < end; ++i) any |= ids[i] - first < length;
    for (std::size_t i = begin; any && i < end; ++i)
      if (ids[i] - first < length) visit(ids[i] - first);
  }
}

/// Calls visit(index of the sample, id, key) for every sample where something is seen.
template <class Visit>
void for_covered_samples(const Visible& visible, const PixelBounds& pixels, const Visit& visit) {
  for (int sample = 0; sample < visible.view.samples; ++sample)
    for (int y = pixels.y0; y < pixels.y1; ++y) {
      const std::size_t row = visible.index(0, y, sample);
      for (std::size_t i = row + std::size_t(pixels.x0); i < row + std::size_t(pixels.x1); ++i)
        if (visible.primitives[i] != no_primitive) visit(i, visible.primitives[i], visible.keys[i]);
    }
}

}  // namespace

SightGatherer::SightGatherer(const std::vector<View>& views, const SightNeeds& needs) : needs_(needs) {
  for (const View& view : views) {
    visible_.push_back(nothing_visible(view));
    sample_count_ += view.sample_count();
  }
  // Up to this number, keeping hidden triangles costs less than finding them, which goes through all samples.
  limit_ = std::max<std::size_t>(std::size_t(1) << 20, sample_count_ / 2);
}

void SightGatherer::include(const Box& bounds) {
  const std::lock_guard lock(mutex_);
  bounds_.include(bounds);
}

std::vector<bool> SightGatherer::merge(const std::vector<const Visible*>& piece, const PiecePlace& place,
                                       const Selection& selection) {
  std::vector<bool> wins(selection.numbers.size());
  const std::lock_guard lock(mutex_);
  for (std::size_t v = 0; v < visible_.size(); ++v)
    for_covered_samples(*piece[v], selection.pixels[v], [&](std::size_t i, PrimitiveId id, float key) {
      PrimitiveId& last_id = visible_[v].primitives[i];
      float& last_key = visible_[v].keys[i];
      const PrimitiveId new_id = place.first + selection.numbers[id];
      // Equal keys go to the lower id, as in a single frame, so the order of pieces does not matter.
      if (key < last_key || (key == last_key && new_id >= last_id)) return;
      last_id = new_id;
      last_key = key;
      wins[id] = true;
      if (v == 0) is_blank_ = false;
    });
  return wins;
}

void SightGatherer::keep(Kept kept) {
  if (kept.triangles.empty()) return;
  const std::lock_guard lock(mutex_);
  kept_count_ += kept.triangles.size();
  kept_.emplace(kept.place.number, std::move(kept));
  if (kept_count_ <= limit_) return;
  forget_hidden();
  // The limit grows by half of what stayed, so the kept triangles are searched a logarithmic number of times.
  limit_ = std::max(limit_, kept_count_ + kept_count_ / 2);
}

void SightGatherer::share(Ranks& ranks, const IdShift& shift, const Execution& execution) {
  for (auto& [number, kept] : kept_) kept.place.first = shift(kept.place.first);
  for (Visible& visible : visible_) {
    shift.apply({visible.primitives.data(), visible.primitives.size()}, execution);
    streaming::share(ranks, visible, execution);
  }
}

/// Works in slices of ids, so that one bit per id takes 32 MiB at most, however long the stream is.
void SightGatherer::forget_hidden() {
  constexpr std::uint64_t slice = std::uint64_t(1) << 28;
  if (kept_.empty()) return;
  const Kept& last = kept_.rbegin()->second;
  const std::uint64_t end = std::uint64_t(last.place.first) + last.triangles.back() + 1;
  for (std::uint64_t first = 0; first < end; first += slice) {
    const auto count = std::size_t(std::min(slice, end - first));
    std::vector<bool> seen(count);
    for (const Visible& visible : visible_)
      for_ids_within(visible, PrimitiveId(first), count, [&](std::uint32_t id) { seen[id] = true; });
    // Triangles outside of the slice stay; another slice decides about them.
    const auto is_wanted = [&](PrimitiveId id) { return id - first >= count || seen[std::size_t(id - first)]; };
    for (auto& [number, kept] : kept_) thin_out(kept, is_wanted);
  }
  kept_count_ = 0;
  for (auto it = kept_.begin(); it != kept_.end();) {
    kept_count_ += it->second.triangles.size();
    it = it->second.triangles.empty() ? kept_.erase(it) : std::next(it);
  }
}

Selection Drawer::select(const Mesh& mesh, const SightGatherer& sight) {
  Selection selection;
  marks_.assign(mesh.triangles.size(), 0);
  for (std::size_t i = 0; i < sight.view_count(); ++i) {
    if (filters_.size() == i) filters_.emplace_back(sight.view(i));
    selection.pixels.push_back(filters_[i].mark(mesh, marks_));
  }
  for (std::uint32_t t = 0; t < marks_.size(); ++t)
    if (marks_[t]) selection.numbers.push_back(t);
  return selection;
}

namespace {

/// Calls tell() for all triangles of a mesh. Corners are copied, a few triangles at a time, because the mesh's own
/// arrays do not have this layout.
void tell_corners(const Mesh& mesh, const std::function<void(CornerSpan)>& tell) {
  std::vector<std::array<glm::vec3, 3>> corners;
  constexpr std::size_t at_once = 1024;
  for (std::size_t begin = 0; begin < mesh.triangles.size(); begin += at_once) {
    corners.clear();
    for (std::size_t t = begin; t < std::min(begin + at_once, mesh.triangles.size()); ++t) {
      const glm::uvec3& triangle = mesh.triangles[t];
      corners.push_back({mesh.positions[triangle.x], mesh.positions[triangle.y], mesh.positions[triangle.z]});
    }
    tell(corners);
  }
}

}  // namespace

void Drawer::draw(StreamPiece& piece, const PiecePlace& place, const Scene& frame, SightGatherer& sight,
                  const Execution& execution) {
  draw_selection(piece, place, frame, sight, execution);
  if (sight.needs().unseen && sight.is_blank()) tell_corners(piece.mesh, sight.needs().unseen);
}

void Drawer::draw_selection(StreamPiece& piece, const PiecePlace& place, const Scene& frame, SightGatherer& sight,
                            const Execution& execution) {
  const Selection selection = select(piece.mesh, sight);
  if (sight.needs().bounds) sight.include(finite_bounds(piece.mesh, 0, piece.mesh.triangles.size()));
  if (selection.numbers.empty()) return;
  if (scene_.instances.empty()) {
    scene_.name = frame.name;
    scene_.meshes.emplace_back();
    scene_.instances.emplace_back();
    buffers_.resize(sight.view_count());
  }
  // Only positions are used: visibility depends on nothing else.
  Mesh& drawn = scene_.meshes[0];
  drawn.triangles.clear();
  for (const std::uint32_t t : selection.numbers) drawn.triangles.push_back(piece.mesh.triangles[t]);
  std::swap(drawn.positions, piece.mesh.positions);
  std::vector<bool> seen;
  {
    const Surfaces surfaces(scene_, execution);
    std::vector<const Visible*> visible;
    for (std::size_t i = 0; i < buffers_.size(); ++i)
      visible.push_back(&buffers_[i].draw(surfaces, sight.view(i), execution));
    seen = sight.merge(visible, place, selection);
  }
  std::swap(drawn.positions, piece.mesh.positions);
  if (!sight.needs().triangles) return;
  Kept kept{place, {}, {}};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i]) continue;
    kept.triangles.push_back(selection.numbers[i]);
    append_triangle(piece.mesh, selection.numbers[i], kept.mesh);
  }
  sight.keep(std::move(kept));
}

}  // namespace frontmost::streaming
