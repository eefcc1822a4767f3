// SPDX-License-Identifier: Apache-2.0
#include "report/faces/cells.h"

#include <algorithm>
#include <optional>

#include "base/parallel.h"

namespace frontmost::faces_detail {
namespace {

/// Pixels along a side of the cells that the picture is divided into at first.
constexpr int kLargestCell = 32;
/// Cells are not divided further at this side, in pixels.
constexpr double kSmallestCell = 1.0 / 1024;
/// So few faces are cut by each other sooner than a cell is divided.
constexpr std::size_t kFewFaces = 48;
/// More faces than this are worth dividing a cell for, even if most of them reach into all of its parts: there, they
/// hide each other.
constexpr std::size_t kManyFaces = 100;

Range range_of(double a, double b, double c) { return {std::min({a, b, c}), std::max({a, b, c})}; }

/// The faces whose boxes meet each of the largest cells.
class CellLists {
 public:
  CellLists(const ViewedFaces& screen, const View& view)
      : columns_((view.width + kLargestCell - 1) / kLargestCell),
        rows_((view.height + kLargestCell - 1) / kLargestCell),
        ends_(size() + 1, 0) {
    visit(screen, [&](std::size_t cell, std::uint32_t) { ++ends_[cell + 1]; });
    for (std::size_t i = 1; i < ends_.size(); ++i) ends_[i] += ends_[i - 1];
    faces_.resize(ends_.back());
    visit(screen, [&](std::size_t cell, std::uint32_t face) { faces_[ends_[cell]++] = face; });
  }
  [[nodiscard]] std::size_t size() const { return std::size_t(columns_) * std::size_t(rows_); }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t cell) const {
    const std::size_t begin = cell == 0 ? 0 : ends_[cell - 1];
    return std::span(faces_).subspan(begin, ends_[cell] - begin);
  }
  [[nodiscard]] CellBox box(std::size_t cell, const View& view) const {
    const auto x = int(cell % std::size_t(columns_)) * kLargestCell,
               y = int(cell / std::size_t(columns_)) * kLargestCell;
    return {double(x), double(y), double(std::min(x + kLargestCell, view.width)),
            double(std::min(y + kLargestCell, view.height))};
  }

 private:
  template <class Visit>
  void visit(const ViewedFaces& screen, const Visit& visit) const {
    const auto cell_at = [](double at, int count) {
      return std::clamp(int(std::floor(at / kLargestCell)), 0, count - 1);
    };
    for (std::uint32_t i = 0; i < screen.faces.size(); ++i) {
      const auto& c = screen.faces[i].corners;
      const ScreenPoint &p = screen.points[c[0]], &q = screen.points[c[1]], &r = screen.points[c[2]];
      const Range x = range_of(p.x, q.x, r.x), y = range_of(p.y, q.y, r.y);
      const int right = cell_at(x.high, columns_), bottom = cell_at(y.high, rows_);
      for (int row = cell_at(y.low, rows_); row <= bottom; ++row)
        for (int column = cell_at(x.low, columns_); column <= right; ++column)
          visit(std::size_t(row) * std::size_t(columns_) + std::size_t(column), i);
    }
  }

  int columns_, rows_;
  std::vector<std::size_t> ends_;  ///< by cell, where its faces end; in visit() where they begin
  std::vector<std::uint32_t> faces_;
};

/// Looks at one of the largest cells after the other.
class CellSolver {
 public:
  explicit CellSolver(const FacesOfView& faces) : screen_(faces.screen), rule_(faces.rule), cutter_(faces) {}

  void solve(const CellBox& box, std::span<const std::uint32_t> faces, std::vector<SeenPart>& seen) {
    list_.clear();
    gathered_.clear();
    for (const std::uint32_t face : faces) gather(face, box);
    divide(box, 0, seen);
  }

 private:
  /// What is known of a cell's list once it is in order: from `kept` on everything is hidden; if `is_told`, all before
  /// is seen.
  struct Sorted {
    std::size_t kept;
    bool is_told;
  };

  /// Corners of the faces of one of the largest cells, so that they lie beside each other.
  struct GatheredFace {
    ScreenPoint corners[3];
    std::uint8_t ending;
  };

  void gather(std::uint32_t face, const CellBox& box);
  /// Adds a face of a larger cell to the end of the list where it reaches into the box.
  void add(const FaceInBox& face, const CellBox& box);
  [[nodiscard]] bool reaches_into(const CellBox& box, FaceInBox& face) const;
  void divide(const CellBox& box, std::size_t first, std::vector<SeenPart>& seen);
  [[nodiscard]] bool divide_further(const CellBox& box, std::size_t first, std::vector<SeenPart>& seen);
  void leave_out_copies(std::size_t first);
  [[nodiscard]] Sorted sort(const CellBox& box, std::size_t first);
  [[nodiscard]] int count_at(const glm::dvec2& place, std::size_t first, std::size_t last) const;
  void show_all(const CellBox& box, std::size_t first, std::vector<SeenPart>& seen);

  const ViewedFaces& screen_;
  const AreaRule& rule_;
  PieceCutter cutter_;
  std::vector<GatheredFace> gathered_;
  std::vector<FaceInBox> list_;  ///< of the cell that is looked at, behind those of the cells that it is a part of
};

void CellSolver::gather(std::uint32_t face, const CellBox& box) {
  const auto& c = screen_.faces[face].corners;
  const ScreenPoint &p = screen_.points[c[0]], &q = screen_.points[c[1]], &r = screen_.points[c[2]];
  const Range key = range_of(p.key, q.key, r.key);
  gathered_.push_back({{p, q, r}, screen_.ending[face]});
  add({face, std::uint32_t(gathered_.size() - 1), screen_.ending[face] != 0, false, key.high, key.low,
       range_of(p.x, q.x, r.x), range_of(p.y, q.y, r.y)},
      box);
}

void CellSolver::add(const FaceInBox& face, const CellBox& box) {
  if (face.x.high <= box.left || face.x.low >= box.right || face.y.high <= box.top || face.y.low >= box.bottom) return;
  list_.push_back(face);
  // What lies in the cell as a whole did so in all larger ones, and gather() said all there is to know.
  const bool is_inside =
      face.x.low >= box.left && face.x.high <= box.right && face.y.low >= box.top && face.y.high <= box.bottom;
  if (!is_inside && !reaches_into(box, list_.back())) list_.pop_back();
}

/// Finds what is to be known of a face that reaches out of the box. \returns whether it reaches into it.
bool CellSolver::reaches_into(const CellBox& box, FaceInBox& found) const {
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
    // How far within the side the middle lies, and how much that varies over the box.
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

/// Finishes the cell whose list begins at `first`, and takes its list away.
void CellSolver::divide(const CellBox& box, std::size_t first, std::vector<SeenPart>& seen) {
  const Sorted sorted = sort(box, first);
  list_.resize(first + sorted.kept);
  if (sorted.is_told)
    show_all(box, first, seen);
  else if (sorted.kept <= kFewFaces || !divide_further(box, first, seen))
    cutter_.cut(box, std::span(list_).subspan(first), seen);
  list_.resize(first);
}

/// \returns false where it would not help: the cell is too small, or most of its faces reach into all parts of it.
bool CellSolver::divide_further(const CellBox& box, std::size_t first, std::vector<SeenPart>& seen) {
  const double size = std::max(box.right - box.left, box.bottom - box.top);
  if (size <= kSmallestCell) return false;
  const double middle_x = 0.5 * (box.left + box.right), middle_y = 0.5 * (box.top + box.bottom);
  const CellBox parts[4] = {{box.left, box.top, middle_x, middle_y},
                            {middle_x, box.top, box.right, middle_y},
                            {box.left, middle_y, middle_x, box.bottom},
                            {middle_x, middle_y, box.right, box.bottom}};
  const std::size_t last = list_.size(), count = last - first;
  std::size_t begins[4];
  for (int k = 0; k < 4; ++k) {
    begins[k] = list_.size();
    for (std::size_t i = first; i < last; ++i) add(FaceInBox(list_[i]), parts[k]);  // a copy: the list grows
  }
  if (list_.size() - last >= 3 * count && (count <= kManyFaces || size <= 1)) {
    list_.resize(last);
    return false;
  }
  for (int k = 3; k >= 0; --k) divide(parts[k], begins[k], seen);  // the last one takes its list away first
  return true;
}

/// Brings the list into the order of its nearest keys, and tells what that tells.
CellSolver::Sorted CellSolver::sort(const CellBox& box, std::size_t first) {
  const auto begin = list_.begin() + std::ptrdiff_t(first);
  // What lies behind something that covers the cell alone need not be put in order.
  double covered = -std::numeric_limits<double>::infinity(), removed = covered;
  for (auto face = begin; face != list_.end(); ++face)
    if (face->is_all) covered = std::max(covered, face->farthest);
  const auto is_hidden = [&](const FaceInBox& face) {
    if (face.nearest < covered) removed = std::max(removed, face.nearest);
    return face.nearest < covered;
  };
  list_.erase(std::remove_if(begin, list_.end(), is_hidden), list_.end());
  std::sort(begin, list_.end(), [](const FaceInBox& a, const FaceInBox& b) {
    return a.nearest != b.nearest ? a.nearest > b.nearest : a.face < b.face;
  });
  leave_out_copies(first);
  // Off the middle, through which the sides of symmetric models pass.
  const glm::dvec2 place(box.left + 0.4372 * (box.right - box.left), box.top + 0.5611 * (box.bottom - box.top));
  for (std::size_t i = first, group = first; i < list_.size();) {
    double farthest = std::numeric_limits<double>::infinity();
    bool is_ending = false;
    for (; i < list_.size() && (i == group || list_[i].nearest >= farthest); ++i) {
      farthest = std::min(farthest, list_[i].farthest);
      is_ending = is_ending || list_[i].is_ending;
    }
    // A group that reaches back to what was removed is not whole: a surface of it may pass through what covers the
    // cell.
    if (i == list_.size() && removed >= farthest) break;
    if (!is_ending) {
      const int count = count_at(place, group, i);
      if (count > 0) return {i - first, group == first && count == 1};
    }
    group = i;
  }
  return {list_.size() - first, false};
}

/// Of faces with the same corners the first stays. Copies follow each other, as they are equally near.
void CellSolver::leave_out_copies(std::size_t first) {
  const auto corner = [&](std::size_t i, int k) -> const ScreenPoint& { return gathered_[list_[i].number].corners[k]; };
  const auto has_corner = [&](std::size_t i, const ScreenPoint& p) {
    for (int k = 0; k < 3; ++k)
      if (const ScreenPoint& q = corner(i, k); q.x == p.x && q.y == p.y && q.key == p.key) return true;
    return false;
  };
  std::size_t kept = first;
  for (std::size_t i = first; i < list_.size(); ++i) {
    const bool is_copy = kept > first && list_[i].nearest == list_[kept - 1].nearest &&
                         list_[i].farthest == list_[kept - 1].farthest && has_corner(i, corner(kept - 1, 0)) &&
                         has_corner(i, corner(kept - 1, 1)) && has_corner(i, corner(kept - 1, 2));
    if (!is_copy) list_[kept++] = list_[i];
  }
  list_.resize(kept);
}

/// How many faces of a part of the list hold a place; -1 where one has it on its rim.
int CellSolver::count_at(const glm::dvec2& place, std::size_t first, std::size_t last) const {
  int count = 0;
  for (std::size_t i = first; i < last; ++i) {
    const FaceInBox& face = list_[i];
    if (place.x < face.x.low || place.x > face.x.high || place.y < face.y.low || place.y > face.y.high) continue;
    const ScreenPoint* const p = gathered_[face.number].corners;
    const double inwards = turn_of(p[0], p[1], p[2]) > 0 ? 1 : -1;
    double least = std::numeric_limits<double>::infinity();
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

/// Every face of the list is seen as far as it lies in the cell.
void CellSolver::show_all(const CellBox& box, std::size_t first, std::vector<SeenPart>& seen) {
  for (std::size_t i = first; i < list_.size(); ++i) {
    const FaceInBox& face = list_[i];
    const auto &x = face.x, &y = face.y;
    if (x.low >= box.left && x.high <= box.right && y.low >= box.top && y.high <= box.bottom)
      seen.push_back({face.face, rule_.areas_of(gathered_[face.number].corners)});
    else
      cutter_.clip(box, face, seen);
  }
}

}  // namespace

std::vector<std::vector<SeenPart>> seen_parts(const FacesOfView& faces, const View& view, const Execution& execution) {
  constexpr std::size_t kCellsAtOnce = 8;
  const CellLists lists(faces.screen, view);
  std::vector<std::vector<SeenPart>> seen((lists.size() + kCellsAtOnce - 1) / kCellsAtOnce);
  parallel_for(execution, lists.size(), kCellsAtOnce, [&](std::size_t begin, std::size_t end) {
    CellSolver solver(faces);
    for (std::size_t cell = begin; cell < end; ++cell)
      solver.solve(lists.box(cell, view), lists[cell], seen[begin / kCellsAtOnce]);
  });
  return seen;
}

}  // namespace frontmost::faces_detail
