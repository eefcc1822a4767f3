// SPDX-License-Identifier: Apache-2.0
// Views of scenes with curved surfaces: triangles first, tiles of rays at a time; then every ray against what is curved
// and not hidden by them.
#include <atomic>

#include "base/float_environment.h"
#include "base/parallel.h"
#include "raycast/curved/curved_parts.h"
#include "raycast/curved/view_rays.h"

namespace frontmost {

using namespace raycast_detail;

namespace {

class CurvedCast {
 public:
  CurvedCast(const CurvedParts& parts, CurvedVisible& out) : parts_(parts), out_(out), rays_(out.visible.view) {}

  void cast_row(int y, int sample) const {
    Visible& visible = out_.visible;
    const glm::ivec2 offset = sample_offsets(visible.view.samples)[std::size_t(sample)];
    for (int x = 0; x < visible.view.width; ++x) {
      const std::size_t at = visible.index(x, y, sample);
      PrimitiveId& id = visible.primitives[at];
      if (id != no_primitive) id = parts_.element_of(id);
      DoubleRay ray = rays_.at(x, y, offset);
      if (id != no_primitive) ray.to = rays_.beyond(visible.keys[at]);
      const CurvedHit hit = parts_.nearest(ray);
      const float key = rays_.key(hit.t);
      if (!hit || key < visible.keys[at] || (key == visible.keys[at] && id < hit.primitive)) continue;
      id = hit.primitive;
      visible.keys[at] = key;
      out_.parameters[at] = hit.parameters;
      out_.normals[at] = hit.normal;
    }
  }

 private:
  const CurvedParts& parts_;
  CurvedVisible& out_;
  ViewRays rays_;
};

}  // namespace

CurvedVisible raycast(const CurvedIndex& index, const View& view, const Execution& execution) {
  validate(view);
  const IeeeScope ieee;
  CurvedVisible out{raycast(index.parts().triangles, view, execution), Buffer<glm::vec2>(view.sample_count()),
                    Buffer<glm::vec3>(view.sample_count())};
  const CurvedCast cast(index.parts(), out);
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
