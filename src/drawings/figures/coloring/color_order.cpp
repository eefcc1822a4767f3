// SPDX-License-Identifier: Apache-2.0
// The colours of a figure's polygons: each polygon is cut into pieces of one colour.
//
//    polygon --start--> sampled --judge--> of one colour --------------------> kept
//                          ^                    | not
//                          |                 best_cut --> two halves ---> waiting
//                          +------------------------------------------------+
//
// The piece that was cut last is taken first, so that few wait. Samples of many pieces are shaded together. A list
// keeps the order of the halves, so the order of writing does not depend on that of shading.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "base/pool.h"
#include "base/srgb.h"
#include "figures/colored_order.h"
#include "figures/coloring/pieces.h"
#include "painter/seen/screen_polygons.h"
#include "shade/colorists.h"
#include "shade/fragment_shader.h"
#include "shade/prepared_scene.h"
#include "surfaces/cluster_set.h"
#include "view/screen_cutout.h"

namespace frontmost {
namespace {

using namespace shading;

/// A shaded point has one sample, at its own place.
constexpr glm::ivec2 kAtPoint[] = {{0, 0}};

/// The scene's triangles, with smooth normals for the large ones.
const TriangleStore& smoothed(PreparedScene& scene, const BitSet& large, const Execution& execution) {
  scene.triangles.smooth(large, execution);
  return scene.triangles;
}

Lighting lighting_of(PreparedScene& scene, const ShadeInput& input, const ShadeOptions& options,
                     const Execution& execution) {
  check_light(options.light);
  if (options.light.shows_environment)
    throw Error(ErrorCode::unsupported, "figure", "an environment cannot be shown as background");
  if (options.shading != Shading::lit) return {};
  return lighting_for(input.first().view, scene.surfaces.scene().up, options.light,
                      scene.environment(options.light, execution));
}

/// The triangles of a figure.
struct FigureTriangles {
  BitSet seen;   ///< all triangles of the figure
  BitSet large;  ///< triangles that need a smooth normal if the model has none
};

struct PointShader {
  /// Borrows all arguments but the options, and prepares whatever the scene lacks. \throws Error as check_opacity()
  /// does.
  PointShader(PreparedScene& scene, const ShadeInput& input, const FigureTriangles& triangles,
              const ShadeOptions& options, const Execution& execution)
      : source(smoothed(scene, triangles.large, execution), input.first().view, &triangles.large),
        lighting(lighting_of(scene, input, options, execution)),
        opacity(shows_materials(options.shading) ? options.opacity : 1.0f) {
    check_opacity(options);
    check_ambient_occlusion(options);
    scene.make_materials_ready(triangles.seen, execution);
    if (options.shading == Shading::lit) {
      Lit lit = lit_by(lighting, {input, options, kAtPoint}, scene, execution);
      lit.occlusion = scene.find_occlusion(input, options, execution);
      scene.shadows.ask_at_points();
      colorist = std::move(lit);
    } else if (options.shading == Shading::depth) {
      colorist = depth_colorist(depth_range(input.first(), execution), glm::vec3(input.first().view.forward()));
    } else {
      colorist = unlit_colorist(options.shading, scene.materials, execution.isa);
    }
  }

  const TriangleSource source;
  const Lighting lighting;
  FragmentShader::Colorist colorist;
  const float opacity;
};

/// In pixels: the least width of a cut piece, and the distance from a cut below which no samples are taken. Textures
/// and shadows are filtered over about this distance, so colours this close to a cut belong to neither side.
constexpr double kLeastWidth = 0.25, kBesideCut = 0.35;
/// The share of the tolerance for differences within a piece, where pieces are grouped; the rest is for the group.
constexpr double kWithin = 2.0 / 3;
/// The factor of the tolerance for pieces narrower than a pixel, which are hardly visible.
constexpr double kOfSlivers = 8;
/// The number of samples that are shaded together: they fill several batches of the shader, but stay in the cache.
constexpr std::size_t kSamplesAtOnce = 2048;

bool is_hole(const glm::vec4& color) { return color.w < 0; }

glm::u8vec4 rounded(const glm::vec4& color) {
  const auto part = [](float value) { return std::uint8_t(std::clamp(value + 0.5f, 0.0f, 255.0f)); };
  return {part(color.x), part(color.y), part(color.z), part(color.w)};
}

/// \throws Error limit_exceeded.
[[noreturn]] void refuse_more_than(std::size_t most) {
  throw Error(ErrorCode::limit_exceeded, "figure", "more than " + std::to_string(most) + " polygons and pieces");
}

/// Cuts polygons into pieces of one colour. Many pieces are sampled before they are judged, so that the shader has
/// whole batches. Not for several threads at once.
class PolygonColors {
 public:
  /// Borrows all but the view.
  PolygonColors(const Surfaces& surfaces, const View& view, const PointShader& shader, const FigureOptions& options,
                const Execution& execution)
      : surfaces_(surfaces), shading_(shader), options_(options), execution_(execution), rays_(view) {
    shader_.begin(shader.source, shader.colorist, execution.isa);
  }

  /// Appends the pieces of `polygons`, some of the polygons of `parts`, without holes and fully transparent pieces. The
  /// result depends only on these polygons. Precondition: each polygon has at least three corners. \throws Error
  /// cancelled, and as refuse_more_than() does.
  void color(const VisibleParts& parts, std::span<const PaintPolygon> polygons, ColoredOrder& into) {
    begin(polygons);
    while (started_ < polygons_.size() || !waiting_.empty()) {
      check_cancelled(execution_);
      if (kept_.size() + waiting_.size() > options_.most_polygons) refuse_more_than(options_.most_polygons);
      take_pieces(parts);
      shade_samples();
      for (Piece& piece : looked_at_) divide(piece);
    }
    for (const Polygon& polygon : polygons_) {
      listed_.clear();
      for (std::uint32_t i = polygon.first_slot; i != no_index; i = slots_[i].next)
        if (slots_[i].kept != no_index) listed_.push_back(&kept_[slots_[i].kept]);
      for (std::uint32_t i = 0; i < listed_.size(); ++i) listed_[i]->group = i;
      if (polygon.is_grouped) group_listed();
      for (std::size_t i = 0; i < listed_.size(); ++i) {
        const Kept& piece = *listed_[i];
        if (i == 0 || listed_[i - 1]->group != piece.group) into.begin_shape(rounded(piece.color));
        into.add_polygon(polygon.outline.id, piece.corners);
      }
    }
  }

 private:
  struct Piece {
    std::vector<glm::dvec2> corners;
    std::vector<ColorSample> samples;  ///< includes samples of the piece from which it was cut
    std::size_t known_samples = 0;
    bool is_sliver = false;     ///< the whole piece lies close to cuts
    std::uint32_t polygon = 0;  ///< index of its polygon
    std::uint32_t slot = 0;
    std::uint32_t cut = no_index;  ///< the last cut that made it
  };
  /// A cut, linked to the cut before it. A piece lies on one side of each of its cuts.
  struct Cut {
    ScreenLine line;
    std::uint32_t before = no_index;
  };
  /// The place of a piece in its polygon's list, which is in painting order.
  struct Slot {
    std::uint32_t next = no_index, kept = no_index;
  };
  struct Kept {
    glm::vec4 color;
    std::vector<glm::dvec2> corners;
    std::uint32_t group = 0;  ///< group of pieces of nearly one colour
  };
  struct Polygon {
    PaintPolygon outline;
    bool is_grouped = false;  ///< pieces of one colour become one shape
    std::uint32_t first_slot = 0;
    std::optional<ScreenCutout> holes{};
    std::optional<std::vector<TexcoordLines>> texture_lines{};  ///< made when first needed
  };
  void begin(std::span<const PaintPolygon> polygons) {
    // The shader is cleared because it sets up a triangle around its first sample, which must be on one of these
    // polygons.
    shader_.clear();
    polygons_.clear();
    slots_.clear();
    cuts_.clear();
    kept_.clear();
    started_ = 0;
    const Cutouts* const cutouts = placed_scene(surfaces_).cutouts.get();
    for (const PaintPolygon& outline : polygons) {
      Polygon& polygon = polygons_.emplace_back(Polygon{outline});
      if (cutouts && cutouts->has(outline.id)) polygon.holes.emplace((*cutouts)[outline.id], rays_);
      polygon.is_grouped = options_.merges_neighbours || shading_.opacity < 1 || !is_opaque(surfaces_, outline.id);
    }
  }

  void start(const VisibleParts& parts, std::uint32_t number) {
    Polygon& polygon = polygons_[number];
    polygon.first_slot = std::uint32_t(slots_.size());
    slots_.emplace_back();
    const PaintCorner* const first = parts.corners.data() + polygon.outline.first_corner;
    Piece& piece = looked_at_.emplace_back();
    piece.corners.reserve(polygon.outline.corner_count);
    for (std::size_t i = 0; i < polygon.outline.corner_count; ++i) piece.corners.push_back(glm::dvec2(first[i].at));
    piece.polygon = number;
    piece.slot = polygon.first_slot;
  }

  /// Takes pieces until their samples fill several batches. The pieces that were cut last are taken first.
  void take_pieces(const VisibleParts& parts) {
    looked_at_.clear();
    std::size_t samples = 0;
    while (samples < kSamplesAtOnce && (started_ < polygons_.size() || !waiting_.empty())) {
      if (waiting_.empty()) {
        start(parts, std::uint32_t(started_++));
      } else {
        looked_at_.push_back(std::move(waiting_.back()));
        waiting_.pop_back();
      }
      Piece& piece = looked_at_.back();
      place_samples(piece);
      samples += piece.samples.size() - piece.known_samples;
    }
  }

  /// Whole polygons are also sampled at their corners; corners of other pieces are known or lie beside a cut. Known
  /// samples count, so a piece often gets no new ones.
  void place_samples(Piece& piece) {
    const PieceSize size(piece.corners);
    const auto add = [&](const glm::dvec2& at) {
      if (!is_beside_a_cut(piece, at)) piece.samples.push_back({at, {}});
    };
    if (options_.tolerance < 255 && !size.is_small()) {
      const auto known = double(piece.samples.size());
      piece.samples.reserve(piece.corners.size() + std::size_t(std::max(size.sample_count(), known)) + 1);
      if (piece.cut == no_index) for_each_corner_place(piece.corners, size.middle, add);
      for_each_place(piece.corners, size.area, std::max(size.sample_count() - known, 0.0), add);
      piece.is_sliver = piece.samples.empty();
      if (piece.is_sliver)
        for_each_place_along(piece.corners, size, [&](const glm::dvec2& at) { piece.samples.push_back({at, {}}); });
    }
    if (piece.samples.empty()) piece.samples.push_back({size.middle, {}});
  }

  void shade_samples() {
    asked_.clear();
    const auto hand_out = [&] {
      shader_.hand_out([&](const FragmentShader::Shaded& shaded) {
        const glm::vec3& light = shaded.light;
        // Paper shows nothing brighter than white, so brighter reflections become white and more opaque.
        const float brightest = std::max(1.0f, std::max(light.x, std::max(light.y, light.z)));
        const glm::vec3 shown = light / brightest;
        const float opacity = std::clamp(shaded.alpha * brightest * shading_.opacity, 0.0f, 1.0f);
        asked_[shaded.number]->color = {float(srgb8_of_linear(shown.x)), float(srgb8_of_linear(shown.y)),
                                        float(srgb8_of_linear(shown.z)), opacity * 255.0f};
      });
    };
    for (Piece& piece : looked_at_) {
      const Polygon& polygon = polygons_[piece.polygon];
      for (; piece.known_samples < piece.samples.size(); ++piece.known_samples) {
        ColorSample& sample = piece.samples[piece.known_samples];
        const glm::dvec2 unit = glm::floor(sample.at * 256.0);
        if (polygon.holes && polygon.holes->is_hole(std::int32_t(unit.x), std::int32_t(unit.y))) {
          sample.color = hole_color;
          continue;
        }
        if (shader_.is_full()) hand_out();
        shader_.add(polygon.outline.id, std::uint32_t(asked_.size()), glm::vec2(sample.at), 1, 1.0f);
        asked_.push_back(&sample);
      }
    }
    hand_out();
  }

  void divide(Piece& piece) {
    const auto [is_one_color, color] = judge(piece);
    if (!is_one_color) {
      if (const std::optional<ScreenLine> line =
              best_cut({piece.corners, piece.samples, kLeastWidth, 2 * double(within(piece))}, texture_lines(piece)))
        return cut(piece, *line);
    }
    if (is_hole(color) || color.w < 0.5f) return;
    slots_[piece.slot].kept = std::uint32_t(kept_.size());
    kept_.push_back({color, std::move(piece.corners)});
  }

  /// The greatest allowed difference, in steps, between a sample and the colour of its piece.
  [[nodiscard]] float within(const Piece& piece) const {
    return float(options_.tolerance * (polygons_[piece.polygon].is_grouped ? kWithin : 1) *
                 (piece.is_sliver ? kOfSlivers : 1));
  }

  [[nodiscard]] bool is_beside_a_cut(const Piece& piece, const glm::dvec2& at) const {
    for (std::uint32_t i = piece.cut; i != no_index; i = cuts_[i].before)
      if (std::abs(cuts_[i].line.distance(at)) < kBesideCut) return true;
    return false;
  }

  /// Whether a piece has one colour, and the colour: that of holes by majority, or else the mean of the surface
  /// samples, if all are near it. The middle between extremes would tint a wide field for the sake of its edge.
  [[nodiscard]] std::pair<bool, glm::vec4> judge(const Piece& piece) const {
    std::size_t holes = 0;
    for (const ColorSample& sample : piece.samples) holes += is_hole(sample.color);
    const bool is_open = 2 * holes > piece.samples.size();
    if (is_open) return {holes == piece.samples.size(), hole_color};
    glm::vec4 sum(0), least(255), greatest(0);
    for (const ColorSample& sample : piece.samples) {
      if (is_hole(sample.color)) continue;
      sum += sample.color;
      least = glm::min(least, sample.color);
      greatest = glm::max(greatest, sample.color);
    }
    const float within = this->within(piece);
    const glm::vec4 mean = sum / float(piece.samples.size() - holes);
    const bool is_near = std::max(difference(greatest, mean), difference(mean, least)) <= within;
    return {holes == 0 && is_near, mean};
  }

  /// Cuts a piece along a line and puts both halves into the waiting list, the one below in painting order first.
  void cut(Piece& piece, const ScreenLine& line) {
    const auto number = std::uint32_t(cuts_.size()), slot = std::uint32_t(slots_.size());
    cuts_.push_back({line, piece.cut});
    slots_.push_back({std::exchange(slots_[piece.slot].next, slot), no_index});
    Piece below, above;
    for (Piece* const side : {&below, &above}) {
      side->polygon = piece.polygon;
      side->slot = side == &above ? slot : piece.slot;
      side->cut = number;
    }
    cut_outline(piece.corners, line, below.corners, above.corners);
    for (const ColorSample& sample : piece.samples) {
      const double distance = line.distance(sample.at);
      if (std::abs(distance) >= kBesideCut) (distance > 0 ? above : below).samples.push_back(sample);
    }
    for (Piece* const side : {&above, &below}) {
      side->known_samples = side->samples.size();
      waiting_.push_back(std::move(*side));
    }
  }

  /// The lines of equal coordinates in the texture of the base colour, which the picture mostly shows.
  [[nodiscard]] std::span<const TexcoordLines> texture_lines(const Piece& piece) {
    Polygon& polygon = polygons_[piece.polygon];
    if (polygon.texture_lines) return *polygon.texture_lines;
    std::vector<TexcoordLines>& lines = polygon.texture_lines.emplace();
    std::vector<TriangleSetup> setups(1);
    const NewTriangle triangle{polygon.outline.id, 0, glm::vec2(piece.samples.front().at)};
    shading_.source.set_up({&triangle, 1}, setups);
    const TriangleSetup& setup = setups[0];
    const Scene& scene = surfaces_.scene();
    if (setup.material >= scene.materials.size()) return lines;
    const TextureUse& use = scene.materials[setup.material].base_color_texture;
    if (!use.is_set() || !setup.has_texcoord[use.set]) return lines;
    const Texture& texture = scene.textures[use.texture];
    const TexcoordTransform transform(use);
    std::array<double, 3> u, v;
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::vec2 place = transform.place(setup.texcoord[use.set][k]);
      u[k] = double(place.x) * texture.width;
      v[k] = double(place.y) * texture.height;
    }
    lines.emplace_back(setup, u);
    lines.emplace_back(setup, v);
    return lines;
  }

  /// Replaces nearly equal colours by the first of them, so that pieces can be merged.
  void group_listed() {
    ColorGroups groups(options_.tolerance * (1 - kWithin));
    for (Kept* const piece : listed_) piece->group = groups.find_or_add(piece->color);
    for (Kept* const piece : listed_) piece->color = groups.colors()[piece->group];
    std::stable_sort(listed_.begin(), listed_.end(), [](const Kept* a, const Kept* b) { return a->group < b->group; });
  }

  const Surfaces& surfaces_;
  const PointShader& shading_;
  const FigureOptions& options_;
  const Execution& execution_;
  const ScreenRays rays_;
  FragmentShader shader_;

  std::vector<Polygon> polygons_;
  std::size_t started_ = 0;       ///< number of polygons that were started
  std::vector<Piece> waiting_;    ///< a stack: the next piece is last
  std::vector<Piece> looked_at_;  ///< the pieces of the current round
  std::vector<ColorSample*> asked_;
  std::vector<Slot> slots_;
  std::vector<Cut> cuts_;
  std::vector<Kept> kept_;
  std::vector<Kept*> listed_;
};

constexpr std::size_t kPolygonsPerPart = 256;
/// Visible area in square pixels; on smaller triangles a smooth normal hardly differs from a flat one.
constexpr float kLarge = 3;

float area_of(const VisibleParts& parts, const PaintPolygon& polygon) {
  const PaintCorner* const corners = parts.corners.data() + polygon.first_corner;
  double twice = 0;
  for (std::size_t i = 2; i < polygon.corner_count; ++i) {
    const glm::dvec3 a = corners[i - 1].at - corners[0].at, b = corners[i].at - corners[0].at;
    twice += a.x * b.y - a.y * b.x;
  }
  return float(std::abs(twice) * 0.5);
}

FigureTriangles triangles_of(const Surfaces& surfaces, const VisibleParts& parts) {
  FigureTriangles triangles{BitSet(surfaces.primitive_count()), BitSet(surfaces.primitive_count())};
  for (const PaintPolygon& polygon : parts.polygons) triangles.seen.add(polygon.id);
  if (!lacks_normals(surfaces.scene())) return triangles;
  std::vector<float> areas(surfaces.primitive_count());
  for (const PaintPolygon& polygon : parts.polygons) areas[polygon.id] += area_of(parts, polygon);
  for (std::size_t id = 0; id < areas.size(); ++id)
    if (areas[id] >= kLarge) triangles.large.add(id);
  return triangles;
}

/// Appends the coloured shapes of consecutive polygons.
void append(const ColoredOrder& part, ColoredOrder& into) {
  const std::size_t polygons = into.polygons.size(), corners = into.corners.size();
  for (const ColoredShape& shape : part.shapes) {
    into.begin_shape(shape.color);
    into.shapes.back().polygon_count = shape.polygon_count;
    into.shapes.back().first_polygon = polygons + shape.first_polygon;
  }
  for (PaintPolygon polygon : part.polygons) {
    polygon.first_corner += corners;
    into.polygons.push_back(polygon);
  }
  into.corners.insert(into.corners.end(), part.corners.begin(), part.corners.end());
}

}  // namespace

ColoredOrder color_order(PreparedScene& scene, const ShadeInput& input, const VisibleParts& parts,
                         const FigureOptions& options, const Execution& execution) {
  const IeeeScope ieee;
  const Surfaces& surfaces = scene.surfaces;
  const FigureTriangles triangles = triangles_of(surfaces, parts);
  const PointShader shader(scene, input, triangles, options.shade, execution);
  const std::size_t count = parts.polygons.size();
  std::vector<ColoredOrder> lists((count + kPolygonsPerPart - 1) / kPolygonsPerPart);
  Pool<PolygonColors> colorers;
  std::atomic<std::size_t> done{0}, made{0};
  parallel_for(execution, count, kPolygonsPerPart, [&](std::size_t begin, std::size_t end) {
    const auto colorer = colorers.borrow(
        [&] { return std::make_unique<PolygonColors>(surfaces, parts.view, shader, options, execution); });
    ColoredOrder& list = lists[begin / kPolygonsPerPart];
    colorer->color(parts, {parts.polygons.data() + begin, end - begin}, list);
    if ((made += list.polygons.size()) > options.most_polygons) refuse_more_than(options.most_polygons);
    report_progress(execution, "colours", double(done += end - begin) / double(count));
  });
  ColoredOrder colored;
  colored.view = parts.view;
  painter_detail::reserve_sum(colored.shapes, lists, &ColoredOrder::shapes);
  painter_detail::reserve_sum(colored.polygons, lists, &ColoredOrder::polygons);
  painter_detail::reserve_sum(colored.corners, lists, &ColoredOrder::corners);
  for (ColoredOrder& list : lists) {
    append(list, colored);
    list = {};
  }
  return colored;
}

}  // namespace frontmost
