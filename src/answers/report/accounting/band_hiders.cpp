// SPDX-License-Identifier: Apache-2.0
// All hiding pairs of objects. The picture is divided into bands of rows; in each band the nearest keys of every object
// are compared with those of all others.
//
//    band       32 rows of the picture
//    column     64 pixels of a band: each object there has a word for each row, and its keys
//
// In most columns one of two objects lies wholly in front of the other. The common bits of their words are then
// counted, without comparing keys.
#include <algorithm>
#include <bit>
#include <memory>

#include "base/parallel.h"
#include "base/pool.h"
#include "report/accounting/object_mask.h"
#include "view/triangle_keys.h"

namespace frontmost::accounting_detail {

using namespace zbuffer_detail;

namespace {

constexpr int kBandRows = 32;
constexpr float kNotCovered = -1;  // keys are 0 and more

/// The part of a column that one object covers.
struct HiderPiece {
  std::uint32_t object;
  int x0, x1;  ///< pixels of the column, both inclusive
  int y0, y1;  ///< rows of the band
  float nearest, farthest;
  std::size_t words, keys;  ///< first word and key of row y0; a row has one word, and a key for each x from x0 to x1
};

/// The keys of the nearest and the second nearest surface at a sample, and their objects.
struct FrontTwo {
  float nearest, next;
  std::uint32_t nearest_object, next_object;
};

/// Sorts pairs and merges equal ones, adding their counts.
void combine(std::vector<HiddenSamples>& pairs) {
  std::sort(pairs.begin(), pairs.end(), [](const HiddenSamples& a, const HiddenSamples& b) {
    return a.object != b.object ? a.object < b.object : a.hider < b.hider;
  });
  std::size_t count = 0;
  for (const HiddenSamples& pair : pairs) {
    if (count > 0 && pairs[count - 1].object == pair.object && pairs[count - 1].hider == pair.hider)
      pairs[count - 1].count += pair.count;
    else
      pairs[count++] = pair;
  }
  pairs.resize(count);
}

/// Finds the hiding pairs of one band after another. For one thread; borrows everything.
class BandHiders {
 public:
  BandHiders(const PlacedScene& scene, const ObjectCanvas& canvas, std::span<const ObjectAccount> objects, Isa isa)
      : scene_(scene),
        canvas_(canvas),
        objects_(objects),
        isa_(isa),
        placer_(scene, canvas, isa),
        plane_(std::size_t(canvas.view.width) * kBandRows, kNotCovered),
        columns_(std::size_t(canvas.view.width + kWordPixels - 1) / kWordPixels),
        fronts_(std::size_t(kBandRows) * kWordPixels) {}

  /// Adds the hidden samples of one sample number in the band that begins at row y0.
  void find(std::size_t sample, int y0, HiderLists& lists) {
    offset_ = sample_offsets(canvas_.view.samples)[sample];
    band_ = {0, y0, canvas_.view.width - 1, std::min(y0 + kBandRows, canvas_.view.height) - 1};
    words_.clear();
    keys_.clear();
    for (std::vector<HiderPiece>& column : columns_) column.clear();
    for (std::uint32_t i = 0; i < objects_.size(); ++i) {
      const PixelBox& box = objects_[i].in_frame.box;
      const PixelRect rect = common_part({box.x, box.y, box.x + box.width - 1, box.y + box.height - 1}, band_);
      if (!box.is_empty() && !rect.is_empty()) add_object(i, rect);
    }
    HiderLists found;
    for (const std::vector<HiderPiece>& column : columns_) {
      compare_pieces(column, found.any);
      find_fronts(column, found.only);
    }
    combine(found.any);
    combine(found.only);
    lists.any.insert(lists.any.end(), found.any.begin(), found.any.end());
    lists.only.insert(lists.only.end(), found.only.begin(), found.only.end());
  }

 private:
  void add_object(std::uint32_t object, const PixelRect& rect) {
    for (const MeshRange& range : ranges_of(scene_, object))
      placer_.visit(range, [&](const TriangleRecord& record) { draw(record, rect); });
    for (int word = rect.x0 / kWordPixels; word <= rect.x1 / kWordPixels; ++word) add_piece(object, word, rect);
    for (int y = rect.y0; y <= rect.y1; ++y) std::fill(key_at(rect.x0, y), key_at(rect.x1, y) + 1, kNotCovered);
  }

  void draw(const TriangleRecord& record, const PixelRect& rect) {
    const MaskPlane plane{nullptr, 0, canvas_.view.width, canvas_.view.height, 0, offset_};
    find_spans(plane, record, spans_, isa_);
    std::optional<ScreenCutout> cutout;
    if (scene_.cutouts && scene_.cutouts->has(record.id)) cutout.emplace((*scene_.cutouts)[record.id], canvas_.rays);
    const KeyPlane gentle(record);
    const SteepKeys steep = gentle.is_steep ? SteepKeys(record) : SteepKeys();
    const int last = std::min(spans_.first + spans_.count - 1, rect.y1);
    for (int y = std::max(spans_.first, rect.y0); y <= last; ++y) {
      const auto row = std::size_t(y - spans_.first);
      const int x0 = std::max(spans_.begin[row], rect.x0), x1 = std::min(spans_.end[row], rect.x1 + 1);
      if (cutout)
        draw_row(x0, x1, y, [&](int x, int at_y) {
          const float key = gentle.is_steep ? steep.at(x, at_y) : gentle.at(x, at_y);
          return cutout->is_hole(x, at_y) ? kNotCovered : key;
        });
      else if (gentle.is_steep)
        draw_row(x0, x1, y, [&](int x, int at_y) { return steep.at(x, at_y); });
      else
        draw_row(x0, x1, y, [&](int x, int at_y) { return gentle.at(x, at_y); });
    }
  }

  /// `key_of(x, y)` returns the key at a position in 1/256 pixel.
  template <class KeyOf>
  void draw_row(int x0, int x1, int y, const KeyOf& key_of) {
    if (x0 >= x1) return;
    float* const row = key_at(x0, y);
    const int at_y = y * kSubPixels + offset_.y, first = x0 * kSubPixels + offset_.x;
    for (int i = 0; i < x1 - x0; ++i) row[i] = std::max(row[i], key_of(first + i * kSubPixels, at_y));
  }

  /// Copies the part of an object in one column from the plane.
  void add_piece(std::uint32_t object, int word, const PixelRect& rect) {
    HiderPiece piece{object,
                     std::max(rect.x0 - word * kWordPixels, 0),
                     std::min(rect.x1 - word * kWordPixels, kWordPixels - 1),
                     rect.y0 - band_.y0,
                     rect.y1 - band_.y0,
                     0,
                     std::numeric_limits<float>::infinity(),
                     words_.size(),
                     keys_.size()};
    bool is_empty = true;
    for (int y = rect.y0; y <= rect.y1; ++y) {
      const float* const row = key_at(word * kWordPixels, y);
      keys_.insert(keys_.end(), row + piece.x0, row + piece.x1 + 1);
      std::uint64_t bits = 0;
      for (int x = piece.x0; x <= piece.x1; ++x) {
        if (row[x] == kNotCovered) continue;
        bits |= std::uint64_t(1) << x;
        piece.nearest = std::max(piece.nearest, row[x]);
        piece.farthest = std::min(piece.farthest, row[x]);
      }
      words_.push_back(bits);
      is_empty = is_empty && bits == 0;
    }
    if (!is_empty) {
      columns_[std::size_t(word)].push_back(piece);
      return;
    }
    words_.resize(piece.words);
    keys_.resize(piece.keys);
  }

  void compare_pieces(const std::vector<HiderPiece>& column, std::vector<HiddenSamples>& any) const {
    for (std::size_t i = 0; i < column.size(); ++i)
      for (std::size_t k = i + 1; k < column.size(); ++k) {
        const HiderPiece &a = column[i], &b = column[k];  // at equal keys a, with the lower number, is in front
        const int y0 = std::max(a.y0, b.y0), y1 = std::min(a.y1, b.y1);
        if (y1 < y0) continue;
        const std::span<const std::uint64_t> of_a = words_from(a, y0, y1), of_b = words_from(b, y0, y1);
        std::uint64_t hidden_b = 0, hidden_a = 0;
        if (a.farthest >= b.nearest)
          hidden_b = count_common(of_a, of_b, isa_);
        else if (b.farthest > a.nearest)
          hidden_a = count_common(of_a, of_b, isa_);
        else
          for (int y = y0; y <= y1; ++y) {
            const float *const keys_a = keys_from(a, y), *const keys_b = keys_from(b, y);
            for (std::uint64_t bits = of_a[std::size_t(y - y0)] & of_b[std::size_t(y - y0)]; bits != 0;
                 bits &= bits - 1) {
              const int x = std::countr_zero(bits);
              ++(keys_a[x - a.x0] >= keys_b[x - b.x0] ? hidden_b : hidden_a);
            }
          }
        if (hidden_b > 0) any.push_back({b.object, a.object, hidden_b});
        if (hidden_a > 0) any.push_back({a.object, b.object, hidden_a});
      }
  }

  void find_fronts(const std::vector<HiderPiece>& column, std::vector<HiddenSamples>& only) {
    if (column.size() < 2) return;
    std::fill(fronts_.begin(), fronts_.end(), FrontTwo{kNotCovered, kNotCovered, no_index, no_index});
    for (const HiderPiece& piece : column)
      for (int y = piece.y0; y <= piece.y1; ++y) {
        const float* const keys = keys_from(piece, y);
        for (std::uint64_t bits = words_from(piece, y, y)[0]; bits != 0; bits &= bits - 1) {
          const int x = std::countr_zero(bits);
          FrontTwo& front = fronts_[std::size_t(y * kWordPixels + x)];
          const float key = keys[x - piece.x0];
          if (key > front.nearest)
            front = {key, front.nearest, piece.object, front.nearest_object};
          else if (key > front.next)
            front.next = key, front.next_object = piece.object;
        }
      }
    for (const FrontTwo& front : fronts_) {
      if (front.next_object == no_index) continue;
      if (!only.empty() && only.back().object == front.next_object && only.back().hider == front.nearest_object)
        ++only.back().count;
      else
        only.push_back({front.next_object, front.nearest_object, 1});
    }
  }

  [[nodiscard]] float* key_at(int x, int y) {
    return plane_.data() + std::size_t(y - band_.y0) * std::size_t(canvas_.view.width) + std::size_t(x);
  }
  [[nodiscard]] std::span<const std::uint64_t> words_from(const HiderPiece& piece, int y0, int y1) const {
    return std::span(words_).subspan(piece.words + std::size_t(y0 - piece.y0), std::size_t(y1 - y0 + 1));
  }
  [[nodiscard]] const float* keys_from(const HiderPiece& piece, int y) const {
    return keys_.data() + piece.keys + std::size_t(y - piece.y0) * std::size_t(piece.x1 - piece.x0 + 1);
  }

  const PlacedScene& scene_;
  const ObjectCanvas& canvas_;
  std::span<const ObjectAccount> objects_;
  Isa isa_;
  RecordPlacer placer_;
  Buffer<float> plane_;  // nearest keys of one object in the band
  std::vector<std::vector<HiderPiece>> columns_;
  std::vector<std::uint64_t> words_;
  std::vector<float> keys_;
  std::vector<FrontTwo> fronts_;
  RowSpans spans_;
  glm::ivec2 offset_{0};
  PixelRect band_{0, 0, -1, -1};
};

}  // namespace

HiderLists find_all_hiders(const PlacedScene& scene, const ObjectCanvas& canvas, std::span<const ObjectAccount> objects,
                           const Execution& execution) {
  const auto bands = std::size_t(canvas.view.height + kBandRows - 1) / kBandRows;
  const std::size_t count = bands * std::size_t(canvas.view.samples);
  std::vector<HiderLists> parts(count);
  Pool<BandHiders> finders;
  parallel_for(execution, count, 1, [&](std::size_t begin, std::size_t end) {
    const auto finder =
        finders.borrow([&] { return std::make_unique<BandHiders>(scene, canvas, objects, execution.isa); });
    for (std::size_t i = begin; i < end; ++i) finder->find(i / bands, int(i % bands) * kBandRows, parts[i]);
  });
  HiderLists lists;
  for (const HiderLists& part : parts) {
    lists.any.insert(lists.any.end(), part.any.begin(), part.any.end());
    lists.only.insert(lists.only.end(), part.only.begin(), part.only.end());
  }
  combine(lists.any);
  combine(lists.only);
  return lists;
}

}  // namespace frontmost::accounting_detail
