// SPDX-License-Identifier: Apache-2.0
// Streams: models of any length, drawn without holding them in memory as a whole.
//
//   file --a piece of triangles--> drawn into the views, merged, dropped --the next piece--> ...
//                                         |
//                                         +-- triangles that are seen so far are kept --> Excerpt, a small scene
//
// The minimum over (depth, primitive id) does not depend on the order of triangles, so pieces give to the bit the
// answer of the whole model. In the end at most one triangle per sample is seen. Shading, maps and reports work on
// these triangles in place of the model.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "frontmost/files.h"
#include "frontmost/pictures.h"
#include "frontmost/scene.h"
#include "frontmost/view.h"

namespace frontmost {

/// The processes that stream one model together, each a part of it, on one machine or many: MPI's ranks, or anything
/// else with these three operations. All ranks call the same operations in the same order, because every rank calls the
/// same functions of its Stream. A call returns when it has received what it needs from the other ranks. Exceptions of
/// an operation are passed on.
class Ranks {
 public:
  using Message = std::vector<std::byte>;

  virtual ~Ranks() = default;
  /// The rank of this process, 0 to count() - 1. Rank 0 gets the results.
  [[nodiscard]] virtual int number() const = 0;
  [[nodiscard]] virtual int count() const = 0;
  /// Replaces every value by the greatest that any rank has at its index. All ranks have the same number of values.
  virtual void keep_greatest(std::span<std::uint64_t> values) = 0;
  /// \returns on rank 0 the messages of all ranks, by rank; nothing on other ranks.
  virtual std::vector<Message> gather(Message message) = 0;
  /// \returns on all ranks the message of rank 0.
  virtual Message broadcast(Message message) = 0;
};

struct StreamOptions {
  LoadOptions load;
  /// Size of a piece, 1 to 2^24. It never changes a result.
  std::uint32_t triangles_at_once = 1u << 19;
  /// Ranks that stream the model together; borrowed, must outlive the stream. Null: this process streams all of it.
  Ranks* ranks = nullptr;
  /// For each file, the rank that alone reads its triangles. -1, or no entry: all ranks read the file, and take turns
  /// by pieces.
  std::vector<int> readers = {};
};

/// The part of a stream that some views show: a scene of the visible triangles, and of the neighbours that their smooth
/// normals need. Functions of surfaces and a Visible return for an Excerpt what they return for the whole model.
class Excerpt {
 public:
  Excerpt();
  ~Excerpt();
  Excerpt(Excerpt&&) noexcept;
  Excerpt& operator=(Excerpt&&) noexcept;

  [[nodiscard]] const Surfaces& surfaces() const;
  /// One Visible per view, with ids of surfaces().
  std::vector<Visible> visible;
  /// Value for ShadeInput::seen_by_light, for the first view; set if StreamNeeds::key_light asked for it.
  std::optional<Visible> seen_by_light;
  /// Numbers of the triangles in the stream, by id of surfaces(); ascending.
  std::vector<PrimitiveId> stream_ids;
  /// \returns `of_excerpt` with the stream's ids in place of those of surfaces(). The result is to the bit zbuffer()'s
  /// answer for the whole model.
  [[nodiscard]] Visible in_stream(Visible of_excerpt) const;

 private:
  friend class Stream;
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

/// Vertices of triangles, three each.
using CornerSpan = std::span<const std::array<glm::vec3, 3>>;

/// Facts needed besides the visible triangles.
struct StreamNeeds {
  bool key_light = false;  ///< triangles that cast shadows in the first view, for lit pictures; takes a second pass
  bool smooth_normals = false;  ///< neighbours of visible triangles, for meshes without normals; takes a second pass
  LightOptions light = {};      ///< lights of the picture, which include the key light
  /// Called with triangles while nothing is seen in the first view. A view that stays blank gets all of them, to find
  /// the reason. Several threads may call it at once. It takes no pass of its own.
  std::function<void(CornerSpan)> unseen = nullptr;
};

/// Streams binary STL and PLY files, each as an object, as if they formed one scene in this order. Memory: some pieces
/// at a time, at most 512 MiB or one piece, if that is more; 8 bytes per sample of the views; about 60 bytes per
/// visible triangle, 100 while an Excerpt is made. Vertices of PLY files are memory-mapped, and count as the system's
/// cache; those of a PLY from a pipe are kept, up to 512 MiB.
///
/// Ranks that stream a model together make Streams of the same files in the same order, and call the same functions.
/// Every rank opens all files. From a shared binary STL file it reads only its own triangles; from a shared PLY file
/// all faces, but only its own vertices. Results are to the bit those of one process with all files.
class Stream {
 public:
  /// Opens the files; "-" is standard input, which can be read only once.
  /// \throws Error as load() does; unsupported for text, other formats, triangle strips or several vertex or face
  /// elements in PLY, and with ranks for anything but ordinary files; limit_exceeded for more than 2^32 - 2 triangles
  /// in all.
  explicit Stream(const std::vector<std::string>& paths, const StreamOptions& options = {},
                  const Execution& execution = {});
  ~Stream();
  Stream(Stream&&) noexcept;
  Stream& operator=(Stream&&) noexcept;

  /// The scene without its triangles: objects, materials, textures, up axis, and warnings, which are complete after a
  /// pass. Bounds, outline and views are relative to its origin. That origin is the first file's, as load() sets it,
  /// but zero for an STL file from a pipe.
  [[nodiscard]] const Scene& scene() const;
  /// True if the model can be read again. \see passes()
  [[nodiscard]] bool can_repeat() const;
  /// Number of passes over the files so far.
  [[nodiscard]] int passes() const;
  /// After a pass: the number of all triangles, and the bounds of those with finite vertices.
  [[nodiscard]] std::uint64_t triangle_count() const;
  [[nodiscard]] Box bounds() const;

  /// A scene of points with the bounds and framing of the model. A view in the direction of `direction` and with its
  /// field of view is framed to the bit as for the whole model. The scene is the same on all ranks. One pass.
  [[nodiscard]] Scene outline(const View& direction, double margin = 0.05, const Execution& execution = {});

  /// Finds the triangles that the views show. One pass, and a second one if the needs ask for it and anything is seen.
  /// Ranks other than 0 get an Excerpt without views and surfaces.
  /// \throws Error as load() and zbuffer() do; unsupported if a second pass is needed and can_repeat() is false.
  [[nodiscard]] Excerpt look(const std::vector<View>& views, const StreamNeeds& needs = {},
                             const Execution& execution = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace frontmost
