// SPDX-License-Identifier: Apache-2.0
// Builds the tree of objects, and refits it after moves.
#include "occlusion/object_tree.h"

#include <algorithm>
#include <cmath>

#include "surfaces/hilbert.h"
#include "surfaces/radix_sort.h"

namespace frontmost::occlusion_detail {
namespace {

constexpr int kLevels = 10, kSizeBits = 2;

/// Orders objects by size, then by their place on D. Hilbert's curve. Size comes first, because a large object would
/// spoil the box of a group of small objects.
class ObjectCurve {
 public:
  explicit ObjectCurve(std::span<const Box> boxes) {
    Box all;
    for (const Box& box : boxes)
      if (!box.is_empty()) all.include(box);
    if (all.is_empty()) return;
    low_ = glm::dvec3(all.low);
    extent_ = std::max(greatest_side(all), 1e-300);
  }
  [[nodiscard]] std::uint32_t place_of(const Box& box) const {
    if (box.is_empty()) return ~0u;
    constexpr double kSteps = (1 << kLevels) - 1;
    const glm::dvec3 at = ((glm::dvec3(box.low) + glm::dvec3(box.high)) * 0.5 - low_) * (kSteps / extent_);
    std::uint32_t morton = 0;
    for (int axis = 0; axis < 3; ++axis) {
      // If boxes reach to infinity, `at` is NaN and the step is 0.
      const auto step = std::uint32_t(at[axis] > 0.0 ? std::min(at[axis], kSteps) : 0.0);
      for (int bit = 0; bit < kLevels; ++bit) morton |= (step >> bit & 1) << (3 * bit + axis);
    }
    const double share = greatest_side(box) / extent_;
    const std::uint32_t size = share > 1.0 / 16 ? 0 : share > 1.0 / 128 ? 1 : 2;
    return size << 3 * kLevels | hilbert_place(morton, kLevels);
  }

 private:
  static double greatest_side(const Box& box) {
    const glm::dvec3 size = glm::dvec3(box.high) - glm::dvec3(box.low);
    return std::max({size.x, size.y, size.z});
  }

  glm::dvec3 low_{0};
  double extent_ = 1;
};

std::vector<std::uint32_t> in_order(std::span<const Box> boxes) {
  const ObjectCurve curve(boxes);
  Buffer<std::uint64_t> keys(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) keys[i] = std::uint64_t(curve.place_of(boxes[i])) << 32 | i;
  keys = radix_sort(std::move(keys), 3 * kLevels + kSizeBits, {.threads = 1});
  std::vector<std::uint32_t> order(boxes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = std::uint32_t(keys[i]);
  return order;
}

}  // namespace

ObjectTree::ObjectTree(std::span<const Box> boxes, std::size_t its_most_on_top)
    : objects_(in_order(boxes)), items_(boxes.size()), first_{0} {
  auto count = std::uint32_t(boxes.size());
  for (std::uint32_t i = 0; i < count; ++i) items_[objects_[i]] = i;
  top_ = {0, count};
  for (std::uint32_t first = count; count > 0; first += count) {
    first_.push_back(first);
    if (count == 1) break;
    const bool is_top = top_.count > its_most_on_top;
    count = (count + group_size - 1) / group_size;
    if (is_top) top_ = {first, count};
  }
  if (boxes.empty()) return;
  boxes_ = BoxColumns(first_.back());
  for (std::uint32_t i = 0; i < objects_.size(); ++i) boxes_.set(i, boxes[objects_[i]]);
  for (std::uint32_t group = std::uint32_t(objects_.size()); group < first_.back(); ++group) fit(group);
}

void ObjectTree::refit() {
  moves_ += moved_.size();
  std::sort(moved_.begin(), moved_.end());
  for (std::size_t level = 1; level + 1 < first_.size(); ++level) {
    for (std::uint32_t& item : moved_) item = first_[level] + (item - first_[level - 1]) / group_size;
    moved_.erase(std::unique(moved_.begin(), moved_.end()), moved_.end());
    for (const std::uint32_t group : moved_) fit(group);
  }
  moved_.clear();
}

void ObjectTree::fit(std::uint32_t group) {
  Box box;
  const ItemRange items = items_of(group);
  for (std::uint32_t i = items.first; i < items.end(); ++i)
    if (const Box one = boxes_.get(i); !one.is_empty()) box.include(one);
  boxes_.set(group, box);
}

}  // namespace frontmost::occlusion_detail
