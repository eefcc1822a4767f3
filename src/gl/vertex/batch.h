// SPDX-License-Identifier: Apache-2.0
// A batch: the vertices of consecutive primitives in one state, their places in the window, and lists by tile.
//
//    inputs      columns of attributes, as submitted       position, normal, color, ...
//    outputs     columns of varyings, after transform and light; vertices that clipping makes follow the others
//    triangles   vertex numbers --> OrderedBatch (small ones in columns, large and clipped ones one by one)
//    lines       vertex numbers and places, with lists by tile; points are lines from a vertex to itself
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "frontmost/base.h"
#include "state/draw_state.h"
#include "state/frame.h"
#include "zbuffer/place/submission.h"

namespace frontmost::gl_detail {

/// A segment, or a point, in the window.
struct WindowLine {
  std::int32_t vertex[2];
  std::int32_t provoking;  ///< the vertex whose color a flat line has
  bool is_back;            ///< an edge of a polygon that is seen from behind
  bool is_point;
  std::uint32_t stipple_start;  ///< pixels of the strip before this segment
  double offset;                ///< polygon offset in steps of depth, for edges of polygons
  std::uint32_t number;         ///< of the primitive in its batch: of the triangle whose edge it is, or of the line
  zbuffer_detail::PixelRect rect{0, 0, -1, -1};  ///< pixels that it may draw
};

/// Primitives of a batch from one draw: a glBegin, or a call such as glDrawArrays.
struct DrawRange {
  int first;                ///< triangle, or line
  std::uint32_t draw;       ///< counted since the colors were cleared
  std::uint32_t primitive;  ///< number of the first primitive in its draw
  int unit;                 ///< triangles of a primitive; 0 if all are one
};

/// The pixels of one axis whose centre is from one place to before another, both in 1/256 pixel.
struct CentreSpan {
  int begin, end;

  [[nodiscard]] int count() const { return end - begin; }
};
[[nodiscard]] inline CentreSpan pixels_between(std::int32_t from, std::int32_t to) {
  const int round = to > from ? 127 : 128;
  return {(std::min(from, to) + round) >> 8, (std::max(from, to) + round) >> 8};
}

/// glPolygonOffset of a triangle, or of a piece that clipping left of one, in steps of depth. Precondition: the area is
/// positive.
[[nodiscard]] double offset_of(const PolygonState& polygon, const zbuffer_detail::TriangleRecord& record);

/// Materials from a vertex on, for glMaterial between glBegin and glEnd.
struct MaterialChange {
  int first;
  std::array<MaterialState, 2> materials;
};

class Batch {
 public:
  static constexpr int kMostVertices = 4096;
  static constexpr int kMostTriangles = int(zbuffer_detail::TriangleBatch::most_triangles);
  static constexpr int kRoom = kMostVertices + 16;  ///< a store may write a whole vector

  enum class Kind { triangles, lines, points };

  Batch();
  /// Forgets the vertices and primitives.
  void clear(std::shared_ptr<const DrawState> draw_state, Kind primitives);

  [[nodiscard]] float* input(int attribute) { return inputs_.data() + std::size_t(attribute) * kRoom; }
  [[nodiscard]] const float* input(int attribute) const { return inputs_.data() + std::size_t(attribute) * kRoom; }
  [[nodiscard]] float* output(int varying) { return outputs_.data() + std::size_t(varying) * stride_; }
  [[nodiscard]] const float* output(int varying) const { return outputs_.data() + std::size_t(varying) * stride_; }
  [[nodiscard]] std::size_t output_stride() const { return stride_; }
  /// Clip coordinates of each vertex, x, y, z and w, are outputs after the varyings.
  [[nodiscard]] float* clip(int axis) { return output(kVaryings + axis); }
  [[nodiscard]] const float* clip(int axis) const { return output(kVaryings + axis); }
  [[nodiscard]] float* window_z() { return output(kVaryings + 4); }
  [[nodiscard]] const float* window_z() const { return output(kVaryings + 4); }
  [[nodiscard]] float* inverse_w() { return output(kVaryings + 5); }
  [[nodiscard]] const float* inverse_w() const { return output(kVaryings + 5); }
  /// Window places in 1/256 pixel, and out codes: bits 0 to 5 for near, far and the guard planes, then the user's.
  [[nodiscard]] std::int32_t* place(int axis) { return reinterpret_cast<std::int32_t*>(output(kVaryings + 6 + axis)); }
  [[nodiscard]] const std::int32_t* place(int axis) const {
    return reinterpret_cast<const std::int32_t*>(output(kVaryings + 6 + axis));
  }
  [[nodiscard]] std::int32_t* out_codes() { return place(2); }
  [[nodiscard]] const std::int32_t* out_codes() const { return place(2); }

  /// Adds a vertex between two others: a + t * (b - a) in clip space. \returns its number.
  int add_between(int a, int b, float t);
  /// Finds the window place of a vertex from its clip coordinates. \returns false if it has none.
  [[nodiscard]] bool project(int vertex);

  /// Transforms, lights, clips and places everything, and makes the lists by tile.
  void prepare(Isa isa);
  /// The stipple of the lines with which the batch begins goes on after so many pixels of earlier batches. Call it
  /// once for each batch, in the order of submission, after prepare(). \returns the pixels after which the next batch
  /// goes on.
  std::uint32_t continue_stipple(std::uint32_t pixels);

  std::shared_ptr<const DrawState> state;
  Kind kind = Kind::triangles;
  int vertex_count = 0;
  std::vector<DrawRange> draws;
  std::uint32_t first_id = 0;                 ///< running number of the first primitive, for Frame::ids
  std::vector<MaterialChange> material_runs;  ///< beside the state's own materials
  bool is_continued = false;                  ///< the first triangle goes on with a polygon of the batch before

  // Primitives as submitted.
  int triangle_count = 0;
  Buffer<std::int32_t> corners[3];  ///< vertex numbers of the triangles
  Buffer<std::uint8_t> edge_flags;  ///< bit k: the edge from vertex k to the next one is an edge of the polygon
  Buffer<std::int32_t> provoking;   ///< vertex whose color a flat triangle has
  std::vector<WindowLine> lines;    ///< also of triangles whose polygon mode is GL_LINE or GL_POINT

  // Primitives as placed. Ids are the triangle's number << 1 | whether it is seen from behind.
  zbuffer_detail::OrderedBatch placed;
  Buffer<std::int32_t> small_corners[3];  ///< of each small triangle, in the order of its placed vertices
  std::vector<std::array<std::int32_t, 3>> single_corners;
  zbuffer_detail::TileLists line_lists;
  zbuffer_detail::PixelRect line_rect{0, 0, -1, -1};

 private:
  void grow();
  void place_polygons(Isa isa);
  void place_lines();

  Buffer<float> inputs_, outputs_;
  std::size_t stride_;
  int room_;  // vertices that the outputs have room for
  // Of place_lines(): the lines before the first one whose stipple begins anew, whether there is one, and the pixels of
  // the last strip.
  std::size_t continued_lines_ = 0;
  bool begins_anew_ = false;
  std::uint32_t last_pixels_ = 0;
  // Of place_polygons(): whether the next batch may go on with the outline of the last triangle's polygon.
  bool goes_on_ = false;
};

/// Transforms and lights the vertices of a batch.
void transform_vertices(Batch& batch, Isa isa);
/// Places the triangles whose vertices are all inside; appends the numbers of those that must be clipped or are large.
void place_small(Batch& batch, std::vector<std::uint32_t>& apart, Isa isa);

}  // namespace frontmost::gl_detail
