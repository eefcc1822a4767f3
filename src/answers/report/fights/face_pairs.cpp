// SPDX-License-Identifier: Apache-2.0
// Tests for overlap are exact: corners are integers, so faces that share a side never overlap by rounding.
#include "report/fights/face_pairs.h"

#include <algorithm>
#include <tuple>

#include "base/work_limit.h"
#include "zbuffer/tile/tile.h"

namespace frontmost {
namespace {

using namespace zbuffer_detail;

constexpr const char* kPlace = "fighting faces";
constexpr std::uint64_t kMostBoxLooks = std::uint64_t(1) << 28, kMostPairs = std::uint64_t(1) << 24;

/// Limits of the pairs examined and kept, by all threads together.
struct PairLimits {
  WorkLimit looks, pairs;
};

/// The bounds of a face in a cell, examined first.
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

/// The faces of one cell, and the indices of those near one of them. Reused from cell to cell.
struct CellScratch {
  std::vector<CellFace> entries;
  std::vector<std::uint32_t> near;
};

/// Whether all of `b` lies on the outer side of a side of `a`, or on that side.
bool is_parted_by_side(const TriangleRecord& a, const TriangleRecord& b) {
  for (int k = 0; k < 3; ++k) {
    const int n = k == 2 ? 0 : k + 1;
    const std::int64_t dx = a.x[n] - a.x[k], dy = a.y[n] - a.y[k];
    const auto side = [&](int corner) { return dx * (b.y[corner] - a.y[k]) - dy * (b.x[corner] - a.x[k]); };
    if (side(0) <= 0 && side(1) <= 0 && side(2) <= 0) return true;
  }
  return false;
}

/// The cells of the screen, each with the numbers of its faces.
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

  /// The text of an error, which names the cell with the most faces.
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
           at(x + 1, view_.width) + "," + at(y + 1, view_.height) + "; leave out what lies there many times";
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
  /// Writes the indices of the entries after the i-th whose rectangles and key ranges overlap its own.
  static NearFaces collect_near(std::size_t i, const std::vector<CellFace>& entries, std::uint32_t* near) {
    const CellFace a = entries[i];
    std::size_t k = i + 1, count = 0;
    for (; k < entries.size() && entries[k].x0 < a.x1; ++k) {
      const CellFace& b = entries[k];
      near[count] = std::uint32_t(k);
      // Without branches, which could not be predicted.
      count += std::size_t(int(b.y0 < a.y1) & int(a.y0 < b.y1) & int(b.low <= a.high) & int(a.low <= b.high));
    }
    return {k - i, count};
  }
  /// Divides the screen into squares of 2^shift steps of 1/256 pixel.
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

}  // namespace

std::vector<FacePair> find_face_pairs(const std::vector<ScreenFace>& faces, const View& view,
                                      const Execution& execution) {
  const FaceCells cells(faces, view);
  std::vector<std::vector<FacePair>> by_row(std::size_t(cells.rows()));
  PairLimits limits{{execution, kMostBoxLooks, kPlace}, {execution, kMostPairs, kPlace}};
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

std::string too_many_faces(const std::vector<ScreenFace>& faces, const View& view, const std::string& things) {
  return FaceCells(faces, view).too_many(things);
}

}  // namespace frontmost
