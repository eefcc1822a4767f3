// SPDX-License-Identifier: Apache-2.0
// Papers are those of ISO 216 and the American ones. Scales are those of ISO 5455: 1, 2 and 5 times a power of ten, the
// largest that is not above a given one. Reductions are quotients of whole numbers, so that 1:5 is the double nearest
// to a fifth.
#include <algorithm>
#include <cmath>

#include "frontmost/base.h"
#include "frontmost/sheets.h"
#include "sheets/page_marks.h"

namespace frontmost {
namespace {

struct PaperKind {
  std::string_view name;
  double width, height;  // portrait
};
constexpr PaperKind paper_kinds[] = {
    {"a0", 841, 1189}, {"a1", 594, 841}, {"a2", 420, 594},         {"a3", 297, 420},        {"a4", 210, 297},
    {"a5", 148, 210},  {"a6", 105, 148}, {"letter", 215.9, 279.4}, {"legal", 215.9, 355.6}, {"tabloid", 279.4, 431.8}};

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return small;
}

/// Removes `ending` if the text has it. \returns whether it did.
bool take_ending(std::string& text, std::string_view ending) {
  if (text.size() <= ending.size() || text.compare(text.size() - ending.size(), ending.size(), ending) != 0)
    return false;
  text.resize(text.size() - ending.size());
  return true;
}

}  // namespace

Paper named_paper(std::string_view name) {
  std::string rest = in_small_letters(name);
  const bool landscape = take_ending(rest, "-landscape"), portrait = take_ending(rest, "-portrait");
  for (const PaperKind& kind : paper_kinds) {
    if (kind.name != rest) continue;
    Paper paper;
    paper.size = landscape ? glm::dvec2(kind.height, kind.width) : glm::dvec2(kind.width, kind.height);
    paper.may_turn = !landscape && !portrait;
    return paper;
  }
  throw Error(ErrorCode::bad_argument, "'" + std::string(name) +
                                           "' is no paper: a0 to a6, letter, legal or tabloid, perhaps with -portrait "
                                           "or -landscape");
}

std::string paper_name(const glm::dvec2& size) {
  const double narrow = std::min(size.x, size.y), wide = std::max(size.x, size.y);
  for (const PaperKind& kind : paper_kinds) {
    if (kind.width != narrow || kind.height != wide) continue;
    std::string name(kind.name);
    name[0] = char(name[0] - 'a' + 'A');
    return name;
  }
  return detail::size_text(size);
}

std::string scale_text(double scale) {
  return scale >= 1 ? detail::number_text(scale) + ":1" : "1:" + detail::number_text(1 / scale);
}

double standard_scale(double most) {
  constexpr double slack = 1 + 1e-9;
  for (int decade = 9; decade >= 0; --decade)
    for (const int digit : {5, 2, 1})
      if (const double scale = digit * std::pow(10.0, decade); scale <= most * slack) return scale;
  for (int decade = 0; decade < 10; ++decade)
    for (const int digit : {2, 5, 10})
      if (const double scale = 1 / (digit * std::pow(10.0, decade)); scale <= most * slack) return scale;
  return most;  // beyond all standard scales, but it fits
}

}  // namespace frontmost
