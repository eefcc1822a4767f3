// SPDX-License-Identifier: Apache-2.0
#include "cli/lines/paper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/failure.h"
#include "cli/values.h"

namespace frontmost::cli {
namespace {

struct Paper {
  std::string_view name;
  double width, height;  // portrait
};
constexpr Paper papers[] = {
    {"a0", 841, 1189}, {"a1", 594, 841}, {"a2", 420, 594},         {"a3", 297, 420},        {"a4", 210, 297},
    {"a5", 148, 210},  {"a6", 105, 148}, {"letter", 215.9, 279.4}, {"legal", 215.9, 355.6}, {"tabloid", 279.4, 431.8}};
constexpr NumberLimits side_range{1, 1e5};

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return small;
}

/// Takes `ending` away where it is there.
bool take_ending(std::string& text, std::string_view ending) {
  if (text.size() <= ending.size() || text.compare(text.size() - ending.size(), ending.size(), ending) != 0)
    return false;
  text.resize(text.size() - ending.size());
  return true;
}

}  // namespace

PaperSettings parse_paper(std::string_view text) {
  std::string name = in_small_letters(text);
  PaperSettings paper;
  if (name == "fit") {
    paper.fits_drawing = true;
    return paper;
  }
  if (!name.empty() && name[0] >= '0' && name[0] <= '9') {
    std::replace(name.begin(), name.end(), 'x', ',');
    const std::vector<double> sides = parse_numbers(name, 2, side_range);
    return {{sides[0], sides[1]}, false, false};
  }
  const bool landscape = take_ending(name, "-landscape"), portrait = take_ending(name, "-portrait");
  for (const Paper& known : papers) {
    if (known.name != name) continue;
    paper.size = landscape ? glm::dvec2(known.height, known.width) : glm::dvec2(known.width, known.height);
    paper.may_turn = !landscape && !portrait;
    return paper;
  }
  throw UsageError(
      fmt::format("'{}' is no paper: a0 to a6, letter, legal or tabloid, perhaps with -portrait or "
                  "-landscape; W,H in millimetres; or fit",
                  text));
}

std::string paper_text(const glm::dvec2& size) {
  const double narrow = std::min(size.x, size.y), wide = std::max(size.x, size.y);
  for (const Paper& known : papers) {
    if (known.width != narrow || known.height != wide) continue;
    std::string name(known.name);
    name[0] = char(name[0] - 'a' + 'A');
    return name;
  }
  return fmt::format("{:.6g} x {:.6g}", size.x, size.y);
}

double parse_scale(std::string_view text) {
  constexpr NumberLimits range{1e-6, 1e6};
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return parse_number(text, range);
  const double paper = parse_number(text.substr(0, colon), range), model = parse_number(text.substr(colon + 1), range);
  return paper / model;
}

std::string scale_text(double scale) {
  return scale >= 1 ? fmt::format("{:.6g}:1", scale) : fmt::format("1:{:.6g}", 1 / scale);
}

double standard_scale(double most) {
  // Reductions are divided by whole numbers, so that 1:5 is the double nearest to a fifth.
  constexpr double slack = 1 + 1e-9;
  for (int decade = 9; decade >= 0; --decade)
    for (const int digit : {5, 2, 1})
      if (const double scale = digit * std::pow(10.0, decade); scale <= most * slack) return scale;
  for (int decade = 0; decade < 10; ++decade)
    for (const int digit : {2, 5, 10})
      if (const double scale = 1 / (digit * std::pow(10.0, decade)); scale <= most * slack) return scale;
  return most;  // beyond all standards, but it fits
}

}  // namespace frontmost::cli
