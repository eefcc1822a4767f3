// SPDX-License-Identifier: Apache-2.0
// Parts that touch have different hatching, as drawing standards require. Two angles and three spacings give six
// styles. Each part, in the order of numbers, gets the style that the earlier parts beside it, in any section, use
// least. So a part looks the same wherever it is cut. Thin walls are hatched densely and look filled, because few lines
// of wide hatching would cross them.
#include <algorithm>

#include "frontmost/lines.h"

namespace frontmost {
namespace {

constexpr int style_count = 6;
constexpr std::size_t most_compared = 2048;
constexpr double spacings[] = {1, 0.7, 1.4};  // two angles of each

Box box_of(const CutFace& face) {
  Box box;
  for (const std::vector<glm::vec3>& outline : face.outlines)
    for (const glm::vec3& p : outline) box.include(p);
  return box;
}

bool may_touch(const Box& a, const Box& b) {
  return glm::all(glm::lessThanEqual(a.low, b.high)) && glm::all(glm::lessThanEqual(b.low, a.high));
}

/// Twice the area by the perimeter: about the width of a long strip.
double thickness_of(const CutFace& face) {
  double around = 0;
  for (const std::vector<glm::vec3>& outline : face.outlines)
    for (std::size_t i = 0; i < outline.size(); ++i)
      around += glm::distance(glm::dvec3(outline[i]), glm::dvec3(outline[i + 1 < outline.size() ? i + 1 : 0]));
  return around > 0 ? 2 * face.area / around : 0;
}

/// A cut face among those of several sections.
struct PlacedFace {
  std::uint32_t instance;
  std::size_t section;
  Box box;
};

std::vector<PlacedFace> faces_of(std::span<const Section* const> sections) {
  std::vector<PlacedFace> faces;
  for (std::size_t i = 0; i < sections.size(); ++i)
    for (const CutFace& face : sections[i]->faces) faces.push_back({face.instance, i, box_of(face)});
  std::stable_sort(faces.begin(), faces.end(),
                   [](const PlacedFace& a, const PlacedFace& b) { return a.instance < b.instance; });
  return faces;
}

}  // namespace

std::vector<std::uint8_t> hatch_styles(std::span<const Section* const> sections) {
  std::vector<std::uint8_t> styles;
  for (const Section* const section : sections) styles.resize(std::max(styles.size(), section->scene.instances.size()));
  const std::vector<PlacedFace> faces = faces_of(sections);
  for (std::size_t begin = 0, end = 0; begin < faces.size(); begin = end) {
    const std::uint32_t instance = faces[begin].instance;
    std::size_t uses[style_count] = {};
    for (; end < faces.size() && faces[end].instance == instance; ++end)
      for (std::size_t k = begin - std::min(begin, most_compared); k < begin; ++k)
        if (faces[k].section == faces[end].section && may_touch(faces[k].box, faces[end].box))
          ++uses[styles[faces[k].instance]];
    styles[instance] = std::uint8_t(std::min_element(std::begin(uses), std::end(uses)) - std::begin(uses));
  }
  return styles;
}

std::vector<HatchSet> section_hatch_sets(const Section& section, std::span<const std::uint8_t> styles,
                                         const SectionHatching& options) {
  constexpr double eighth = std::numbers::pi / 4;
  std::vector<HatchSet> sets;
  for (int style = 0; style < style_count; ++style)
    sets.push_back({style % 2 == 0 ? eighth : 3 * eighth, options.spacing * spacings[style / 2]});
  sets.push_back({eighth, options.solid_spacing});
  for (const CutFace& face : section.faces) {
    const bool is_solid = thickness_of(face) < options.thinnest;
    const int style = face.instance < styles.size() ? styles[face.instance] % style_count : 0;
    sets[std::size_t(is_solid ? style_count : style)].materials.push_back(face.material);
  }
  std::erase_if(sets, [](const HatchSet& set) { return set.materials.empty(); });
  return sets;
}

ToneOptions section_tone(const CuttingPlane& plane) {
  ToneOptions tone;
  tone.to_light =
      plane.towards == Axis::x || plane.towards == Axis::minus_x ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  tone.casts_shadows = false;
  tone.crease_angle = 0;
  return tone;
}

}  // namespace frontmost
