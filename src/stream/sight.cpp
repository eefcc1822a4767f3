// SPDX-License-Identifier: Apache-2.0
#include "stream/sight.h"

#include <algorithm>

namespace frontmost::streaming {
namespace {

/// Calls visit(id - first) for runs of equal ids within [first, first + count). Most samples show something else, so
/// many are looked at in one go.
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

}  // namespace

Sight::Sight(const std::vector<View>& views, bool keeps_triangles) : keeps_triangles_(keeps_triangles) {
  for (const View& view : views) {
    visible_.push_back(nothing_visible(view));
    sample_count_ += view.sample_count();
  }
  limit_ = std::max<std::size_t>(std::size_t(1) << 20, sample_count_ / 2);
}

std::vector<bool> Sight::merge(const std::vector<const Visible*>& piece, const Place& place, std::size_t triangle_count,
                               const Box& bounds) {
  std::vector<bool> seen;
  const std::lock_guard lock(mutex_);
  bounds_.include(bounds);
  for (std::size_t i = 0; i < visible_.size(); ++i)
    frontmost::merge(visible_[i], *piece[i], place.first, {.threads = 1});
  if (!keeps_triangles_) return seen;
  seen.resize(triangle_count);
  for (const Visible& visible : visible_)
    for_ids_within(visible, place.first, triangle_count, [&](std::uint32_t triangle) { seen[triangle] = true; });
  return seen;
}

void Sight::keep(Kept kept) {
  if (kept.triangles.empty()) return;
  const std::lock_guard lock(mutex_);
  kept_count_ += kept.triangles.size();
  kept_.emplace(kept.place.number, std::move(kept));
  if (kept_count_ <= limit_) return;
  forget_hidden();
  limit_ = std::max(limit_, kept_count_ + kept_count_ / 2);
}

void Sight::finish() { forget_hidden(); }

/// In slices of ids, so that a bit for each costs 32 MiB at most, however long the stream is.
void Sight::forget_hidden() {
  constexpr std::uint64_t slice = std::uint64_t(1) << 28;
  if (kept_.empty()) return;
  const Kept& last = kept_.rbegin()->second;
  const std::uint64_t end = std::uint64_t(last.place.first) + last.triangles.back() + 1;
  for (std::uint64_t first = 0; first < end; first += slice) {
    const auto count = std::size_t(std::min(slice, end - first));
    std::vector<bool> seen(count);
    for (const Visible& visible : visible_)
      for_ids_within(visible, PrimitiveId(first), count, [&](std::uint32_t id) { seen[id] = true; });
    // What lies outside of the slice stays, for its own.
    const auto is_wanted = [&](PrimitiveId id) { return id - first >= count || seen[std::size_t(id - first)]; };
    for (auto& [number, kept] : kept_) thin_out(kept, is_wanted);
  }
  kept_count_ = 0;
  for (auto it = kept_.begin(); it != kept_.end();) {
    kept_count_ += it->second.triangles.size();
    it = it->second.triangles.empty() ? kept_.erase(it) : std::next(it);
  }
}

void Drawer::draw(Piece& piece, const Place& place, const Scene& frame, Sight& sight, const Execution& execution) {
  if (scene_.instances.empty()) {
    scene_.name = frame.name;
    scene_.meshes.emplace_back();
    scene_.instances.emplace_back();
    buffers_.resize(sight.view_count());
  }
  // What is visible does not depend on materials, and their numbers are those of another scene.
  std::vector<std::uint32_t> material_ids = std::move(piece.mesh.material_ids);
  piece.mesh.material_ids.clear();
  std::swap(scene_.meshes[0], piece.mesh);
  std::vector<bool> seen;
  {
    const Surfaces surfaces(scene_, execution);
    std::vector<const Visible*> visible;
    for (std::size_t i = 0; i < buffers_.size(); ++i)
      visible.push_back(&buffers_[i].draw(surfaces, sight.view(i), execution));
    seen = sight.merge(visible, place, surfaces.primitive_count(), surfaces.bounds());
  }
  std::swap(scene_.meshes[0], piece.mesh);
  piece.mesh.material_ids = std::move(material_ids);
  Kept kept{place, {}, {}};
  for (std::uint32_t t = 0; t < seen.size(); ++t) {
    if (!seen[t]) continue;
    kept.triangles.push_back(t);
    append_triangle(piece.mesh, t, kept.mesh);
  }
  sight.keep(std::move(kept));
}

}  // namespace frontmost::streaming
