// SPDX-License-Identifier: Apache-2.0
// One pass over all files of a stream: pieces are fetched in order, and worked on by several threads at once.
//
//   fetch (one at a time)      piece 0    piece 1    piece 2    piece 3    ...
//   parse and work             +-- worker 0 --------+           +-- worker 0 ...
//                                         +-- worker 1 ---------------+
//
// What is fetched one after the other is only bytes, so the file is read from front to back. A worker has memory of its
// own, which its pieces use one after the other.
#pragma once

#include <exception>
#include <functional>
#include <vector>

#include "io/models/model_stream.h"

namespace frontmost::streaming {

/// Where a piece stands among all.
struct PiecePlace {
  std::size_t number = 0;    ///< of the piece
  PrimitiveId first = 0;     ///< number of its first triangle in the stream
  std::uint32_t object = 0;  ///< of its file
};

/// Several models as one.
class Models {
 public:
  Models(const std::vector<std::string>& paths, const LoadOptions& options, const Execution& execution);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] bool can_rewind() const;
  [[nodiscard]] double fraction() const;
  void rewind();
  /// \returns false at the end. \throws Error, limit_exceeded for more triangles than ids can tell apart.
  bool fetch(StreamPiece& piece, PiecePlace& place, std::uint32_t triangles);
  void parse(StreamPiece& piece, const PiecePlace& place) const;
  [[nodiscard]] std::uint64_t triangle_count() const { return next_; }

 private:
  struct Model {
    std::unique_ptr<ModelStream> stream;
    std::uint32_t object = 0, first_material = 0;
    glm::dvec3 moved{0};               ///< its mesh in world space
    std::size_t warnings = 0;          ///< taken over so far
    std::uint64_t triangle_count = 0;  ///< fetched in this pass
    bool has_ended = false;            ///< in an earlier pass or in this
  };
  void add(Model model);
  void take_warnings(Model& model);
  void end(Model& model);

  std::vector<Model> models_;
  Scene scene_;
  std::size_t current_ = 0, next_number_ = 0;
  std::uint64_t next_ = 0;
};

struct LoopOptions {
  std::uint32_t triangles_at_once = 1;
  int workers = 1;
};

/// Calls work(worker, piece, place) for every piece. Of several errors the one of the first piece is thrown, whatever
/// the number of threads.
void for_each_piece(Models& models, const LoopOptions& options, const Execution& execution,
                    const std::function<void(int worker, StreamPiece&, const PiecePlace&)>& work);

}  // namespace frontmost::streaming
