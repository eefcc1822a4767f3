// SPDX-License-Identifier: Apache-2.0
// Reading a picture: each thread reads bands of rows and makes runs and tallies of what they show.
//
// A band has tallies only of objects that it shows, so a million objects of which few are seen cost nothing. Sums are
// of integers, so the order in which bands are added does not matter.

#include "report/accounting/seen_objects.h"

#include <memory>

#include "base/parallel.h"
#include "base/pool.h"
#include "surfaces/placed_scene.h"

namespace frontmost::accounting_detail {
namespace {

/// The tallies of one band, by object.
class TallyList {
 public:
  explicit TallyList(std::size_t object_count) : places_(object_count, 0) {}

  [[nodiscard]] SeenTally& of(std::uint32_t object) {
    std::uint32_t& place = places_[object];
    if (place == 0) {
      tallies_.push_back({.object = object, .rect = {1 << 30, 1 << 30, -1, -1}});
      place = std::uint32_t(tallies_.size());
    }
    return tallies_[place - 1];
  }
  /// Returns the tallies and empties the list.
  [[nodiscard]] std::vector<SeenTally> take() {
    for (const SeenTally& tally : tallies_) places_[tally.object] = 0;
    return std::exchange(tallies_, {});
  }

 private:
  std::vector<std::uint32_t> places_;  // by object: index into `tallies_` plus 1; 0 if it has none
  std::vector<SeenTally> tallies_;
};

/// The ids of one object, or no_primitive.
struct ObjectIds {
  std::uint32_t object = no_index;
  PrimitiveId first = no_primitive;
  std::uint32_t count = 1;
};

class BandReader {
 public:
  BandReader(const Surfaces& surfaces, const Visible& visible, const glm::ivec2& margin, Isa isa)
      : first_primitives_(placed_scene(surfaces).first_primitives),
        visible_(visible),
        left_(margin.x % kWordPixels),
        isa_(isa) {}

  [[nodiscard]] SeenRows read(int sample, int y0, int y1, TallyList& tallies, std::uint64_t& background) const {
    const View& view = visible_.view;
    SeenRows rows(std::size_t(left_ + view.width + kWordPixels - 1) / kWordPixels);
    for (int y = y0; y < y1; ++y) {
      const std::size_t first = visible_.index(0, y, sample);
      const PrimitiveId* const ids = visible_.primitives.data() + first;
      const float* const keys = visible_.keys.data() + first;
      for (int x = 0; x < view.width;) {
        const ObjectIds seen = object_of(ids[x]);
        const SeenSpan span = find_seen_span({ids + x, ids + view.width}, keys + x, seen.first, seen.count, isa_);
        const PixelRect run{x, y, x + int(span.end) - 1, y};
        x = run.x1 + 1;
        rows.append(left_ + run.x0, left_ + x, seen.object);
        if (seen.object == no_index)
          background += span.end;
        else
          tallies.of(seen.object).add(tally_of(run, seen.object, span.nearest, sample));
      }
      rows.end_row();
    }
    return rows;
  }

 private:
  [[nodiscard]] ObjectIds object_of(PrimitiveId id) const {
    if (id == no_primitive) return {};
    const auto next = std::upper_bound(first_primitives_.begin(), first_primitives_.end(), id);
    const PrimitiveId first = *std::prev(next);
    return {std::uint32_t(next - first_primitives_.begin() - 1), first, *next - first};
  }

  /// The tally of a run of pixels in one row.
  [[nodiscard]] SeenTally tally_of(const PixelRect& run, std::uint32_t object, float nearest, int sample) const {
    const glm::ivec2 offset = sample_offsets(visible_.view.samples)[std::size_t(sample)];
    const auto count = std::uint64_t(run.x1 - run.x0 + 1);
    // The sum of both ends is twice the middle, in half pixels.
    const std::uint64_t sum_x =
        count * std::uint64_t(run.x0 + run.x1) * (kSubPixels / 2) + count * std::uint64_t(offset.x);
    const std::uint64_t sum_y = count * std::uint64_t(run.y0 * kSubPixels + offset.y);
    return {object, count, run, nearest, sum_x, sum_y};
  }

  const std::vector<PrimitiveId>& first_primitives_;
  const Visible& visible_;
  int left_;  // index of the picture's first pixel in its word
  Isa isa_;
};

}  // namespace

void SeenRows::append(int x0, int x1, std::uint32_t object) {
  while (x0 < x1) {
    const int word = x0 / kWordPixels, end = std::min(x1, (word + 1) * kWordPixels);
    runs_.push_back({object, std::uint8_t(x0 % kWordPixels), std::uint8_t(end - 1 - word * kWordPixels)});
    if (end == (word + 1) * kWordPixels) close_words(row_count_ * words_across_ + std::size_t(word) + 1);
    x0 = end;
  }
}

void SeenTally::add(const SeenTally& other) {
  count += other.count;
  rect = {std::min(rect.x0, other.rect.x0), std::min(rect.y0, other.rect.y0), std::max(rect.x1, other.rect.x1),
          std::max(rect.y1, other.rect.y1)};
  nearest = std::max(nearest, other.nearest);
  sum_x += other.sum_x;
  sum_y += other.sum_y;
}

SeenObjects find_seen_objects(const Surfaces& surfaces, const Visible& visible, const glm::ivec2& margin,
                              const Execution& execution) {
  const View& view = visible.view;
  const std::size_t object_count = surfaces.scene().instances.size();
  const auto bands = std::size_t(view.height + SeenObjects::rows_in_band - 1) / SeenObjects::rows_in_band;
  SeenObjects seen;
  seen.margin = margin;
  seen.bands_in_sample = bands;
  const std::size_t count = bands * std::size_t(view.samples);
  seen.bands.assign(count, SeenRows(1));
  std::vector<std::vector<SeenTally>> tallies(count);
  std::vector<std::uint64_t> background(count, 0);
  Pool<TallyList> lists;
  const BandReader reader(surfaces, visible, margin, execution.isa);
  parallel_for(execution, count, 1, [&](std::size_t begin, std::size_t end) {
    const auto list = lists.borrow([&] { return std::make_unique<TallyList>(object_count); });
    for (std::size_t i = begin; i < end; ++i) {
      const int y = int(i % bands) * SeenObjects::rows_in_band;
      const int last = std::min(y + SeenObjects::rows_in_band, view.height);
      seen.bands[i] = reader.read(int(i / bands), y, last, *list, background[i]);
      tallies[i] = list->take();
    }
  });
  TallyList all(object_count);
  for (std::size_t i = 0; i < count; ++i) {
    seen.background += background[i];
    for (const SeenTally& tally : tallies[i]) all.of(tally.object).add(tally);
  }
  seen.tallies = all.take();
  return seen;
}

}  // namespace frontmost::accounting_detail
