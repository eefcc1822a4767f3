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

/// Which pieces are read here.
struct Turns {
  int number = 0, count = 1;  ///< of this rank, and of all
  std::vector<int> readers;   ///< as StreamOptions::readers

  [[nodiscard]] int reader_of(std::size_t file) const { return file < readers.size() ? readers[file] : -1; }
};

/// What a reader said during a pass.
struct FileWarning {
  std::uint32_t file = 0;
  std::string text;
};

/// Several models as one.
class Models {
 public:
  Models(const std::vector<std::string>& paths, const LoadOptions& options, const Turns& turns,
         const Execution& execution);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] bool can_rewind() const;
  [[nodiscard]] double fraction() const;
  void rewind();
  /// \returns false at the end. \throws Error, limit_exceeded for more triangles than ids can tell apart.
  bool fetch(StreamPiece& piece, PiecePlace& place, std::uint32_t triangles);
  void parse(StreamPiece& piece, const PiecePlace& place) const;
  /// Of files that were read, in the last pass.
  [[nodiscard]] std::uint64_t triangle_count() const;

  // What ranks that read parts of the models have to tell each other after their first pass.

  /// Where the ids of each file began in the last pass, and how many there were; none of files that others read.
  [[nodiscard]] std::vector<PrimitiveId> first_ids() const;
  [[nodiscard]] std::vector<std::uint64_t> triangle_counts() const;
  /// How many there are, read here or not: ids are those of the whole from now on. \throws Error as fetch().
  void set_triangle_counts(const std::vector<std::uint64_t>& counts);
  /// Those of files whose warnings this rank has to tell.
  [[nodiscard]] std::vector<FileWarning> take_warnings();
  void add_warnings(const std::vector<FileWarning>& warnings);

 private:
  struct Model {
    std::unique_ptr<ModelStream> stream;
    std::uint32_t object = 0, first_material = 0;
    glm::dvec3 moved{0};               ///< its mesh in world space
    std::size_t warnings = 0;          ///< taken over so far
    PrimitiveId first = 0;             ///< id of its first triangle
    std::uint64_t triangle_count = 0;  ///< fetched in this pass
    bool has_ended = false;            ///< in an earlier pass or in this
  };
  void add(Model model);
  void warn(const Model& model, const std::string& text);
  void take_warnings(Model& model);
  void begin(std::size_t file);
  void end(Model& model);
  [[nodiscard]] bool is_read_here(std::size_t file) const;
  [[nodiscard]] bool is_shared(std::size_t file) const;
  /// Whether the next piece is this rank's.
  bool takes_turn(std::size_t file);

  std::vector<Model> models_;
  Turns turns_;
  Scene scene_;
  std::vector<FileWarning> warnings_;  ///< of passes, for other ranks
  bool has_opened_ = false, knows_firsts_ = false;
  std::size_t current_ = 0, begun_ = 0, next_number_ = 0;
  std::uint64_t next_ = 0, shared_pieces_ = 0;
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
