// SPDX-License-Identifier: Apache-2.0
// Other programs that answer the same question: what is seen at every pixel centre of a view.
#pragma once

#include <frontmost/frontmost.h>

#include <memory>
#include <vector>

namespace frontmost::bench {

/// What a peer saw, top row first.
struct PeerImage {
  std::vector<PrimitiveId> primitives;  ///< no_primitive where nothing is seen
  std::vector<float> depths;            ///< planar distance, or what make_*() says
};

class Peer {
 public:
  virtual ~Peer() = default;
  /// One frame: clear, draw ids and depth, wait until it is finished. Nothing is read back.
  virtual void draw() = 0;
};

/// A rasteriser that says where it puts vertices.
class RasterPeer : public Peer {
 public:
  /// The last frame.
  [[nodiscard]] virtual PeerImage read() = 0;
  /// Every vertex before the divide, from the very shader that draws. y runs down, as in the picture.
  [[nodiscard]] virtual std::vector<glm::vec4> clip_positions() const = 0;
};

/// A ray caster that answers single rays too, one after another on one thread.
class RayPeer : public Peer {
 public:
  /// The last frame.
  [[nodiscard]] virtual PeerImage read() = 0;
  /// Builds its hierarchy anew.
  virtual void rebuild() = 0;
  /// What the hierarchy takes beside the mesh.
  [[nodiscard]] virtual std::size_t byte_count() const = 0;
  /// How many rays meet something, the nearest of which is found.
  virtual std::size_t count_hits(const std::vector<Ray>& rays) = 0;
  /// How many segments are blocked, by whatever is found first.
  virtual std::size_t count_blocked(const std::vector<Segment>& segments) = 0;
};

/// Draws everything translucent, layer by layer.
class PeelingPeer : public Peer {
 public:
  /// The last frame, top row first: colours multiplied by alpha, and alpha.
  [[nodiscard]] virtual std::vector<glm::vec4> read() = 0;
  /// How many layers it had.
  [[nodiscard]] virtual int layer_count() const = 0;
};

/// Scenes are of one mesh in one instance without a transform, or of many that are shifted each by the same as the one
/// before. All of these borrow `scene`.
struct PeerInput {
  const Scene& scene;
  const View& view;
  int threads = 1;
};

/// Mesa's software OpenGL through EGL, without a display. The number of threads of the first call holds for all.
/// Its depths are window depths: 0 at the near plane, 1 at the far plane and where nothing is seen.
/// Null where it was not found when this was built. \throws Error unsupported where there is no such context.
[[nodiscard]] std::unique_ptr<RasterPeer> make_llvmpipe(const PeerInput& input);
/// The same, peeling: front to back, one pass over all triangles a layer, until nothing is left. Every surface has
/// opacity 0.4 and is lit by one light at the camera's upper left. Null or throws as make_llvmpipe().
/// C. Everitt. Interactive Order-Independent Transparency. NVIDIA, 2001.
[[nodiscard]] std::unique_ptr<PeelingPeer> make_peeling(const PeerInput& input);
/// Intel's ray casting kernels: primary rays in packets of 16. Building the hierarchy is part of the construction.
/// Null where it was not found when this was built.
[[nodiscard]] std::unique_ptr<RayPeer> make_embree(const PeerInput& input);

}  // namespace frontmost::bench
