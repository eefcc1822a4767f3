// SPDX-License-Identifier: Apache-2.0
// Faces that a depth buffer may not tell apart: pairs of faces, their areas at risk, and pairs of objects.
//
//   screen_faces -> pairs of faces -> RiskFinder -> areas by faces -> unions by objects
//
// The faces of a pair overlap on the screen and come close to each other in depth. Pairs are found cell by cell of the
// screen. Tests for overlap are exact: corners are integers, so faces that share a side never overlap by rounding.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <tuple>

#include "base/parallel.h"
#include "base/work_limit.h"
#include "frontmost/precision.h"
#include "frontmost/zbuffer.h"
#include "report/exact_depth.h"
#include "report/fights/faces_at_risk.h"
#include "zbuffer/tile/tile.h"

namespace frontmost {
namespace {

using namespace zbuffer_detail;

constexpr const char* kPlace = "fighting faces";

/// Numbers of two faces, the lower one first.
struct FacePair {
  std::uint32_t first, second;

  /// Both numbers as one number, by which pairs are ordered.
  [[nodiscard]] std::uint64_t number() const { return std::uint64_t(first) << 32 | second; }
  friend bool operator<(const FacePair& a, const FacePair& b) { return a.number() < b.number(); }
};

/// Limits of the pairs that are examined and of the pairs that are kept, by all threads together.
struct PairLimits {
  WorkLimit looks, pairs;
};

/// The bounds of a face in a cell, which are tested first.
struct CellFace {
  std::int32_t x0, x1, y0, y1;
  float low, high;
  std::uint32_t face;

  CellFace(const ScreenFace& f, std::uint32_t number) : low(f.low), high(f.high), face(number) {
    const TriangleRecord& r = f.record;
    std::tie(x0, x1) = std::minmax({r.x[0], r.x[1], r.x[2]});
    std::tie(y0, y1) = std::minmax({r.y[0], r.y[1], r.y[2]});
  }
};

/// The faces of one cell, and the indices of the faces near one of them. Reused from cell to cell.
struct CellScratch {
  std::vector<CellFace> entries;
  std::vector<std::uint32_t> near;
};

/// Whether a side of `a` separates the triangles: all of `b` lies on its outer side, or on the side itself.
bool is_parted_by_side(const TriangleRecord& a, const TriangleRecord& b) {
  for (int k = 0; k < 3; ++k) {
    const int n = k == 2 ? 0 : k + 1;
    const std::int64_t dx = a.x[n] - a.x[k], dy = a.y[n] - a.y[k];
    const auto side = [&](int corner) { return dx * (b.y[corner] - a.y[k]) - dy * (b.x[corner] - a.x[k]); };
    if (side(0) <= 0 && side(1) <= 0 && side(2) <= 0) return true;
  }
  return false;
}

/// The cells of the screen, each with the numbers of the faces whose rectangles touch it.
///
///    +----+----+----+     Within a cell, faces are sorted by their left ends, and only faces whose rectangles and
///    |  /\|    |    |     ranges of keys overlap are compared. A pair that shares several cells is found in one: that
///    | /__\ \  |    |     of the upper left corner of the common part of their rectangles.
///    +----+----+----+
class FaceCells {
 public:
  FaceCells(const std::vector<ScreenFace>& faces, const View& view) : faces_(faces), view_(view) {
    // Cells are so large that a face meets few of them, and so small that they hold few faces.
    constexpr std::size_t kCellsOfAFace = 4;
    constexpr int kFirstShift = 9;  // 2 pixels
    divide_screen(kFirstShift);
    for (int shift = kFirstShift; cells_of_all() > kCellsOfAFace * faces.size() && columns_ * rows_ > 1;)
      divide_screen(++shift);
    lists_.make({0, std::size_t(columns_) * std::size_t(rows_)}, faces.size(), [&](std::size_t i, const auto& add) {
      const PixelRect cells = cells_of(faces[i]);
      for (int y = cells.y0; y <= cells.y1; ++y)
        for (int x = cells.x0; x <= cells.x1; ++x) add(std::size_t(y) * std::size_t(columns_) + std::size_t(x));
    });
  }
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }

  /// The text of the error, which names the cell that has the most faces.
  [[nodiscard]] std::string too_many(const std::string& things) const {
    const std::size_t columns = std::size_t(columns_);
    std::size_t fullest = 0;
    for (std::size_t cell = 1; cell < columns * std::size_t(rows_); ++cell)
      if (lists_.of(cell).size() > lists_.of(fullest).size()) fullest = cell;
    const double side = double(1 << shift_) / kSubPixels;
    const auto at = [&](std::size_t place, int size) {
      return std::to_string(std::min(int(double(place) * side), size));
    };
    const std::size_t x = fullest % columns, y = fullest / columns;
    return "too many " + things + ": most faces, " + std::to_string(lists_.of(fullest).size()) +
           ", are in the pixels from " + at(x, view_.width) + "," + at(y, view_.height) + " to " +
           at(x + 1, view_.width) + "," + at(y + 1, view_.height) + "; leave out faces that lie there many times";
  }

  /// Appends the pairs that are found in this cell.
  void find_pairs(int column, int row, CellScratch& scratch, PairLimits& limits, std::vector<FacePair>& pairs) const {
    std::vector<CellFace>& entries = scratch.entries;
    entries.clear();
    for (const std::uint32_t i : lists_.of(std::size_t(row) * std::size_t(columns_) + std::size_t(column)))
      entries.emplace_back(faces_[i], i);
    std::sort(entries.begin(), entries.end(), [](const CellFace& a, const CellFace& b) { return a.x0 < b.x0; });
    scratch.near.resize(entries.size());
    constexpr std::size_t kLooksAtOnce = 1 << 12;
    std::size_t looks = 0, told = pairs.size();
    const auto tell = [&] {
      limits.looks.add(looks, [&] { return too_many("faces lie over each other"); });
      limits.pairs.add(pairs.size() - told, [&] { return too_many("pairs of faces lie close to each other"); });
      looks = 0;
      told = pairs.size();
    };
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const CellFace& a = entries[i];
      const NearFaces found = collect_near(i, entries, scratch.near.data());
      for (std::size_t n = 0; n < found.count; ++n) {
        const CellFace& b = entries[scratch.near[n]];
        if (cell_of(b.x0, columns_) != column || cell_of(std::max(a.y0, b.y0), rows_) != row) continue;
        const TriangleRecord &p = faces_[a.face].record, &q = faces_[b.face].record;
        if (p.id == q.id || is_parted_by_side(p, q) || is_parted_by_side(q, p)) continue;
        pairs.push_back({std::min(a.face, b.face), std::max(a.face, b.face)});
      }
      looks += found.looks;
      if (looks > kLooksAtOnce) tell();
    }
    tell();
  }

 private:
  struct NearFaces {
    std::size_t looks, count;
  };
  /// Collects the entries after the i-th whose rectangles and key ranges overlap those of the i-th, and writes their
  /// indices.
  static NearFaces collect_near(std::size_t i, const std::vector<CellFace>& entries, std::uint32_t* near) {
    const CellFace a = entries[i];
    std::size_t k = i + 1, count = 0;
    for (; k < entries.size() && entries[k].x0 < a.x1; ++k) {
      const CellFace& b = entries[k];
      near[count] = std::uint32_t(k);
      // No branches here, because they could not be predicted.
      count += std::size_t(int(b.y0 < a.y1) & int(a.y0 < b.y1) & int(b.low <= a.high) & int(a.low <= b.high));
    }
    return {k - i, count};
  }
  /// Divides the screen into squares with a side length of 2^shift / 256 pixels.
  void divide_screen(int shift) {
    const int side = 1 << shift;
    shift_ = shift;
    columns_ = (view_.width * kSubPixels + side - 1) / side;
    rows_ = (view_.height * kSubPixels + side - 1) / side;
  }
  [[nodiscard]] int cell_of(std::int32_t place, int cells) const {
    return std::min(std::max(place, 0) >> shift_, cells - 1);
  }
  [[nodiscard]] PixelRect cells_of(const ScreenFace& face) const {
    const TriangleRecord& r = face.record;
    const auto [x0, x1] = std::minmax({r.x[0], r.x[1], r.x[2]});
    const auto [y0, y1] = std::minmax({r.y[0], r.y[1], r.y[2]});
    return {cell_of(x0, columns_), cell_of(y0, rows_), cell_of(x1, columns_), cell_of(y1, rows_)};
  }
  [[nodiscard]] std::size_t cells_of_all() const {
    std::size_t sum = 0;
    for (const ScreenFace& face : faces_) {
      const PixelRect cells = cells_of(face);
      sum += std::size_t(cells.x1 - cells.x0 + 1) * std::size_t(cells.y1 - cells.y0 + 1);
    }
    return sum;
  }

  const std::vector<ScreenFace>& faces_;
  const View& view_;
  int shift_ = 0, columns_ = 0, rows_ = 0;
  TileLists lists_;
};

/// Finds all pairs of faces of different primitives that have a common area and overlapping ranges of keys. The pairs
/// are in order.
std::vector<FacePair> find_face_pairs(const std::vector<ScreenFace>& faces, const View& view,
                                      const Execution& execution) {
  const FaceCells cells(faces, view);
  std::vector<std::vector<FacePair>> by_row(std::size_t(cells.rows()));
  constexpr std::uint64_t kMostLooks = std::uint64_t(1) << 28, kMostPairs = std::uint64_t(1) << 24;
  PairLimits limits{{execution, kMostLooks, kPlace}, {execution, kMostPairs, kPlace}};
  parallel_for(execution, by_row.size(), 1, [&](std::size_t row, std::size_t) {
    CellScratch scratch;
    for (int column = 0; column < cells.columns(); ++column)
      cells.find_pairs(column, int(row), scratch, limits, by_row[row]);
  });
  std::vector<FacePair> pairs;
  for (const std::vector<FacePair>& row : by_row) pairs.insert(pairs.end(), row.begin(), row.end());
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

bool share_corner(const std::array<glm::vec3, 3>& a, const std::array<glm::vec3, 3>& b) {
  return std::any_of(a.begin(), a.end(),
                     [&](const glm::vec3& corner) { return std::find(b.begin(), b.end(), corner) != b.end(); });
}

FightKind kind_of(const Surfaces& surfaces, PrimitiveId first, PrimitiveId second) {
  const auto a = surfaces.corners(first), b = surfaces.corners(second);
  if (lie_in_one_plane(a, b)) return FightKind::one_plane;
  return share_corner(a, b) ? FightKind::fold : FightKind::close;
}

/// The areas in the order in which they were found.
struct FoundAreas {
  std::vector<FightingFaces> faces;
  std::vector<glm::dvec2> corners;
};

/// The input of the search for areas.
struct FightSearch {
  const Surfaces& surfaces;
  const Visible& visible;
  const DepthSetup& setup;
  const std::vector<ScreenFace>& faces;
  const KeyStep step{setup};

  /// Appends the area of two faces; if the two faces are the same, the area in which it may be stored as the clear
  /// value.
  void find(RiskFinder& finder, VisibleShares& shares, const FacePair& pair, FoundAreas& found) const {
    const ScreenFace &a = faces[pair.first], &b = faces[pair.second];
    const bool is_alone = pair.first == pair.second;
    const ConvexArea& area = is_alone ? finder.of_clear_value(a) : finder.of_pair(a, b);
    if (area.is_empty()) return;
    const RiskKeys keys(a, b, step);
    const double share = shares.of(area, keys);
    if (share == 0) return;
    FightingFaces fight;
    fight.first = a.record.id;
    if (!is_alone) fight.second = b.record.id;
    fight.kind = is_alone ? FightKind::clear : kind_of(surfaces, fight.first, fight.second);
    fight.area = area.area();
    fight.visible_area = fight.area * share;
    double nearest = 0;
    for (const glm::dvec2& corner : area.corners()) nearest = std::max(nearest, keys.nearest_at(corner));
    fight.distance = std::clamp<double>(depth_of_key(visible.view, float(nearest)), setup.clip.near, setup.clip.far);
    fight.corner_begin = std::uint32_t(found.corners.size());
    fight.corner_count = std::uint32_t(area.corners().size());
    found.corners.insert(found.corners.end(), area.corners().begin(), area.corners().end());
    found.faces.push_back(fight);
  }
};

FoundAreas find_areas(const FightSearch& search, const std::vector<FacePair>& pairs, const Execution& execution) {
  constexpr std::size_t kGrain = 4096, kMostAreas = std::size_t(1) << 22, kPairsAtOnce = 16;
  constexpr std::uint64_t kMostLooks = std::uint64_t(1) << 30, kMostLooksOfSample = 64;
  WorkLimit work(execution, kMostLooks + kMostLooksOfSample * search.visible.view.sample_count(), kPlace);
  std::vector<FoundAreas> parts((pairs.size() + kGrain - 1) / kGrain);
  parallel_for(execution, pairs.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    RiskFinder finder(search.visible.view, search.setup);
    VisibleShares shares(search.visible, pairs.size());
    for (std::size_t i = begin; i < end; ++i) {
      search.find(finder, shares, pairs[i], parts[begin / kGrain]);
      if (i % kPairsAtOnce == 0 || i + 1 == end)
        work.add(shares.take_looks(), [&] {
          return FaceCells(search.faces, search.visible.view).too_many("pairs of faces lie over each other");
        });
    }
  });
  FoundAreas all;
  for (const FoundAreas& part : parts) {
    const auto shift = std::uint32_t(all.corners.size());
    all.corners.insert(all.corners.end(), part.corners.begin(), part.corners.end());
    for (FightingFaces fight : part.faces) {
      fight.corner_begin += shift;
      all.faces.push_back(fight);
    }
    if (all.faces.size() > kMostAreas)
      throw Error(ErrorCode::limit_exceeded, kPlace, "more than 4194304 areas are at risk");
  }
  return all;
}

/// The part of a horizontal line within an area.
struct Chord {
  std::int64_t line;
  double begin, end;

  friend bool operator<(const Chord& a, const Chord& b) {
    return a.line != b.line ? a.line < b.line : a.begin < b.begin;
  }
};

struct VerticalReach {
  double top, bottom;

  explicit VerticalReach(std::span<const glm::dvec2> corners) : top(corners[0].y), bottom(top) {
    for (const glm::dvec2& corner : corners) {
      top = std::min(top, corner.y);
      bottom = std::max(bottom, corner.y);
    }
  }
};

/// Appends the chords that the lines at y = (n + 0.5) * spacing have in common with an area.
void append_chords(std::span<const glm::dvec2> corners, double spacing, std::vector<Chord>& chords) {
  const VerticalReach height(corners);
  auto line = std::int64_t(std::ceil(height.top / spacing - 0.5));
  for (; (double(line) + 0.5) * spacing < height.bottom; ++line) {
    const double y = (double(line) + 0.5) * spacing;
    Chord chord{line, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const glm::dvec2 &a = corners[i], &b = corners[i + 1 == corners.size() ? 0 : i + 1];
      if ((a.y <= y) == (b.y <= y)) continue;
      const double x = a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
      chord.begin = std::min(chord.begin, x);
      chord.end = std::max(chord.end, x);
    }
    if (chord.begin < chord.end) chords.push_back(chord);
  }
}

/// The area of the union divided by the sum of the areas: 1 if no areas overlap, and at least 1 divided by their
/// number. The union is measured along lines 1/16 pixel apart, or farther apart if there would be too many lines. A
/// part of a line that lies in several areas counts once.
///
///     +-------+
///     |-------|-----
///     |   +---+---+
///     |---|---|---|-
///     +---+---+   |
///         +-------+
double share_of_union(std::span<const std::span<const glm::dvec2>> areas) {
  if (areas.size() == 1) return 1;
  constexpr double kMostChords = 1 << 16;
  double heights = 0;
  for (const std::span<const glm::dvec2> corners : areas) {
    const VerticalReach height(corners);
    heights += height.bottom - height.top;
  }
  const double spacing = std::max(1.0 / 16, heights / kMostChords);
  std::vector<Chord> chords;
  for (const std::span<const glm::dvec2> corners : areas) append_chords(corners, spacing, chords);
  std::sort(chords.begin(), chords.end());
  double all = 0, united = 0, reached = 0;
  for (std::size_t i = 0; i < chords.size(); ++i) {
    const Chord& chord = chords[i];
    if (i == 0 || chord.line != chords[i - 1].line) reached = chord.begin;
    all += chord.end - chord.begin;
    united += std::max(chord.end - std::max(chord.begin, reached), 0.0);
    reached = std::max(reached, chord.end);
  }
  return all > 0 ? united / all : 1;
}

std::vector<FightingObjects> join_by_objects(const FightAreas& fights, const Surfaces& surfaces) {
  using Key = std::tuple<std::uint32_t, std::uint32_t, FightKind>;
  std::map<Key, std::vector<std::uint32_t>> members;
  for (std::size_t i = 0; i < fights.faces.size(); ++i) {
    const FightingFaces& fight = fights.faces[i];
    const auto instance = [&](PrimitiveId id) { return id == no_primitive ? no_index : surfaces.source(id).instance; };
    members[{instance(fight.first), instance(fight.second), fight.kind}].push_back(std::uint32_t(i));
  }
  std::vector<FightingObjects> objects;
  for (const auto& [key, numbers] : members) {
    FightingObjects pair;
    std::tie(pair.first, pair.second, pair.kind) = key;
    pair.areas = numbers.size();
    std::vector<std::span<const glm::dvec2>> areas;
    pair.distance = std::numeric_limits<double>::infinity();
    for (const std::uint32_t i : numbers) {
      const FightingFaces& fight = fights.faces[i];
      areas.push_back(fights.polygon(fight));
      pair.area += fight.area;
      pair.visible_area += fight.visible_area;
      pair.distance = std::min(pair.distance, fight.distance);
    }
    const double share = share_of_union(areas);
    pair.area *= share;
    pair.visible_area *= share;
    pair.gap = resolvable_gap(fights.setup, pair.distance);
    objects.push_back(pair);
  }
  std::stable_sort(objects.begin(), objects.end(), [](const FightingObjects& a, const FightingObjects& b) {
    const bool a_folds = a.kind == FightKind::fold, b_folds = b.kind == FightKind::fold;
    return a_folds != b_folds ? b_folds : a.visible_area > b.visible_area;
  });
  return objects;
}

}  // namespace

FightAreas find_fighting_faces(const Surfaces& surfaces, const View& view, DepthFormat format, bool reversed,
                               const Execution& execution) {
  validate(view);
  const IeeeScope ieee;
  FightAreas fights;
  fights.view = view;
  fights.setup = {view.projection.clip, format, reversed, view.projection.orthographic};
  const Visible visible = zbuffer(surfaces, view, execution);
  const std::vector<ScreenFace> faces =
      screen_faces(surfaces, view, KeyStep(fights.setup), FarthestSeen(visible), execution);
  std::vector<FacePair> pairs = find_face_pairs(faces, view, execution);
  const auto of_two = std::ptrdiff_t(pairs.size());
  const RiskFinder finder(view, fights.setup);
  for (std::uint32_t i = 0; i < faces.size(); ++i)
    if (finder.may_be_clear_value(faces[i])) pairs.push_back({i, i});
  std::inplace_merge(pairs.begin(), pairs.begin() + of_two, pairs.end());
  FoundAreas found = find_areas({surfaces, visible, fights.setup, faces}, pairs, execution);
  fights.faces = std::move(found.faces);
  fights.corners = std::move(found.corners);
  fights.objects = join_by_objects(fights, surfaces);
  return fights;
}

}  // namespace frontmost
