// SPDX-License-Identifier: Apache-2.0
#include "occlusion/masked_peer.h"

#ifdef FRONTMOST_BENCH_MASKED
#include <MaskedOcclusionCulling.h>

#include <algorithm>
#endif

namespace frontmost::bench {

#ifdef FRONTMOST_BENCH_MASKED
namespace {

/// Place of an object on the screen, in clip space divided by w.
struct Placed {
  std::uint32_t instance;
  float x0, y0, x1, y1;
  float nearest;
  std::array<float, 16> clip_from_mesh;
};

class Masked : public MaskedPeer {
 public:
  Masked(const Surfaces& surfaces, const View& view, bool leaves_out_backs)
      : scene_(surfaces.scene()), seen_(scene_.instances.size()), leaves_out_backs_(leaves_out_backs) {
    culling_ = MaskedOcclusionCulling::Create();
    // The library works on whole tiles only.
    culling_->SetResolution(unsigned(view.width + 7) / 8 * 8, unsigned(view.height + 7) / 8 * 8);
    culling_->SetNearClipPlane(float(view.projection.clip.near));
    const glm::dmat4 clip_from_world = clip_from_eye(view.projection) * glm::inverse(view.world_from_eye);
    for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) place(surfaces, view, clip_from_world, i);
    std::sort(placed_.begin(), placed_.end(), [](const Placed& a, const Placed& b) { return a.nearest < b.nearest; });
  }
  ~Masked() override { MaskedOcclusionCulling::Destroy(culling_); }
  Masked(const Masked&) = delete;
  Masked& operator=(const Masked&) = delete;

  void cull() override {
    culling_->ClearBuffer();
    std::fill(seen_.begin(), seen_.end(), std::uint8_t(0));
    const auto winding =
        leaves_out_backs_ ? MaskedOcclusionCulling::BACKFACE_CW : MaskedOcclusionCulling::BACKFACE_NONE;
    for (const Placed& o : placed_) {
      if (culling_->TestRect(o.x0, o.y0, o.x1, o.y1, o.nearest) != MaskedOcclusionCulling::VISIBLE) continue;
      seen_[o.instance] = 1;
      const Mesh& mesh = scene_.meshes[scene_.instances[o.instance].mesh];
      culling_->RenderTriangles(&mesh.positions[0].x, &mesh.triangles[0].x, int(mesh.triangles.size()),
                                o.clip_from_mesh.data(), winding, MaskedOcclusionCulling::CLIP_PLANE_ALL,
                                MaskedOcclusionCulling::VertexLayout(sizeof(glm::vec3), 4, 8));
    }
  }
  [[nodiscard]] const std::vector<std::uint8_t>& seen() const override { return seen_; }
  [[nodiscard]] const char* instructions() const override {
    constexpr const char* names[] = {"SSE2", "SSE4.1", "AVX2", "AVX-512"};
    return names[culling_->GetImplementation()];
  }

 private:
  void place(const Surfaces& surfaces, const View& view, const glm::dmat4& clip_from_world, std::uint32_t instance) {
    const Box& box = surfaces.bounds(instance);
    if (box.is_empty()) return;
    constexpr float beyond = std::numeric_limits<float>::infinity();
    Placed o{instance, beyond, beyond, -beyond, -beyond, beyond, {}};
    bool crosses_near = false;
    float farthest = -beyond;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec4 p =
          clip_from_world * glm::dvec4(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                       corner & 4 ? box.high.z : box.low.z, 1);
      crosses_near = crosses_near || p.w < view.projection.clip.near;
      o.nearest = std::min(o.nearest, float(p.w));
      farthest = std::max(farthest, float(p.w));
      o.x0 = std::min(o.x0, float(p.x / p.w)), o.x1 = std::max(o.x1, float(p.x / p.w));
      o.y0 = std::min(o.y0, float(p.y / p.w)), o.y1 = std::max(o.y1, float(p.y / p.w));
    }
    if (farthest < view.projection.clip.near) return;
    if (crosses_near) o.x0 = o.y0 = -1, o.x1 = o.y1 = 1, o.nearest = float(view.projection.clip.near);
    if (o.x0 > 1 || o.y0 > 1 || o.x1 < -1 || o.y1 < -1) return;
    const glm::dmat4 clip_from_mesh = clip_from_world * scene_.instances[instance].world_from_mesh;
    for (int i = 0; i < 16; ++i) o.clip_from_mesh[std::size_t(i)] = float(clip_from_mesh[i / 4][i % 4]);
    placed_.push_back(o);
  }

  const Scene& scene_;
  MaskedOcclusionCulling* culling_;
  std::vector<Placed> placed_;  ///< objects within the view volume, the nearest first
  std::vector<std::uint8_t> seen_;
  bool leaves_out_backs_;
};

}  // namespace

std::unique_ptr<MaskedPeer> make_masked_peer(const Surfaces& surfaces, const View& view, bool leaves_out_backs) {
  return std::make_unique<Masked>(surfaces, view, leaves_out_backs);
}
#else
std::unique_ptr<MaskedPeer> make_masked_peer(const Surfaces&, const View&, bool) { return nullptr; }
#endif

}  // namespace frontmost::bench
