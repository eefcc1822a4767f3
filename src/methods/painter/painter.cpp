// SPDX-License-Identifier: Apache-2.0
// Runs the stages of stages.h one after another, and repeats sorting and parting for cycles until every piece has its
// place in the order:
//
//   members --push--> work, the next on top      sort: pieces that may have an order    -> paint and part
//                       |          ^             part: a cycle, cut in two by a plane   -> part and sort
//                       +---run----+             paint: pieces in their order           -> the result
//
// Parting stops once groups are small enough to be sorted again, because a plane that parts a cycle mostly leaves
// pieces that have an order. Every further plane would cut pieces that need no cut.
#include "frontmost/painter.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "base/memory.h"
#include "base/parallel.h"
#include "painter/stages.h"
#include "surfaces/cluster_set.h"
#include "view/facing_rule.h"

namespace frontmost {
namespace painter_detail {
namespace {

constexpr std::size_t kTrianglesPerPart = 4096;
/// Relative margin of distances, which is greater than their rounding.
constexpr double kMargin = 1e-9;

class Gatherer {
 public:
  Gatherer(const Surfaces& surfaces, const View& view, const Sight& sight)
      : surfaces_(surfaces),
        view_(view),
        sight_(sight),
        empty_(sight),
        facing_(view.culling, placed_scene(surfaces).sides.get()) {}

  enum class Place : std::uint8_t { outside, inside, crossing };

  /// Sets the extent and the face of a triangle that is not outside. \returns `crossing` if the near or far plane may
  /// cut it.
  Place gather(PrimitiveId id, PolygonExtent& extent, Face& face) const {
    face = {surfaces_.corners(id), id};
    for (const glm::vec3& corner : face.corners)
      if (!is_finite(corner)) return Place::outside;
    ExtentBuilder box = empty_;
    double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
    for (const glm::vec3& corner : face.corners) {
      const glm::dvec3 in_eye = sight_.in_eye(glm::dvec3(corner));
      nearest = std::min(nearest, in_eye.z);
      farthest = std::max(farthest, in_eye.z);
      box.include(in_eye);
    }
    const double slack = kMargin * std::max(std::abs(nearest), std::abs(farthest));
    if (farthest + slack < sight_.near() || nearest - slack > sight_.far()) return Place::outside;
    const bool is_crossing = nearest - slack < sight_.near() || farthest + slack > sight_.far();
    extent = is_crossing ? anywhere() : box.extent();
    extent.low = glm::max(extent.low, glm::vec2(0));
    extent.high = glm::min(extent.high, glm::vec2(view_.width, view_.height));
    if (!(extent.low.x < extent.high.x && extent.low.y < extent.high.y) || !turn_to_eye(face)) return Place::outside;
    return is_crossing ? Place::crossing : Place::inside;
  }

 private:
  static PolygonExtent anywhere() {
    const float infinite = std::numeric_limits<float>::infinity();
    return {glm::vec2(-infinite), glm::vec2(infinite), -infinite, infinite};
  }

  /// Makes a face counter-clockwise to the eye. \returns false if the face is not visible at all.
  bool turn_to_eye(Face& face) const {
    const auto& c = face.corners;
    const int facing = sight_.facing(glm::dvec3(c[0]), glm::dvec3(c[1]), glm::dvec3(c[2]));
    if (facing == 0) return false;
    if (facing_.culling() != Culling::none) {
      const bool is_front = (facing > 0) != surfaces_.is_mirrored(surfaces_.source(face.id).instance);
      if (!facing_.keeps(face.id, is_front)) return false;
    }
    if (facing < 0) std::swap(face.corners[1], face.corners[2]);
    return true;
  }

  const Surfaces& surfaces_;
  const View& view_;
  const Sight& sight_;
  const ExtentBuilder empty_;
  const FacingRule facing_;
};

/// Returns the plane at a distance in front of the eye, facing away from the eye.
Plane plane_at(const View& view, double distance) {
  return {view.eye() + view.forward() * distance, Leg{view.up()}, Leg{view.right()}};
}

/// Cuts away everything outside the near and far planes. \returns the remaining piece, or no_index if nothing remains.
std::uint32_t clip(Pieces& pieces, std::uint32_t piece, std::uint32_t near_plane, const Plane& near,
                   std::uint32_t far_plane, const Plane* far) {
  const Sides at_near = pieces.sides(piece, near);
  if (!at_near.front) return no_index;
  if (at_near.both()) piece = pieces.cut(piece, near_plane).front;
  if (!far) return piece;
  const Sides at_far = pieces.sides(piece, *far);
  if (!at_far.back) return no_index;
  return at_far.both() ? pieces.cut(piece, far_plane).back : piece;
}

/// The triangles that are kept of a part of consecutive ids, in the order of their ids.
struct Part {
  std::size_t count = 0;
  std::vector<std::uint32_t> crossing;  ///< numbers of triangles in the part, from 0
};

/// Fills a section of the list for every part, then joins the sections. \returns the triangles that cross the near or
/// far plane.
std::vector<std::uint32_t> fill(const Surfaces& surfaces, const Gatherer& gatherer, Pieces& pieces,
                                const Execution& execution) {
  const std::size_t all = surfaces.primitive_count();
  pieces.resize(all);
  std::vector<Part> parts((all + kTrianglesPerPart - 1) / kTrianglesPerPart);
  parallel_for(execution, all, kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
    Part& part = parts[begin / kTrianglesPerPart];
    for (std::size_t id = begin; id < end; ++id) {
      PolygonExtent extent;
      Face face;
      const Gatherer::Place place = gatherer.gather(PrimitiveId(id), extent, face);
      if (place == Gatherer::Place::outside) continue;
      if (place == Gatherer::Place::crossing) part.crossing.push_back(std::uint32_t(part.count));
      pieces.set(begin + part.count++, extent, face);
    }
  });
  std::size_t total = 0;
  std::vector<std::uint32_t> crossing;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto first = std::uint32_t(i * kTrianglesPerPart);
    for (const std::uint32_t k : parts[i].crossing) crossing.push_back(std::uint32_t(total) + k);
    for (std::uint32_t k = 0; k < parts[i].count && first != total; ++k)
      pieces.set(total + k, pieces.extent(first + k), pieces.face(first + k));
    total += parts[i].count;
  }
  pieces.resize(total);
  return crossing;
}

}  // namespace

std::vector<std::uint32_t> gather(const Surfaces& surfaces, const View& view, Pieces& pieces,
                                  const Execution& execution) {
  const std::vector<std::uint32_t> crossing = fill(surfaces, {surfaces, view, pieces.sight()}, pieces, execution);
  std::vector<std::uint32_t> members(pieces.size());
  for (std::uint32_t i = 0; i < members.size(); ++i) members[i] = i;

  const bool has_far = view.projection.clip.far < std::numeric_limits<double>::infinity();
  const Plane near = plane_at(view, pieces.sight().near());
  const Plane far = has_far ? plane_at(view, pieces.sight().far()) : near;
  const std::uint32_t near_plane = pieces.add_plane(near), far_plane = pieces.add_plane(far);
  for (const std::uint32_t i : crossing)
    members[i] = clip(pieces, i, near_plane, near, far_plane, has_far ? &far : nullptr);
  members.erase(std::remove(members.begin(), members.end(), no_index), members.end());
  return members;
}

}  // namespace painter_detail

namespace {

using namespace painter_detail;

/// The most table entries that a triangle is compared with. A copy that is not found among them stays.
constexpr int kMostProbes = 64;

/// Odd numbers without a pattern.
constexpr std::uint64_t kMix = 0x9e3779b97f4a7c15, kMixCorner = 0xc2b2ae3d27d4eb4f;

/// Hash of three vertices, which does not depend on which of them comes first.
std::uint64_t hash_of(const Face& face) {
  std::uint64_t sum = 0;
  for (const glm::vec3& corner : face.corners) {
    const glm::vec3 no_negative_zero = corner + 0.0f;
    std::uint32_t bits[3];
    std::memcpy(bits, &no_negative_zero, sizeof bits);
    const std::uint64_t mixed = ((bits[0] * kMix) ^ (std::uint64_t(bits[1]) << 32 | bits[2])) * kMixCorner;
    sum += mixed ^ (mixed >> 32);
  }
  return sum * kMix;
}

/// Returns whether the faces have the same vertices. Both faces are counter-clockwise to the eye, so the same vertices
/// are in the same cyclic order.
bool is_copy(const Face& a, const Face& b) {
  for (std::size_t turn = 0; turn < 3; ++turn)
    if (a.corners[0] == b.corners[turn])
      return a.corners[1] == b.corners[(turn + 1) % 3] && a.corners[2] == b.corners[(turn + 2) % 3];
  return false;
}

/// Hash table of the first triangle of each group of copies, with open addressing.
class FirstOnes {
 public:
  explicit FirstOnes(std::size_t count) {
    while (std::size_t(1) << bits_ < 2 * count) ++bits_;
    entries_.assign(std::size_t(1) << bits_, {0, no_index});
  }
  void prefetch(std::uint64_t hash) const { prefetch_line(&entries_[home(hash)]); }

  /// Returns the piece that this piece is a copy of, or no_index; this piece is then stored.
  std::uint32_t find_or_add(const Pieces& pieces, std::uint32_t piece, std::uint64_t hash) {
    const auto tag = std::uint32_t(hash);
    std::size_t i = home(hash);
    for (int probe = 0; probe < kMostProbes; ++probe, i = (i + 1) & (entries_.size() - 1)) {
      Entry& entry = entries_[i];
      if (entry.piece == no_index) {
        entry = {tag, piece};
        return no_index;
      }
      if (entry.tag == tag && is_copy(pieces.face(entry.piece), pieces.face(piece))) return entry.piece;
    }
    return no_index;
  }

 private:
  struct Entry {
    std::uint32_t tag, piece;
  };
  [[nodiscard]] std::size_t home(std::uint64_t hash) const { return std::size_t(hash >> (64 - bits_)); }

  unsigned bits_ = 1;
  std::vector<Entry> entries_;
};

/// Triangles that coincide, because exporters write faces twice, or models are placed twice. Of triangles with the same
/// vertices, only the one with the lowest id is ordered and cut. The others are its copies and lie directly below it.
class Copies {
 public:
  /// Takes copies out of `members`, which are in the order of their ids. O(members).
  Copies(const Pieces& pieces, std::vector<std::uint32_t>& members) {
    constexpr std::size_t ahead = 16;
    FirstOnes first_ones(members.size());
    std::vector<std::uint64_t> hashes;
    hashes.reserve(members.size());
    for (const std::uint32_t piece : members) hashes.push_back(hash_of(pieces.face(piece)));
    std::size_t kept = 0;
    for (std::size_t i = 0; i < hashes.size(); ++i) {
      if (i + ahead < hashes.size()) first_ones.prefetch(hashes[i + ahead]);
      const std::uint32_t piece = members[i];
      // Only whole triangles are compared, because a triangle that the near plane cut has an outline of its own.
      const std::uint32_t first = pieces.is_whole(piece) ? first_ones.find_or_add(pieces, piece, hashes[i]) : no_index;
      if (first == no_index)
        members[kept++] = piece;
      else
        copies_.push_back({pieces.face(first).id, piece});
    }
    members.resize(kept);
    std::stable_sort(copies_.begin(), copies_.end(), [](const Copy& a, const Copy& b) { return a.of < b.of; });
  }

  /// Puts copies back, directly below each piece of their original, unless the original is an occluder and hides them.
  /// Each copy gets the outline of that piece and its own id. \throws Error limit_exceeded if there are then more than
  /// `most` pieces.
  void put_back(Pieces& pieces, std::vector<std::uint32_t>& members, const Occluders& occluders,
                std::size_t most) const {
    if (copies_.empty()) return;
    std::size_t count = members.size();
    for (const std::uint32_t piece : members) count += of(pieces.face(piece).id, occluders).size();
    if (count > most) refuse_more_polygons_than(most);
    std::vector<std::uint32_t> all;
    all.reserve(count);
    for (const std::uint32_t piece : members) {
      const std::span<const Copy> copies = of(pieces.face(piece).id, occluders);
      for (std::size_t i = copies.size(); i-- > 0;) {
        all.push_back(copies[i].piece);
        if (pieces.is_whole(piece)) continue;
        Face face = pieces.face(piece);
        face.id = pieces.face(copies[i].piece).id;
        pieces.add(pieces.extent(piece), face);
        all.back() = pieces.size() - 1;
      }
      all.push_back(piece);
    }
    members = std::move(all);
  }

 private:
  struct Copy {
    PrimitiveId of;
    std::uint32_t piece;
  };
  [[nodiscard]] std::span<const Copy> of(PrimitiveId id, const Occluders& occluders) const {
    const auto is_before = [](const Copy& copy, PrimitiveId other) { return copy.of < other; };
    const auto begin = std::lower_bound(copies_.begin(), copies_.end(), id, is_before);
    auto end = begin;
    while (end != copies_.end() && end->of == id) ++end;
    if (begin == end || occluders.contain(id)) return {};
    return {&*begin, std::size_t(end - begin)};
  }

  std::vector<Copy> copies_;  ///< sorted by originals; the copies of each from the lowest to the highest id
};

/// A group without an order is parted until its parts are smaller by this factor; the parts are then sorted again. On
/// assemblies of parts that pass through each other, a factor of 4 takes 1.3 times as long and makes 2 to 9 % fewer
/// polygons, none of them visible. Parting down to single pieces, as PaintMethod::bsp does, takes a third of the time
/// and makes 1.5 times as many polygons.
constexpr std::size_t kFewer = 64;

/// Orders all pieces by means of a stack of work, with the next work on top. The stack replaces recursion, because
/// partitions may be so uneven that recursion would be as deep as there are pieces.
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
    std::size_t few = 0;  ///< groups of at most this size are sorted again, larger groups are parted further
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
    throw Error(ErrorCode::limit_exceeded, "painter",
                "more than " + std::to_string(options_.most_cuts) + " cuts: too many triangles intersect");
  }

  /// Refuses a list that needs too many cuts. This is done before sorting, which would compare every two pieces.
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
