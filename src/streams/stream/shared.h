// SPDX-License-Identifier: Apache-2.0
// What ranks that stream a model together make of their parts after a pass.
//
//   rank 0   pieces of its own --> planes, copies of triangles --+
//   rank 1   pieces of its own --> planes, copies of triangles --+--> planes of the whole, on all ranks
//   ...                                                          +--> copies of what those show, on rank 0
//
// Each function is called by all ranks at the same place.
#pragma once

#include <vector>

#include "frontmost/streams.h"
#include "stream/kept_triangles.h"
#include "stream/piece_loop.h"

namespace frontmost::streaming {

/// What a pass finds beside what is seen.
struct PassFacts {
  std::vector<std::uint64_t> triangle_counts;  ///< by file
  std::vector<FileWarning> warnings;           ///< in the order of files
  Box bounds;
};
/// Those of all ranks, on all ranks.
[[nodiscard]] PassFacts share(Ranks& ranks, const PassFacts& mine);

/// The lists of all ranks in one, on all ranks.
[[nodiscard]] std::vector<glm::vec3> share(Ranks& ranks, const std::vector<glm::vec3>& mine);

/// What all ranks see becomes what each sees. Ids are those of the whole.
void share(Ranks& ranks, Visible& visible, const Execution& execution);

/// The copies of all ranks, on rank 0; none on others. Places are in the whole.
[[nodiscard]] KeptPieces gather(Ranks& ranks, KeptPieces mine);

/// From the ids of a pass in which only files of this rank were counted to those of the whole.
class IdShift {
 public:
  /// `from` are where the ids of the files began, `counts` how many there were: files that were not read have none.
  IdShift(const std::vector<PrimitiveId>& from, const std::vector<std::uint64_t>& counts,
          const std::vector<PrimitiveId>& to);

  /// Precondition: it is an id of the pass.
  [[nodiscard]] PrimitiveId operator()(PrimitiveId id) const;
  /// Of all but no_primitive.
  void apply(std::span<PrimitiveId> ids, const Execution& execution) const;

 private:
  struct File {
    PrimitiveId from, shift;
  };
  std::vector<File> files_;  ///< ascending
};

}  // namespace frontmost::streaming
