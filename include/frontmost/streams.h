// SPDX-License-Identifier: Apache-2.0
// Streams: models of any length, drawn without ever being in memory as a whole.
//
//   file --a piece of triangles--> drawn into the views, merged, forgotten --the next piece--> ...
//                                         |
//                                         +-- triangles that are seen so far are kept --> Excerpt, a small scene
//
// The minimum over (depth, primitive id) does not care in which order triangles come, so pieces give to the bit what
// the whole model gives. What is seen in the end is at most a triangle for each sample; shading, maps and reports take
// those for the model.
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

/// The processes, on one machine or many, that stream one model together, each a part of it: MPI's ranks, or whatever
/// else does these three things. All of them call the same ones in the same order, as their Streams do; a call ends
/// when what it needs has come from the others. What one throws goes through.
class Ranks {
 public:
  using Message = std::vector<std::byte>;

  virtual ~Ranks() = default;
  /// From 0 to count() - 1. Rank 0 has the results.
  [[nodiscard]] virtual int number() const = 0;
  [[nodiscard]] virtual int count() const = 0;
  /// Every value becomes the greatest that any rank has in its place. As many on all ranks.
  virtual void keep_greatest(std::span<std::uint64_t> values) = 0;
  /// \returns on rank 0 what every rank has handed in, by its number; on others nothing.
  virtual std::vector<Message> gather(Message message) = 0;
  /// \returns on all ranks what rank 0 has handed in.
  virtual Message broadcast(Message message) = 0;
};

struct StreamOptions {
  LoadOptions load;
  /// Read, drawn and forgotten together, 1 to 2^24. Never changes a result.
  std::uint32_t triangles_at_once = 1u << 19;
  /// With whom the model is streamed; borrowed, and it must outlive the stream. Null: this process has all of it.
  Ranks* ranks = nullptr;
  /// By file, the rank that alone reads its triangles. -1, or beyond the end: all ranks, whose pieces take turns.
  std::vector<int> readers = {};
};

/// What some views show of a stream: a scene of the triangles that are seen, and of those that their smooth normals
/// need. Whatever takes surfaces and a Visible gives for it what it gives for the whole model.
class Excerpt {
 public:
  Excerpt();
  ~Excerpt();
  Excerpt(Excerpt&&) noexcept;
  Excerpt& operator=(Excerpt&&) noexcept;

  [[nodiscard]] const Surfaces& surfaces() const;
  /// One for each view. Their ids are those of surfaces().
  std::vector<Visible> visible;
  /// For ShadeInput::seen_by_light, if it was asked for; of the first view.
  std::optional<Visible> seen_by_light;
  /// The numbers of the triangles in the stream, by id of surfaces(); ascending.
  std::vector<PrimitiveId> stream_ids;
  /// The same with ids of the stream: to the bit what zbuffer() shows of the whole model.
  [[nodiscard]] Visible in_stream(Visible of_excerpt) const;

 private:
  friend class Stream;
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

/// Corners of triangles.
using CornerSpan = std::span<const std::array<glm::vec3, 3>>;

/// What is to be known of a stream beside what is visible.
struct StreamNeeds {
  bool key_light = false;       ///< what throws shadows in the first view: for pictures that are lit. A second pass
  bool smooth_normals = false;  ///< the neighbours of triangles that are seen: where meshes have no normals. The same
  LightOptions light = {};      ///< of the picture: where its key light is
  /// Called with triangles as long as nothing is seen in the first view: with all of them when it stays blank, so that
  /// it can be said why. By several threads at once. No pass of its own.
  std::function<void(CornerSpan)> unseen = nullptr;
};

/// Binary STL and PLY files, each an object, as if their scenes stood in one, in this order. Memory: some pieces at a
/// time, at most 512 MiB or one piece, whichever is more; and for each sample of the views 8 bytes, and of the
/// triangles seen about 60 bytes each, 100 while an Excerpt is made. Vertices of PLY files are mapped, and count
/// as the system's cache; those of a PLY from a pipe are kept, up to 512 MiB.
///
/// Where ranks stream a model together, each makes a Stream of the same files in the same order, and calls the same
/// functions. Each opens all of the files, and reads of binary STL files its own triangles alone, of PLY files that all
/// of them read all faces, but its own vertices. Results are to the bit those of one process that has all files.
class Stream {
 public:
  /// Opens the files; "-" is standard input, which can be read only once.
  /// \throws Error as load() does; unsupported for text, other formats, and triangle strips or several elements of
  /// vertices or faces in PLY, and among ranks for what is no ordinary file; limit_exceeded for more than 2^32 - 2
  /// triangles in all.
  explicit Stream(const std::vector<std::string>& paths, const StreamOptions& options = {},
                  const Execution& execution = {});
  ~Stream();
  Stream(Stream&&) noexcept;
  Stream& operator=(Stream&&) noexcept;

  /// All but the triangles: objects, materials, textures, which way is up; warnings, complete after a pass. Its origin
  /// is the first file's, as load() gives it, but zero of an STL file from a pipe; bounds, outline and views are about
  /// it.
  [[nodiscard]] const Scene& scene() const;
  /// Whether the model can be read again. \see passes()
  [[nodiscard]] bool can_repeat() const;
  /// How often it was read.
  [[nodiscard]] int passes() const;
  /// Of all triangles that were read; of those with finite corners. After a pass.
  [[nodiscard]] std::uint64_t triangle_count() const;
  [[nodiscard]] Box bounds() const;

  /// A scene of points that stands for the model wherever only bounds and framing count: a view that looks the way of
  /// `direction`, with the same field of view, is framed to the bit as it is for the whole model. The same on all
  /// ranks. One pass.
  [[nodiscard]] Scene outline(const View& direction, double margin = 0.05, const Execution& execution = {});

  /// What the views show. One pass, and another one where the needs ask for something that is seen. On ranks other than
  /// the first an Excerpt without views and surfaces.
  /// \throws Error as load() and zbuffer() do; unsupported where another pass is needed and can_repeat() is false.
  [[nodiscard]] Excerpt look(const std::vector<View>& views, const StreamNeeds& needs = {},
                             const Execution& execution = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace frontmost
