// SPDX-License-Identifier: Apache-2.0
// Visibles: whether one can be read, its depths, a hash that represents it in tests, and merging several by the
// z-buffer's own comparison, sample by sample:
//
//   (key, id) wins over (key', id')  where  key > key',  or  key == key' and id < id'
//
// The rule depends neither on order nor on repetition: parts of a scene may be merged in any order, or twice.
#include <algorithm>
#include <atomic>
#include <bit>
#include <string>

#include "base/parallel.h"
#include "base/word_hash.h"
#include "frontmost/view.h"
#include "view/answer.h"
#include "view/packed.h"

namespace frontmost {
namespace {

bool same_projection(const Projection& a, const Projection& b) {
  return a.orthographic == b.orthographic && a.left == b.left && a.right == b.right && a.bottom == b.bottom &&
         a.top == b.top && a.clip.near == b.clip.near && a.clip.far == b.clip.far;
}

bool same_view(const View& a, const View& b) {
  // Compared to the bit, because keys of views that differ in the last place cannot be compared.
  return a.width == b.width && a.height == b.height && a.samples == b.samples && a.world_from_eye == b.world_from_eye &&
         a.culling == b.culling && same_projection(a.projection, b.projection);
}

constexpr std::size_t samples_at_once = 1u << 16;

[[noreturn]] void fail_too_many(const char* who) {
  throw Error(ErrorCode::limit_exceeded, who, "more than 4294967294 triangles, the most that ids can number");
}

/// Merges a run of samples, without branches, so that the compiler uses vectors. \returns the greatest new id.
std::uint64_t merge_run(Visible& into, const Visible& other, PrimitiveId first_id, std::size_t begin, std::size_t end) {
  PrimitiveId* ids = into.primitives.data();
  float* keys = into.keys.data();
  const PrimitiveId* other_ids = other.primitives.data();
  const float* other_keys = other.keys.data();
  PrimitiveId greatest = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const bool is_seen = other_ids[i] != no_primitive;
    greatest = std::max(greatest, is_seen ? other_ids[i] : 0u);
    const PrimitiveId id = is_seen ? other_ids[i] + first_id : no_primitive;
    // Bitwise, not logical: both sides are cheap, and a branch is not.
    const bool wins = (other_keys[i] > keys[i]) | ((other_keys[i] == keys[i]) & (id < ids[i]));
    ids[i] = wins ? id : ids[i];
    keys[i] = wins ? other_keys[i] : keys[i];
  }
  return std::uint64_t(greatest) + first_id;
}

}  // namespace

void check_planes(const Visible& visible, const char* who) {
  const std::size_t count = visible.view.sample_count();
  if (visible.primitives.size() != count || visible.keys.size() != count)
    throw Error(ErrorCode::bad_argument, std::string(who), "the arrays do not match the size of their view");
}

void check_ids(std::span<const PrimitiveId> ids, std::uint32_t primitive_count, const char* who,
               const Execution& execution) {
  std::atomic<bool> is_of_others{false};
  constexpr std::size_t ids_at_once = 1u << 17;
  parallel_for(execution, ids.size(), ids_at_once, [&](std::size_t begin, std::size_t end) {
    // Each id is compared plus one, so that no_primitive becomes the least: one maximum suffices, without a branch.
    std::uint32_t most = 0;
    for (std::size_t i = begin; i < end; ++i) most = std::max(most, ids[i] + 1);
    if (most > primitive_count) is_of_others = true;
  });
  if (is_of_others) throw Error(ErrorCode::bad_argument, std::string(who), "the surfaces are not those of the Visible");
}

void check_answer(const Visible& visible, std::uint32_t primitive_count, const char* who, const Execution& execution) {
  check_planes(visible, who);
  check_ids({visible.primitives.data(), visible.primitives.size()}, primitive_count, who, execution);
}

float depth_of_key(const View& view, float key) {
  const ClipDistances& clip = view.projection.clip;
  if (view.projection.orthographic) return float(clip.far - double(key) * (clip.far - clip.near));
  // Kernels divide the near plane as a float by the distance, so the same float recovers the distance here.
  return key > 0 ? float(double(float(clip.near)) / double(key)) : std::numeric_limits<float>::infinity();
}

Buffer<float> depths_of(const Visible& visible) {
  check_planes(visible, "depths_of");
  Buffer<float> depth(visible.keys.size());
  for (std::size_t i = 0; i < depth.size(); ++i)
    depth[i] = visible.primitives[i] == no_primitive ? std::numeric_limits<float>::infinity()
                                                     : depth_of_key(visible.view, visible.keys[i]);
  return depth;
}

std::uint64_t content_hash(const Visible& visible) {
  WordHash hash;
  hash.add(std::uint64_t(visible.view.width));
  hash.add(std::uint64_t(visible.view.height));
  hash.add(std::uint64_t(visible.view.samples));
  for (std::size_t i = 0; i < visible.keys.size(); ++i) {
    // The bits, not the number: two pictures are equal only to the last bit.
    hash.add(std::uint64_t(bits_as<std::uint32_t>(visible.keys[i])) << 32 | visible.primitives[i]);
  }
  return hash.value();
}

Visible nothing_visible(const View& view) {
  validate(view);
  const std::size_t count = view.sample_count();
  return {view, Buffer<PrimitiveId>(count, no_primitive), Buffer<float>(count, 0.0f)};
}

void merge(Visible& into, const Visible& other, PrimitiveId first_id, const Execution& execution) {
  if (!same_view(into.view, other.view))
    throw Error(ErrorCode::bad_argument, "merge", "the two views are not the same");
  check_planes(into, "merge");
  check_planes(other, "merge");
  // Whether ids run out is tested once a run instead of at every sample. An error is rare, and the merged samples are
  // lost then anyway.
  std::atomic<bool> is_full{false};
  parallel_for(execution, into.keys.size(), samples_at_once, [&](std::size_t begin, std::size_t end) {
    if (merge_run(into, other, first_id, begin, end) >= no_primitive) is_full = true;
  });
  if (is_full) fail_too_many("merge");
}

Buffer<std::uint64_t> pack(const Visible& visible, PrimitiveId first_id, const Execution& execution) {
  check_planes(visible, "pack");
  Buffer<std::uint64_t> packed(visible.keys.size());
  std::atomic<bool> is_full{false};
  parallel_for(execution, packed.size(), samples_at_once, [&](std::size_t begin, std::size_t end) {
    std::uint64_t greatest = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const PrimitiveId id = visible.primitives[i];
      greatest = std::max(greatest, id == no_primitive ? 0 : std::uint64_t(id) + first_id);
      packed[i] = packed_sample(id == no_primitive ? id : id + first_id, visible.keys[i]);
    }
    if (greatest >= no_primitive) is_full = true;
  });
  if (is_full) fail_too_many("pack");
  return packed;
}

Visible unpack(const View& view, std::span<const std::uint64_t> packed, const Execution& execution) {
  validate(view);
  if (packed.size() != view.sample_count())
    throw Error(ErrorCode::bad_argument, "unpack",
                "the number of packed values is not the number of samples of the view");
  Visible visible{view, Buffer<PrimitiveId>(packed.size()), Buffer<float>(packed.size())};
  std::atomic<bool> is_wrong{false};
  parallel_for(execution, packed.size(), samples_at_once, [&](std::size_t begin, std::size_t end) {
    constexpr std::uint32_t bits_of_one = 0x3F800000u;  // bits of floats in [0, 1] are ordered like the floats
    std::uint32_t greatest = 0;
    for (std::size_t i = begin; i < end; ++i) {
      greatest = std::max(greatest, std::uint32_t(packed[i] >> 32));
      unpack_sample(packed[i], visible.primitives[i], visible.keys[i]);
    }
    if (greatest > bits_of_one) is_wrong = true;
  });
  if (is_wrong) throw Error(ErrorCode::bad_argument, "unpack", "a key is not between 0 and 1");
  return visible;
}

namespace {

bool is_mixed(const Visible& visible, int x, int y) {
  const PrimitiveId first = visible.primitives[visible.index(x, y)];
  for (int s = 1; s < visible.view.samples; ++s)
    if (visible.primitives[visible.index(x, y, s)] != first) return true;
  return false;
}

/// Whether the samples of all mixed pixels lie within `others`, and no mixed pixel lies outside of the picture.
bool has_all_others(const VisiblePixels& pixels) {
  const int width = pixels.view.width, across = int(pixels.runs_across());
  const std::size_t each = std::size_t(pixels.view.samples - 1);
  for (std::size_t number = 0; number < pixels.mixed.size(); ++number) {
    const std::uint32_t mixed = pixels.mixed[number];
    if (mixed == 0) continue;
    const int left = int(number % std::size_t(across)) * VisiblePixels::run;
    const std::size_t end = pixels.places[number] + std::size_t(std::popcount(mixed)) * each;
    if (int(std::bit_width(mixed)) > width - left || end > pixels.other_count) return false;
  }
  return true;
}

}  // namespace

VisiblePixels undefined_pixels(const View& view) {
  validate(view);
  VisiblePixels pixels;
  pixels.view = pixels.first.view = view;
  pixels.first.view.samples = 1;
  const std::size_t count = view.pixel_count(), runs = pixels.runs_across() * std::size_t(view.height);
  pixels.first.primitives = Buffer<PrimitiveId>(count);
  pixels.first.keys = Buffer<float>(count);
  pixels.mixed = Buffer<std::uint16_t>(runs);
  pixels.places = Buffer<std::uint32_t>(runs);
  pixels.others = Buffer<PrimitiveId>(count * std::size_t(view.samples - 1));
  return pixels;
}

VisiblePixels pixels_of(const Visible& visible) {
  check_planes(visible, "pixels_of");
  const View& view = visible.view;
  VisiblePixels pixels = undefined_pixels(view);
  std::copy_n(visible.primitives.begin(), view.pixel_count(), pixels.first.primitives.begin());
  std::copy_n(visible.keys.begin(), view.pixel_count(), pixels.first.keys.begin());
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const std::size_t number = std::size_t(y) * pixels.runs_across() + std::size_t(x / VisiblePixels::run);
      if (x % VisiblePixels::run == 0) {
        pixels.mixed[number] = 0;
        pixels.places[number] = std::uint32_t(pixels.other_count);
      }
      if (!is_mixed(visible, x, y)) continue;
      pixels.mixed[number] = std::uint16_t(pixels.mixed[number] | 1u << x % VisiblePixels::run);
      for (int s = 1; s < view.samples; ++s)
        pixels.others[pixels.other_count++] = visible.primitives[visible.index(x, y, s)];
    }
  return pixels;
}

void check_answer(const VisiblePixels& pixels, std::uint32_t primitive_count, const char* who,
                  const Execution& execution) {
  check_answer(pixels.first, primitive_count, who, execution);
  const View &view = pixels.view, &first = pixels.first.view;
  const std::size_t runs = pixels.runs_across() * std::size_t(view.height);
  if (view.width != first.width || view.height != first.height || first.samples != 1 || pixels.mixed.size() != runs ||
      pixels.places.size() != runs || pixels.others.size() < pixels.other_count)
    throw Error(ErrorCode::bad_argument, std::string(who), "the arrays do not match the size of their view");
  if (!has_all_others(pixels))
    throw Error(ErrorCode::bad_argument, std::string(who), "a mixed pixel lies outside the picture or lacks samples");
  check_ids({pixels.others.data(), pixels.other_count}, primitive_count, who, execution);
}

}  // namespace frontmost
