// SPDX-License-Identifier: Apache-2.0
// The stream of primitives from glBegin and the arrays to the frame.
//
//    glVertex --> open batch --close--> queue of batches, clears and pixel rectangles --run--> frame
//
// A batch has the vertices of consecutive primitives that were submitted in one state. It is closed when it is full, or
// when a primitive begins after the state changed; a primitive that a full batch cuts goes on in the next batch. Work
// is done in the order of submission in every tile of the frame. The other threads draw a full queue while the calling
// thread fills the next one, and helps them once that is full, too.
#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <vector>

#include "base/crew.h"
#include "fragments/painter.h"
#include "frontmost/base.h"
#include "state/frame.h"
#include "vertex/batch.h"

namespace frontmost::gl_detail {

/// A primitive, as a program counts.
struct PrimitiveName {
  std::uint32_t draw, primitive;
};

class PrimitiveStream {
 public:
  PrimitiveStream();
  ~PrimitiveStream();

  /// Between begin() and end(), each vertex() takes the current values of the input's state as one vertex.
  void begin(DrawInput& input, GLenum mode);
  void vertex(DrawInput& input);
  void end(DrawInput& input);
  [[nodiscard]] bool is_open() const { return is_open_; }
  /// Draws triangles whose vertices have indices: index(i) is that of corner i, and read(index) sets the current
  /// values. A vertex that several triangles of a batch have in common is transformed once, if its index was met
  /// lately.
  template <class Index, class Read>
  void indexed_triangles(DrawInput& input, std::size_t triangle_count, const Index& index, const Read& read) {
    begin(input, GL_TRIANGLES);
    limit_ = -1;  // the loop minds the batch's end
    ++stamp_;
    for (std::size_t i = 0; i < 3 * triangle_count; i += 3) {
      if (count_ + 3 > Batch::kMostVertices || open_->triangle_count == Batch::kMostTriangles) {
        first_ = count_;  // nothing is cut
        carry_on(input);
        limit_ = -1;
        ++stamp_;
      }
      int vertices[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t key = index(i + k);
        MetIndex& met = met_[key % met_.size()];
        if (met.stamp != stamp_ || met.index != key) {
          read(key);
          met = {key, stamp_, count_};
          vertex(input);
        }
        vertices[k] = met.vertex;
      }
      add_triangle(vertices[0], vertices[1], vertices[2], 7, vertices[2]);
    }
    first_ = count_;
    end(input);
  }

  /// The input's state will differ from now on: the next primitive opens a batch.
  void state_changes() { is_stale_ = true; }
  /// glMaterial between begin() and end(): later vertices have other materials.
  void material_changes(DrawInput& input);

  /// glClear of the color, depth and stencil planes in `mask`.
  void clear(DrawInput& input, GLbitfield mask);
  /// Draws a rectangle of pixels with the fragment operations of the state.
  void draw(DrawInput& input, PixelRectangle&& rectangle);
  /// Draws everything submitted so far into the input's frame.
  void finish(DrawInput& input);

  /// Keeps all work from now on until the colors are cleared, or stops doing so. Kept work takes memory; explain()
  /// needs it.
  void keep_draws(DrawInput& input, bool keep);
  /// Drops kept work, because the colors are cleared or the frame has another size, and counts anew.
  void forget_draws(DrawInput& input);
  /// The draw and the primitive that a running number of Frame::ids stands for, as counted since the colors were
  /// cleared. Precondition: draws are kept, and the number is of a primitive.
  [[nodiscard]] PrimitiveName name_of(std::uint32_t id) const;
  /// What happened at a pixel since the colors were cleared, in the order of submission. Precondition: draws are kept.
  [[nodiscard]] std::vector<FragmentEvent> explain(DrawInput& input, int x, int y);

  /// How many threads draw, and by which instruction set.
  Execution execution;
  /// Fragments that passed all tests since this was set to 0; counted only while `counts_samples`.
  std::uint64_t samples_passed = 0;
  bool counts_samples = false;

 private:
  /// An input of each vertex: the attribute whose current value goes to a column of the open batch.
  struct Input {
    float* column;
    int attribute;
  };
  /// A batch, a clearing of planes, or a rectangle of pixels.
  struct Work {
    std::unique_ptr<Batch> batch;
    std::shared_ptr<const DrawState> state;
    GLbitfield cleared = 0;
    std::unique_ptr<PixelRectangle> rectangle;
    std::uint32_t id = 0;  ///< of the rectangle
  };
  /// The draws that running numbers from `id` on belong to.
  struct IdRange {
    std::uint32_t id, draw, primitive;
    int unit;
  };

  /// An index of indexed_triangles(), and its vertex in the open batch, if the stamp is the present one.
  struct MetIndex {
    std::size_t index = 0;
    std::uint64_t stamp = 0;
    int vertex = 0;
  };

  void open_batch(DrawInput& input, Batch::Kind kind);
  void close_batch(DrawInput& input);
  void submit(DrawInput& input, Work&& work);
  /// Draws the work of a queue.
  void draw_all(Frame& frame, const std::vector<Work>& works);
  /// Draws all that waits, and keeps it or takes its batches back.
  void run(DrawInput& input);
  /// Waits for the threads that draw. \throws what they threw.
  void settle();
  void paint(const PaintTarget& target, const zbuffer_detail::Tile& tile, const Work& work) const;
  void set_limit();
  void name_primitives(std::uint32_t draw, std::uint32_t primitive);
  /// The batch is full: the primitive goes on in another one.
  void carry_on(DrawInput& input);
  void assemble(bool is_last);
  void add_triangle(int a, int b, int c, int edges, int provoking);
  void add_line(int a, int b, int provoking, bool continues);

  std::unique_ptr<Batch> open_;
  std::vector<std::unique_ptr<Batch>> spare_;
  std::vector<Work> queue_;
  std::vector<Work> in_errand_;  // what the errand draws
  std::exception_ptr error_;
  std::shared_ptr<const DrawState> state_;  // of the open batch, and of the next ones while is_stale_ is false
  std::vector<Input> inputs_;
  std::array<MetIndex, 4096> met_;
  std::uint64_t stamp_ = 0;
  std::vector<Work> kept_;                             // since the colors were cleared
  std::vector<IdRange> names_;                         // of all ids since then
  Buffer<std::uint32_t> color_before_, depth_before_;  // planes of the frame before kept_ was drawn
  bool keeps_ = false;
  std::uint32_t next_id_ = 0, next_draw_ = 0;
  std::uint32_t stipple_pixels_ = 0;  // of a strip with which the next batch may go on
  int count_ = 0, limit_ = 0;         // vertices of the open batch
  // The primitive between begin() and end().
  GLenum mode_ = GL_POINTS;
  int first_ = 0;              // its first vertex in the open batch
  bool is_continued_ = false;  // it began in an earlier batch
  bool is_open_ = false;
  bool is_stale_ = true;
  std::optional<Crew::Errand> errand_;  // is destroyed first, as it uses the rest
};

}  // namespace frontmost::gl_detail
