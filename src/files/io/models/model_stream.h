// SPDX-License-Identifier: Apache-2.0
// Models that are read piece by piece, from front to back, so that only the piece at hand is in memory. The parsing is
// that of the readers which read files whole; a stream gives the same triangles in the same order, and the same errors.
//
//   fetch()   the bytes of so many triangles: one thread at a time, in order
//   parse()   a mesh of those bytes: any number of threads, each with its own piece
#pragma once

#include <memory>
#include <mutex>

#include "frontmost/files.h"
#include "io/byte_stream.h"
#include "io/models/model_source.h"

namespace frontmost {

/// Consecutive triangles of a model. Reused from piece to piece, it keeps its memory.
struct StreamPiece {
  std::uint64_t first_triangle = 0;  ///< in the model
  Mesh mesh;                         ///< vertices are numbered anew in every piece; no names, no face ids
  std::vector<std::byte> bytes;      ///< as in the file: the reader's own
  std::size_t used = 0;              ///< of the bytes
  std::uint64_t first_row = 0, row_count = 0, triangle_count = 0;

  void clear();
};

/// One model. A piece is fetched in order, and parsed by whoever fetched it while others fetch the next.
class ModelStream {
 public:
  virtual ~ModelStream() = default;

  /// All but triangles: at most one mesh, without vertices, and its instance; materials, textures, up, and warnings,
  /// which are complete when the last piece was fetched.
  [[nodiscard]] const Scene& scene() const { return scene_; }
  /// For its warnings, which scene() holds as readers make them, without the model's name.
  [[nodiscard]] const ModelSource& source() const { return source_; }
  /// What load() adds to a reader's scene.
  void introduce(std::string name, Axis up, SceneSource source) {
    scene_.name = std::move(name);
    scene_.up = up;
    scene_.source = std::move(source);
  }
  [[nodiscard]] bool can_rewind() const { return bytes_->can_rewind(); }
  /// How many triangles there will be, where the header and the size of the file say.
  [[nodiscard]] std::optional<std::uint64_t> known_count() const { return known_count_; }
  /// How much of the model was fetched, 0 to 1.
  [[nodiscard]] virtual double fraction() const = 0;
  /// The next fetch() gives the first piece. Precondition: can_rewind().
  virtual void rewind() = 0;
  /// Reads the bytes of the next `triangles` or so, and says in the piece how many they hold: perhaps none, where a
  /// file has faces of two corners. For one thread at a time. \returns false at the end of the model. \throws Error as
  /// load() does.
  virtual bool fetch(StreamPiece& piece, std::uint64_t triangles) = 0;
  /// As fetch(), but of the piece nothing is kept than how many triangles it has.
  virtual bool pass_over(StreamPiece& piece, std::uint64_t triangles) { return fetch(piece, triangles); }
  /// Makes piece.mesh of the bytes. Several threads may, each with a piece of its own. \throws Error as load() does.
  virtual void parse(StreamPiece& piece) const = 0;

 protected:
  ModelStream(std::unique_ptr<ByteStream> bytes, ModelSource source)
      : bytes_(std::move(bytes)), source_(std::move(source)) {}

  std::unique_ptr<ByteStream> bytes_;
  ModelSource source_;
  Scene scene_;
  std::optional<std::uint64_t> known_count_;
};

/// What a stream begins with: enough to know the format.
struct StreamStart {
  std::unique_ptr<ByteStream> bytes;
  std::vector<std::byte> start;  ///< read already
  std::string path;
  std::shared_ptr<OpenedFiles> opened;
  bool has_ended = false;  ///< `start` is the whole file

  /// None for a pipe that goes on.
  [[nodiscard]] std::optional<std::uint64_t> size() const;
  /// For a pipe that goes on, more than any file has.
  [[nodiscard]] std::uint64_t greatest_size() const { return size().value_or(std::uint64_t(1) << 62); }
  /// Reads on until `start` has this size or the file ends.
  void extend(std::size_t size);
};

/// Opens a binary STL or PLY file, or "-", which is standard input.
/// \throws Error as load() does, and unsupported for other formats.
[[nodiscard]] std::unique_ptr<ModelStream> open_model_stream(const std::string& path, const LoadOptions& options,
                                                             const Execution& execution);
[[nodiscard]] std::unique_ptr<ModelStream> open_stl_stream(StreamStart start, const ModelSource& source);
[[nodiscard]] std::unique_ptr<ModelStream> open_ply_stream(StreamStart start, const ModelSource& source);

}  // namespace frontmost
