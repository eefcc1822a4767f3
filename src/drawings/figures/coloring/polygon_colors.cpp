// SPDX-License-Identifier: Apache-2.0
// The life of a piece:
//
//    polygon --start--> sampled --judge--> of one colour --------------------> kept
//                          ^                    | not
//                          |                 best_cut --> two halves ---> waiting
//                          +------------------------------------------------+
//
// Waiting pieces are taken first, the last one first, so that few wait at a time. Samples of many pieces are shaded
// together, about 2,048 at a time, which gives whole batches that stay in the cache. A tree of cuts keeps the order of
// the halves, so the order of writing does not depend on the order of shading.
//
// A hole has a colour far from all others, so the same cuts separate it from the surface.
#include "figures/coloring/polygon_colors.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/srgb.h"
#include "figures/coloring/color_groups.h"
#include "surfaces/cluster_set.h"

namespace frontmost::shading {
namespace {

/// In pixels: the least width of a cut piece, and the distance from a cut below which no samples are taken. Textures
/// and shadows are filtered over about this distance, so colours this close to a cut belong to neither side.
constexpr double kLeastWidth = 0.25, kBesideCut = 0.35;
/// The share of the tolerance for differences within a piece, where pieces are grouped; the rest is for differences
/// between pieces of a group.
constexpr double kWithin = 2.0 / 3;
/// The factor of the tolerance for pieces narrower than a pixel: they are hardly visible, and there are many beside
/// textures.
constexpr double kOfSlivers = 8;
/// Samples that are shaded together: some batches of the shader, and few enough to stay in the cache.
constexpr std::size_t kSamplesAtOnce = 2048;

bool is_hole(const glm::vec4& color) { return color.w < 0; }

glm::u8vec4 rounded(const glm::vec4& color) {
  const auto part = [](float value) { return std::uint8_t(std::clamp(value + 0.5f, 0.0f, 255.0f)); };
  return {part(color.x), part(color.y), part(color.z), part(color.w)};
}

bool is_opaque(const Surfaces& surfaces, PrimitiveId id) {
  const PrimitiveSource source = surfaces.source(id);
  const Scene& scene = surfaces.scene();
  const std::uint32_t material = scene.meshes[source.mesh].material_of(source.triangle);
  return material >= scene.materials.size() ||
         (scene.materials[material].alpha == Material::Alpha::opaque && !scene.materials[material].is_see_through());
}

}  // namespace

void refuse_more_than(std::size_t most) {
  throw Error(ErrorCode::limit_exceeded, "figure", "more than " + std::to_string(most) + " polygons and pieces");
}

PolygonColors::PolygonColors(const Surfaces& surfaces, const View& view, const PointShader& shader,
                             const FigureOptions& options, const Execution& execution)
    : surfaces_(surfaces), shading_(shader), options_(options), execution_(execution), rays_(view) {
  shader_.begin(shader.source(), shader.colorist(), execution.isa);
}

void PolygonColors::color(const VisibleParts& parts, std::span<const PaintPolygon> polygons, ColoredOrder& into) {
  begin(polygons);
  while (started_ < polygons_.size() || !waiting_.empty()) {
    check_cancelled(execution_);
    if (kept_.size() + waiting_.size() > options_.most_polygons) refuse_more_than(options_.most_polygons);
    take_pieces(parts);
    shade_samples();
    for (Piece& piece : looked_at_) divide(piece);
  }
  for (const Polygon& polygon : polygons_) emit(polygon, into);
}

void PolygonColors::begin(std::span<const PaintPolygon> polygons) {
  // A triangle is set up about its first sample, which must be on one of these polygons.
  shader_.clear();
  polygons_.clear();
  nodes_.clear();
  cuts_.clear();
  kept_.clear();
  started_ = 0;
  const Cutouts* const cutouts = placed_scene(surfaces_).cutouts.get();
  for (const PaintPolygon& outline : polygons) {
    Polygon& polygon = polygons_.emplace_back(Polygon{outline});
    if (cutouts && cutouts->has(outline.id)) polygon.holes.emplace((*cutouts)[outline.id], rays_);
    polygon.is_grouped = options_.merges_neighbours || shading_.opacity() < 1 || !is_opaque(surfaces_, outline.id);
  }
}

void PolygonColors::start(const VisibleParts& parts, std::uint32_t number) {
  Polygon& polygon = polygons_[number];
  polygon.node = std::uint32_t(nodes_.size());
  nodes_.emplace_back();
  const PaintCorner* const first = parts.corners.data() + polygon.outline.first_corner;
  Piece& piece = looked_at_.emplace_back();
  piece.corners.reserve(polygon.outline.corner_count);
  for (std::size_t i = 0; i < polygon.outline.corner_count; ++i) piece.corners.push_back(glm::dvec2(first[i].at));
  piece.polygon = number;
  piece.node = polygon.node;
}

/// Takes pieces with samples for some batches; first the ones that were cut last.
void PolygonColors::take_pieces(const VisibleParts& parts) {
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
/// samples count, so a piece gets fewer new ones than its size suggests, often none.
void PolygonColors::place_samples(Piece& piece) {
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

void PolygonColors::shade_samples() {
  asked_.clear();
  const auto hand_out = [&] {
    shader_.hand_out([&](const FragmentShader::Shaded& shaded) {
      const glm::vec3& light = shaded.light;
      // Paper shows nothing brighter than white: brighter reflections hide what is behind instead.
      const float brightest = std::max(1.0f, std::max(light.x, std::max(light.y, light.z)));
      const glm::vec3 shown = light / brightest;
      const float opacity = std::clamp(shaded.alpha * brightest * shading_.opacity(), 0.0f, 1.0f);
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

void PolygonColors::divide(Piece& piece) {
  const Judgement found = judge(piece);
  if (!found.is_one_color) {
    if (const std::optional<ScreenLine> line =
            best_cut({piece.corners, piece.samples, kLeastWidth, 2 * double(within(piece))}, texture_lines(piece)))
      return cut(piece, *line);
  }
  keep(piece, found.color);
}

/// The greatest difference, in steps, between a sample and the colour of its piece.
float PolygonColors::within(const Piece& piece) const {
  return float(options_.tolerance * (polygons_[piece.polygon].is_grouped ? kWithin : 1) *
               (piece.is_sliver ? kOfSlivers : 1));
}

bool PolygonColors::is_beside_a_cut(const Piece& piece, const glm::dvec2& at) const {
  for (std::uint32_t i = piece.cut; i != no_index; i = cuts_[i].before)
    if (std::abs(cuts_[i].line.distance(at)) < kBesideCut) return true;
  return false;
}

/// Decides by the majority of the samples between surface and hole. The colour is the mean of the surface samples, if
/// all are near enough to it: the middle between extremes would tint a wide field for the sake of its edge.
PolygonColors::Judgement PolygonColors::judge(const Piece& piece) const {
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

/// Cuts a piece along a line and puts both halves into the waiting list.
void PolygonColors::cut(Piece& piece, const ScreenLine& line) {
  const auto number = std::uint32_t(cuts_.size()), node = std::uint32_t(nodes_.size());
  cuts_.push_back({line, piece.cut});
  nodes_[piece.node] = {node, node + 1, no_index};
  nodes_.resize(nodes_.size() + 2);
  Piece below, above;
  for (Piece* const side : {&below, &above}) {
    side->polygon = piece.polygon;
    side->node = node + (side == &above);
    side->cut = number;
  }
  CutOutline corners = cut_outline(piece.corners, line);
  below.corners = std::move(corners.below);
  above.corners = std::move(corners.above);
  for (const ColorSample& sample : piece.samples) {
    const double distance = line.distance(sample.at);
    if (std::abs(distance) >= kBesideCut) (distance > 0 ? above : below).samples.push_back(sample);
  }
  for (Piece* const side : {&above, &below}) {
    side->known_samples = side->samples.size();
    waiting_.push_back(std::move(*side));
  }
}

void PolygonColors::keep(Piece& piece, const glm::vec4& color) {
  if (is_hole(color) || color.w < 0.5f) return;
  nodes_[piece.node].kept = std::uint32_t(kept_.size());
  kept_.push_back({color, std::move(piece.corners)});
}

/// Lists the kept pieces in painting order: below a cut before above it.
void PolygonColors::list_kept(const Polygon& polygon) {
  listed_.clear();
  path_.assign(1, polygon.node);
  while (!path_.empty()) {
    const Node node = nodes_[path_.back()];
    path_.pop_back();
    if (node.kept != no_index) listed_.push_back(&kept_[node.kept]);
    if (node.below != no_index) path_.insert(path_.end(), {node.above, node.below});
  }
}

/// Replaces nearly equal colours by the first of them, so that pieces can be merged.
void PolygonColors::group_kept() {
  ColorGroups groups(options_.tolerance * (1 - kWithin));
  for (Kept* const piece : listed_) piece->group = groups.find_or_add(piece->color);
  for (Kept* const piece : listed_) piece->color = groups.colors()[piece->group];
  std::stable_sort(listed_.begin(), listed_.end(), [](const Kept* a, const Kept* b) { return a->group < b->group; });
}

void PolygonColors::emit(const Polygon& polygon, ColoredOrder& into) {
  list_kept(polygon);
  for (std::uint32_t i = 0; i < listed_.size(); ++i) listed_[i]->group = i;
  if (polygon.is_grouped) group_kept();
  for (std::size_t i = 0; i < listed_.size(); ++i) {
    const Kept& piece = *listed_[i];
    if (i == 0 || listed_[i - 1]->group != piece.group) into.begin_shape(rounded(piece.color));
    into.add_polygon(polygon.outline.id, piece.corners);
  }
}

/// Lines along the coordinates of the base colour's texture, which the picture mostly shows.
std::span<const TexcoordLines> PolygonColors::texture_lines(const Piece& piece) {
  Polygon& polygon = polygons_[piece.polygon];
  if (polygon.texture_lines) return *polygon.texture_lines;
  std::vector<TexcoordLines>& lines = polygon.texture_lines.emplace();
  std::vector<TriangleSetup> setups(1);
  const NewTriangle triangle{polygon.outline.id, 0, glm::vec2(piece.samples.front().at)};
  shading_.source().set_up({&triangle, 1}, setups);
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

}  // namespace frontmost::shading
