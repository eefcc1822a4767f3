// SPDX-License-Identifier: Apache-2.0
// One picture without clusters: parcels of triangles in the scene's order are put on the screen, sorted into tiles,
// and drawn, some hundred parcels at a time. What is seen is a minimum, so the picture may be taken up again for the
// next ones.

#include "zbuffer/direct_frame.h"

#include <algorithm>
#include <memory>

#include "base/parallel.h"
#include "base/pool.h"
#include "zbuffer/cutout_pass.h"
#include "zbuffer/parcel_kernel.h"
#include "zbuffer/record_lists.h"
#include "zbuffer/submission.h"

namespace frontmost::zbuffer_detail {
namespace {

constexpr std::size_t kParcelsAtOnce = 256;  // half a million triangles

std::vector<PrimitiveId> first_primitives_of(const Scene& scene) {
  std::vector<PrimitiveId> first{0};
  for (const Instance& instance : scene.instances)
    first.push_back(first.back() + PrimitiveId(scene.meshes[instance.mesh].triangles.size()));
  return first;
}

/// Pieces [begin, end).
struct PieceRange {
  std::size_t begin, end;
};

/// Consecutive pieces that go into one parcel together: most scenes have a few large instances, some many small ones.
std::vector<PieceRange> parcels_of(std::span<const Piece> pieces) {
  std::vector<PieceRange> parcels;
  std::size_t count = Parcel::most_triangles;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::size_t more = pieces[i].end - pieces[i].begin;
    if (count + more > Parcel::most_triangles) {
      parcels.push_back({i, i});
      count = 0;
    }
    count += more;
    parcels.back().end = i + 1;
  }
  return parcels;
}

/// What filling a parcel needs of memory, one a thread.
struct ParcelScratch : PlaceScratch {
  Buffer<ParcelColumns> spare{1};
};

class DirectFrame {
 public:
  DirectFrame(const Scene& scene, const View& view, const Execution& execution)
      : scene_(scene),
        execution_(execution),
        first_primitives_(first_primitives_of(scene)),
        cutouts_(Cutouts::of(scene, first_primitives_)),
        transform_(view),
        target_(transform_, view, execution.isa),
        visible_{view, Buffer<PrimitiveId>(view.sample_count()), Buffer<float>(view.sample_count())},
        is_drawn_(Tile::count(view), 0) {}

  Visible draw() {
    const std::vector<Piece> pieces =
        pieces_of(scene_, first_primitives_, {0, first_primitives_.back()}, std::uint32_t(Parcel::most_triangles));
    const std::vector<PieceRange> parcels = parcels_of(pieces);
    parcels_.resize(std::min(parcels.size(), kParcelsAtOnce));
    for (std::size_t first = 0; first < parcels.size() || first == 0; first += kParcelsAtOnce) {
      const std::size_t end = std::min(parcels.size(), first + kParcelsAtOnce);
      place(pieces, std::span(parcels).subspan(first, end - first));
      draw_placed(end == parcels.size());
      if (!parcels.empty()) report_progress(execution_, "visible", double(end) / double(parcels.size()));
    }
    if (cutouts_) draw_cutouts(*cutouts_, cutout_records_, visible_, execution_);
    return std::move(visible_);
  }

 private:
  void place(std::span<const Piece> pieces, std::span<const PieceRange> parcels) {
    parallel_for(execution_, parcels.size(), 1, [&](std::size_t begin, std::size_t end) {
      const auto scratch = scratches_.borrow([] { return std::make_unique<ParcelScratch>(); });
      for (std::size_t i = begin; i < end; ++i) {
        parcels_[i].clear();
        for (std::size_t piece = parcels[i].begin; piece < parcels[i].end; ++piece)
          place_in_parcel(target_, geometry_of(scene_, pieces[piece], execution_.isa, *scratch), scratch->vertices,
                          parcels_[i]);
        if (!cutouts_) parcels_[i].bin(scratch->spare);
      }
    });
    sort_out(parcels.size());
  }

  /// What was placed, by kind, near things first.
  void sort_out(std::size_t count) {
    records_.records.clear();
    nearest_first_.clear();
    for (std::size_t i = 0; i < count; ++i) {
      Parcel& parcel = parcels_[i];
      if (cutouts_) {
        parcel.extract([&](PrimitiveId id) { return cutouts_->has(id); }, cutout_records_);
        parcel.bin(spare_);
      }
      records_.records.insert(records_.records.end(), parcel.records.begin(), parcel.records.end());
      if (parcel.count > 0) nearest_first_.push_back(&parcel);
    }
    std::sort(nearest_first_.begin(), nearest_first_.end(),
              [](const Parcel* a, const Parcel* b) { return a->nearest > b->nearest; });
    records_.plan(visible_.view);
    list_parcels();
  }

  void list_parcels() {
    const std::size_t across = Tile::tiles_across(visible_.view);
    parcel_lists_.make({0, is_drawn_.size()}, nearest_first_.size(), [&](std::size_t i, const auto& add) {
      const Parcel& parcel = *nearest_first_[i];
      const TileRect tiles = parcel.tiles();
      for (int y = tiles.y0; y <= tiles.y1; ++y)
        for (int x = tiles.x0; x <= tiles.x1; ++x)
          if (!parcel.in_tile(x, y).empty()) add(std::size_t(y) * across + std::size_t(x));
    });
  }

  /// `is_last`: nothing comes after it, so what is still empty stays so.
  void draw_placed(bool is_last) {
    const View& view = visible_.view;
    // As in zbuffer.cpp: memory that is touched for the first time.
    const bool streams = view.sample_count() * (sizeof(PrimitiveId) + sizeof(float)) >= std::size_t(32) << 20;
    const Picture picture{view, sample_offsets(view.samples), visible_.primitives.data(), visible_.keys.data(),
                          streams};
    const ParcelFrame frame{picture, nearest_first_, records_.records};
    for (const TileRange& round : records_.rounds()) {
      records_.list(round, view);
      parallel_for(execution_, round.end - round.begin, 1, [&](std::size_t begin, std::size_t end) {
        const auto scratch = tile_scratches_.borrow([] { return std::make_unique<TileScratch>(); });
        scratch->reserve(frame.samples.size());
        for (std::size_t tile = round.begin + begin; tile < round.begin + end; ++tile) {
          const ParcelJob job{Tile(tile, view), records_.of(tile), parcel_lists_.of(tile), is_drawn_[tile] != 0};
          if (job.is_empty() && (job.is_drawn || !is_last)) continue;
          draw_parcels(frame, job, *scratch, execution_.isa);
          is_drawn_[tile] = 1;
        }
      });
    }
  }

  const Scene& scene_;
  const Execution& execution_;
  std::vector<PrimitiveId> first_primitives_;  // by instance, and the total at the end
  std::shared_ptr<const Cutouts> cutouts_;
  ScreenTransform transform_;
  PlaceTarget target_;
  Visible visible_;
  std::vector<std::uint8_t> is_drawn_;  // by tile
  // Of the parcels that are placed.
  std::vector<Parcel> parcels_;
  std::vector<const Parcel*> nearest_first_;
  RecordLists records_;
  TileLists parcel_lists_;
  std::vector<TriangleRecord> cutout_records_;  // of all so far
  Buffer<ParcelColumns> spare_{1};
  Pool<ParcelScratch> scratches_;
  Pool<TileScratch> tile_scratches_;
};

}  // namespace

Visible draw_directly(const Scene& scene, const View& view, const Execution& execution) {
  return DirectFrame(scene, view, execution).draw();
}

}  // namespace frontmost::zbuffer_detail
