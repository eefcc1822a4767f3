// SPDX-License-Identifier: Apache-2.0
// The z-buffer: visibility by rasterisation into tiles.
//
//   triangles --place--> snapped to 1/256 pixel, sorted into the tiles that they touch --draw--> each tile by itself
//
// Each tile is drawn by one thread, within the processor's cache. A tile keeps the nearest key of each sample and, at
// equal keys, the lower id. Its result therefore does not depend on the order of triangles. (E. Catmull. A Subdivision
// Algorithm for Computer Display of Curved Surfaces. 1974.)
#pragma once

#include <memory>

#include "frontmost/scene.h"
#include "frontmost/view.h"

namespace frontmost {

/// The front-most triangle at every sample. Vertices are snapped to 1/256 pixel; coverage is exact by the top-left
/// rule. Depth keys are interpolated in screen space, where they are affine; at equal keys the lower id wins. The
/// result is the same to the bit for any number of threads and any instruction set. O(triangles + covered samples)
/// time; 8 bytes a sample for the result.
/// Surfaces without clusters are drawn from the scene's own arrays, up to ten times as fast as building clusters and
/// drawing those. For several pictures use a ZBuffer, or call Surfaces::make_clusters() first.
/// \throws Error as validate(view) does.
[[nodiscard]] Visible zbuffer(const Surfaces& surfaces, const View& view, const Execution& execution = {});

/// The z-buffer for repeated views. It draws from the surfaces' clusters, which the first frame builds if they are
/// missing. Later frames reuse memory and allocate nothing unless a frame needs more. A ZBuffer may not be used by
/// several threads at once; each draw() runs on the threads it is given.
class ZBuffer {
 public:
  ZBuffer();
  ~ZBuffer();
  ZBuffer(ZBuffer&&) noexcept;
  ZBuffer& operator=(ZBuffer&&) noexcept;
  ZBuffer(const ZBuffer&) = delete;
  ZBuffer& operator=(const ZBuffer&) = delete;

  /// \returns what zbuffer() returns, valid until the next draw() or take(); unspecified after an error.
  /// \throws Error as validate(view) does.
  const Visible& draw(const Surfaces& surfaces, const View& view, const Execution& execution = {});
  /// Moves the last result out. The next draw() allocates planes again, unless some are given back.
  [[nodiscard]] Visible take();
  /// Hands planes of any size to the next draw(), which reuses them if they fit.
  void give_back(Visible&& planes);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The result of zbuffer() as VisiblePixels, for shade() with several samples. It takes 8 bytes a pixel, and 4 more for
/// each further sample of mixed pixels.
[[nodiscard]] VisiblePixels zbuffer_pixels(const Surfaces& surfaces, const View& view, const Execution& execution = {});

// DepthBuffer: a depth buffer with OpenGL's state: comparison function, mask, clear value, range, polygon offset,
// format.
//
// M. Segal, K. Akeley. The OpenGL Graphics System: A Specification, version 4.6 core. 13.8 (depth range), 14.6.5 (depth
// offset), 17.3.4 (depth test), 17.4.3 (clearing), 2.3.5 (fixed point).
//
// Coverage, facing and keys are those of zbuffer(). The difference is which of several triangles a sample keeps: the
// DepthBuffer draws triangles strictly in the order of their ids, and the state decides. Use a DepthBuffer if order,
// format or state matters; zbuffer() is the fast way to the nearest surface.

/// Storage of depths: unsigned integers of n bits, meaning value / (2^n - 1), or a 32-bit float.
enum class DepthFormat : std::uint8_t { d8, d16, d24, f32 };

/// Comparison that lets a fragment pass: the fragment's depth is compared with the stored one, by GL_NEVER to
/// GL_ALWAYS.
enum class DepthFunc : std::uint8_t { never, less, equal, less_equal, greater, not_equal, greater_equal, always };

/// Rounds a depth to `format`. Integers: the nearest multiple of 1 / (2^n - 1), ties to even, after clamping to [0, 1].
/// f32: the bits of the nearest float, not clamped. Precondition: not NaN.
[[nodiscard]] std::uint32_t stored_depth(DepthFormat format, double depth);
/// The depth that stored bits stand for.
[[nodiscard]] double depth_of_stored(DepthFormat format, std::uint32_t stored);
/// Number of bits of an integer format; 0 for f32.
[[nodiscard]] int integer_bits(DepthFormat format);

/// glPolygonOffset and glPolygonOffsetClamp: adds m * factor + r * units to a triangle's depths. `clamp` limits the sum
/// from above if positive, from below if negative, and not at all if 0. m is the greater of |dz/dx| and |dz/dy| in
/// pixels, found for each piece of a clipped triangle. r is one step, 1 / (2^n - 1), for integers. For floats r is 2^(e
/// - 23), with the exponent e of the greatest depth in the triangle's visible part. Magnitudes up to 1e30.
struct PolygonOffset {
  double factor = 0, units = 0, clamp = 0;
};

/// The state that decides which fragments pass. The defaults are OpenGL's.
struct DepthState {
  DepthFunc func = DepthFunc::less;
  bool mask = true;                      ///< passing fragments store their depth; false: they are only seen
  double range_near = 0, range_far = 1;  ///< glDepthRange: 0 to 1 each, in either order
  /// False: near maps to range_near and far to range_far (opengl_depth with OpenGL's clip volume, zero_to_one_depth
  /// with Direct3D's). True: the reverse (gortler_depth, reversed_depth); compare with `greater` and clear to 0.
  bool nearer_is_greater = false;
  PolygonOffset offset = {};
};

/// One draw call.
struct DepthDraw {
  DepthState state = {};
  PrimitiveId begin = 0, end = no_primitive;  ///< primitives to draw; an end beyond the last counts as the last
  PrimitiveId id_offset = 0;                  ///< added to stored ids, to tell several surfaces apart
};

/// Depth, primitive and key for every sample, kept between draw calls and owned by the caller. 12 bytes a sample.
///
/// A fragment's depth is n + (f - n) * u in double, for the depth range [n, f]. u runs from 0 at the near plane to 1 at
/// the far plane (or the reverse) and is affine in the sample's key of zbuffer(). The depth is limited to the depth
/// range, offset, limited to [0, 1], and then rounded once, to the format. With f32, nearer_is_greater and an infinite
/// far plane, the stored depth is thus the key. There is no depth clamping as in OpenGL: the view's near and far planes
/// always clip.
class DepthBuffer {
 public:
  /// Clears to 1.
  /// \throws Error bad_argument or limit_exceeded, as validate(view) does for size and samples.
  DepthBuffer(int width, int height, int samples = 1, DepthFormat format = DepthFormat::d24);

  /// Forgets all primitives and stores `depth` everywhere, rounded, and clamped to [0, 1] for integer formats.
  /// \throws Error bad_argument if `depth` is not finite.
  void clear(double depth = 1);

  /// Draws primitives in the order of their ids, over the result of earlier calls. The result is the same to the bit
  /// for any number of threads and any instruction set. A cancelled call leaves some of its triangles drawn.
  /// O(triangles + covered samples); up to 256 MiB while it runs.
  /// \throws Error as validate(view) does; bad_argument for a view of another size, for state out of range, and for ids
  /// beyond no_primitive - 1.
  void draw(const Surfaces& surfaces, const View& view, const DepthDraw& call = {}, const Execution& execution = {});

  [[nodiscard]] DepthFormat format() const { return format_; }
  /// Stored bits, in the order of Visible.
  [[nodiscard]] const Buffer<std::uint32_t>& stored() const { return stored_; }
  /// The depth at every sample as a float, as glReadPixels returns it for GL_DEPTH_COMPONENT.
  [[nodiscard]] Buffer<float> depths() const;
  /// The primitive of the last fragment that passed since the last clear, and its key, neither rounded nor offset;
  /// no_primitive and 0 where none has passed. `view` is that of the draw calls.
  [[nodiscard]] Visible visible(const View& view) const&;
  [[nodiscard]] Visible visible(const View& view) &&;

 private:
  int width_, height_, samples_;
  DepthFormat format_;
  Buffer<std::uint32_t> stored_;
  Buffer<PrimitiveId> primitives_;
  Buffer<float> keys_;
};

}  // namespace frontmost
