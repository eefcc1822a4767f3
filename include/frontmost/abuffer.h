// SPDX-License-Identifier: Apache-2.0
// The A-buffer: everything that a pixel sees, in the order of depth, with how much of the pixel each covers.
//
// L. Carpenter. The A-buffer, an Antialiased Hidden Surface Method. SIGGRAPH 1984.
#pragma once

#include <span>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/view.h"

namespace frontmost {

struct AbufferOptions {
  /// Sub-samples of a pixel: 0 takes the view's own (View::samples, at sample_offsets()); 2, 4 or 8 a regular grid of
  /// that many by as many.
  int grid = 0;
  /// Multiplies the opacity of everything, 0 to 1. Below 1 nothing is opaque, so nothing is cut off.
  float opacity = 1.0f;
};

/// What one triangle shows in one pixel.
struct Fragment {
  /// Bit s: sub-sample s is covered. Grids are numbered row by row from the top left. Never 0.
  std::uint64_t mask = 0;
  PrimitiveId primitive = no_primitive;
  float key = 0;                 ///< at the pixel's centre, within the triangle's range; as Visible::keys
  float key_dx = 0, key_dy = 0;  ///< change of the key per pixel to the right and down
  float opacity = 1;             ///< of the material without its texture, times AbufferOptions::opacity
};

/// The fragments of every pixel, nearer first; at equal keys of the centre the lower id is first. What lies wholly
/// behind an opaque fragment that covers the whole pixel is left out, and where there are more than 2^18 in 64 x 64
/// pixels, copies of an opaque triangle, which its lower id hides. A triangle that had to be clipped may come in
/// several pieces, whose masks are disjoint.
struct FragmentLists {
  View view;
  std::vector<glm::ivec2> samples;  ///< positions of the mask's bits in 1/256 pixel from the pixel's top left corner
  Buffer<std::uint64_t> first;      ///< by pixel, row by row, where its list begins; and the end of the last
  std::vector<Fragment> fragments;

  [[nodiscard]] std::span<const Fragment> at(int x, int y) const {
    const std::size_t pixel = std::size_t(y) * std::size_t(view.width) + std::size_t(x);
    return std::span(fragments).subspan(first[pixel], first[pixel + 1] - first[pixel]);
  }
};

/// The most fragments that abuffer() returns: 2^30, 32 GiB. A pixel has at most 2^20 - 1 in every function here.
/// Functions go through at most 2^28 fragments and 1,024 more for each triangle, 2^30 in all; or 64 for each pixel, if
/// that is more. Hidden fragments count. How many there are is estimated by the areas of the triangles, before they are
/// gathered. Of opaque triangles at one place the lowest id alone counts, for visible_layers() of others as many as
/// there are layers, and for count_fragments() all.
inline constexpr std::uint64_t most_fragments = std::uint64_t(1) << 30;

/// All fragments of a view as data: 32 bytes each, twice that while it works.
/// O(triangles + n log^2 n for lists of n fragments). The bytes depend on neither threads, instruction set, nor the
/// order of triangles, but for equal keys.
/// \throws Error as validate(view) does, bad_argument for options out of range, limit_exceeded over the limits above.
[[nodiscard]] FragmentLists abuffer(const Surfaces& surfaces, const View& view, const AbufferOptions& options = {},
                                    const Execution& execution = {});

/// What the A-buffer goes through for a view.
struct FragmentCounts {
  std::uint64_t fragments = 0;  ///< of all pixels, those behind opaque ones too
  std::uint32_t longest = 0;    ///< the most of one pixel
};

/// Counts without keeping: what a picture's depth complexity is, and before abuffer() is called an upper bound of its
/// fragments. O(triangles + fragments), in 10 to 20 megabytes a thread. `options.opacity` has no meaning here.
/// \throws Error as abuffer() does.
[[nodiscard]] FragmentCounts count_fragments(const Surfaces& surfaces, const View& view,
                                             const AbufferOptions& options = {}, const Execution& execution = {});

/// The first `count` layers, nearest first, at the view's samples: the k-th holds the k-th nearest primitive at every
/// sample, by the key there. Behind an opaque primitive nothing is seen. The nearest layer is what zbuffer() gives, to
/// the bit; shade() shows the others with SeeThrough::never. Memory: `count` Visibles and a few megabytes a thread.
/// `options.grid` has no meaning here.
/// \throws Error as abuffer() does; bad_argument unless `count` is 1 to 1024.
[[nodiscard]] std::vector<Visible> visible_layers(const Surfaces& surfaces, const View& view, int count,
                                                  const AbufferOptions& options = {}, const Execution& execution = {});

}  // namespace frontmost
