// SPDX-License-Identifier: Apache-2.0
// Casts one ray through every pixel centre with Embree, in coherent packets of 4 x 4, as Embree's documentation
// recommends for primary rays.
#include <embree3/rtcore.h>
#include <pmmintrin.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <xmmintrin.h>

#include <atomic>
#include <cmath>

#include "peers/peer.h"

namespace frontmost::bench {
namespace {

constexpr int kPacket = 4;  ///< pixels on a side
constexpr int kTile = 32;

/// The direction of the ray through pixel (x, y) is corner + x * right + y * down; distances along it are planar.
struct Lens {
  glm::vec3 eye, corner, right, down;
  float near, far;
};

Lens make_lens(const View& view) {
  const Projection& p = view.projection;
  const glm::dvec3 right = view.right() * ((p.right - p.left) / view.width);
  const glm::dvec3 down = view.up() * ((p.bottom - p.top) / view.height);
  const glm::dvec3 corner = view.forward() + view.right() * p.left + view.up() * p.top + (right + down) * 0.5;
  return {glm::vec3(view.eye()), glm::vec3(corner),  glm::vec3(right),
          glm::vec3(down),       float(p.clip.near), float(p.clip.far)};
}

class Embree : public RayPeer {
 public:
  explicit Embree(const PeerInput& input)
      : view_(input.view), lens_(make_lens(input.view)), arena_(input.threads), mesh_(input.scene.meshes.at(0)) {
    image_.primitives.resize(view_.pixel_count());
    image_.depths.resize(view_.pixel_count());
    const std::string settings = "set_affinity=0,frequency_level=simd256,threads=" + std::to_string(input.threads);
    device_ = rtcNewDevice(settings.c_str());
    if (!device_) throw Error(ErrorCode::unsupported, "Embree: no device");
    rtcSetDeviceMemoryMonitorFunction(
        device_,
        [](void* bytes, ssize_t change, bool) {
          *static_cast<std::atomic<std::ptrdiff_t>*>(bytes) += change;
          return true;
        },
        &bytes_);
    build();
  }
  ~Embree() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  void draw() override {
    const int tiles_x = (view_.width + kTile - 1) / kTile, tiles_y = (view_.height + kTile - 1) / kTile;
    arena_.execute([&] {
      tbb::parallel_for(0, tiles_x * tiles_y, [&](int tile) {
        // Embree's documentation asks for both modes.
        _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
        _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
        cast_tile(tile % tiles_x * kTile, tile / tiles_x * kTile);
      });
    });
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_OFF);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_OFF);
  }
  [[nodiscard]] PeerImage read() override { return image_; }

  void rebuild() override {
    rtcReleaseScene(scene_);
    build();
  }
  [[nodiscard]] std::size_t byte_count() const override { return std::size_t(bytes_.load()); }

  std::size_t count_hits(const std::vector<Ray>& rays) override {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    std::size_t count = 0;
    for (const Ray& ray : rays) {
      RTCRayHit query{};
      query.ray = single(ray.origin, ray.direction, std::numeric_limits<float>::infinity());
      query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene_, &context, &query);
      count += query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
    return count;
  }
  std::size_t count_blocked(const std::vector<Segment>& segments) override {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    std::size_t count = 0;
    for (const Segment& segment : segments) {
      RTCRay query = single(segment.from, segment.to - segment.from, 1);
      rtcOccluded1(scene_, &context, &query);
      count += query.tfar < 0;  // Embree sets tfar to minus infinity if a ray is blocked
    }
    return count;
  }

 private:
  static RTCRay single(const glm::vec3& o, const glm::vec3& d, float far) {
    return {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, far, ~0u, 0, 0};
  }

  void build() {
    // Embree reads 16 bytes at the last vertex, so the array is padded.
    positions_ = mesh_.positions;
    positions_.emplace_back();
    scene_ = rtcNewScene(device_);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions_.data(), 0,
                               sizeof(glm::vec3), mesh_.positions.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh_.triangles.data(), 0,
                               sizeof(glm::uvec3), mesh_.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }

  void cast_tile(int left, int top) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (int y = top; y < std::min(top + kTile, view_.height); y += kPacket)
      for (int x = left; x < std::min(left + kTile, view_.width); x += kPacket) cast_packet(context, x, y);
  }

  void cast_packet(RTCIntersectContext& context, int left, int top) {
    RTCRayHit16 packet;
    alignas(64) int valid[16];
    for (int k = 0; k < 16; ++k) {
      const int x = left + k % kPacket, y = top + k / kPacket;
      valid[k] = x < view_.width && y < view_.height ? -1 : 0;
      const glm::vec3 direction = lens_.corner + lens_.right * float(x) + lens_.down * float(y);
      packet.ray.org_x[k] = lens_.eye.x, packet.ray.org_y[k] = lens_.eye.y, packet.ray.org_z[k] = lens_.eye.z;
      packet.ray.dir_x[k] = direction.x, packet.ray.dir_y[k] = direction.y, packet.ray.dir_z[k] = direction.z;
      packet.ray.tnear[k] = lens_.near, packet.ray.tfar[k] = lens_.far, packet.ray.time[k] = 0;
      packet.ray.mask[k] = ~0u, packet.ray.id[k] = unsigned(k), packet.ray.flags[k] = 0;
      packet.hit.geomID[k] = packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.primID[k] = no_primitive;
    }
    rtcIntersect16(valid, scene_, &context, &packet);
    for (int k = 0; k < 16; ++k) {
      if (!valid[k]) continue;
      const std::size_t i = std::size_t(top + k / kPacket) * std::size_t(view_.width) + std::size_t(left + k % kPacket);
      const bool hit = packet.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
      image_.primitives[i] = hit ? packet.hit.primID[k] : no_primitive;
      image_.depths[i] = hit ? packet.ray.tfar[k] : std::numeric_limits<float>::infinity();
    }
  }

  View view_;
  Lens lens_;
  tbb::task_arena arena_;
  const Mesh& mesh_;
  std::vector<glm::vec3> positions_;
  std::atomic<std::ptrdiff_t> bytes_{0};
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  PeerImage image_;
};

}  // namespace

std::unique_ptr<RayPeer> make_embree(const PeerInput& input) { return std::make_unique<Embree>(input); }

}  // namespace frontmost::bench
