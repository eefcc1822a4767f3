// SPDX-License-Identifier: Apache-2.0
// One pass over all files of a stream: pieces are fetched in order, and processed by several threads at once.
//
//   fetch (one at a time)      piece 0    piece 1    piece 2    piece 3    ...
//   parse and work             +-- worker 0 --------+           +-- worker 0 ...
//                                         +-- worker 1 ---------------+
//
// Fetching only reads bytes, so files are read from front to back. Each worker has memory of its own, which its pieces
// reuse.
#pragma once

#include <exception>
#include <functional>
#include <vector>

#include "io/models/model_stream.h"

namespace frontmost::streaming {

/// The position of a piece in the stream.
struct PiecePlace {
  std::size_t number = 0;    ///< number of the piece
  PrimitiveId first = 0;     ///< number of its first triangle in the stream
  std::uint32_t object = 0;  ///< number of the object that its file became
};

/// Decides which pieces this rank reads.
struct Turns {
  int number = 0, count = 1;  ///< this rank's number, and the count of ranks
  std::vector<int> readers;   ///< as in StreamOptions::readers

  [[nodiscard]] int reader_of(std::size_t file) const { return file < readers.size() ? readers[file] : -1; }
};

/// A warning that a reader gave during a pass.
struct FileWarning {
  std::uint32_t file = 0;
  std::string text;
};

/// Several models, read as one.
class Models {
 public:
  Models(const std::vector<std::string>& paths, const LoadOptions& options, const Turns& turns,
         const Execution& execution);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] bool can_rewind() const;
  [[nodiscard]] double fraction() const;
  void rewind();
  /// \returns false at the end. \throws Error limit_exceeded for more triangles than ids can number, and as readers do.
  bool fetch(StreamPiece& piece, PiecePlace& place, std::uint32_t triangles);
  void parse(StreamPiece& piece, const PiecePlace& place) const;
  /// Number of triangles of the files that were read in the last pass.
  [[nodiscard]] std::uint64_t triangle_count() const;

  // Facts that ranks exchange after their first pass if each rank reads a part of the models.

  /// First id and number of triangles of each file in the last pass; the number is 0 for files that other ranks read.
  [[nodiscard]] std::vector<PrimitiveId> first_ids() const;
  [[nodiscard]] std::vector<std::uint64_t> triangle_counts() const;
  /// Sets the numbers of triangles of all files, read here or not. Ids are those of the whole model from now on.
  /// \throws Error as fetch().
  void set_triangle_counts(const std::vector<std::uint64_t>& counts);
  /// Moves out the warnings about files for which this rank reports.
  [[nodiscard]] std::vector<FileWarning> take_warnings();
  void add_warnings(const std::vector<FileWarning>& warnings);

 private:
  struct Model {
    std::unique_ptr<ModelStream> stream;
    std::uint32_t object = 0, first_material = 0;
    glm::dvec3 moved{0};               ///< position of its mesh in world space
    std::size_t warnings = 0;          ///< number of warnings taken over so far
    PrimitiveId first = 0;             ///< id of its first triangle
    std::uint64_t triangle_count = 0;  ///< number of triangles fetched in this pass
    bool has_ended = false;            ///< whether the file was read to its end, in this pass or an earlier one
  };
  void add(Model model);
  void warn(const Model& model, const std::string& text);
  void take_warnings(Model& model);
  /// True if all ranks read the file, taking turns by pieces.
  [[nodiscard]] bool is_shared(std::size_t file) const { return turns_.count > 1 && turns_.reader_of(file) < 0; }
  [[nodiscard]] bool is_read_here(std::size_t file) const {
    return turns_.count == 1 || is_shared(file) || turns_.reader_of(file) == turns_.number;
  }

  std::vector<Model> models_;
  Turns turns_;
  Scene scene_;
  std::vector<FileWarning> warnings_;  ///< warnings of passes, to be shared with other ranks
  bool has_opened_ = false, knows_firsts_ = false;
  std::size_t current_ = 0, begun_ = 0, next_number_ = 0;
  std::uint64_t next_ = 0, shared_pieces_ = 0;
};

struct LoopOptions {
  std::uint32_t triangles_at_once = 1;
  int workers = 1;
};

/// Calls work(worker, piece, place) for every piece. If several pieces fail, the error of the earliest is thrown, for
/// any number of threads.
void for_each_piece(Models& models, const LoopOptions& options, const Execution& execution,
                    const std::function<void(int worker, StreamPiece&, const PiecePlace&)>& work);

}  // namespace frontmost::streaming
