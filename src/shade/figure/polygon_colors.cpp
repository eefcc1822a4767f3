// SPDX-License-Identifier: Apache-2.0
#include "shade/figure/polygon_colors.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/srgb.h"
#include "shade/figure/color_groups.h"
#include "surfaces/cluster_set.h"

namespace frontmost::shading {
namespace {

/// Square pixels, and pixels from end to end: smaller pieces have the colour of their middle.
constexpr double kLeastArea = 1.5, kLeastLength = 2;
/// Pixels: narrower ones are not cut along, and what lies nearer to a cut is not asked for its colour again. Textures
/// and shadows are smoothed over about as much, so there a colour is neither that of one side nor that of the other.
constexpr double kLeastWidth = 0.25, kBesideCut = 0.35;
/// Square pixels a sample, of pieces of some size and of large ones; pixels, of slivers; and the fewest.
constexpr double kAreaPerSample = 2, kMostAreaPerSample = 9, kLengthPerSample = 1;
constexpr double kFewSamples = 4, kManySamples = 64;
/// Of the tolerance: by how much pieces may differ within; colours that differ by no more than the rest become one.
constexpr double kWithin = 2.0 / 3;
/// Pixels: by how much samples of corners lie within.
constexpr double kInset = 0.25;

double area_of(std::span<const PaintCorner> corners) {
  double twice = 0;
  const glm::dvec2 from(corners[0].at);
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const glm::dvec2 a = glm::dvec2(corners[i - 1].at) - from, b = glm::dvec2(corners[i].at) - from;
    twice += a.x * b.y - a.y * b.x;
  }
  return std::abs(twice) * 0.5;
}

glm::dvec2 middle_of(std::span<const PaintCorner> corners) {
  glm::dvec2 sum(0);
  for (const PaintCorner& corner : corners) sum += glm::dvec2(corner.at);
  return sum / double(corners.size());
}

/// At least half of the distance between the two corners that are farthest from each other.
double length_of(std::span<const PaintCorner> corners) {
  double most = 0;
  for (const PaintCorner& corner : corners)
    most = std::max(most, glm::length(glm::dvec2(corner.at) - glm::dvec2(corners[0].at)));
  return most;
}

/// How many samples a piece is worth.
double sample_count(double area, double length) {
  const double wanted = std::max(area / kAreaPerSample, length / kLengthPerSample);
  return std::max(std::clamp(wanted, kFewSamples, kManySamples), area / kMostAreaPerSample);
}

double affine_of(const View& view, double depth) { return view.projection.orthographic ? depth : 1 / depth; }

bool is_hole(const glm::vec4& color) { return color.w < 0; }

glm::u8vec4 rounded(const glm::vec4& color) {
  const auto part = [](float value) { return std::uint8_t(std::clamp(value + 0.5f, 0.0f, 255.0f)); };
  return {part(color.x), part(color.y), part(color.z), part(color.w)};
}

}  // namespace

void refuse_more_than(std::size_t most) {
  throw Error(ErrorCode::limit_exceeded, "figure: more than " + std::to_string(most) + " polygons and pieces");
}

PolygonColors::PolygonColors(const Surfaces& surfaces, const View& view, const PointShader& shader,
                             const ColorOptions& options, const Execution& execution)
    : surfaces_(surfaces),
      view_(view),
      shading_(shader),
      options_(options),
      execution_(execution),
      rays_(view),
      shader_(shader.source(), shader.colorist()) {}

const ColoredPieces& PolygonColors::pieces_of(PrimitiveId id, std::span<const PaintCorner> outline) {
  begin(id, outline);
  while (!parts_.empty()) {
    check_cancelled(execution_);
    if (kept_.size() + parts_.size() > options_.most_polygons) refuse_more_than(options_.most_polygons);
    Part part = std::move(parts_.back());
    parts_.pop_back();
    divide(std::move(part));
  }
  group_by_color();
  return pieces_;
}

void PolygonColors::begin(PrimitiveId id, std::span<const PaintCorner> outline) {
  id_ = id;
  texture_lines_.reset();
  cuts_.clear();
  kept_.clear();
  holes_.reset();
  const Cutouts* const cutouts = surfaces_.clusters().cutouts.get();
  if (cutouts && cutouts->has(id)) holes_.emplace((*cutouts)[id], rays_);
  Part& whole = parts_.emplace_back(Part{{outline.begin(), outline.end()}, no_index});
  for (PaintCorner& corner : whole.corners) corner.at.z = affine_of(view_, corner.at.z);
}

void PolygonColors::divide(Part part) {
  look(part);
  const Judgement found = judge(part);
  if (!found.is_one_color) {
    outline_.clear();
    for (const PaintCorner& corner : part.corners) outline_.push_back(glm::dvec2(corner.at));
    if (const std::optional<ScreenLine> line = best_cut({outline_, samples_, kLeastWidth}, texture_lines()))
      return cut(part, *line);
  }
  keep(part, found.color);
}

/// Samples of the corners first, where colours go furthest; then some that lie evenly.
void PolygonColors::look(const Part& part) {
  samples_.clear();
  const glm::dvec2 middle = middle_of(part.corners);
  const double area = area_of(part.corners), length = length_of(part.corners);
  corner_samples_ = 0;
  if (options_.tolerance >= 255 || (area < kLeastArea && length < kLeastLength)) {
    samples_.push_back({middle, {}});
  } else {
    for (const PaintCorner& corner : part.corners) {
      const glm::dvec2 way = middle - glm::dvec2(corner.at);
      const double inset = std::min(0.25, kInset / std::max(glm::length(way), 1e-9));
      samples_.push_back({glm::dvec2(corner.at) + way * inset, {}});
    }
    corner_samples_ = samples_.size();
    add_places(part.corners, sample_count(area, length));
  }
  shade_places();
}

/// A rank-1 lattice over each triangle of the fan, as many places as its part of the area asks for.
/// (M. Roberts. The Unreasonable Effectiveness of Quasirandom Sequences. 2018.)
void PolygonColors::add_places(std::span<const PaintCorner> corners, double count) {
  const double area = area_of(corners);
  double before = 0;
  std::size_t number = 0;
  const glm::dvec2 from(corners[0].at);
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const glm::dvec2 a = glm::dvec2(corners[i - 1].at) - from, b = glm::dvec2(corners[i].at) - from;
    before += std::abs(a.x * b.y - a.y * b.x) * 0.5;
    const auto until = std::size_t(std::ceil(before / area * count));
    for (; number < until; ++number) {
      double u = 0.5 + 0.7548776662466927 * double(number), v = 0.5 + 0.5698402909980532 * double(number);
      u -= std::floor(u);
      v -= std::floor(v);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      samples_.push_back({from + a * u + b * v, {}});
    }
  }
}

void PolygonColors::shade_places() {
  const auto hand_out = [&] {
    shader_.hand_out([&](std::uint32_t i, float, const glm::vec3& light, float alpha) {
      const float opacity = std::clamp(alpha * shading_.opacity(), 0.0f, 1.0f);
      samples_[i].color = {float(srgb8_of_linear(light.x)), float(srgb8_of_linear(light.y)),
                           float(srgb8_of_linear(light.z)), opacity * 255.0f};
    });
  };
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const glm::dvec2& at = samples_[i].at;
    if (holes_ && holes_->is_hole(std::int32_t(std::floor(at.x * 256)), std::int32_t(std::floor(at.y * 256)))) {
      samples_[i].color = hole_color;
      continue;
    }
    if (shader_.is_full()) hand_out();
    shader_.add(id_, std::uint32_t(i), glm::vec2(at), 1, 1.0f);
  }
  hand_out();
}

bool PolygonColors::is_beside_a_cut(const Part& part, const glm::dvec2& at) const {
  for (std::uint32_t i = part.cut; i != no_index; i = cuts_[i].before)
    if (std::abs(cuts_[i].line.distance(at)) < kBesideCut) return true;
  return false;
}

PolygonColors::Judgement PolygonColors::judge(const Part& part) const {
  // What most of the samples are; of these the mean, without corners where there are others.
  std::size_t holes = 0, asked = 0;
  std::vector<std::uint8_t> counts(samples_.size());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    counts[i] = !is_beside_a_cut(part, samples_[i].at);
    asked += counts[i];
  }
  if (asked == 0) std::fill(counts.begin(), counts.end(), std::uint8_t(1));
  for (std::size_t i = corner_samples_; i < samples_.size(); ++i) holes += is_hole(samples_[i].color);
  const bool is_open = 2 * holes > samples_.size() - corner_samples_;
  glm::vec4 sum(0), mean = hole_color;
  float weight = 0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (!counts[i] || is_hole(samples_[i].color) != is_open) continue;
    const float share = i < corner_samples_ ? 1e-3f : 1.0f;
    sum += samples_[i].color * share;
    weight += share;
  }
  if (weight > 0) mean = sum / weight;
  Judgement found{true, mean};
  if (asked == 0) return found;
  for (std::size_t i = 0; i < samples_.size(); ++i)
    if (counts[i] && double(difference(samples_[i].color, mean)) > options_.tolerance * kWithin)
      found.is_one_color = false;
  return found;
}

/// Puts both sides of a line on the stack.
void PolygonColors::cut(const Part& part, const ScreenLine& line) {
  const std::size_t count = part.corners.size();
  Part sides[2];
  for (Part& side : sides) side.cut = std::uint32_t(cuts_.size());
  cuts_.push_back({line, part.cut});
  for (std::size_t i = 0; i < count; ++i) {
    const PaintCorner &from = part.corners[i], &to = part.corners[i + 1 == count ? 0 : i + 1];
    const double a = line.distance(glm::dvec2(from.at)), b = line.distance(glm::dvec2(to.at));
    const int side = a > 0;
    sides[side].corners.push_back(from);
    if (side == (b > 0)) continue;
    const glm::dvec3 at = from.at + (to.at - from.at) * (a / (a - b));
    sides[side].corners.push_back({at, true});             // from here along the cut
    sides[1 - side].corners.push_back({at, from.is_cut});  // from here along what was there
  }
  parts_.push_back(std::move(sides[1]));
  parts_.push_back(std::move(sides[0]));
}

void PolygonColors::keep(const Part& part, const glm::vec4& color) {
  if (is_hole(color) || color.w < 0.5f) return;
  kept_.push_back({color, 0, part.corners});
}

/// Colours that are nearly the same become the first of them, so that pieces can be joined to larger ones.
void PolygonColors::group_by_color() {
  ColorGroups groups(options_.tolerance * (1 - kWithin));
  for (Kept& piece : kept_) piece.shape = groups.find_or_add(piece.color);
  const std::vector<glm::vec4>& colors = groups.colors();
  std::stable_sort(kept_.begin(), kept_.end(), [](const Kept& a, const Kept& b) { return a.shape < b.shape; });
  pieces_.pieces.clear();
  pieces_.corners.clear();
  pieces_.shape_count = std::uint32_t(colors.size());
  for (const Kept& piece : kept_) {
    pieces_.pieces.push_back(
        {pieces_.corners.size(), std::uint32_t(piece.corners.size()), piece.shape, rounded(colors[piece.shape])});
    for (const PaintCorner& corner : piece.corners)
      pieces_.corners.push_back({{corner.at.x, corner.at.y, affine_of(view_, corner.at.z)}, corner.is_cut});
  }
}

/// Along the coordinates of what the picture mostly shows, the base colour's texture.
std::span<const TexcoordLines> PolygonColors::texture_lines() {
  if (texture_lines_) return *texture_lines_;
  texture_lines_.emplace();
  setup_.resize(1);
  const NewTriangle triangle{id_, 0, glm::vec2(samples_.front().at)};
  shading_.source().set_up({&triangle, 1}, setup_);
  const TriangleSetup& setup = setup_[0];
  const Scene& scene = surfaces_.scene();
  if (!setup.has_texcoord || setup.material >= scene.materials.size()) return *texture_lines_;
  const TextureUse& use = scene.materials[setup.material].base_color_texture;
  if (!use.is_set()) return *texture_lines_;
  const Texture& texture = scene.textures[use.texture];
  const TexcoordTransform transform(use);
  std::array<double, 3> u, v;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::vec2 place = transform.place(setup.texcoord[k]);
    u[k] = double(place.x) * texture.width;
    v[k] = double(place.y) * texture.height;
  }
  texture_lines_->emplace_back(setup, u);
  texture_lines_->emplace_back(setup, v);
  return *texture_lines_;
}

}  // namespace frontmost::shading
