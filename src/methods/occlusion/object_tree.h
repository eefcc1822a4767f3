// SPDX-License-Identifier: Apache-2.0
// A tree of objects in groups, and groups of groups. Objects that are hidden together, or outside together, are tested
// at once.
//
//    level 2                  [ 34 ]                     Items have numbers: first the objects, in an order in which
//    level 1       [ 32 ]               [ 33 ]           neighbours in space follow each other; then groups of 16
//    level 0    [0][1]...[15]     [16][17]...[31]        objects, then groups of 16 groups, up to one group of all.
//
// The box of an item contains all items below it.
#pragma once

#include <span>
#include <vector>

#include "occlusion/cells.h"

namespace frontmost::occlusion_detail {

class ObjectTree {
 public:
  /// The number of items in a group, and the most items that a search may begin with.
  static constexpr std::uint32_t group_size = 16, most_on_top = 64;

  ObjectTree() = default;
  /// O(objects).
  explicit ObjectTree(std::span<const Box> boxes, std::size_t its_most_on_top = most_on_top);

  /// Sets the box of an object. Call refit() after all moves.
  void move(std::uint32_t object, const Box& box) {
    boxes_.set(items_[object], box);
    moved_.push_back(items_[object]);
  }
  /// Fits the boxes of all groups to the moved objects. O(moved x levels).
  void refit();
  /// Returns whether so many objects have moved that a new order may be better.
  [[nodiscard]] bool is_outdated() const { return moves_ > 4 * objects_.size(); }

  [[nodiscard]] const BoxColumns& boxes() const { return boxes_; }  ///< by item
  [[nodiscard]] std::size_t item_count() const { return first_.back(); }
  [[nodiscard]] ItemRange top() const { return top_; }
  [[nodiscard]] bool is_object(std::uint32_t item) const { return item < objects_.size(); }
  /// Precondition: is_object(item).
  [[nodiscard]] std::uint32_t object(std::uint32_t item) const { return objects_[item]; }
  /// The items of a group. Precondition: not is_object(item).
  [[nodiscard]] ItemRange items_of(std::uint32_t item) const {
    const std::size_t level = level_of(item);
    const std::uint32_t first = first_[level - 1] + (item - first_[level]) * group_size;
    return {first, std::min(group_size, first_[level] - first)};
  }
  /// The objects at or below the item, as a range of items.
  [[nodiscard]] ItemRange objects_of(std::uint32_t item) const {
    const std::size_t level = level_of(item);
    std::uint32_t first = item - first_[level], count = 1;
    for (std::size_t i = 0; i < level; ++i) first *= group_size, count *= group_size;
    return {first, std::min(count, std::uint32_t(objects_.size()) - first)};
  }
  /// Returns the group of all objects. Precondition: there are objects.
  [[nodiscard]] std::uint32_t root() const { return first_.back() - 1; }

 private:
  [[nodiscard]] std::size_t level_of(std::uint32_t item) const {
    std::size_t level = 0;
    while (first_[level + 1] <= item) ++level;
    return level;
  }
  void fit(std::uint32_t group);

  std::vector<std::uint32_t> objects_;   ///< by item
  std::vector<std::uint32_t> items_;     ///< by object
  std::vector<std::uint32_t> first_{0};  ///< first item of each level; then the number of items
  BoxColumns boxes_{0};
  ItemRange top_;
  std::vector<std::uint32_t> moved_;
  std::size_t moves_ = 0;
};

}  // namespace frontmost::occlusion_detail
