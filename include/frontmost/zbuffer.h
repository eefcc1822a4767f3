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

#include "frontmost/surfaces.h"
#include "frontmost/view.h"
#include "frontmost/visible.h"
#include "frontmost/visible_pixels.h"

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

}  // namespace frontmost
