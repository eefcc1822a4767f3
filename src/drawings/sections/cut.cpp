// SPDX-License-Identifier: Apache-2.0
// Each object is cut separately, and closed with a face where the plane passes through it:
//
//        before            behind the plane        A triangle with one vertex behind leaves a triangle, one with two
//      /\      .           /|                      leaves two. The side along the plane is kept as a segment, with the
//     /  \     .  plane   / |  cut face            removed part on its left. The segments of an object form outlines,
//    /____\    .         /__|                      and the outlines bound the regions of the cut face.
//
// The intersection of an edge with the plane is computed from the edge's lesser end, so outlines close to the bit.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/parallel.h"
#include "scene/edges.h"
#include "sections/regions.h"
#include "surfaces/cluster_set.h"

namespace frontmost {
namespace {

using namespace lines_detail;

constexpr std::size_t triangles_per_poll = 1 << 14;

glm::vec3 meeting(const PlaneAxes& plane, glm::vec3 p, glm::vec3 q) {
  if (std::tie(q.x, q.y, q.z) < std::tie(p.x, p.y, p.z)) std::swap(p, q);
  const int across = plane.across;
  const glm::dvec3 from(p), to(q);
  const double t = (plane.at - from[across]) / (to[across] - from[across]);
  glm::vec3 place(t <= 0.5 ? from + (to - from) * t : to + (from - to) * (1 - t));
  place[across] = plane.at;
  return place + 0.0f;  // -0 is 0
}

/// Cuts one object: `left` is the remaining part, `segments` are the segments of the cut.
struct ObjectCutter {
  void run(const ToWorld& to_world, const Execution& execution) {
    left.name = mesh.name;
    left.positions.reserve(mesh.positions.size());
    for (const glm::vec3& p : mesh.positions) left.positions.push_back(to_world(p) + 0.0f);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (t % triangles_per_poll == 0) check_cancelled(execution);
      add(t);
    }
    append_edges(
        mesh, instance.world_from_mesh, [&](const glm::uvec2& edge) { return left_of(edge); }, left);
    keep_covered(mesh, left);
  }

  /// The part of a stated edge behind the plane. Sides of triangles are cut at the same point.
  std::optional<glm::uvec2> left_of(const glm::uvec2& edge) {
    const glm::vec3 from = left.positions[edge.x], to = left.positions[edge.y];
    if (!is_finite(from) || !is_finite(to) || (!plane.is_behind(from) && !plane.is_behind(to))) return std::nullopt;
    if (plane.is_behind(from) && plane.is_behind(to)) return edge;
    left.positions.push_back(meeting(plane, from, to));
    return glm::uvec2(plane.is_behind(from) ? edge.x : edge.y, left.positions.size() - 1);
  }

  void add(std::uint32_t number) {
    glm::uvec3 corners = mesh.triangles[number];
    if (is_mirrored) std::swap(corners.y, corners.z);
    int behind = 0, odd = 0;  // odd: the corner that is alone on its side
    bool is_behind[3];
    for (int k = 0; k < 3; ++k) {
      if (!is_finite(left.positions[corners[k]])) return;
      is_behind[k] = plane.is_behind(left.positions[corners[k]]);
      behind += is_behind[k];
    }
    if (behind == 0) return;
    const std::uint32_t material = mesh.material_of(number);
    if (behind == 3) return add(corners, material);
    while (is_behind[odd] != (behind == 1)) ++odd;
    const std::uint32_t a = corners[odd], b = corners[odd == 2 ? 0 : odd + 1], c = corners[odd == 0 ? 2 : odd - 1];
    const glm::vec3 on_b = meeting(plane, left.positions[a], left.positions[b]);
    const glm::vec3 on_c = meeting(plane, left.positions[a], left.positions[c]);
    const auto first = std::uint32_t(left.positions.size());
    left.positions.push_back(on_b);
    left.positions.push_back(on_c);
    if (behind == 1) {
      add({a, first, first + 1}, material);
      add_segment(on_c, on_b);
    } else {
      add({first, b, c}, material);
      add({first, c, first + 1}, material);
      add_segment(on_b, on_c);
    }
  }

  void add(const glm::uvec3& corners, std::uint32_t material) {
    left.triangles.push_back(corners);
    left.material_ids.push_back(material);
  }

  void add_segment(const glm::vec3& from, const glm::vec3& to) {
    if (from != to) segments.push_back({plane.in_plane(from), plane.in_plane(to)});
  }

  const PlaneAxes& plane;
  const Mesh& mesh;
  const Instance& instance;
  const bool is_mirrored;
  Mesh left{};
  std::vector<CutSegment> segments{};
};

/// Fills the cut of an object with triangles of the face's material.
CutFace close(const std::vector<CutSegment>& segments, const PlaneAxes& plane, std::uint32_t material, Mesh& mesh,
              const Execution& execution) {
  CutFace face;
  face.material = material;
  Outlines outlines = find_outlines(segments, execution);
  face.open_count = outlines.open_count;
  std::vector<FlatTriangle> triangles;
  for (Region& region : regions_of(std::move(outlines), execution)) {
    fill(region, triangles, execution);
    face.area += region.area;
    region.holes.insert(region.holes.begin(), std::move(region.outer));
    for (const SectionOutline& outline : region.holes) {
      std::vector<glm::vec3>& points = face.outlines.emplace_back();
      for (const glm::vec2& p : outline) points.push_back(plane.in_space(p));
    }
  }
  for (const FlatTriangle& triangle : triangles) {
    const auto first = std::uint32_t(mesh.positions.size());
    for (const glm::vec2& p : triangle) mesh.positions.push_back(plane.in_space(p));
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.material_ids.push_back(material);
  }
  return face;
}

/// The whole mesh in world space, without attributes.
Mesh placed(const Mesh& mesh, const Instance& instance, bool is_mirrored) {
  const ToWorld to_world(instance.world_from_mesh);
  Mesh all;
  all.name = mesh.name;
  for (const glm::vec3& p : mesh.positions) all.positions.push_back(to_world(p));
  all.triangles = mesh.triangles;
  if (is_mirrored)
    for (glm::uvec3& t : all.triangles) std::swap(t.y, t.z);
  all.material_ids = mesh.material_ids;
  append_edges(
      mesh, instance.world_from_mesh, [](const glm::uvec2& edge) { return std::optional(edge); }, all);
  return all;
}

constexpr int style_count = 6;
constexpr std::size_t most_compared = 2048;
constexpr double spacings[] = {1, 0.7, 1.4};  // factors of the spacing, each used at two angles

bool may_touch(const Box& a, const Box& b) {
  return glm::all(glm::lessThanEqual(a.low, b.high)) && glm::all(glm::lessThanEqual(b.low, a.high));
}

/// Twice the area divided by the perimeter: about the width of a long strip.
double thickness_of(const CutFace& face) {
  double around = 0;
  for (const std::vector<glm::vec3>& outline : face.outlines)
    for (std::size_t i = 0; i < outline.size(); ++i)
      around += glm::distance(glm::dvec3(outline[i]), glm::dvec3(outline[i + 1 < outline.size() ? i + 1 : 0]));
  return around > 0 ? 2 * face.area / around : 0;
}

/// A cut face of one of several sections.
struct PlacedFace {
  std::uint32_t instance;
  std::size_t section;
  Box box;
};

}  // namespace

Section cut(const Surfaces& surfaces, const CuttingPlane& plane, const Execution& execution,
            std::span<const std::uint32_t> whole) {
  if (!std::isfinite(float(plane.at)))
    throw Error(ErrorCode::bad_argument, "cut", "the plane's place must be finite, as a float");
  const IeeeScope ieee;
  const Scene& model = surfaces.scene();
  const PlaneAxes axes(plane);
  Section section;
  Scene& scene = section.scene;
  scene.name = model.name;
  scene.up = model.up;
  scene.origin = model.origin;
  scene.cameras = model.cameras;
  scene.materials = model.materials;
  for (Material& material : scene.materials)  // the face has no coordinates of textures
    for (TextureUse* const use : texture_uses_of(material)) *use = {};
  for (std::uint32_t i = 0; i < model.instances.size(); ++i) {
    const Instance& instance = model.instances[i];
    const Mesh& mesh = model.meshes[instance.mesh];
    ObjectCutter cutter{axes, mesh, instance, surfaces.is_mirrored(i)};
    cutter.run(ToWorld(instance.world_from_mesh), execution);
    const bool is_whole = std::find(whole.begin(), whole.end(), i) != whole.end();
    if (is_whole && !cutter.segments.empty()) {
      cutter.left = placed(mesh, instance, surfaces.is_mirrored(i));
    } else if (!cutter.segments.empty()) {
      std::vector<Material>& materials = scene.materials;
      section.faces.push_back(close(cutter.segments, axes, std::uint32_t(materials.size()), cutter.left, execution));
      section.faces.back().instance = i;
      // The material of the object's first triangle, renamed to the object's name.
      const std::uint32_t own = mesh.material_of(0);
      materials.push_back(own != no_index ? Material(materials[own]) : Material());
      materials.back().name = instance.name;
    }
    scene.instances.push_back({instance.name, i, glm::dmat4(1)});
    scene.meshes.push_back(std::move(cutter.left));
    report_progress(execution, "cut", double(i + 1) / double(model.instances.size()));
  }
  return section;
}

std::vector<std::uint8_t> hatch_styles(std::span<const Section* const> sections) {
  std::vector<std::uint8_t> styles;
  for (const Section* const section : sections) styles.resize(std::max(styles.size(), section->scene.instances.size()));
  std::vector<PlacedFace> faces;
  for (std::size_t i = 0; i < sections.size(); ++i)
    for (const CutFace& face : sections[i]->faces) {
      faces.push_back({face.instance, i, {}});
      for (const std::vector<glm::vec3>& outline : face.outlines)
        for (const glm::vec3& p : outline) faces.back().box.include(p);
    }
  std::stable_sort(faces.begin(), faces.end(),
                   [](const PlacedFace& a, const PlacedFace& b) { return a.instance < b.instance; });
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
  const bool is_across_x = plane.towards == Axis::x || plane.towards == Axis::minus_x;
  return {is_across_x ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), false, 0};
}

}  // namespace frontmost
