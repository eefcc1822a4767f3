// SPDX-License-Identifier: Apache-2.0
// Lists of results for each polygon on the screen: computed slot by slot, by several threads, and joined in the order
// of painting.
//
// Threads take slots, because neighbours on the screen share the data that they read. Results are needed in the order
// of painting, so each list remembers where the results of every slot end, and the lists are then read by place. The
// result does not depend on which thread made which list.
#pragma once

#include <atomic>
#include <type_traits>
#include <vector>

#include "base/parallel.h"
#include "base/pool.h"
#include "painter/seen/screen_polygons.h"

namespace frontmost::painter_detail {

inline constexpr std::size_t slots_per_list = 1024;

/// Calls add(worker, slot, list) for every slot, which adds the results of one polygon to a List. Each thread has a
/// worker of its own, made by new_worker(). \returns the joined list, by place. `name` names the progress.
///
/// A List has add_polygon(other, i), which adds the results of the list `other` for its i-th polygon, and
/// reserve(lists).
template <class List, class NewWorker, class Add>
List list_by_place(const ScreenPolygons& screen, const Execution& execution, const char* name,
                   const NewWorker& new_worker, const Add& add) {
  const std::size_t count = screen.count();
  std::vector<List> lists((count + slots_per_list - 1) / slots_per_list);
  Pool<typename std::invoke_result_t<NewWorker>::element_type> workers;
  std::atomic<std::size_t> done{0};
  parallel_for(execution, count, slots_per_list, [&](std::size_t begin, std::size_t end) {
    const auto worker = workers.borrow(new_worker);
    for (std::size_t slot = begin; slot < end; ++slot) add(*worker, slot, lists[begin / slots_per_list]);
    report_progress(execution, name, double(done += end - begin) / double(count));
  });
  List all;
  all.reserve(lists);
  for (std::uint32_t place = 0; place < count; ++place) {
    const std::size_t slot = screen.slot(place);
    all.add_polygon(lists[slot / slots_per_list], slot % slots_per_list);
  }
  return all;
}

/// Reserves room for the sum of one vector of all lists.
template <class T, class List>
void reserve_sum(std::vector<T>& all, const std::vector<List>& lists, std::vector<T> List::*member) {
  std::size_t sum = 0;
  for (const List& list : lists) sum += (list.*member).size();
  all.reserve(sum);
}

}  // namespace frontmost::painter_detail
