// SPDX-License-Identifier: Apache-2.0
#include "shade/tile.h"

#include <algorithm>

#include "base/memory.h"
#include "base/parallel.h"
#include "shade/canvas/canvas.h"

namespace frontmost::shading {
namespace {

/// A fragment's number is the number of its pixel, in the low kPixelBits. If a block of 2 x 2 pixels shares a fragment,
/// the number is that of the block's first pixel, and the next four bits say which pixels share the fragment.
constexpr std::uint32_t kPixelBits = 16;
constexpr std::uint32_t kWholeBlock = 15u << kPixelBits;
static_assert(tile_pixels <= 1 << kPixelBits);
static_assert(tile_width % 2 == 0 && tile_height % 2 == 0, "blocks lie within tiles");

}  // namespace

void TileWork::begin(const ShadedLayer& layer, const Colorist& colorist, ShadingRate rate, Isa isa) {
  visible_ = &layer.visible;
  rate_ = rate;
  mixed_ = layer.pixels;
  samples_ = layer.use == SampleUse::first ? 1 : layer.view().samples;
  const auto all = sample_offsets(layer.view().samples);
  centre_ = glm::vec2(0);
  for (std::size_t s = 0; s < std::size_t(samples_); ++s) {
    offsets_[s] = glm::vec2(all[s]) / 256.0f;
    centre_ += offsets_[s] / float(samples_);
  }
  fragments_.begin(layer.source, colorist, isa);
}

bool TileWork::shade(const TileRectangle& tile) {
  fragments_.clear();
  width_ = tile.width;
  bool anything = false;
  for (int y = 0; y < tile.height; ++y) {
    look_at_row({tile.x, tile.y + y}, tile.width, rows_[y]);
    anything = anything || !rows_[y].is_empty;
  }
  if (!anything) return false;
  // Most of a picture is background, so nothing is cleared before a fragment is found.
  std::fill(pixels_.begin(), pixels_.end(), glm::vec4(0));
  // Fragments are added strip by strip, so that a batch lies close together on the surface. This helps rays that are
  // cast together.
  constexpr int strip = FragmentShader::strip;
  const bool is_coarse = rate_ == ShadingRate::each_2x2;
  for (int left = 0; left < tile.width; left += strip) {
    const int right = std::min(left + strip, tile.width);
    for (int y = 0; y < tile.height; y += is_coarse ? 2 : 1)
      is_coarse ? add_blocks(tile, y, left, right) : add_pixels(tile, y, left, right);
  }
  flush();
  return true;
}

void TileWork::fade(float opacity) {
  for (glm::vec4& pixel : pixels_) pixel *= opacity;
}

void TileWork::look_at_row(const glm::ivec2& at, int width, Row& row) const {
  const std::size_t begin = visible_->index(at.x, at.y);
  // Prefetches the same row of the next tile: the stride of rows is too long for the hardware prefetcher.
  constexpr int line = 64 / sizeof(PrimitiveId);
  const PrimitiveId* plane = visible_->primitives.data() + begin;
  for (int x = 0; x < tile_width; x += line) prefetch_line(plane + tile_width + x);
  PrimitiveId all = no_primitive;
  for (int x = 0; x < width; ++x) {
    row.first[x] = plane[x];
    row.differing[x] = 0;
    all &= plane[x];
  }
  row.is_empty = all == no_primitive;
  mixed_ ? find_mixed(at, width, row) : compare_planes(begin, width, row);
}

void TileWork::compare_planes(std::size_t begin, int width, Row& row) const {
  constexpr int line = 64 / sizeof(PrimitiveId);
  const PrimitiveId* plane = visible_->primitives.data() + begin;
  PrimitiveId all = no_primitive;
  for (int s = 1; s < samples_; ++s) {
    plane += visible_->view.pixel_count();
    for (int x = 0; x < tile_width; x += line) prefetch_line(plane + tile_width + x);
    for (int x = 0; x < width; ++x) {
      row.differing[x] |= plane[x] ^ row.first[x];
      all &= plane[x];
    }
  }
  row.is_empty = row.is_empty && all == no_primitive;
}

void TileWork::find_mixed(const glm::ivec2& at, int width, Row& row) const {
  constexpr int run = VisiblePixels::run;
  static_assert(tile_width % run == 0);
  std::size_t number = std::size_t(at.y) * mixed_->runs_across() + std::size_t(at.x / run);
  for (int begin = 0; begin < width; begin += run, ++number) {
    const unsigned mixed = mixed_->mixed[number];
    if (mixed == 0) continue;
    row.is_empty = false;
    row.others[begin / run] = mixed_->others.data() + mixed_->places[number];
    for (int x = begin; x < std::min(begin + run, width); ++x) row.differing[x] = mixed >> (x - begin) & 1u;
  }
}

void TileWork::list_ids(const TileRectangle& tile, int x, int y, PrimitiveId* ids) {
  ids[0] = rows_[y].first[x];
  if (mixed_) {
    const PrimitiveId*& others = rows_[y].others[x / VisiblePixels::run];
    for (int s = 1; s < samples_; ++s) ids[s] = *others++;
  } else {
    for (int s = 1; s < samples_; ++s) ids[s] = visible_->primitives[visible_->index(tile.x + x, tile.y + y, s)];
  }
}

void TileWork::add_pixels(const TileRectangle& tile, int y, int left, int right) {
  const Row& row = rows_[y];
  if (row.is_empty) return;
  for (int x = left; x < right;) {
    const int begin = x;
    while (x < right && row.differing[x] == 0) ++x;
    if (x > begin) {
      if (!fragments_.has_room_for_strip()) flush();
      const glm::vec2 screen = glm::vec2(float(tile.x + begin), float(tile.y + y)) + centre_;
      fragments_.add_strip(row.first + begin, x - begin,
                           {std::uint32_t(y * tile.width + begin), screen, all_samples(), 1.0f});
    }
    for (; x < right && row.differing[x] != 0; ++x) add_mixed_pixel(tile, x, y);
  }
}

void TileWork::add_row(PrimitiveId id, int count, FragmentShader::RowStart start) {
  while (count > 0) {
    if (fragments_.is_full()) flush();
    const int part = std::min(count, fragments_.room());
    fragments_.add_row(id, part, start);
    start.number += std::uint32_t(start.step * part);
    start.screen.x += float(start.step * part);
    count -= part;
  }
}

void TileWork::add_mixed_pixel(const TileRectangle& tile, int x, int y) {
  PrimitiveId ids[16];
  list_ids(tile, x, y, ids);
  const glm::vec2 corner(float(tile.x + x), float(tile.y + y));
  unsigned done = 0;
  for (int s = 0; s < samples_; ++s) {
    if (ids[s] == no_primitive || (done >> s) & 1) continue;
    glm::vec2 sum(0);
    unsigned own = 0;
    float count = 0;
    for (int other = s; other < samples_; ++other)
      if (ids[other] == ids[s]) {
        sum += offsets_[std::size_t(other)];
        own |= 1u << other;
        ++count;
      }
    done |= own;
    if (fragments_.is_full()) flush();
    fragments_.add(ids[s], std::uint32_t(y * tile.width + x), corner + sum / count, own, count / float(samples_));
  }
}

void TileWork::add_blocks(const TileRectangle& tile, int y, int left, int right) {
  if (rows_[y].is_empty && (y + 1 == tile.height || rows_[y + 1].is_empty)) return;
  for (int x = left; x < right;) {
    const glm::vec2 corner(float(tile.x + x), float(tile.y + y));
    const auto pixel = std::uint32_t(y * tile.width + x);
    const int whole = y + 1 < tile.height ? whole_blocks(y, x, right) : 0;
    if (whole > 0) {
      const PrimitiveId id = rows_[y].first[x];
      if (id != no_primitive) add_row(id, whole, {pixel | kWholeBlock, corner + centre_, all_samples(), 1.0f, 2});
      x += 2 * whole;
      continue;
    }
    PrimitiveId ids[4];
    for (int p = 0; p < 4; ++p) {
      const int column = x + p % 2, row = y + p / 2;
      ids[p] = no_primitive;
      if (column >= tile.width || row >= tile.height) continue;
      if (rows_[row].differing[column] != 0)
        add_mixed_pixel(tile, column, row);
      else
        ids[p] = rows_[row].first[column];
    }
    add_shared(ids, corner, pixel);
    x += 2;
  }
}

int TileWork::whole_blocks(int y, int x, int right) const {
  const Row &upper = rows_[y], &lower = rows_[y + 1];
  const PrimitiveId id = upper.first[x];
  const int begin = x;
  for (; x + 1 < right; x += 2) {
    const PrimitiveId others =
        (upper.first[x] ^ id) | (upper.first[x + 1] ^ id) | (lower.first[x] ^ id) | (lower.first[x + 1] ^ id);
    const PrimitiveId mixed = upper.differing[x] | upper.differing[x + 1] | lower.differing[x] | lower.differing[x + 1];
    if ((others | mixed) != 0) break;
  }
  return (x - begin) / 2;
}

void TileWork::add_shared(PrimitiveId (&ids)[4], glm::vec2 corner, std::uint32_t pixel) {
  for (int p = 0; p < 4; ++p) {
    const PrimitiveId id = ids[p];
    if (id == no_primitive) continue;
    std::uint32_t sharing = 0;
    for (int other = p; other < 4; ++other) {
      if (ids[other] != id) continue;
      sharing |= 1u << other;
      ids[other] = no_primitive;
    }
    const glm::vec2 first = corner + glm::vec2(float(p % 2), float(p / 2));
    add_row(id, 1, {pixel | sharing << kPixelBits, first + centre_, all_samples(), 1.0f});
  }
}

void TileWork::flush() {
  // A pixel's fragments arrive in the order of its samples, so its sum does not depend on the neighbours.
  fragments_.hand_out([this](const FragmentShader::Shaded& s) {
    const glm::vec4 color(s.light * (s.weight * s.alpha), s.weight * s.alpha);
    const std::uint32_t pixel = s.number & ((1u << kPixelBits) - 1), sharing = s.number >> kPixelBits;
    if (sharing == 0) return void(pixels_[pixel] += color);
    for (std::uint32_t p = 0; p < 4; ++p)
      if (sharing >> p & 1) pixels_[pixel + p / 2 * std::uint32_t(width_) + p % 2] += color;
  });
}

void shade_part(const TileRectangle& part, const ShadedLayer& layer, const Painting& painting, Pool<TileWork>& works,
                Isa isa) {
  const auto work = works.borrow([] { return std::make_unique<TileWork>(); });
  work->begin(layer, painting.colorist, painting.rate, isa);
  for (int y = 0; y < part.height; y += tile_height)
    for (int x = 0; x < part.width; x += tile_width) {
      const TileRectangle tile{part.x + x, part.y + y, std::min(tile_width, part.width - x),
                               std::min(tile_height, part.height - y)};
      if (!work->shade(tile)) {
        painting.canvas.fill(tile, painting.background);
        continue;
      }
      if (painting.opacity != 1.0f) work->fade(painting.opacity);
      painting.canvas.write(tile, work->pixels(), painting.background);
    }
}

void shade_tiles(const ShadedLayer& layer, const Painting& painting, Pool<TileWork>& works,
                 const Execution& execution) {
  const View& view = layer.view();
  const auto rows = std::size_t((view.height + tile_height - 1) / tile_height);
  parallel_for(execution, rows, 1, [&](std::size_t begin, std::size_t end) {
    const int y = int(begin) * tile_height, below = std::min(int(end) * tile_height, view.height);
    shade_part({0, y, view.width, below - y}, layer, painting, works, execution.isa);
  });
}

}  // namespace frontmost::shading
