// SPDX-License-Identifier: Apache-2.0
// Models that are read piece by piece, from front to back, with only the current piece in memory. Streams share the
// parsers of whole files and give the same triangles in the same order, and the same errors.
//
//   fetch()   reads the bytes of some triangles: one thread at a time, in order
//   parse()   makes a mesh of those bytes: any number of threads, each with its own piece
#pragma once

#include <memory>
#include <mutex>

#include "frontmost/files.h"
#include "io/models/reader.h"

namespace frontmost {

/// Consecutive triangles of a model. A piece is reused and keeps its memory.
struct StreamPiece {
  std::uint64_t first_triangle = 0;  ///< in the model
  Mesh mesh;                         ///< vertices are numbered anew in each piece; no names, no face ids
  std::vector<std::byte> bytes;      ///< as in the file, for the reader's use
  std::size_t used = 0;              ///< number of bytes used
  std::uint64_t first_row = 0, row_count = 0, triangle_count = 0;

  void clear();
};

/// One model as a stream. Pieces are fetched in order. A thread may parse its piece while others fetch the next ones.
class ModelStream {
 public:
  virtual ~ModelStream() = default;

  /// Returns the scene without triangles. It has at most one mesh, which is empty, with its instance, and materials,
  /// textures, up axis and warnings. Warnings are complete after the last fetch().
  [[nodiscard]] const Scene& scene() const { return scene_; }
  /// Returns the source, which has the model's name. Warnings in scene() lack this name, as readers write them.
  [[nodiscard]] const ModelSource& source() const { return source_; }
  /// Sets the members of the scene that load() adds to a reader's scene.
  void introduce(std::string name, Axis up, SceneSource source) {
    scene_.name = std::move(name);
    scene_.up = up;
    scene_.source = std::move(source);
  }
  [[nodiscard]] bool can_rewind() const { return bytes_->can_rewind(); }
  /// Returns the total number of triangles, if the header or the size of the file tells it.
  [[nodiscard]] std::optional<std::uint64_t> known_count() const { return known_count_; }
  /// Returns the fraction of the model that was fetched, 0 to 1.
  [[nodiscard]] virtual double fraction() const = 0;
  /// Makes the next fetch() return the first piece. Precondition: can_rewind().
  virtual void rewind() = 0;
  /// Reads the bytes of about `triangles` further triangles and stores their actual number in the piece. The number may
  /// be zero if a file has faces of two corners. Only one thread at a time may call this function. \returns false at
  /// the end of the model. \throws Error as load() does.
  virtual bool fetch(StreamPiece& piece, std::uint64_t triangles) = 0;
  /// Reads as fetch() does, but only the piece's number of triangles is valid afterwards.
  virtual bool pass_over(StreamPiece& piece, std::uint64_t triangles) { return fetch(piece, triangles); }
  /// Makes piece.mesh of the bytes. Several threads may call it, each with its own piece. \throws Error as load() does.
  virtual void parse(StreamPiece& piece) const = 0;

 protected:
  ModelStream(std::unique_ptr<ByteStream> bytes, ModelSource source)
      : bytes_(std::move(bytes)), source_(std::move(source)) {}

  std::unique_ptr<ByteStream> bytes_;
  ModelSource source_;
  Scene scene_;
  std::optional<std::uint64_t> known_count_;
};

/// The first bytes of a stream, enough to recognize the format.
struct StreamStart {
  std::unique_ptr<ByteStream> bytes;
  std::vector<std::byte> start;  ///< read already
  std::string path;
  std::shared_ptr<OpenedFiles> opened;
  bool has_ended = false;  ///< whether `start` is the whole file

  /// Returns the size of the file, or nothing for a pipe that has not ended.
  [[nodiscard]] std::optional<std::uint64_t> size() const;
  /// Returns the size of the file, or a number greater than any file's size for a pipe that has not ended.
  [[nodiscard]] std::uint64_t greatest_size() const { return size().value_or(std::uint64_t(1) << 62); }
  /// Reads on until `start` has `size` bytes or the file ends.
  void extend(std::size_t size);
};

/// Opens a binary STL or PLY file, or "-", which is standard input.
/// \throws Error as load() does, and unsupported for other formats.
[[nodiscard]] std::unique_ptr<ModelStream> open_model_stream(const std::string& path, const LoadOptions& options,
                                                             const Execution& execution);
[[nodiscard]] std::unique_ptr<ModelStream> open_stl_stream(StreamStart start, const ModelSource& source);
[[nodiscard]] std::unique_ptr<ModelStream> open_ply_stream(StreamStart start, const ModelSource& source);

}  // namespace frontmost
