// SPDX-License-Identifier: Apache-2.0
// Runs the stages of stages.h one after another, and repeats them for cycles until every piece has its place:
//
//   members --push--> work, the next on top      sort: pieces that may have an order    -> paint and part
//                       |          ^             part: a cycle, cut in two by a plane   -> part and sort
//                       +---run----+             paint: pieces in their order           -> the result
//
// Parting stops once groups are small enough to be sorted again: a plane that parts a cycle mostly leaves pieces that
// have an order, and every further plane would cut pieces that need no cut.
#include "frontmost/painter.h"

#include <algorithm>

#include "base/parallel.h"
#include "painter/stages.h"

namespace frontmost {
namespace {

using namespace painter_detail;

/// A group without an order is parted until its parts are so many times smaller, and the parts are sorted again. A
/// factor of 4 takes 1.3 times as long on assemblies of parts that pass through each other, for 2 to 9 % fewer
/// polygons, none of them visible. Parting down to single pieces, as PaintMethod::bsp does, takes a third of the time
/// and leaves half as many polygons again.
constexpr std::size_t kFewer = 64;

/// Makes one list of all pieces from a stack of work, the next work on top. A stack replaces recursion, as partitions
/// may be as uneven as there are pieces.
class Orderer {
 public:
  Orderer(Pieces& pieces, const PainterOptions& options, PaintEffort& effort, PaintSteps& steps)
      : pieces_(pieces), options_(options), steps_(steps), poll_(effort) {}

  [[nodiscard]] std::vector<std::uint32_t> order(std::vector<std::uint32_t> members) {
    all_ = members.size();
    foresee_cuts(members);
    push(std::move(members), options_.method == PaintMethod::bsp ? 0 : all_);
    while (!work_.empty()) {
      const Item item = std::move(work_.back());
      work_.pop_back();
      poll_.count();
      run(item);
    }
    return std::move(order_);
  }

 private:
  enum class Work : std::uint8_t { sort, part, paint };
  struct Item {
    Work work;
    std::vector<std::uint32_t> members;
    std::size_t few = 0;  ///< smaller groups are sorted again, larger ones parted further
  };

  void push(std::vector<std::uint32_t> members, std::size_t few) {
    if (members.empty()) return;
    const Work work = members.size() == 1 ? Work::paint : members.size() <= few ? Work::sort : Work::part;
    work_.push_back({work, std::move(members), few});
  }

  void run(const Item& item) {
    switch (item.work) {
      case Work::paint: order_.insert(order_.end(), item.members.begin(), item.members.end()); break;
      case Work::sort: sort(item.members); break;
      case Work::part: part_by_plane(item); break;
    }
  }

  void part_by_plane(const Item& item) {
    Partition partition = part(pieces_, item.members, steps_, poll_);
    check_limits();
    push(std::move(partition.before), item.few);
    work_.push_back({Work::paint, std::move(partition.within)});
    push(std::move(partition.behind), item.few);
  }

  [[noreturn]] void refuse_more_cuts() const {
    throw Error(
        ErrorCode::limit_exceeded, "painter",
        "more than " + std::to_string(options_.most_cuts) + " cuts: too many triangles pass through each other");
  }

  /// Throws early the error that would come after all cuts. Called before sorting, which would compare every two
  /// pieces.
  void foresee_cuts(const std::vector<std::uint32_t>& members) {
    const auto count = double(members.size());
    if (0.5 * count * count <= double(options_.most_cuts)) return;
    if (least_cuts(pieces_, members, poll_) > double(options_.most_cuts)) refuse_more_cuts();
  }

  void check_limits() const {
    if (steps_.cuts > options_.most_cuts) refuse_more_cuts();
    if (pieces_.size() > options_.most_polygons) refuse_more_polygons_than(options_.most_polygons);
  }

  void sort(const std::vector<std::uint32_t>& members) {
    const Groups groups = depth_sort(pieces_, members, members.size() == all_, steps_, poll_);
    std::vector<Item> items;
    std::size_t begin = 0;
    for (const std::size_t end : groups.ends) {
      const Work work = end - begin == 1 ? Work::paint : Work::part;
      if (work == Work::part || items.empty() || items.back().work == Work::part)
        items.push_back({work, {}, (end - begin) / kFewer});
      std::vector<std::uint32_t>& list = items.back().members;
      list.insert(list.end(), groups.pieces.begin() + std::ptrdiff_t(begin),
                  groups.pieces.begin() + std::ptrdiff_t(end));
      begin = end;
    }
    std::move(items.rbegin(), items.rend(), std::back_inserter(work_));
  }

  Pieces& pieces_;
  const PainterOptions& options_;
  PaintSteps& steps_;
  Poll poll_;
  std::size_t all_ = 0;
  std::vector<Item> work_;
  std::vector<std::uint32_t> order_;
};

void sort_by_centroid(const Pieces& pieces, std::vector<std::uint32_t>& members) {
  std::vector<double> depth(pieces.size());
  for (const std::uint32_t i : members)
    for (const glm::vec3& corner : pieces.face(i).corners) depth[i] += pieces.sight().in_eye(glm::dvec3(corner)).z;
  std::sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (depth[a] != depth[b]) return depth[a] > depth[b];
    return pieces.face(a).id > pieces.face(b).id;
  });
}

/// Fills an empty order with pieces as polygons, in the order of the list.
void fill(const Pieces& pieces, const std::vector<std::uint32_t>& members, PaintOrder& order, Poll& poll) {
  std::size_t corners = 0;
  order.polygons.reserve(members.size());
  for (const std::uint32_t piece : members) {
    order.polygons.push_back({pieces.face(piece).id, pieces.corner_count(piece), corners});
    corners += order.polygons.back().corner_count;
  }
  order.corners.resize(corners);
  for (std::size_t i = 0; i < members.size(); ++i) {
    poll.count();
    pieces.copy_corners(members[i], order.corners.data() + order.polygons[i].first_corner);
  }
}

}  // namespace

PaintOrder painter(const Surfaces& surfaces, const View& view, const PainterOptions& options,
                   const Execution& execution) {
  validate(view);
  const IeeeScope ieee;
  report_progress(execution, "painter", 0);
  PaintOrder order;
  order.view = view;
  Pieces pieces(view);
  std::vector<std::uint32_t> members = gather(surfaces, view, pieces, execution);
  if (pieces.size() > options.most_polygons) refuse_more_polygons_than(options.most_polygons);
  const Copies copies(pieces, members);
  std::vector<std::uint32_t> first;
  PaintEffort effort(execution, members.size());
  if (options.occluders.may_exist()) {
    Unhidden left = without_hidden(pieces, members, view, options.occluders, effort);
    members = std::move(left.others);
    first = std::move(left.unoverlapped);
  }
  report_progress(execution, "painter", 0.2);
  if (options.method == PaintMethod::farthest) {
    sort_by_farthest(pieces, members, execution);
  } else if (options.method == PaintMethod::centroid) {
    sort_by_centroid(pieces, members);
  } else {
    members = Orderer(pieces, options, effort, order.steps).order(std::move(members));
  }
  report_progress(execution, "painter", 0.9);
  first.insert(first.end(), members.begin(), members.end());
  copies.put_back(pieces, first, options.occluders, options.most_polygons);
  Poll poll(effort);
  fill(pieces, first, order, poll);
  report_progress(execution, "painter", 1);
  return order;
}

}  // namespace frontmost
