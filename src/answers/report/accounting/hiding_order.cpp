// SPDX-License-Identifier: Apache-2.0
// The order of objects that hide each other. Tarjan's search joins each cycle into one component; components get ranks.
//
//    a hides b, b hides c, c hides b, c hides d          a  ->  { b, c }  ->  d
//                                                        0        1           2
#include <algorithm>

#include "frontmost/report.h"
#include "geometry/buckets.h"

namespace frontmost {
namespace {

/// Finds the components. A component is complete after all components that it hides.
class CycleSearch {
 public:
  CycleSearch(std::size_t count, std::span<const HiddenSamples> pairs)
      : hidden_(count, pairs.size(), [&](std::size_t i, const auto& add) { add(pairs[i].hider, pairs[i].object); },
                {.threads = 1}),
        next_(count, 0),
        numbers_(count, 0),
        component_(count, no_index) {
    for (std::uint32_t object = 0; object < count; ++object)
      if (numbers_[object] == 0) search(object);
  }

  [[nodiscard]] HidingOrder order() const {
    HidingOrder result;
    std::vector<std::vector<std::uint32_t>> members(component_count_);
    for (std::uint32_t i = 0; i < component_.size(); ++i) members[component_[i]].push_back(i);
    std::vector<std::uint32_t> ranks(component_count_, 0);
    // Components hide only those that were completed before them.
    for (std::size_t from = component_count_; from-- > 0;)
      for (const std::uint32_t object : members[from])
        for (const std::uint32_t hidden : hidden_[object]) {
          const std::uint32_t to = component_[hidden];
          if (to != from) ranks[to] = std::max(ranks[to], ranks[from] + 1);
        }
    for (const std::uint32_t component : component_) result.ranks.push_back(ranks[component]);
    for (std::vector<std::uint32_t>& cycle : members)
      if (cycle.size() > 1) result.cycles.push_back(std::move(cycle));
    std::sort(result.cycles.begin(), result.cycles.end());
    return result;
  }

 private:
  void search(std::uint32_t root) {
    std::vector<std::uint32_t> way;
    enter(root, way);
    while (!way.empty()) {
      const std::uint32_t object = way.back();
      if (next_[object] < hidden_[object].size()) {
        const std::uint32_t to = hidden_[object][next_[object]++];
        if (numbers_[to] == 0)
          enter(to, way);
        else if (component_[to] == no_index)
          lowest_[object] = std::min(lowest_[object], numbers_[to]);
        continue;
      }
      way.pop_back();
      if (!way.empty()) lowest_[way.back()] = std::min(lowest_[way.back()], lowest_[object]);
      if (lowest_[object] == numbers_[object]) close(object);
    }
  }

  void enter(std::uint32_t object, std::vector<std::uint32_t>& way) {
    numbers_[object] = lowest_[object] = ++entered_;
    open_.push_back(object);
    way.push_back(object);
  }

  void close(std::uint32_t object) {
    std::uint32_t member = no_index;
    do {
      member = open_.back();
      open_.pop_back();
      component_[member] = component_count_;
    } while (member != object);
    ++component_count_;
  }

  const Buckets<std::uint32_t> hidden_;  // hidden objects, by hider
  std::vector<std::size_t> next_;        // by object: number of its hidden objects that were visited
  std::vector<std::uint32_t> numbers_, lowest_ = numbers_, component_, open_;
  std::uint32_t entered_ = 0, component_count_ = 0;
};

}  // namespace

HidingOrder find_hiding_order(std::size_t object_count, std::span<const HiddenSamples> pairs) {
  for (const HiddenSamples& pair : pairs)
    if (pair.object >= object_count || pair.hider >= object_count || pair.object == pair.hider)
      throw Error(ErrorCode::bad_argument, "hiding order", "a pair needs two different objects");
  return CycleSearch(object_count, pairs).order();
}

}  // namespace frontmost
