// SPDX-License-Identifier: Apache-2.0
// Each kind of line has a layer of the page, in drawing order. Within a layer, each object of each view is a group.
//
//    dashes on a line     |=====  ==  =====  ==  =====|      it begins and ends with a whole long dash; long dashes are
//                                                            stretched to fit the length
#include <cmath>
#include <compare>
#include <map>

#include "frontmost/sheets.h"
#include "sheets/paper.h"

namespace frontmost {
namespace {

/// Layers are in drawing order. Their names contain numbers, because a plotter's pens are selected by number.
constexpr std::size_t layer_count = 6;
enum LayerOf : std::size_t { stippling, hatching, centre, hidden, seen, outline };
const char* const layer_names[layer_count] = {"5 stippling", "4 hatching", "6 centre lines",
                                              "1 hidden",    "2 visible",  "3 outline"};

/// The dashes of a pen, fitted to a line of that length. The line gets an odd number of the pen's first dash, with the
/// other dashes between them. The length of the first dash is rounded, so that lines of similar length have the same
/// pattern. Empty if there is room for only one dash.
std::vector<double> dashes_on(const Pen& pen, double length) {
  if (pen.dashes.empty()) return {};
  constexpr double step = 0.02;  // millimetres
  double between = 0;
  for (std::size_t i = 1; i < pen.dashes.size(); ++i) between += pen.dashes[i];
  const double pairs = std::round((length - pen.dashes[0]) / (pen.dashes[0] + between) / 2);
  if (pairs < 1) return {};
  std::vector<double> dashes = pen.dashes;
  dashes[0] = std::round((length - 2 * pairs * between) / (2 * pairs + 1) / step) * step;
  return dashes;
}

/// The layers under construction, with the group of each view and object.
class SheetLayers {
 public:
  SheetLayers(const Surfaces& surfaces, const LinePens& pens) : surfaces_(surfaces), pens_(pens) {
    for (std::size_t i = 0; i < layer_count; ++i) layers_[i].name = layer_names[i];
  }

  void draw(const SheetView& view, std::uint32_t number) {
    for (const Stipple& dot : view.stippling) {
      const glm::dvec2 at = view.on_page(dot.at);
      group({stippling, number, dot.instance, false}, view, pens_.stippling).add(std::span(&at, 1), false);
    }
    for (const HatchLine& line : view.hatching) {
      const glm::dvec2 ends[] = {view.on_page(line.from), view.on_page(line.to)};
      group({hatching, number, line.instance, false}, view, pens_.hatching).add(ends, false);
    }
    for (const CentreLine& line : view.centre_lines) {
      const glm::dvec2 ends[] = {view.on_page(line.from), view.on_page(line.to)};
      Pen pen = pens_.centre;
      pen.dashes = dashes_on(pen, glm::distance(ends[0], ends[1]));
      std::vector<PageGroup>& groups = layers_[centre].groups;
      const auto [known, is_new] = centre_groups_.try_emplace(pen.dashes, groups.size());
      if (is_new) groups.push_back({"", pen});
      groups[known->second].add(ends, false);
    }
    for (const Stroke& stroke : view.strokes.strokes) append(stroke, view, group_for(stroke, view, number));
  }

  std::vector<PageLayer> take() {
    std::vector<PageLayer> layers;
    for (PageLayer& layer : layers_)
      if (!layer.groups.empty()) layers.push_back(std::move(layer));
    return layers;
  }

 private:
  PageGroup& group_for(const Stroke& stroke, const SheetView& view, std::uint32_t number) {
    const bool is_crease = stroke.kind == EdgeKind::crease;
    const LayerOf layer = stroke.is_hidden ? hidden : stroke.is_outline ? outline : seen;
    // Creases share a group with the other lines of their object unless their pen differs.
    const bool is_apart = layer == seen && is_crease && pens_.crease.width != pens_.seen.width;
    return group({layer, number, stroke.instance, is_apart}, view, detail::pen_of(stroke, pens_));
  }

  struct GroupKey {
    LayerOf layer;
    std::uint32_t view, instance;
    bool is_apart;

    friend auto operator<=>(const GroupKey&, const GroupKey&) = default;
  };
  PageGroup& group(const GroupKey& key, const SheetView& view, const Pen& pen) {
    std::vector<PageGroup>& groups = layers_[key.layer].groups;
    const auto [known, is_new] = places_.try_emplace(key, groups.size());
    if (is_new) groups.push_back({name_of(view, key.instance), pen});
    return groups[known->second];
  }

  [[nodiscard]] std::string name_of(const SheetView& view, std::uint32_t instance) const {
    const std::string object = instance == no_index ? "" : surfaces_.scene().instances[instance].name;
    return view.name.empty() || object.empty() ? view.name + object : view.name + ": " + object;
  }

  static void append(const Stroke& stroke, const SheetView& view, PageGroup& group) {
    const Strokes& all = view.strokes;
    group.paths.push_back({std::uint32_t(group.points.size()), stroke.count, stroke.is_closed});
    for (std::uint32_t i = stroke.first; i < stroke.first + stroke.count; ++i) {
      group.points.push_back(view.on_page(all.points[i]));
      if (!all.bulges.empty()) group.bulges.push_back(all.bulges[i]);
    }
  }

  const Surfaces& surfaces_;
  const LinePens& pens_;
  PageLayer layers_[layer_count];
  std::map<GroupKey, std::size_t> places_;
  std::map<std::vector<double>, std::size_t> centre_groups_;  ///< by dashes
};

}  // namespace

LinePens technical_pens() { return {}; }

LinePens figure_pens() {
  return {
      {0.7, {}}, {0.35, {}}, {0.18, {}}, {0.13, {}, {1.5, 0.75}}, {0.13, {}}, {0.25, {}}, {0.13, {}, {6, 1, 0.1, 1}}};
}

Pen thin_pen() { return {0.13, {}}; }

Page page_of(const Surfaces& surfaces, std::span<const SheetView> views, const LinePens& pens, const glm::dvec2& size) {
  SheetLayers sheet(surfaces, pens);
  for (std::size_t i = 0; i < views.size(); ++i) sheet.draw(views[i], std::uint32_t(i));
  return {size.x, size.y, surfaces.scene().name, sheet.take()};
}

DrawingBounds bounds_of(const Drawing& drawing, bool with_hidden) {
  DrawingBounds all;
  for (const DrawnPart& part : drawing.parts) {
    if (part.hidden_by != 0 && !with_hidden) continue;
    all.low = glm::min(all.low, glm::min(part.from, part.to));
    all.high = glm::max(all.high, glm::max(part.from, part.to));
  }
  return all;
}

}  // namespace frontmost
