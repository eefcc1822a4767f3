// SPDX-License-Identifier: Apache-2.0
// One object alone on the canvas.
//
// Triangles are placed by the z-buffer's own stage, with the picture's transform and another top left corner. The marks
// within the frame are therefore exactly the samples that zbuffer() would draw of the object. Triangles with holes come
// last, since samples that are already marked need no look-up in their textures.

#include "report/accounting/object_mask.h"

#include <algorithm>
#include <cstring>

namespace frontmost::accounting_detail {

using namespace zbuffer_detail;

namespace {

constexpr int kLargestCanvas = 2 * kGuardBand / kSubPixels;  // pixels; triangles that reach farther are clipped

int margin_of(int size, double scale) { return int(std::min((scale - 1) / 2 * size, (kLargestCanvas - size) / 2.0)); }

View view_of_canvas(const View& picture, const glm::ivec2& margin) {
  View view = picture;
  view.width += 2 * margin.x;
  view.height += 2 * margin.y;
  return view;
}

ScreenTransform moved(ScreenTransform transform, const glm::ivec2& margin) {
  transform.centre_x += margin.x * kSubPixels;
  transform.centre_y += margin.y * kSubPixels;
  return transform;
}

/// Whether a triangle crosses the near plane. Precondition: it does not lie wholly outside.
bool crosses_near(const glm::uvec3& vertices, const SnappedVertices& snapped) {
  constexpr std::int32_t kBeforeNear = 1;
  for (int k = 0; k < 3; ++k) {
    std::int32_t key;
    std::memcpy(&key, &snapped.key[vertices[k]], sizeof key);
    if (key < 0 && (key & kBeforeNear) != 0) return true;
  }
  return false;
}

}  // namespace

ObjectCanvas::ObjectCanvas(const View& picture, double scale)
    : margin(margin_of(picture.width, scale), margin_of(picture.height, scale)),
      frame{margin.x, margin.y, margin.x + picture.width - 1, margin.y + picture.height - 1},
      view(view_of_canvas(picture, margin)),
      transform(moved(ScreenTransform(picture), margin)),
      rays(picture) {}

ObjectCanvas::ObjectCanvas(const View& picture, const PixelRect& part)
    : margin(-part.x0, -part.y0),
      frame{0, 0, part.x1 - part.x0, part.y1 - part.y0},
      view(picture),
      transform(moved(ScreenTransform(picture), margin)),
      rays(picture) {
  view.width = frame.x1 + 1;
  view.height = frame.y1 + 1;
}

std::span<const MeshRange> ranges_of(const PlacedScene& scene, std::uint32_t object) {
  const std::span<const MeshRange> all(scene.ranges);
  const auto first_of = [&](std::uint32_t instance) {
    const auto is_before = [&](const MeshRange& range) { return range.instance < instance; };
    return std::size_t(std::partition_point(all.begin(), all.end(), is_before) - all.begin());
  };
  const std::size_t first = first_of(object);
  return all.subspan(first, first_of(object + 1) - first);
}

ObjectMask::ObjectMask(const PlacedScene& scene, const ObjectCanvas& canvas, Isa isa)
    : scene_(scene),
      canvas_(canvas),
      target_(canvas.transform, canvas.view, scene.sides.get(), isa),
      touched_(kNoPixels) {
  const View& view = canvas.view;
  const auto stride = std::size_t(view.width + kWordPixels - 1) / kWordPixels;
  const std::size_t words = stride * std::size_t(view.height);
  words_ = Buffer<std::uint64_t>(words * std::size_t(view.samples), 0);
  for (const glm::ivec2& place : sample_offsets(view.samples)) {
    const std::size_t number = planes_.size();
    planes_.push_back({words_.data() + number * words, stride, view.width, view.height, number, place});
  }
}

void ObjectMask::draw(std::uint32_t object) {
  const std::span<const MeshRange> ranges = ranges_of(scene_, object);
  clear();
  if (is_strewn(ranges))
    draw_at_once(ranges);
  else
    for (const MeshRange& range : ranges) {
      const WorldTriangles triangles = world_triangles(scene_, range, target_.isa, scratch_);
      snap_vertices(target_, triangles.positions, scratch_.vertices);
      draw_triangles(triangles);
    }
  if (touched_.is_empty()) return;
  for (const TriangleRecord& record : cutouts_) draw_cutout(record);
  cutouts_.clear();
}

void ObjectMask::clear() {
  if (!touched_.is_empty())
    for (const MaskPlane& plane : planes_)
      for (int y = touched_.y0; y <= touched_.y1; ++y)
        std::fill(plane.row(y) + touched_.x0 / kWordPixels, plane.row(y) + touched_.x1 / kWordPixels + 1, 0);
  touched_ = kNoPixels;
  is_cut_by_near_ = false;
}

bool ObjectMask::is_strewn(std::span<const MeshRange> ranges) const {
  std::size_t triangles = 0;
  bool is_any = false;
  for (const MeshRange& range : ranges) {
    triangles += range.count();
    is_any = is_any || !range.vertices.is_dense(range.count());
  }
  return is_any && scene_.mesh(ranges[0]).positions.size() <= 3 * triangles;
}

void ObjectMask::draw_at_once(std::span<const MeshRange> ranges) {
  const glm::dmat4& world_from_mesh = scene_.scene->instances[ranges[0].instance].world_from_mesh;
  const std::vector<glm::vec3>& positions = scene_.mesh(ranges[0]).positions;
  if (scratch_.positions.size() < positions.size()) scratch_.positions.resize(positions.size());
  place_vertices(world_from_mesh, positions, scratch_.positions.data(), target_.isa);
  WorldTriangles triangles;
  triangles.positions = std::span(scratch_.positions).first(positions.size());
  triangles.is_mirrored = scene_.mirrored[ranges[0].instance] != 0;
  snap_vertices(target_, triangles.positions, scratch_.vertices);
  for (const MeshRange& range : ranges) {
    triangles.corners = scene_.corners(range);
    triangles.first_id = scene_.first_id(range);
    draw_triangles(triangles);
  }
}

void ObjectMask::draw_triangles(const WorldTriangles& triangles) {
  scratch_.apart.clear();
  batch_.clear();
  place_triangles(target_, triangles, scratch_.vertices, batch_, scratch_.apart);
  if (batch_.count > 0) draw_small();
  large_.clear();
  for (const std::uint32_t i : scratch_.apart) {
    is_cut_by_near_ =
        is_cut_by_near_ || crosses_near(triangles.corners[i] - triangles.first_position, scratch_.vertices);
    append_polygon(target_, polygon_of(target_, triangles, scratch_.vertices, i), triangles.first_id + i, large_);
  }
  for (const TriangleRecord& record : large_) draw_large(record);
}

void ObjectMask::draw_small() {
  touched_ = around(touched_, batch_.rect);
  if (scene_.cutouts) {
    cutout_batch_.clear();
    batch_.extract([&](PrimitiveId id) { return scene_.cutouts->has(id); }, cutout_batch_);
    for (std::size_t i = 0; i < cutout_batch_.count; ++i) cutouts_.push_back(cutout_batch_.record(i));
  }
  for (const MaskPlane& plane : planes_) mark_triangles(plane, batch_.columns(), batch_.count, target_.isa);
}

void ObjectMask::draw_large(const TriangleRecord& record) {
  touched_ = around(touched_, pixel_rect(record, canvas_.view.width, canvas_.view.height));
  if (scene_.cutouts && scene_.cutouts->has(record.id)) {
    cutouts_.push_back(record);
    return;
  }
  for (const MaskPlane& plane : planes_) {
    find_spans(plane, record, spans_, target_.isa);
    mark_spans(plane, spans_, target_.isa);
  }
}

void ObjectMask::draw_cutout(const TriangleRecord& record) {
  const ScreenCutout cutout((*scene_.cutouts)[record.id], canvas_.rays);
  for (const MaskPlane& plane : planes_) {
    find_spans(plane, record, spans_, target_.isa);
    const glm::ivec2 first = plane.place - canvas_.margin * kSubPixels;  // relative to the picture's top left
    for (int i = 0; i < spans_.count; ++i) {
      const int y = spans_.first + i;
      for (int x = spans_.begin[std::size_t(i)]; x < spans_.end[std::size_t(i)]; ++x) {
        std::uint64_t& word = plane.row(y)[x / kWordPixels];
        const std::uint64_t bit = std::uint64_t(1) << (x % kWordPixels);
        if ((word & bit) == 0 && !cutout.is_hole(first.x + x * kSubPixels, first.y + y * kSubPixels)) word |= bit;
      }
    }
  }
}

}  // namespace frontmost::accounting_detail
