// SPDX-License-Identifier: Apache-2.0
// The visible faces, found cell by cell of the picture: at once in cells where no relevant surface ends, else in
// smaller cells.
//
//   Surfaces --viewed_faces()--> faces on the screen --cells--> parts of them --added up--> VisibleFaces
//
//    eye                      In a cell, a group of faces lies nearer than all others, by the ranges of their keys.
//     |    ____               If no surface ends at their sides within the cell, the number of them over a place is
//     |   /    \__  group     the same everywhere, so one place tells it. (A side is plain if one face continues
//     |  ~~~~~~~~~~           another there.) If the number is 1, every face of the group is seen as far as it lies
//     |   . . . .   others    in the cell. If it is 1 or more, nothing behind the group is seen.
//     v
#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "base/pool.h"
#include "base/work_limit.h"
#include "report/faces/cell_lists.h"
#include "report/faces/pieces.h"

namespace frontmost::faces_detail {
namespace {

/// Side length of the smallest cells, in pixels.
constexpr double kSmallestCell = 1.0 / 1024;
/// A cell with at most this number of faces is not divided. The faces cut each other instead.
constexpr std::size_t kFewFaces = 128;
/// A cell with more faces than this is divided even if most of them reach into all of its parts, because the faces hide
/// each other in the parts.
constexpr std::size_t kManyFaces = 256;
/// The largest cells with more faces than this are divided before their faces are examined.
constexpr std::size_t kManyListed = 500;
/// Cells with more faces than this are divided into 4 x 4 at once.
constexpr std::size_t kCrowd = 300;

/// A cell of any size with more faces than this is not divided if all of its parts would have these faces as well.
constexpr std::size_t kManySides = 1024;
/// Cost of entering a face into the list of a cell and of ordering the list, in steps of about ten nanoseconds.
constexpr std::uint64_t kStepsInCell = 8;
/// If more faces than this cover a cell, and the ranges of their keys leave their order open, their planes order them.
constexpr std::size_t kManyCovers = 32;

constexpr double kNever = -std::numeric_limits<double>::infinity();  ///< nearest key if there are no faces

/// A face whose part within a cell is seen, and which extends beyond the cell.
struct ToldPart {
  std::uint32_t face;
  CellBox box;
};

/// Facts that cells find out about faces. Any thread may set them at any time.
class FaceMarks {
 public:
  explicit FaceMarks(std::size_t count) : seen_(new Mark[count]()), partial_(new Mark[count]()) {}

  /// The face is seen in a cell that it extends beyond.
  void set_seen(std::uint32_t face) { seen_[face].store(kSeen, std::memory_order_relaxed); }
  /// The face is seen in the one cell in which it lies.
  void set_whole(std::uint32_t face) { seen_[face].store(kWhole, std::memory_order_relaxed); }
  /// Some part of the face may be hidden, or lie outside the picture. Ignored if set_whole() is called for the face.
  void set_partial(std::uint32_t face) { partial_[face].store(1, std::memory_order_relaxed); }
  [[nodiscard]] bool is_partial(std::uint32_t face) const {
    return partial_[face].load(std::memory_order_relaxed) != 0;
  }
  [[nodiscard]] bool is_whole(std::uint32_t face) const {
    const std::uint8_t seen = seen_[face].load(std::memory_order_relaxed);
    return seen == kWhole || (seen == kSeen && !is_partial(face));
  }

 private:
  static constexpr std::uint8_t kSeen = 1, kWhole = 2;
  using Mark = std::atomic<std::uint8_t>;

  std::unique_ptr<Mark[]> seen_, partial_;
};

/// Sorts a list that is nearly sorted.
template <class Iterator, class Before>
void sort_nearly_sorted(Iterator begin, Iterator end, const Before& before) {
  std::ptrdiff_t moves_left = 8 * (end - begin);
  for (Iterator i = begin; i != end; ++i) {
    Iterator to = i;
    const auto item = *i;
    for (; to != begin && before(item, *std::prev(to)); --to) *to = *std::prev(to);
    *to = item;
    moves_left -= i - to;
    if (moves_left < 0) return std::sort(begin, end, before);
  }
}

/// A place in a box, away from the middle, because the sides of symmetric models often pass through the middle.
glm::dvec2 place_in(const CellBox& box) {
  return {box.left + 0.4372 * (box.right - box.left), box.top + 0.5611 * (box.bottom - box.top)};
}

/// Finds the visible parts in one of the largest cells after another.
class CellSolver {
 public:
  CellSolver(const FacesOfView& faces, FaceMarks& marks, const std::function<void(std::uint64_t)>& tell)
      : screen_(faces.screen), marks_(marks), cutter_(faces, tell) {}

  void solve(const CellLists& lists, std::size_t cell, const View& view) {
    order_.sort(lists[cell]);
    const std::vector<ListedFace>& faces = order_.faces();
    constexpr std::uint16_t kAllParts = 0xFFFF;
    least_looked_at_ = faces.size();
    if (faces.size() <= kManyListed) {
      parts_of_faces_.assign(faces.size(), kAllParts);
      solve(lists.box(cell, view), kAllParts);
    } else {
      parts_of_faces_.resize(faces.size());
      int used = 0;
      for (std::size_t i = 0; i < faces.size(); ++i)
        used |= parts_of_faces_[i] = lists.parts_of(cell, face_of(faces[i]));
      for (std::size_t part = 0; part < CellLists::parts_of_cell; ++part)
        if ((used >> part & 1) != 0) solve(lists.box_of_part(cell, part, view), std::uint16_t(1 << part));
    }
    for (std::size_t i = least_looked_at_; i < faces.size(); ++i) marks_.set_partial(face_of(faces[i]));
  }

  void clip(const ToldPart& part, std::vector<SeenPart>& seen) { cutter_.clip(part.box, part.face, seen); }
  /// Reports the remaining work.
  void tell_rest() { cutter_.tell_rest(); }

  std::vector<SeenPart> parts;
  std::vector<ToldPart> told;

 private:
  /// Facts about the ordered list of a cell. Faces from `kept` on are hidden. If `is_told`, all faces before `kept` are
  /// seen. No face that was left out of the list is nearer than `removed`.
  struct Sorted {
    std::size_t kept;
    bool is_told;
    double removed;
  };

  /// The last group of a list that is being filled from the nearest face on.
  struct LastGroup {
    std::size_t begin, looked_at;
    double covered = kNever;  ///< among the faces that cover the cell, the greatest of their farthest keys
    double farthest = -kNever;
    bool is_ending = false;
  };

  void solve(const CellBox& box, std::uint16_t part) {
    list_.clear();
    gathered_.clear();
    divide(box, 0, gather_nearest(box, part));
  }
  /// Fills the list with the faces of some parts, the nearest first, until the remaining faces are hidden. \returns the
  /// nearest key of the remaining faces.
  double gather_nearest(const CellBox& box, std::uint16_t part) {
    const glm::dvec2 place = place_in(box);
    LastGroup group{list_.size(), list_.size()};
    for (std::size_t bucket = 0; bucket < order_.size(); ++bucket) {
      const std::uint32_t nearest = order_.least(bucket);
      if (order_of(group.covered) < nearest || (order_of(group.farthest) < nearest && hides_rest(group, place))) {
        least_looked_at_ = std::min(least_looked_at_, order_.begin(bucket));
        return key_before(nearest);
      }
      for (std::size_t i = order_.begin(bucket); i < order_.end(bucket); ++i)
        if ((parts_of_faces_[i] & part) != 0) gather(face_of(order_.faces()[i]), box);
      look_at_new(group);
    }
    return kNever;
  }

  /// Whether a group hides all faces that are not yet in the list. All of these lie behind the group. If it does not
  /// hide them, a new group begins.
  bool hides_rest(LastGroup& group, const glm::dvec2& place) {
    if (!group.is_ending && count_at(place, group.begin, list_.size()) > 0) return true;
    group = {list_.size(), list_.size(), group.covered};
    return false;
  }

  void look_at_new(LastGroup& group) {
    for (; group.looked_at < list_.size(); ++group.looked_at) {
      const FaceInBox& face = list_[group.looked_at];
      group.farthest = std::min(group.farthest, face.farthest);
      group.is_ending = group.is_ending || face.is_ending;
      if (face.is_all) group.covered = std::max(group.covered, face.farthest);
    }
  }

  /// Adds faces of a larger cell to the list, the nearest first, until the remaining faces are hidden. `end` becomes
  /// the number of the first remaining face. \returns the nearest key of the remaining faces.
  template <class Index>
  double add_nearest(const CellBox& box, double removed, std::size_t& end, const Index& index) {
    const glm::dvec2 place = place_in(box);
    LastGroup group{list_.size(), list_.size()};
    for (std::size_t i = 0; i < end; ++i) {
      const FaceInBox face = list_[index(i)];  // a copy, because the list grows
      if (face.nearest < group.covered ||
          (std::max(face.nearest, removed) < group.farthest && i > 0 && hides_rest(group, place))) {
        end = i;
        return std::max(face.nearest, removed);
      }
      add(face, box);
      look_at_new(group);
    }
    return removed;
  }

  void gather(std::uint32_t face, const CellBox& box) {
    const auto& c = screen_.faces[face].corners;
    const ScreenPoint &p = screen_.points[c[0]], &q = screen_.points[c[1]], &r = screen_.points[c[2]];
    const Range key = range_of(p.key, q.key, r.key);
    const auto number = std::uint32_t(gathered_.size());
    gathered_.push_back({{p, q, r}, range_of(p.x, q.x, r.x), range_of(p.y, q.y, r.y), face, screen_.ending[face]});
    add({key.high, key.low, number, screen_.ending[face] != 0, false}, box);
  }

  void add(const FaceInBox& face, const CellBox& box) {
    const GatheredFace& gathered = gathered_[face.number];
    const Range &x = gathered.x, &y = gathered.y;
    if (x.high <= box.left || x.low >= box.right || y.high <= box.top || y.low >= box.bottom) return;
    list_.push_back(face);
    // A face that lies wholly in this cell lay wholly in all larger cells, too, so gather() has set all of its values.
    const bool is_inside = x.low >= box.left && x.high <= box.right && y.low >= box.top && y.high <= box.bottom;
    if (!is_inside && !reaches_into(box, list_.back())) list_.pop_back();
  }

  /// Sets the values of a face that extends beyond the box. \returns whether it reaches into the box.
  bool reaches_into(const CellBox& box, FaceInBox& found) const {
    const GatheredFace& gathered = gathered_[found.number];
    const ScreenPoint* const p = gathered.corners;
    const double middle_x = 0.5 * (box.left + box.right), middle_y = 0.5 * (box.top + box.bottom);
    const double half_x = box.right - middle_x, half_y = box.bottom - middle_y;
    const double inwards = turn_of(p[0], p[1], p[2]) > 0 ? 1 : -1;
    found.is_ending = false;
    found.is_all = true;
    for (int k = 0; k < 3; ++k) {
      const ScreenPoint &a = p[k], &b = p[k == 2 ? 0 : k + 1];
      const double along_x = b.x - a.x, along_y = b.y - a.y;
      // Distance of the box's middle from the side, positive inside, and its variation over the box.
      const double within = inwards * (along_x * (middle_y - a.y) - along_y * (middle_x - a.x));
      const double varies = std::abs(along_x) * half_y + std::abs(along_y) * half_x;
      const double narrow = kNarrow * (std::abs(along_x) + std::abs(along_y));
      if (within + varies <= narrow) return false;
      if (within - varies > narrow) continue;
      found.is_all = false;
      if ((gathered.ending >> k & 1) == 0) continue;
      found.is_ending =
          found.is_ending || (std::min(a.x, b.x) <= box.right + kNarrow && std::max(a.x, b.x) >= box.left - kNarrow &&
                              std::min(a.y, b.y) <= box.bottom + kNarrow && std::max(a.y, b.y) >= box.top - kNarrow);
    }
    const AffineKey plane(p[0], p[1], p[2]);
    const double at_middle = plane.at({middle_x, middle_y});
    const double varies = std::abs(plane.along_x) * half_x + std::abs(plane.along_y) * half_y;
    const Range key = range_of(p[0].key, p[1].key, p[2].key);
    found.nearest = std::min(key.high, at_middle + varies);
    found.farthest = std::max(key.low, at_middle - varies);
    return true;
  }

  /// Finishes the cell whose list begins at `first`, and removes the list. No face that was left out of the list is
  /// nearer than `removed`.
  void divide(const CellBox& box, std::size_t first, double removed) {
    cutter_.count(kStepsInCell * (list_.size() - first));
    const Sorted sorted = sort(box, first, removed);
    drop(first + sorted.kept);
    if (sorted.is_told)
      show_all(box, first);
    else if (sorted.kept <= kFewFaces || !divide_further(box, first, sorted.removed)) {
      cutter_.cut(box, std::span(list_).subspan(first), gathered_, parts);
      drop(first);
    }
    list_.resize(first);
  }

  /// Divides a cell into four. \returns false if division would not help, because the cell is too small or most of its
  /// faces reach into all parts.
  bool divide_further(const CellBox& box, std::size_t first, double removed) {
    const double size = std::max(box.right - box.left, box.bottom - box.top);
    if (size <= kSmallestCell) return false;
    const std::size_t last = list_.size(), count = last - first;
    if (count > kCrowd && size > 4 && divide_crowd(box, first, removed)) return true;
    const double middle_x = 0.5 * (box.left + box.right), middle_y = 0.5 * (box.top + box.bottom);
    const CellBox parts_of_box[4] = {{box.left, box.top, middle_x, middle_y},
                                     {middle_x, box.top, box.right, middle_y},
                                     {box.left, middle_y, middle_x, box.bottom},
                                     {middle_x, middle_y, box.right, box.bottom}};
    std::size_t begins[4], left_out = 0, pairs = 0;
    double nearest[4];  // nearest keys of the faces left out
    for (std::size_t k = 0; k < 4; ++k) {
      begins[k] = list_.size();
      std::size_t end = count;
      nearest[k] = add_nearest(parts_of_box[k], removed, end, [&](std::size_t i) { return first + i; });
      left_out = std::max(left_out, count - end);
      if (count > kManySides) nearest[k] = std::max(nearest[k], drop_covered(parts_of_box[k], begins[k]));
      pairs += (list_.size() - begins[k]) * (list_.size() - begins[k]);
    }
    // Where many sides lie along one line, even very small cells hold as many of these sides as larger cells.
    const bool helps = count > kManyFaces ? pairs < count * count : list_.size() - last < 3 * count;
    if (!helps && (count <= kManyFaces || count > kManySides || size <= 1)) {
      list_.resize(last);
      return false;
    }
    for (std::size_t i = last - left_out; i < last; ++i) marks_.set_partial(gathered_[list_[i].number].face);
    for (std::size_t k = 4; k-- > 0;)
      divide(parts_of_box[k], begins[k], nearest[k]);  // the last list is finished first, since finishing removes it
    return true;
  }

  /// Divides a cell into 4 x 4 parts, at first by the boxes of its faces. \returns false if very many of these boxes
  /// meet all parts.
  bool divide_crowd(const CellBox& box, std::size_t first, double removed) {
    constexpr int kAlong = 4;
    const double width = (box.right - box.left) / kAlong, height = (box.bottom - box.top) / kAlong;
    const auto at = [](double place, double start, double size) {
      return std::clamp(int((place - start) / size), 0, kAlong - 1);
    };
    const auto visit = [&](const auto& body) {
      for (std::size_t i = first; i < list_.size(); ++i) {
        const GatheredFace& face = gathered_[list_[i].number];
        const int right = at(face.x.high, box.left, width), bottom = at(face.y.high, box.top, height);
        for (int row = at(face.y.low, box.top, height); row <= bottom; ++row)
          for (int column = at(face.x.low, box.left, width); column <= right; ++column)
            body(std::size_t(row * kAlong + column), i);
      }
    };
    std::array<std::size_t, kAlong * kAlong + 1> ends{};
    const std::size_t begin = members_.size(), last = list_.size();
    visit([&](std::size_t part, std::size_t) { ++ends[part + 1]; });
    const std::size_t count = last - first, meetings = std::accumulate(ends.begin(), ends.end(), std::size_t(0));
    if (count > kManySides && meetings > count * kAlong * kAlong / 2) return false;
    ends[0] = begin;
    for (std::size_t k = 1; k < ends.size(); ++k) ends[k] += ends[k - 1];
    members_.resize(ends.back());
    visit([&](std::size_t part, std::size_t i) { members_[ends[part]++] = std::uint32_t(i); });
    for (std::size_t k = 0, from = begin; k < kAlong * kAlong; from = ends[k++]) {
      const double left = box.left + double(k % kAlong) * width, top = box.top + double(k / kAlong) * height;
      const CellBox part{left, top, left + width, top + height};
      std::size_t end = ends[k] - from;
      const double nearest = add_nearest(part, removed, end, [&](std::size_t i) { return members_[from + i]; });
      for (std::size_t i = from + end; i < ends[k]; ++i) marks_.set_partial(gathered_[list_[members_[i]].number].face);
      divide(part, last, nearest);
    }
    members_.resize(begin);
    return true;
  }

  /// If very many faces cover the cell, drops the faces that one of them hides. \returns the nearest key of the dropped
  /// faces.
  double drop_covered(const CellBox& box, std::size_t first) {
    const std::span<FaceInBox> list = std::span(list_).subspan(first);
    const auto covers = [](const FaceInBox& face) { return face.is_all; };
    if (std::size_t(std::count_if(list.begin(), list.end(), covers)) <= kManyCovers) return kNever;
    const std::size_t kept = cutter_.leave_out_covered(box, list, gathered_);
    double nearest = kNever;
    for (const FaceInBox& face : list.subspan(kept)) nearest = std::max(nearest, face.nearest);
    drop(first + kept);
    return nearest;
  }

  /// Orders the list by nearest keys, and finds out which faces are surely hidden or seen.
  Sorted sort(const CellBox& box, std::size_t first, double removed) {
    const auto begin = list_.begin() + std::ptrdiff_t(first);
    // Faces behind a face that covers the whole cell need not be ordered.
    double covered = kNever;
    for (auto face = begin; face != list_.end(); ++face)
      if (face->is_all) covered = std::max(covered, face->farthest);
    if (covered > kNever) {
      const auto hidden =
          std::stable_partition(begin, list_.end(), [&](const FaceInBox& face) { return !(face.nearest < covered); });
      for (auto face = hidden; face != list_.end(); ++face) removed = std::max(removed, face->nearest);
      drop(std::size_t(hidden - list_.begin()));
      removed = std::max(removed, drop_covered(box, first));
    }
    sort_nearly_sorted(begin, list_.end(), [&](const FaceInBox& a, const FaceInBox& b) {
      return a.nearest != b.nearest ? a.nearest > b.nearest : gathered_[a.number].face < gathered_[b.number].face;
    });
    leave_out_copies(first);
    const glm::dvec2 place = place_in(box);
    for (std::size_t i = first, group = first; i < list_.size();) {
      double farthest = -kNever;
      bool is_ending = false;
      for (; i < list_.size() && (i == group || list_[i].nearest >= farthest); ++i) {
        farthest = std::min(farthest, list_[i].farthest);
        is_ending = is_ending || list_[i].is_ending;
      }
      // A group whose farthest key is not nearer than a removed face may be incomplete: one of its surfaces may pass
      // through the face that covers the cell. The same holds for all groups behind it.
      if (removed >= farthest) break;
      if (!is_ending) {
        const int count = count_at(place, group, i);
        if (count > 0) return {i - first, group == first && count == 1, removed};
      }
      group = i;
    }
    return {list_.size() - first, false, removed};
  }

  /// Keeps the first of several faces with the same corners. Copies are neighbours in the list, since they are equally
  /// near.
  void leave_out_copies(std::size_t first) {
    const auto corner = [&](std::size_t i, int k) -> const ScreenPoint& {
      return gathered_[list_[i].number].corners[k];
    };
    const auto has_corner = [&](std::size_t i, const ScreenPoint& p) {
      for (int k = 0; k < 3; ++k)
        if (const ScreenPoint& q = corner(i, k); q.x == p.x && q.y == p.y && q.key == p.key) return true;
      return false;
    };
    std::size_t i = first + 1;
    while (i < list_.size() && list_[i].nearest != list_[i - 1].nearest) ++i;
    std::size_t kept = std::min(i, list_.size());
    for (; i < list_.size(); ++i) {
      const bool is_copy = list_[i].nearest == list_[kept - 1].nearest &&
                           list_[i].farthest == list_[kept - 1].farthest && has_corner(i, corner(kept - 1, 0)) &&
                           has_corner(i, corner(kept - 1, 1)) && has_corner(i, corner(kept - 1, 2));
      if (!is_copy) list_[kept++] = list_[i];
    }
    list_.resize(kept);
  }

  /// The number of faces that contain a place, among those of a part of the list; -1 if the place lies on the rim of a
  /// face.
  int count_at(const glm::dvec2& place, std::size_t first, std::size_t last) const {
    int count = 0;
    for (std::size_t i = first; i < last; ++i) {
      const GatheredFace& face = gathered_[list_[i].number];
      if (place.x < face.x.low || place.x > face.x.high || place.y < face.y.low || place.y > face.y.high) continue;
      const ScreenPoint* const p = face.corners;
      const double inwards = turn_of(p[0], p[1], p[2]) > 0 ? 1 : -1;
      double least = -kNever;
      for (int k = 0; k < 3; ++k) {
        const ScreenPoint &a = p[k], &b = p[k == 2 ? 0 : k + 1];
        const double within = inwards * turn_of(a, b, {place.x, place.y, 0});
        const double narrow = kNarrow * (std::abs(b.x - a.x) + std::abs(b.y - a.y));
        least = std::min(least, within > narrow ? 1.0 : within < -narrow ? -1.0 : 0.0);
      }
      if (least == 0) return -1;
      count += least > 0;
    }
    return count;
  }

  /// Marks every face of the list as seen, as far as it lies in the cell.
  void show_all(const CellBox& box, std::size_t first) {
    for (std::size_t i = first; i < list_.size(); ++i) {
      const GatheredFace& face = gathered_[list_[i].number];
      const Range &x = face.x, &y = face.y;
      if (x.low >= box.left && x.high <= box.right && y.low >= box.top && y.high <= box.bottom) {
        marks_.set_whole(face.face);
      } else {
        marks_.set_seen(face.face);
        told.push_back({face.face, box});
      }
    }
  }

  /// Removes the list from `first` on. The removed faces are hidden in the cell, or seen only in part.
  void drop(std::size_t first) {
    for (std::size_t i = first; i < list_.size(); ++i) marks_.set_partial(gathered_[list_[i].number].face);
    list_.resize(first);
  }

  const ViewedFaces& screen_;
  FaceMarks& marks_;
  PieceCutter cutter_;
  RoughOrder order_;
  std::vector<std::uint16_t> parts_of_faces_;  ///< by face of `order_`: parts of the cell that its box meets, as bits
  std::size_t least_looked_at_ = 0;            ///< from this face of the order on, faces are hidden in some part
  std::vector<GatheredFace> gathered_;
  std::vector<FaceInBox> list_;  ///< faces of the current cell, after those of the larger cells around it
  std::vector<std::uint32_t> members_;
};

/// The text of the error, which names the largest cell that has the most faces.
std::string too_many_faces(const CellLists& lists, const FacesOfView& faces, const View& view) {
  std::size_t fullest = 0;
  for (std::size_t cell = 0; cell < lists.size(); ++cell)
    if (lists[cell].size() > lists[fullest].size()) fullest = cell;
  const CellBox box = lists.box(fullest, view);
  const Surfaces& surfaces = faces.surfaces;
  const PrimitiveId id = faces.screen.faces[face_of(lists[fullest].front())].id;
  return "too many faces overlap in the picture to cut them by each other: most of them, " +
         std::to_string(lists[fullest].size()) + ", in the pixels from " + std::to_string(int(box.left)) + "," +
         std::to_string(int(box.top)) + " to " + std::to_string(int(box.right)) + "," +
         std::to_string(int(box.bottom)) + ", among them face " + std::to_string(surfaces.source(id).triangle) +
         " of object " + std::to_string(surfaces.source(id).instance) + "; leave out faces that lie there many times";
}

/// The visible parts of the faces of a view.
struct SeenParts {
  Buffer<std::uint8_t> is_whole;             ///< by face: all of it is seen; the face then has no parts
  std::vector<std::vector<SeenPart>> parts;  ///< parts of the other faces; a face may have several
};

/// Finds all visible parts in the view. The result is the same for any number of threads.
SeenParts seen_parts(const FacesOfView& faces, const View& view, std::uint64_t most_steps, const Execution& execution) {
  constexpr std::size_t kCellsAtOnce = 8;
  const CellLists lists(faces.screen, view, execution);
  FaceMarks marks(faces.screen.faces.size());
  for (const std::uint32_t face : lists.beyond_picture()) marks.set_partial(face);
  WorkLimit work(execution, most_steps + 64 * std::uint64_t(faces.screen.faces.size()), "visible faces");
  const auto tell = [&](std::uint64_t steps) { work.add(steps, [&] { return too_many_faces(lists, faces, view); }); };
  const std::size_t chunks = (lists.size() + kCellsAtOnce - 1) / kCellsAtOnce;
  SeenParts seen;
  seen.parts.resize(chunks);
  std::vector<std::vector<ToldPart>> told(chunks);
  Pool<CellSolver> solvers;
  parallel_for(execution, lists.size(), kCellsAtOnce, [&](std::size_t begin, std::size_t end) {
    const auto solver = solvers.borrow([&] { return std::make_unique<CellSolver>(faces, marks, tell); });
    for (std::size_t cell = begin; cell < end; ++cell) solver->solve(lists, cell, view);
    solver->tell_rest();
    seen.parts[begin / kCellsAtOnce] = std::exchange(solver->parts, {});
    told[begin / kCellsAtOnce] = std::exchange(solver->told, {});
  });
  parallel_for(execution, chunks, 1, [&](std::size_t chunk, std::size_t) {
    const auto solver = solvers.borrow([&] { return std::make_unique<CellSolver>(faces, marks, tell); });
    for (const ToldPart& part : told[chunk])
      if (marks.is_partial(part.face)) solver->clip(part, seen.parts[chunk]);
    solver->tell_rest();
  });
  seen.is_whole = Buffer<std::uint8_t>(faces.screen.faces.size());
  for (std::uint32_t i = 0; i < seen.is_whole.size(); ++i) seen.is_whole[i] = marks.is_whole(i);
  return seen;
}

}  // namespace

std::vector<VisibleFace> find_faces(const Surfaces& surfaces, const View& view,
                                    const std::vector<EdgeNeighbours>& sides, std::uint64_t most_steps,
                                    const Execution& execution) {
  constexpr std::size_t kFacesAtOnce = 4096;
  const ViewedFaces screen = viewed_faces(surfaces, view, sides, execution);
  const FacesOfView faces{surfaces, screen, AreaRule(view)};
  const SeenParts found = seen_parts(faces, view, most_steps, execution);
  std::vector<Areas> areas(screen.faces.size());
  parallel_for(execution, areas.size(), kFacesAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (found.is_whole[i] == 0) continue;
      const auto& c = screen.faces[i].corners;
      areas[i] = faces.rule.areas_of(std::array{screen.points[c[0]], screen.points[c[1]], screen.points[c[2]]});
    }
  });
  for (const std::vector<SeenPart>& parts : found.parts)
    for (const SeenPart& part : parts) areas[part.face] += part.areas;
  std::vector<VisibleFace> seen;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    if (!(areas[i].pixels > 0)) continue;
    if (seen.empty() || seen.back().id != screen.faces[i].id) seen.push_back({screen.faces[i].id, 0, 0, 0});
    seen.back().pixels += areas[i].pixels;
    seen.back().area += areas[i].units;
    seen.back().solid_angle += areas[i].solid_angle;
  }
  return seen;
}

}  // namespace frontmost::faces_detail

namespace frontmost {
namespace {

/// Limit of steps: fifteen times what the most crowded of 237 models takes.
constexpr std::uint64_t kMostFaceSteps = std::uint64_t(1) << 31;

/// The area of a triangle, in scene units squared.
double area_of_triangle(const std::array<glm::vec3, 3>& corners) {
  const glm::dvec3 a(corners[0]);
  return 0.5 * glm::length(glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a));
}

}  // namespace

VisibleFaces visible_faces(const Surfaces& surfaces, const View& view, const Execution& execution) {
  const IeeeScope ieee;
  validate(view);
  return {view, faces_detail::find_faces(surfaces, view, faces_detail::sides_of_meshes(surfaces.scene(), execution),
                                         kMostFaceSteps, execution)};
}

std::vector<SeenFace> faces_ever_seen(const Surfaces& surfaces, std::span<const View> views,
                                      const Execution& execution) {
  const IeeeScope ieee;
  for (const View& view : views) validate(view);
  const std::vector<EdgeNeighbours> sides = faces_detail::sides_of_meshes(surfaces.scene(), execution);
  std::vector<SeenFace> best(surfaces.primitive_count());
  for (std::uint32_t number = 0; number < views.size(); ++number)
    for (const VisibleFace& face :
         faces_detail::find_faces(surfaces, views[number], sides, kMostFaceSteps, execution)) {
      SeenFace& found = best[face.id];
      found.id = face.id;
      ++found.view_count;
      found.largest_pixels = std::max(found.largest_pixels, face.pixels);
      const double share = std::min(face.area / area_of_triangle(surfaces.corners(face.id)), 1.0);
      if (share <= found.largest_share) continue;
      found.largest_share = share;
      found.best_view = number;
    }
  std::erase_if(best, [](const SeenFace& face) { return face.view_count == 0; });
  return best;
}

}  // namespace frontmost
