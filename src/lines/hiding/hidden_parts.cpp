// SPDX-License-Identifier: Apache-2.0
// Cell by cell along the edge, the nearest occluders first, eight at a time. A cell is left as soon as what of the edge
// lies in it is hidden: what else it holds could only hide the same again.

#include "lines/hiding/hidden_parts.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kMostAtOnce = 64, kBlock = 16;
/// Cells: less than what sides leave open, and more than the rounding of a place.
constexpr double kEndPad = 5e-6;

/// A float not nearer, whatever rounding does.
float wide_low(double value) { return float(value - 1e-6 * std::abs(value)); }
float wide_high(double value) { return -wide_low(-value); }

}  // namespace

Interval EdgeCutter::within_view() const {
  Interval shown{0, 1};
  const auto keep = [&](double at_0, double at_1) {
    const Interval in = where_positive(with_sign_of_value(at_0), with_sign_of_value(at_1), false);
    shown = {std::max(shown.begin, in.begin), std::min(shown.end, in.end)};
  };
  const Projection& p = o_.view.projection;
  const double w0 = p.orthographic ? 1 : from_eye_.z, w1 = p.orthographic ? 1 : to_eye_.z;
  keep(from_eye_.z - p.clip.near, to_eye_.z - p.clip.near);
  if (p.clip.far < std::numeric_limits<double>::infinity()) keep(p.clip.far - from_eye_.z, p.clip.far - to_eye_.z);
  keep(from_eye_.x - p.left * w0, to_eye_.x - p.left * w1);
  keep(p.right * w0 - from_eye_.x, p.right * w1 - to_eye_.x);
  keep(from_eye_.y - p.bottom * w0, to_eye_.y - p.bottom * w1);
  keep(p.top * w0 - from_eye_.y, p.top * w1 - to_eye_.y);
  return shown;
}

glm::dvec2 EdgeCutter::on_screen(double t) const {
  // From the nearer end, so that both ends are met.
  glm::dvec3 p = t <= 0.5 ? from_eye_ + (to_eye_ - from_eye_) * t : to_eye_ + (from_eye_ - to_eye_) * (1 - t);
  // It is within the view; rounding may say otherwise of edges that are very much longer than their part in it.
  p.z = std::max(p.z, o_.sight.near());
  return glm::clamp(glm::dvec2(o_.sight.to_screen(p)), glm::dvec2(0), glm::dvec2(o_.view.width, o_.view.height));
}

/// What of the edge may lie in a cell: rather more.
Interval EdgeCutter::part_in(const OccluderGrid::Visit& cell) const {
  const glm::dvec2 along = end_ - begin_;
  const int axis = std::abs(along.y) > std::abs(along.x);
  if (std::abs(along[axis]) < 1e-3) return shown_;
  const auto at = [&](double coordinate, double margin) {
    const double s = std::clamp((coordinate - begin_[axis]) / along[axis] + margin / std::abs(along[axis]), 0.0, 1.0);
    const double w0 = o_.sight.to_weight(from_eye_, to_eye_, shown_.begin),
                 w1 = o_.sight.to_weight(from_eye_, to_eye_, shown_.end);
    const double share = s * w0 / (s * w0 + (1 - s) * w1);
    return shown_.begin + share * (shown_.end - shown_.begin);
  };
  const bool is_forward = along[axis] > 0;
  return {at(is_forward ? cell.low[axis] : cell.high[axis], -2e-6) - 1e-12,
          at(is_forward ? cell.high[axis] : cell.low[axis], 2e-6) + 1e-12};
}

/// From the first to the last point of `part` that is not hidden so far; empty where all of it is.
Interval EdgeCutter::open_part(Interval part) const {
  part = {std::max(part.begin, shown_.begin), std::min(part.end, shown_.end)};
  if (counts_) return part;
  if (const auto at = first_to(part.begin); at != hidden_.end() && at->interval.begin <= part.begin)
    part.begin = at->interval.end;
  if (const auto at = first_to(part.end); at != hidden_.end() && at->interval.begin < part.end)
    part.end = at->interval.begin;
  return part;
}

/// A part of the edge as it is seen in a cell.
struct EdgeCutter::InCell {
  ScreenPart box;
  ScreenSegment segment;

  InCell(const EdgeCutter& cutter, const Interval& part, const glm::dvec2& corner) {
    const OccluderGrid& grid = cutter.o_.grid;
    const glm::dvec2 a = cutter.on_screen(part.begin) * grid.scale(), b = cutter.on_screen(part.end) * grid.scale();
    const glm::dvec2 low = glm::min(a, b) - kEndPad, high = glm::max(a, b) + kEndPad;
    const auto distance = [&](double t) { return cutter.from_eye_.z + (cutter.to_eye_.z - cutter.from_eye_.z) * t; };
    const double from = distance(part.begin), to = distance(part.end);
    box = {{wide_low(low.x), wide_low(low.y)},
           {wide_high(high.x), wide_high(high.y)},
           cutter.is_for_cover_ ? cutter.farthest_ : std::min(cutter.farthest_, wide_high(std::max(from, to)))};
    const auto near = [&](double planar) {
      // What covers may lie behind.
      if (cutter.is_for_cover_) return -std::numeric_limits<float>::infinity();
      return float(nearness(planar, cutter.o_.sight.is_parallel()));
    };
    segment = {glm::vec2(a - corner), glm::vec2(b - corner), near(from), near(to)};
  }
};

/// For cells of many entries: the nearest first, then those just before the edge. Of a stack of sheets the ones between
/// hide ever less than the next one, and are asked no more when that has left nothing where they are.
void EdgeCutter::pass_many(const OccluderGrid::Visit& cell) {
  Interval open = open_part(part_in(cell));
  if (!(open.begin < open.end)) return;
  InCell in(*this, open, cell.corner);
  const float* nearest = o_.grid.boxes(cell.first).nearest;
  const auto before =
      std::size_t(std::upper_bound(nearest, nearest + (cell.last - cell.first), in.box.farthest) - nearest);
  const std::size_t blocks = (before + kBlock - 1) / kBlock;
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::size_t offset = (i == 0 ? 0 : blocks - i) * kBlock, count = std::min(kBlock, before - offset);
    std::uint64_t bits = o_.kernels.overlapping(o_.grid.boxes(cell.first + offset), count, in.box);
    if (bits != 0) bits &= o_.kernels.within_sides(o_.grid.sides(cell.cell, offset), count, in.segment);
    if (bits == 0) continue;
    if (!ask(bits, cell.first + offset, cell)) return;
    if (batch_.count == 0 || !flush()) continue;
    open = open_part(open);
    if (!(open.begin < open.end)) return;
    in = InCell(*this, open, cell.corner);
  }
}

/// \returns true when all of the edge is hidden.
bool EdgeCutter::pass(const OccluderGrid::Visit& cell) {
  if (o_.grid.has_sides(cell)) {
    pass_many(cell);
    return !counts_ && is_hidden(shown_);
  }
  const glm::dvec2 pad(OccluderGrid::kPad);
  const glm::dvec2 low = cell.low - pad, high = cell.high + pad;
  const ScreenPart part{{wide_low(low.x), wide_low(low.y)}, {wide_high(high.x), wide_high(high.y)}, farthest_};
  for (std::size_t first = cell.first; first < cell.last; first += kMostAtOnce) {
    const ScreenBoxes boxes = o_.grid.boxes(first);
    if (*boxes.nearest > farthest_) break;
    const std::uint64_t bits = o_.kernels.overlapping(boxes, std::min(kMostAtOnce, cell.last - first), part);
    if (!ask(bits, first, cell)) break;
  }
  return !counts_ && is_hidden(shown_);
}

/// \returns false when nothing is left to hide in this cell.
bool EdgeCutter::ask(std::uint64_t bits, std::size_t first, const OccluderGrid::Visit& cell) {
  for (; bits != 0; bits &= bits - 1) {
    const Occluder& occluder = o_.grid.occluder(first + std::size_t(std::countr_zero(bits)));
    const Occluder*& last = asked_[(reinterpret_cast<std::uintptr_t>(&occluder) / sizeof(Occluder)) % asked_.size()];
    if (last == &occluder) continue;
    last = &occluder;
    batch_.add(occluder);
    if (batch_.count == OccluderBatch::most && flush() && is_hidden(part_in(cell))) return false;
  }
  return true;
}

/// \returns true when more is hidden than before, and it matters.
bool EdgeCutter::flush() {
  HiddenBatch found;
  (is_for_cover_ ? o_.kernels.cover : o_.kernels.hide)(batch_, edge_, o_.sight, found);
  for (std::uint32_t bits = found.hides | found.open; bits != 0; bits &= bits - 1) {
    const auto i = std::size_t(std::countr_zero(bits));
    const Occluder& occluder = *batch_.occluders[i];
    if ((found.open >> i & 1) || occluder.is_near || edge_.slack > 0)
      hide((is_for_cover_ ? covered_by : hidden_by)(occluder, edge_, o_.sight), occluder.triangle);
    else
      hide({found.begin[i], found.end[i]}, occluder.triangle);
  }
  batch_.count = 0;
  return !counts_ && (found.hides | found.open) != 0;
}

void EdgeCutter::hide(const Interval& interval, std::uint32_t triangle) {
  Interval in{std::max(interval.begin, shown_.begin), std::min(interval.end, shown_.end)};
  if (!(in.begin < in.end)) return;
  if (counts_) {
    hidden_.push_back({in, triangle});
    return;
  }
  const auto first = hidden_.begin() + (first_to(in.begin) - hidden_.begin());
  auto last = first;
  for (; last != hidden_.end() && last->interval.begin <= in.end; ++last)
    in = {std::min(in.begin, last->interval.begin), std::max(in.end, last->interval.end)};
  if (first == last) {
    hidden_.insert(first, {in, triangle});
  } else {
    first->interval = in;
    hidden_.erase(first + 1, last);
  }
}

bool EdgeCutter::is_hidden(const Interval& part) const {
  const double begin = std::max(part.begin, shown_.begin), end = std::min(part.end, shown_.end);
  const auto at = first_to(end);
  return at != hidden_.end() && at->interval.begin <= begin;
}

/// Of what is hidden, without counts, the first that reaches t.
std::deque<EdgeCutter::Hidden>::const_iterator EdgeCutter::first_to(double t) const {
  return std::lower_bound(hidden_.begin(), hidden_.end(), t,
                          [](const Hidden& hidden, double place) { return hidden.interval.end < place; });
}

/// A triangle that was asked in two cells counts once.
void EdgeCutter::drop_doubles() {
  std::sort(hidden_.begin(), hidden_.end(), [](const Hidden& a, const Hidden& b) { return a.triangle < b.triangle; });
  hidden_.erase(std::unique(hidden_.begin(), hidden_.end(),
                            [](const Hidden& a, const Hidden& b) { return a.triangle == b.triangle; }),
                hidden_.end());
}

void EdgeCutter::emit(std::uint32_t number, std::vector<DrawnPart>& parts) {
  changes_.clear();
  for (const Hidden& hidden : hidden_) {
    changes_.emplace_back(hidden.interval.begin, 1);
    changes_.emplace_back(hidden.interval.end, -1);
  }
  changes_.emplace_back(shown_.end, 0);
  std::sort(changes_.begin(), changes_.end());
  const std::size_t first = parts.size();
  double begin = shown_.begin;
  int depth = 0;
  for (const auto& [t, change] : changes_) {
    if (t > begin) {
      const auto hidden_by = std::uint32_t(counts_ ? depth : std::min(depth, 1));
      if (parts.size() > first && parts.back().hidden_by == hidden_by)
        parts.back().end = t;
      else
        parts.push_back({number, begin, t, {}, {}, hidden_by});
      begin = t;
    }
    depth += change;
  }
  for (std::size_t i = first; i < parts.size(); ++i) {
    parts[i].from = i == first ? on_screen(parts[i].begin) : parts[i - 1].to;
    parts[i].to = on_screen(parts[i].end);
  }
}

void EdgeCutter::cut(const SightedEdge& edge, std::uint32_t number, std::vector<DrawnPart>& parts) {
  edge_ = edge;
  from_eye_ = o_.sight.in_eye(edge.from);
  to_eye_ = o_.sight.in_eye(edge.to);
  edge_.from_distance = from_eye_.z;
  edge_.to_distance = to_eye_.z;
  const Interval shown = within_view();
  if (!(shown.begin < shown.end)) return;
  search(shown, false);
  if (counts_) drop_doubles();
  const std::size_t first = parts.size();
  emit(number, parts);
  if (o_.outlines && edge.outer != 0) split_outline(first, parts);
}

/// Fills `hidden_` for what of the edge lies in `span`.
void EdgeCutter::search(const Interval& span, bool for_cover) {
  shown_ = span;
  is_for_cover_ = for_cover;
  counts_ = o_.counts && !for_cover;
  const glm::dvec2 a = on_screen(span.begin), b = on_screen(span.end);
  begin_ = a * o_.grid.scale();
  end_ = b * o_.grid.scale();
  const double farthest = std::max(from_eye_.z, to_eye_.z);
  farthest_ = for_cover ? std::numeric_limits<float>::infinity() : wide_high(farthest);
  hidden_.clear();
  asked_.fill(nullptr);
  batch_.count = 0;
  const auto vertex = [](const EndOn& on, bool is_seen) { return is_seen && on[0] == on[1] ? on[0] : no_index; };
  const GridLine line{begin_, end_, vertex(edge_.from_on, span.begin == 0), vertex(edge_.to_on, span.end == 1)};
  o_.grid.visit_cells(line, [&](const OccluderGrid::Visit& cell) { return !pass(cell); });
  if (batch_.count > 0) flush();
}

/// Cuts the seen parts from `first` on where what lies beside them begins and ends.
void EdgeCutter::split_outline(std::size_t first, std::vector<DrawnPart>& parts) {
  split_.clear();
  for (std::size_t i = first; i < parts.size(); ++i) {
    DrawnPart part = parts[i];
    if (part.hidden_by == 0) {
      search({part.begin, part.end}, true);
      const auto cut_at = [&](double t, bool is_outline) {
        if (!(part.begin < t)) return;
        DrawnPart piece = part;
        piece.is_outline = is_outline;
        piece.end = t;
        if (t < part.end) piece.to = on_screen(t);
        part.begin = t;
        part.from = piece.to;
        split_.push_back(piece);
      };
      const double end = part.end;
      for (const Hidden& covered : hidden_) {
        cut_at(covered.interval.begin, true);
        cut_at(covered.interval.end, false);
      }
      cut_at(end, true);
    } else {
      split_.push_back(part);
    }
  }
  parts.resize(first);
  parts.insert(parts.end(), split_.begin(), split_.end());
}

}  // namespace frontmost::lines_detail
