// SPDX-License-Identifier: Apache-2.0
// The A-buffer: all fragments that a pixel sees, in order of depth, with the part of the pixel that each covers.
//
// L. Carpenter. The A-buffer, an Antialiased Hidden Surface Method. SIGGRAPH 1984.
#pragma once

#include <span>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/view.h"

namespace frontmost {

struct AbufferOptions {
  /// Sub-samples of a pixel. 0: the view's samples (View::samples, at sample_offsets()); n = 2, 4 or 8: a regular grid
  /// of n rows and n columns.
  int grid = 0;
  /// 0 to 1: multiplies every opacity. If it is below 1, nothing is opaque, so all fragments are kept.
  float opacity = 1.0f;
};

/// The part of one triangle that lies in one pixel.
struct Fragment {
  /// Bit s is set if sub-sample s is covered; at least one bit is set. Grids are numbered row by row from the top left.
  std::uint64_t mask = 0;
  PrimitiveId primitive = no_primitive;
  float key = 0;                 ///< key at the pixel's centre, limited to the triangle's keys; as in Visible::keys
  float key_dx = 0, key_dy = 0;  ///< change of the key per pixel to the right and down
  float opacity = 1;             ///< opacity of the material without its texture, times AbufferOptions::opacity
};

/// The fragments of every pixel, ordered by their keys at the pixel's centre, nearer first; at equal keys, the lower id
/// first. Fragments that lie wholly behind an opaque one covering the whole pixel are left out. If 64 x 64 pixels have
/// more than 2^18 fragments, coincident triangles of higher id than an opaque one are left out as well. A clipped
/// triangle may have several fragments in a pixel, with disjoint masks.
struct FragmentLists {
  View view;
  std::vector<glm::ivec2> samples;  ///< by bit: position in 1/256 pixel from the pixel's top left corner
  Buffer<std::uint64_t> first;      ///< index of each pixel's first fragment, row by row, and the total at the end
  std::vector<Fragment> fragments;

  [[nodiscard]] std::span<const Fragment> at(int x, int y) const {
    const std::size_t pixel = std::size_t(y) * std::size_t(view.width) + std::size_t(x);
    return std::span(fragments).subspan(first[pixel], first[pixel + 1] - first[pixel]);
  }
};

/// The most fragments that abuffer() returns: 2^30, 32 GiB. In every function here, a pixel has at most 2^20 - 1. A
/// function processes at most 2^28 fragments plus 1,024 per triangle, or 64 per pixel if that is more, and never more
/// than 2^30. The number of fragments is estimated from the areas of triangles before gathering, and includes hidden
/// ones. Of coincident opaque triangles only the lowest id counts. Other coincident triangles all count, except that
/// visible_layers() counts only as many as there are layers. count_fragments() counts every triangle.
inline constexpr std::uint64_t most_fragments = std::uint64_t(1) << 30;

/// \returns all fragments of a view. They take 32 bytes each, and twice that during the call. O(triangles + n log^2 n
/// for lists of n fragments). The bytes do not depend on threads or instruction set, nor, except at equal keys, on the
/// order of triangles.
/// \throws Error as validate(view) does, bad_argument for options out of range, limit_exceeded beyond the limits above.
[[nodiscard]] FragmentLists abuffer(const Surfaces& surfaces, const View& view, const AbufferOptions& options = {},
                                    const Execution& execution = {});

/// Numbers of fragments that the A-buffer processes for a view.
struct FragmentCounts {
  std::uint64_t fragments = 0;  ///< fragments of all pixels, including those behind opaque ones
  std::uint32_t longest = 0;    ///< greatest number of fragments in one pixel
};

/// Counts fragments without storing them: the depth complexity of a picture, and an upper bound for abuffer().
/// `options.opacity` is ignored. O(triangles + fragments), in 10 to 20 megabytes a thread.
/// \throws Error as abuffer() does.
[[nodiscard]] FragmentCounts count_fragments(const Surfaces& surfaces, const View& view,
                                             const AbufferOptions& options = {}, const Execution& execution = {});

/// \returns the first `count` layers at the view's samples. Layer k holds, at every sample, the k-th nearest primitive
/// by its key there; nothing is seen behind an opaque primitive. The nearest layer equals zbuffer()'s answer to the
/// bit; shade() shows the others with SeeThrough::never. `options.grid` is ignored. Memory: `count` Visibles and a few
/// megabytes a thread.
/// \throws Error as abuffer() does; bad_argument unless `count` is 1 to 1024.
[[nodiscard]] std::vector<Visible> visible_layers(const Surfaces& surfaces, const View& view, int count,
                                                  const AbufferOptions& options = {}, const Execution& execution = {});

}  // namespace frontmost
