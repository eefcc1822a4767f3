// SPDX-License-Identifier: Apache-2.0
// Views of scenes with curved surfaces: triangles first, tiles of rays at a time; then every ray against what is curved
// and not hidden by them.
//
// The key of what triangles show is a float, which several distances have. So a ray goes on a little beyond the
// distance of that key, and keys are compared again: what is curved and has the same key is seen if its id is lower.
#include <atomic>

#include "base/parallel.h"
#include "raycast/curved/curved_parts.h"
#include "raycast/curved/double_ray.h"
#include "raycast/curved/patch_packet.h"

namespace frontmost {

using namespace raycast_detail;

namespace {

class CurvedCast {
 public:
  CurvedCast(const CurvedParts& parts, CurvedVisible& out, Isa isa)
      : parts_(parts), out_(out), rays_(out.visible.view), isa_(isa) {}

  void cast_row(int y, int sample) const {
    const int width = out_.visible.view.width;
    for (int x = 0; x < width; x += int(kPacketRays)) cast_packet(x, std::min(x + int(kPacketRays), width), y, sample);
  }

 private:
  void cast_packet(int begin, int end, int y, int sample) const {
    Visible& visible = out_.visible;
    const glm::ivec2 offset = sample_offsets(visible.view.samples)[std::size_t(sample)];
    std::array<DoubleRay, kPacketRays> rays;
    std::array<CurvedHit, kPacketRays> hits;
    const auto count = std::size_t(end - begin);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = visible.index(begin + int(i), y, sample);
      PrimitiveId& id = visible.primitives[at];
      rays[i] = rays_.at(begin + int(i), y, offset);
      if (id == no_primitive) continue;
      id = parts_.element_of(id);
      rays[i].to = rays_.beyond(visible.keys[at]);
    }
    parts_.nearest({rays.data(), count}, hits, isa_);
    for (std::size_t i = 0; i < count; ++i) keep(hits[i], visible.index(begin + int(i), y, sample));
  }

  void keep(const CurvedHit& hit, std::size_t at) const {
    Visible& visible = out_.visible;
    const float key = rays_.key(hit.t);
    if (!hit || key < visible.keys[at] || (key == visible.keys[at] && visible.primitives[at] < hit.primitive)) return;
    visible.primitives[at] = hit.primitive;
    visible.keys[at] = key;
    out_.parameters[at] = hit.parameters;
    out_.normals[at] = hit.normal;
  }

  const CurvedParts& parts_;
  CurvedVisible& out_;
  ViewRays rays_;
  Isa isa_;
};

}  // namespace

CurvedVisible raycast(const CurvedIndex& index, const View& view, const Execution& execution) {
  validate(view);
  const IeeeScope ieee;
  CurvedVisible out{raycast(index.parts().triangles, view, execution), Buffer<glm::vec2>(view.sample_count()),
                    Buffer<glm::vec3>(view.sample_count())};
  const CurvedCast cast(index.parts(), out, execution.isa);
  const auto rows = std::size_t(view.height) * std::size_t(view.samples);
  std::atomic<std::size_t> done{0};
  parallel_for(execution, rows, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      cast.cast_row(int(row % std::size_t(view.height)), int(row / std::size_t(view.height)));
    report_progress(execution, "visible", double(done += end - begin) / double(rows));
  });
  return out;
}

}  // namespace frontmost
