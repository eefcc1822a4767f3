// SPDX-License-Identifier: Apache-2.0
// Other programs that answer the same question: which primitive is seen at every pixel centre of a view.
#pragma once

#include <frontmost/frontmost.h>

#include <memory>
#include <vector>

namespace frontmost::bench {

/// A peer's picture, top row first.
struct PeerImage {
  std::vector<PrimitiveId> primitives;  ///< no_primitive where nothing is seen
  std::vector<float> depths;            ///< planar distances, unless make_*() says otherwise
};

class Peer {
 public:
  virtual ~Peer() = default;
  /// Draws one frame: clears, draws ids and depths, and waits until the frame is finished. Nothing is read back.
  virtual void draw() = 0;
};

/// A rasteriser that reports where it puts vertices.
class RasterPeer : public Peer {
 public:
  /// Reads the last frame.
  [[nodiscard]] virtual PeerImage read() = 0;
  /// Clip position of every vertex before the divide, from the shader that draws. y points down, as in the picture.
  [[nodiscard]] virtual std::vector<glm::vec4> clip_positions() const = 0;
};

/// A ray caster that also answers single rays, one after another on one thread.
class RayPeer : public Peer {
 public:
  /// Reads the last frame.
  [[nodiscard]] virtual PeerImage read() = 0;
  /// Builds the hierarchy anew.
  virtual void rebuild() = 0;
  /// Bytes of the hierarchy, without the mesh.
  [[nodiscard]] virtual std::size_t byte_count() const = 0;
  /// Number of rays that hit something; the nearest hit is found.
  virtual std::size_t count_hits(const std::vector<Ray>& rays) = 0;
  /// Number of blocked segments; any hit ends the search.
  virtual std::size_t count_blocked(const std::vector<Segment>& segments) = 0;
};

/// Draws all surfaces as translucent, layer by layer.
class PeelingPeer : public Peer {
 public:
  /// Reads the last frame, top row first: colours multiplied by alpha, and alpha.
  [[nodiscard]] virtual std::vector<glm::vec4> read() = 0;
  /// Number of layers in the last frame.
  [[nodiscard]] virtual int layer_count() const = 0;
};

/// The scene has one mesh, in one instance without a transform or in many, each shifted by the same vector from the one
/// before. All peers borrow `scene`.
struct PeerInput {
  const Scene& scene;
  const View& view;
  int threads = 1;
};

/// Mesa's software OpenGL through EGL, without a display. The number of threads of the first call holds for all. Depths
/// are window depths: 0 at the near plane, 1 at the far plane and where nothing is seen. Null if the build has no EGL.
/// \throws Error unsupported if there is no such context.
[[nodiscard]] std::unique_ptr<RasterPeer> make_llvmpipe(const PeerInput& input);
/// Depth peeling by Mesa's software OpenGL: front to back, one pass over all triangles a layer, until nothing is left.
/// Every surface has opacity 0.4 and is lit by one light at the camera's upper left. Null or throws as make_llvmpipe().
/// C. Everitt. Interactive Order-Independent Transparency. NVIDIA, 2001.
[[nodiscard]] std::unique_ptr<PeelingPeer> make_peeling(const PeerInput& input);
/// Intel's ray casting kernels: primary rays in packets of 16. The constructor builds the hierarchy. Null if the build
/// has no Embree.
[[nodiscard]] std::unique_ptr<RayPeer> make_embree(const PeerInput& input);

}  // namespace frontmost::bench
