// SPDX-License-Identifier: Apache-2.0
//
//    o->|>|---->|      Numbers that would touch are moved aside, and are joined to their extension lines by jogs.
//       /  .    |
//      3   5    18
#include "sheets/dimensions/positions.h"

#include <algorithm>
#include <cmath>

namespace frontmost::detail {
namespace {

constexpr std::size_t most_steps = 16, fewest_alike = 5;

/// Places numbers as near to their extension lines as they have room, by isotonic regression: numbers that would touch
/// form blocks, and a block has its mean place. \returns false if there is no room. `row` ascends.
bool place_numbers(std::vector<Position>& row, const NumberRoom& room) {
  struct Block {
    double sum;
    std::size_t count;
    [[nodiscard]] double mean() const { return sum / double(count); }
  };
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0 && row[i].distance - row[i - 1].distance < room.least_gap) return false;
    blocks.push_back({row[i].distance - double(i) * room.thickness, 1});
    for (std::size_t last = blocks.size() - 1; last > 0 && blocks[last - 1].mean() > blocks[last].mean(); --last) {
      blocks[last - 1].sum += blocks[last].sum;
      blocks[last - 1].count += blocks[last].count;
      blocks.pop_back();
    }
  }
  std::size_t at = 0;
  const double high = room.high - double(row.size() - 1) * room.thickness;
  if (high < room.low) return false;
  for (const Block& block : blocks)
    for (std::size_t i = 0; i < block.count; ++i, ++at) {
      row[at].place = std::clamp(block.mean(), room.low, high) + double(at) * room.thickness;
      if (std::abs(row[at].place - row[at].distance) > room.most_moved + same_place) return false;
    }
  return true;
}

}  // namespace

std::vector<Position> chosen_positions(std::vector<Position> positions, double away, const NumberRoom& room,
                                       std::size_t& left_out) {
  std::erase_if(positions, [](const Position& p) { return p.distance < same_place; });
  std::stable_sort(positions.begin(), positions.end(),
                   [](const Position& a, const Position& b) { return a.distance < b.distance; });
  std::vector<Position> each;
  double begin_of_run = 0;
  for (Position& p : positions) {
    if (each.empty() || p.distance >= begin_of_run + same_place) {
      begin_of_run = p.distance;
      each.push_back(std::move(p));
      continue;
    }
    // Of positions at one distance, the one nearest to the row has the extension line.
    Position& known = each.back();
    known.length = std::max(known.length, p.length);
    known.planes.insert(known.planes.end(), p.planes.begin(), p.planes.end());
    if (away * p.foot <= away * known.foot) continue;
    known.foot = p.foot;
    known.distance = p.distance;
  }
  std::stable_sort(each.begin(), each.end(), [](const Position& a, const Position& b) { return a.length > b.length; });
  std::vector<Position> chosen;
  std::size_t steps = 0;
  for (auto begin = each.begin(); begin != each.end();) {
    const bool is_step = std::isfinite(begin->length);
    const auto end =
        std::find_if(begin, each.end(), [&](const Position& p) { return p.length < (1 - same_size) * begin->length; });
    std::vector<Position> more = chosen;
    const auto count = std::size_t(end - begin);
    for (auto p = begin; p != end; ++p) {
      if (is_step && steps + (more.size() - chosen.size()) >= most_steps) break;
      std::vector<Position> wanted = more;
      wanted.insert(std::find_if(wanted.begin(), wanted.end(),
                                 [&](const Position& other) { return other.distance > p->distance; }),
                    *p);
      if (place_numbers(wanted, room)) more = std::move(wanted);
    }
    if (is_step && count >= fewest_alike && more.size() - chosen.size() < count) more = chosen;
    if (!is_step) left_out += count - (more.size() - chosen.size());
    if (is_step) steps += more.size() - chosen.size();
    chosen = std::move(more);
    begin = end;
  }
  return chosen;
}

}  // namespace frontmost::detail
