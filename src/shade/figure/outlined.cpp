// SPDX-License-Identifier: Apache-2.0
#include "base/float_environment.h"
#include "base/parallel.h"
#include "shade/figure/figure_traps.h"
#include "shade/figure/side_net.h"

namespace frontmost {
namespace {

using namespace shading;
using painter_detail::TrapList;
using painter_detail::TrappedCorner;

/// Writes outlines with their traps into a figure.
class Outliner {
 public:
  Outliner(Figure& figure, const TrapList& traps) : figure_(figure), traps_(traps) {}

  void begin_shape(const glm::u8vec4& color, bool is_in_last_sheet) {
    const std::uint32_t sheet = figure_.shapes.empty() ? 0 : figure_.shapes.back().sheet + !is_in_last_sheet;
    figure_.shapes.push_back({color, 0, figure_.rings.size(), sheet});
  }
  void add_ring(std::span<const TrappedCorner> outline) {
    const std::size_t first = figure_.corners.size();
    write_outline(traps_, outline, figure_.corners);
    figure_.rings.push_back({first, std::uint32_t(figure_.corners.size() - first)});
    ++figure_.shapes.back().ring_count;
  }

 private:
  Figure& figure_;
  const TrapList& traps_;
};

}  // namespace

Figure outlined(const ColoredOrder& colored, double width, const Occluders& occluders, const Execution& execution) {
  const TrapList traps = figure_traps(colored, width, occluders, execution);
  const IeeeScope ieee;
  Figure figure;
  figure.view = colored.view;
  figure.shapes.reserve(colored.shapes.size());
  figure.rings.reserve(colored.shapes.size());
  figure.corners.reserve(colored.corners.size() * 2);  // about what traps add
  Outliner outliner(figure, traps);
  SideNet net;
  std::vector<TrappedCorner> corners;
  const ColoredShape* before = nullptr;
  for (const ColoredShape& shape : colored.shapes) {
    check_cancelled(execution);
    outliner.begin_shape(shape.color, before && shape.color.a < 255 && before->sheet == shape.sheet);
    before = &shape;
    net.clear();
    for (std::size_t i = shape.first_polygon; i < shape.first_polygon + shape.polygon_count; ++i) {
      traps.set_corners(i, colored.corners_of(colored.polygons[i]), corners);
      if (shape.polygon_count > 1) net.add(corners, std::uint32_t(i));
    }
    if (shape.polygon_count == 1) {
      outliner.add_ring(corners);
      continue;
    }
    net.weave();
    net.for_each_ring([&](std::span<const TrappedCorner> ring) { outliner.add_ring(ring); });
  }
  return figure;
}

}  // namespace frontmost
