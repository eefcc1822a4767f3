// SPDX-License-Identifier: Apache-2.0
//    A               A          A cutting line is thin, with long dashes and dots, and has thick ends beyond the cut
//    |               |          part. Arrows at the ends point in the section's view direction, with its letter behind
//    v               v          them. The letter, written twice, is the name of the section.
//    ===- - - . - ===
#include "frontmost/sheets.h"
#include "sheets/page_marks.h"
#include "sheets/sections/sections.h"

namespace frontmost::detail {
namespace {

constexpr double gap_before = 3, thick_length = 6;   // millimetres beyond the cut part
constexpr double arrow_place = 6;                    // likewise: in the middle of the thick end
constexpr double arrow_length = 8, head_length = 4;  // millimetres
constexpr double letter_distance = 1;                // from the arrow's tail

class MarkPen {
 public:
  explicit MarkPen(const SectionMarkOptions& options)
      : options_(options),
        thin_{"", options.thin},
        thick_{"", {2 * options.thin.width, options.thin.color}},
        heads_{"", {options.thin.width, options.thin.color}},
        texts_{"", text_pen(options.text_height)} {
    texts_.pen.color = options.thin.color;
  }

  void draw(const CuttingLine& line) {
    const glm::dvec2 along = glm::normalize(line.to - line.from);
    const glm::dvec2 ends[] = {line.from - gap_before * along, line.to + gap_before * along};
    thin_.add(ends, false);
    draw_end(line, line.from, -along);
    draw_end(line, line.to, along);
  }

  void draw(const ViewName& name) {
    add_text(texts_, name.text, name.at, {options_.text_height, 0, TextAlign::centre, TextLine::bottom});
    const double half = text_width(name.text, options_.text_height) / 2;
    marks_.boxes.push_back({name.at - glm::dvec2(half, options_.text_height), name.at + glm::dvec2(half, 0)});
  }

  SectionMarks take() {
    for (PageGroup* const group : {&thin_, &thick_, &heads_, &texts_})
      if (!group->paths.empty()) marks_.layer.groups.push_back(std::move(*group));
    return std::move(marks_);
  }

 private:
  void draw_end(const CuttingLine& line, const glm::dvec2& end, const glm::dvec2& outwards) {
    const glm::dvec2 thick[] = {end + gap_before * outwards, end + (gap_before + thick_length) * outwards};
    thick_.add(thick, false);
    const glm::dvec2 tip = end + arrow_place * outwards, tail = tip - arrow_length * line.looking;
    const glm::dvec2 shaft[] = {tail, tip};
    heads_.add(shaft, false);
    add_arrowhead(heads_, tip, line.looking, head_length);
    const double half = options_.text_height / 2;
    const glm::dvec2 letter = tail - (letter_distance + half) * line.looking;
    add_text(texts_, line.letter, letter, {options_.text_height, 0, TextAlign::centre, TextLine::middle});
    const glm::dvec2 corners[] = {letter - half, letter + half, thick[0], thick[1], tail};
    PageBox box{corners[0], corners[0]};
    for (const glm::dvec2& corner : corners) {
      box.low = glm::min(box.low, corner);
      box.high = glm::max(box.high, corner);
    }
    marks_.boxes.push_back(box);
  }

  const SectionMarkOptions& options_;
  PageGroup thin_, thick_, heads_, texts_;
  SectionMarks marks_;
};

}  // namespace

SectionMarks draw_section_marks(std::span<const CuttingLine> lines, std::span<const ViewName> names,
                                const SectionMarkOptions& options) {
  if (!(options.text_height >= 0.5 && options.text_height <= 100))
    throw Error(ErrorCode::bad_argument, "text_height", "must be from 0.5 to 100 millimetres");
  MarkPen pen(options);
  for (const CuttingLine& line : lines) {
    if (!(glm::distance(line.from, line.to) > 0)) throw Error(ErrorCode::bad_argument, "a cutting line has no length");
    pen.draw(line);
  }
  for (const ViewName& name : names) pen.draw(name);
  return pen.take();
}

}  // namespace frontmost::detail
