// SPDX-License-Identifier: Apache-2.0
// The z-buffer: visibility by rasterisation into tiles.
//
//   triangles --place--> snapped to 1/256 pixel, sorted into the tiles that they touch --draw--> each tile by itself
//
// A tile is drawn by one thread, in the processor's cache. What it shows is the nearest key of each sample, and
// at equal keys the lower id, which is the same in whatever order its triangles come.
// (E. Catmull. A Subdivision Algorithm for Computer Display of Curved Surfaces. 1974.)
#pragma once

#include <memory>

#include "frontmost/scene.h"
#include "frontmost/view.h"

namespace frontmost {

/// The front-most triangle at every sample. Vertices are snapped to 1/256 pixel, coverage is exact by the top-left
/// rule, depth keys are interpolated in screen space, where they are affine; at equal keys the lower id wins.
/// The result is the same to the bit for any number of threads and any instruction set.
/// O(triangles + covered samples) time; 8 bytes a sample for the result. The first two pictures of surfaces that have
/// no clusters yet are drawn from the scene's own arrays: up to ten times as fast as clusters and a picture of them,
/// wherever a scene is shown once or twice. The third makes the clusters; for many pictures take a ZBuffer.
/// \throws Error as validate(view) does.
[[nodiscard]] Visible zbuffer(const Surfaces& surfaces, const View& view, const Execution& execution = {});

/// The same for repeated views, from the surfaces' clusters, which the first frame makes where they are not there yet.
/// Frames after the first reuse the memory of those before, and allocate nothing as long as no frame needs more. Not
/// for several threads at once; each draw() uses the threads it is given.
class ZBuffer {
 public:
  ZBuffer();
  ~ZBuffer();
  ZBuffer(ZBuffer&&) noexcept;
  ZBuffer& operator=(ZBuffer&&) noexcept;
  ZBuffer(const ZBuffer&) = delete;
  ZBuffer& operator=(const ZBuffer&) = delete;

  /// What zbuffer() gives. The result stays as it is until the next draw() or take(); after an error it is unspecified.
  /// \throws Error as validate(view) does.
  const Visible& draw(const Surfaces& surfaces, const View& view, const Execution& execution = {});
  /// Moves the last result out; the next draw() allocates another, unless one is given back.
  [[nodiscard]] Visible take();
  /// Planes of whatever size, for the next draw() to use again where they fit.
  void give_back(Visible&& planes);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What zbuffer() gives, by pixels, for shade() of pictures with several samples: 8 bytes a pixel and, where its
/// samples see different primitives, 4 for each but the first. Like zbuffer(), counts as one of the first two pictures.
[[nodiscard]] VisiblePixels zbuffer_pixels(const Surfaces& surfaces, const View& view, const Execution& execution = {});

// The depth buffer as OpenGL's users know it: comparison function, mask, clear value, range, polygon offset, formats.
//
// M. Segal, K. Akeley. The OpenGL Graphics System: A Specification, version 4.6 core. 13.8 (depth range), 14.6.5 (depth
// offset), 17.3.4 (depth test), 17.4.3 (clearing), 2.3.5 (fixed point).
//
// Coverage, facing and keys are those of zbuffer(); what differs is which of several triangles a sample keeps. Here
// they are drawn strictly in the order of their ids, and the state decides. Beside it zbuffer() stays the fast way to
// the nearest surface: use this where order, format or state is the question.

/// How depths are stored: unsigned integers of n bits that mean value / (2^n - 1), or a 32-bit float.
enum class DepthFormat : std::uint8_t { d8, d16, d24, f32 };

/// When a fragment passes, comparing its depth with the stored one; in the order of GL_NEVER to GL_ALWAYS.
enum class DepthFunc : std::uint8_t { never, less, equal, less_equal, greater, not_equal, greater_equal, always };

/// The rounding of a depth to what `format` stores: the nearest multiple of 1 / (2^n - 1), ties to the even one, after
/// clamping to [0, 1]; or the bits of the nearest float, not clamped. Precondition: not NaN.
[[nodiscard]] std::uint32_t stored_depth(DepthFormat format, double depth);
/// The depth that stored bits mean.
[[nodiscard]] double depth_of_stored(DepthFormat format, std::uint32_t stored);
/// The number of bits of an integer format; 0 for f32.
[[nodiscard]] int integer_bits(DepthFormat format);

/// glPolygonOffset and glPolygonOffsetClamp: m * factor + r * units is added to a triangle's depths, limited by `clamp`
/// from above (positive) or below (negative); 0: not at all. m is the greater of |dz/dx| and |dz/dy| in pixels, found
/// for each piece of a clipped triangle. r is 1 / (2^n - 1), one step, for integers; for floats 2^(e - 23), e being the
/// exponent of the greatest depth in the triangle's visible part. Magnitudes up to 1e30.
struct PolygonOffset {
  double factor = 0, units = 0, clamp = 0;
};

/// The state that decides about fragments; the defaults are OpenGL's.
struct DepthState {
  DepthFunc func = DepthFunc::less;
  bool mask = true;                      ///< passing fragments store their depth; they are seen either way
  double range_near = 0, range_far = 1;  ///< glDepthRange: 0 to 1 each, in any order
  /// False: the near plane maps to range_near, the far one to range_far (opengl_depth with OpenGL's clip volume,
  /// zero_to_one_depth with Direct3D's). True: the other way round (gortler_depth, reversed_depth); compare with
  /// greater and clear to 0.
  bool nearer_is_greater = false;
  PolygonOffset offset = {};
};

/// One draw call.
struct DepthDraw {
  DepthState state = {};
  PrimitiveId begin = 0, end = no_primitive;  ///< which primitives; an end beyond the last is the last
  PrimitiveId id_offset = 0;  ///< added to the ids that are kept, so that several surfaces can be told apart
};

/// Depth, primitive and key for every sample, kept between draw calls; the caller owns it. 12 bytes a sample.
///
/// The depth of a fragment is n + (f - n) * u in double, u from 0 at the near plane to 1 at the far plane (or back),
/// affine in the key that zbuffer() finds at the sample: limited to the depth range, offset, limited to [0, 1], then
/// rounded once, to the format. So with f32, nearer_is_greater and an infinite far plane the stored depth is the key.
/// Unlike OpenGL there is no depth clamping: the view's near and far planes always clip.
class DepthBuffer {
 public:
  /// Cleared to 1. \throws Error bad_argument or limit_exceeded, as validate(view) does for size and samples.
  DepthBuffer(int width, int height, int samples = 1, DepthFormat format = DepthFormat::d24);

  /// Forgets what was seen and stores `depth` everywhere: rounded, and for integer formats clamped to [0, 1].
  /// \throws Error bad_argument when it is not finite.
  void clear(double depth = 1);

  /// Draws primitives in the order of their ids; calls follow one another. The result is the same to the bit for any
  /// number of threads and any instruction set. O(triangles + covered samples); up to 256 MiB while it runs.
  /// A call that ends by an Error of ErrorCode::cancelled leaves some of its triangles drawn.
  /// \throws Error as validate(view) does; bad_argument for a view of another size, and for state out of range.
  void draw(const Surfaces& surfaces, const View& view, const DepthDraw& call = {}, const Execution& execution = {});

  [[nodiscard]] DepthFormat format() const { return format_; }
  /// Stored bits, in the order of Visible.
  [[nodiscard]] const Buffer<std::uint32_t>& stored() const { return stored_; }
  /// What glReadPixels gives for GL_DEPTH_COMPONENT: the depth at every sample, as float.
  [[nodiscard]] Buffer<float> depths() const;
  /// The primitive of the last fragment that passed, and its key (not rounded to the format, not offset). no_primitive
  /// and 0 where none has since the last clear. `view`: of the draw calls.
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
