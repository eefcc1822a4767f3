// SPDX-License-Identifier: Apache-2.0
// Triangles with holes, behind all others: no order, no tiles, no vectors. A look into a texture costs many depth
// tests, so all that counts is to look only where the fragment would be seen.
//
// What is seen is a minimum, and a minimum may be taken in any order. So everything without holes is drawn first, by
// the kernels that know nothing of textures, and a triangle with holes then meets a picture in which most of its
// fragments are hidden: these are never looked up.

#include <algorithm>

#include "base/parallel.h"
#include "view/screen_cutout.h"
#include "zbuffer/triangle_records.h"

namespace frontmost::zbuffer_detail {
namespace {

/// Draws one triangle after another into some rows of the picture, sample by sample.
class CutoutPainter {
 public:
  CutoutPainter(const Cutouts& cutouts, const ScreenRays& rays, const PixelRect& rows, Visible& visible)
      : cutouts_(cutouts),
        rays_(rays),
        rows_(rows),
        samples_(sample_offsets(visible.view.samples)),
        visible_(visible) {}

  void draw(const TriangleRecord& r) {
    const PixelRect rect = common_part(pixel_rect(r, visible_.view.width, visible_.view.height), rows_);
    if (rect.is_empty()) return;
    const ScreenCutout cutout(cutouts_[r.id], rays_);
    const TriangleKeys keys(r);
    for (std::size_t s = 0; s < samples_.size(); ++s)
      visit_covered(r, rect, samples_[s], [&](int x, int y) {
        const glm::ivec2 at = glm::ivec2(x, y) * kSubPixels + samples_[s];
        put(r.id, keys.at(at.x, at.y), visible_.index(x, y, int(s)), [&] { return cutout.is_hole(at.x, at.y); });
      });
  }

 private:
  template <class IsHole>
  void put(PrimitiveId id, float key, std::size_t i, const IsHole& is_hole) {
    const bool is_nearer = key > visible_.keys[i] || (key == visible_.keys[i] && id < visible_.primitives[i]);
    // In this order: most fragments of foliage are behind what is there already.
    if (!is_nearer || is_hole()) return;
    visible_.keys[i] = key;
    visible_.primitives[i] = id;
  }

  const Cutouts& cutouts_;
  const ScreenRays& rays_;
  PixelRect rows_;
  std::span<const glm::ivec2> samples_;
  Visible& visible_;
};

}  // namespace

void draw_cutouts(const ClusterSet& set, const ScreenTransform& transform, Visible& visible,
                  const Execution& execution) {
  std::vector<TriangleRecord> records;
  for (std::size_t i = set.first_cutout; i < set.clusters.size(); ++i)
    append_records(set, set.clusters[i], transform, visible.view, records);
  draw_cutouts(*set.cutouts, records, visible, execution);
}

void draw_cutouts(const Cutouts& cutouts, std::span<const TriangleRecord> records, Visible& visible,
                  const Execution& execution) {
  const View& view = visible.view;
  const ScreenRays rays(view);
  // Threads share no row, so none has to be locked; each goes through all records, which are few or large.
  constexpr std::size_t kRowsPerPart = 16;
  parallel_for(execution, std::size_t(view.height), kRowsPerPart, [&](std::size_t begin, std::size_t end) {
    CutoutPainter painter(cutouts, rays, {0, int(begin), view.width - 1, int(end) - 1}, visible);
    for (const TriangleRecord& record : records) painter.draw(record);
  });
}

}  // namespace frontmost::zbuffer_detail
