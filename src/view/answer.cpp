// SPDX-License-Identifier: Apache-2.0
#include "view/answer.h"

#include <algorithm>
#include <atomic>
#include <string>

#include "base/parallel.h"

namespace frontmost {

void check_planes(const Visible& visible, const char* who) {
  const std::size_t count = visible.view.sample_count();
  if (visible.primitives.size() != count || visible.keys.size() != count)
    throw Error(ErrorCode::bad_argument, std::string(who) + ": the planes do not have the size of their view");
}

void check_ids(std::span<const PrimitiveId> ids, std::uint32_t primitive_count, const char* who,
               const Execution& execution) {
  std::atomic<bool> is_of_others{false};
  constexpr std::size_t ids_at_once = 1u << 17;
  parallel_for(execution, ids.size(), ids_at_once, [&](std::size_t begin, std::size_t end) {
    // One more than each id, so that no_primitive becomes the least: one maximum, without a branch.
    std::uint32_t most = 0;
    for (std::size_t i = begin; i < end; ++i) most = std::max(most, ids[i] + 1);
    if (most > primitive_count) is_of_others = true;
  });
  if (is_of_others)
    throw Error(ErrorCode::bad_argument, std::string(who) + ": the surfaces are not those that were seen");
}

void check_answer(const Visible& visible, std::uint32_t primitive_count, const char* who, const Execution& execution) {
  check_planes(visible, who);
  check_ids({visible.primitives.data(), visible.primitives.size()}, primitive_count, who, execution);
}

}  // namespace frontmost
