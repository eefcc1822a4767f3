// SPDX-License-Identifier: Apache-2.0
// One picture without clusters: parcels of triangles in the scene's order are put on the screen, sorted into tiles,
// and drawn, some hundred parcels at a time. What is seen is a minimum, so the picture may be taken up again for the
// next ones.

#include "zbuffer/direct/direct_frame.h"

#include <algorithm>
#include <cstring>
#include <memory>

#include "base/parallel.h"
#include "base/pool.h"
#include "zbuffer/cutout_pass.h"
#include "zbuffer/direct/parcel_kernel.h"
#include "zbuffer/record_lists.h"
#include "zbuffer/submission.h"

namespace frontmost::zbuffer_detail {
namespace {

// Half a million triangles; of a large scene at first fewer, so that those behind them need not be looked at.
constexpr std::size_t kParcelsAtOnce = 256, kParcelsAtFirst = 32, kFewParcels = 128;

/// Pieces [begin, end).
struct PieceRange {
  std::size_t begin, end;
};

/// Consecutive pieces that go into one parcel together: most scenes have a few large instances, some many small ones.
std::vector<PieceRange> parcels_of(std::span<const MeshRange> pieces) {
  std::vector<PieceRange> parcels;
  std::size_t count = Parcel::most_triangles;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::size_t more = pieces[i].count();
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

/// A parcel and how near it is. Slices are half as deep again as they are far: finer ones hide no more, and lose the
/// order of the file, which is that of memory.
struct Near {
  std::uint32_t slice, parcel;

  Near() = default;
  Near(float key, std::size_t number) : parcel(std::uint32_t(number)) {
    std::memcpy(&slice, &key, sizeof slice);
    slice >>= 22;  // the exponent and a bit
  }
};

class DirectFrame {
 public:
  DirectFrame(const PlacedScene& scene, const View& view, const Execution& execution)
      : scene_(scene),
        execution_(execution),
        cutouts_(scene.cutouts.get()),
        transform_(view),
        target_(transform_, view, execution.isa),
        visible_{view, Buffer<PrimitiveId>(view.sample_count()), Buffer<float>(view.sample_count())},
        is_drawn_(Tile::count(view), 0),
        farthest_(is_drawn_.size() * BlockBounds::count, 0.0f) {}

  Visible draw() {
    survey();
    std::size_t next = 0, at_once = order_.size() > kFewParcels ? kParcelsAtFirst : kParcelsAtOnce;
    do {
      const std::size_t count = std::min(at_once, order_.size() - next);
      place(std::span(order_).subspan(next, count));
      next += count;
      draw_placed(next == order_.size());
      report_progress(execution_, "visible", order_.empty() ? 1 : double(next) / double(order_.size()));
      at_once = kParcelsAtOnce;
    } while (next < order_.size());
    if (cutouts_) draw_cutouts(*cutouts_, cutout_records_, visible_, execution_);
    return std::move(visible_);
  }

 private:
  /// Parcels, and in which order to draw them: near ones first, as far as a few triangles of each tell.
  void survey() {
    constexpr std::size_t kGrain = 64;
    parcel_pieces_ = parcels_of(scene_.ranges);
    order_.resize(parcel_pieces_.size());
    parallel_for(execution_, order_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) order_[i] = Near(nearest_of(parcel_pieces_[i]), i);
    });
    std::sort(order_.begin(), order_.end(), [](const Near& a, const Near& b) {
      return a.slice != b.slice ? a.slice > b.slice : a.parcel < b.parcel;
    });
  }

  /// The greatest key of some triangles of a parcel; more than any where one is behind the eye.
  [[nodiscard]] float nearest_of(const PieceRange& pieces) const {
    constexpr std::size_t kTriangles = 4;
    float nearest = 0;
    for (std::size_t k = 0; k < kTriangles; ++k) {
      const MeshRange& piece =
          scene_.ranges[pieces.begin + (2 * k + 1) * (pieces.end - pieces.begin) / (2 * kTriangles)];
      const std::span<const glm::uvec3> corners = scene_.corners(piece);
      const glm::uvec3& triangle = corners[(2 * k + 1) * corners.size() / (2 * kTriangles)];
      const ToWorld world(scene_.scene->instances[piece.instance].world_from_mesh);
      const std::vector<glm::vec3>& positions = scene_.mesh(piece).positions;
      for (int c = 0; c < 3; ++c) {
        const HomogeneousVertex v = transform(transform_, world(positions[triangle[c]]));
        if (v.d < transform_.near) return 2;
        if (is_plain(transform_, v)) nearest = std::max(nearest, snap(transform_, v).key);
      }
    }
    return nearest;
  }

  /// False where blocks that were found to be nearer cover all of the piece, or nothing of it is on the screen.
  [[nodiscard]] bool may_be_seen(const PieceExtent& extent) const {
    // A negative key is a vertex with out codes: not seen where all of them have one, and one plane in common.
    if (!extent.all_plain) return extent.common >= 0 || (extent.common & kOutside) == 0;
    const View& view = visible_.view;
    const PixelRect rect{std::max(extent.low.x >> 8, 0), std::max(extent.low.y >> 8, 0),
                         std::min(extent.high.x >> 8, view.width - 1), std::min(extent.high.y >> 8, view.height - 1)};
    if (rect.x1 < rect.x0 || rect.y1 < rect.y0) return false;
    float nearest;
    std::memcpy(&nearest, &extent.nearest, sizeof nearest);
    const std::size_t across = Tile::tiles_across(view);
    for (int y = rect.y0 / kBlockSize; y <= rect.y1 / kBlockSize; ++y)
      for (int x = rect.x0 / kBlockSize; x <= rect.x1 / kBlockSize; ++x) {
        const std::size_t tile = std::size_t(y / 8) * across + std::size_t(x / 8);
        if (!(farthest_[tile * BlockBounds::count + std::size_t(y % 8 * 8 + x % 8)] > nearest)) return true;
      }
    return false;
  }

  void place_piece(const MeshRange& piece, ParcelScratch& scratch, Parcel& parcel) const {
    const WorldTriangles geometry = world_triangles(scene_, piece, scratch);
    const PieceExtent extent = snap_piece(target_, geometry, scratch.vertices);
    if (may_be_seen(extent)) place_in_parcel(target_, geometry, scratch.vertices, extent.all_plain, parcel);
  }

  void place(std::span<const Near> chosen) {
    if (parcels_.size() < chosen.size()) parcels_.resize(chosen.size());
    parallel_for(execution_, chosen.size(), 1, [&](std::size_t begin, std::size_t end) {
      const auto scratch = scratches_.borrow([] { return std::make_unique<ParcelScratch>(); });
      for (std::size_t i = begin; i < end; ++i) {
        const PieceRange& pieces = parcel_pieces_[chosen[i].parcel];
        parcels_[i].clear();
        for (std::size_t piece = pieces.begin; piece < pieces.end; ++piece)
          place_piece(scene_.ranges[piece], *scratch, parcels_[i]);
        if (!cutouts_) parcels_[i].bin(scratch->spare);
      }
    });
    sort_out(chosen.size());
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
          const ParcelJob job{Tile(tile, view),     records_.of(tile), parcel_lists_.of(tile),
                              is_drawn_[tile] != 0, is_last,           &farthest_[tile * BlockBounds::count]};
          if (job.is_empty() && (job.is_drawn || !is_last)) continue;
          draw_parcels(frame, job, *scratch, execution_.isa);
          is_drawn_[tile] = 1;
        }
      });
    }
  }

  const PlacedScene& scene_;
  const Execution& execution_;
  const Cutouts* cutouts_;
  ScreenTransform transform_;
  PlaceTarget target_;
  Visible visible_;
  std::vector<std::uint8_t> is_drawn_;  // by tile
  std::vector<float> farthest_;         // by tile and block: no sample of it is farther than this key
  std::vector<PieceRange> parcel_pieces_;
  std::vector<Near> order_;
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

Visible draw_directly(const PlacedScene& scene, const View& view, const Execution& execution) {
  return DirectFrame(scene, view, execution).draw();
}

}  // namespace frontmost::zbuffer_detail
