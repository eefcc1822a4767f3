// SPDX-License-Identifier: Apache-2.0
// Merges the results of ranks that stream a model together, after each pass.
//
//   rank 0   pieces of its own --> planes, copies of triangles --+
//   rank 1   pieces of its own --> planes, copies of triangles --+--> planes of the whole, on all ranks
//   ...                                                          +--> copies of the triangles seen there, on rank 0
//
// All ranks call each function at the same point.
#pragma once

#include <vector>

#include "frontmost/streams.h"
#include "stream/kept_triangles.h"
#include "stream/piece_loop.h"

namespace frontmost::streaming {

/// Results of a pass besides the visible triangles.
struct PassFacts {
  std::vector<std::uint64_t> triangle_counts;  ///< by file
  std::vector<FileWarning> warnings;           ///< in the order of files
  Box bounds;
};
/// \returns on all ranks the facts of all ranks together.
[[nodiscard]] PassFacts share(Ranks& ranks, const PassFacts& mine);

/// \returns on all ranks the lists of all ranks, joined.
[[nodiscard]] std::vector<glm::vec3> share(Ranks& ranks, const std::vector<glm::vec3>& mine);

/// Merges the planes of all ranks into the same planes on each. Ids are those of the whole model.
void share(Ranks& ranks, Visible& visible, const Execution& execution);

/// \returns on rank 0 the kept triangles of all ranks, and nothing on other ranks. Places are in the whole model.
[[nodiscard]] KeptPieces gather(Ranks& ranks, KeptPieces mine);

/// Maps ids of a pass, in which only this rank's files were counted, to ids of the whole model.
class IdShift {
 public:
  /// `from` and `to` have each file's first id, `counts` its number of ids in the pass: 0 for a file that was not read.
  IdShift(const std::vector<PrimitiveId>& from, const std::vector<std::uint64_t>& counts,
          const std::vector<PrimitiveId>& to);

  /// Precondition: `id` is an id of the pass.
  [[nodiscard]] PrimitiveId operator()(PrimitiveId id) const;
  /// Replaces all ids but no_primitive.
  void apply(std::span<PrimitiveId> ids, const Execution& execution) const;

 private:
  struct File {
    PrimitiveId from, shift;
  };
  std::vector<File> files_;  ///< ascending
};

}  // namespace frontmost::streaming
