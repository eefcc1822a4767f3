// SPDX-License-Identifier: Apache-2.0
// The classic teapot: its control points, and its triangles.
//
// M. Newell. The Utilization of Procedure Models in Digital Image Synthesis. University of Utah, 1975; the bottom was
// added by F. Crow, 1987. In the usual list of 306 points and 32 patches most numbers are reflections of a few others:
// parts with a profile are turned about the axis, and handle and spout consist of two halves each. This file lists only
// numbers that are not reflections.
//
// Every patch becomes a grid of triangles, and points that two patches share are stored once. Patches of one part (body
// with lid and bottom, handle, spout) are welded where their points agree to the bit, which evaluate() guarantees along
// shared edges.
#include <algorithm>
#include <map>
#include <tuple>

#include "scene/bezier_patch.h"
#include "scene/shapes.h"

namespace frontmost {
namespace {

// One ring of control points: its radius, the length of the handles that shape each quarter circle, and its height. A
// handle is 0.56 times the radius long, but 0.45 / 0.8 times for the knob.
struct ProfileRing {
  double radius, arm, height;
};

constexpr std::array<ProfileRing, 4> kRim{
    {{1.4, 0.784, 2.4}, {1.3375, 0.749, 2.53125}, {1.4375, 0.805, 2.53125}, {1.5, 0.84, 2.4}}};
constexpr std::array<ProfileRing, 4> kUpperBody{
    {{1.5, 0.84, 2.4}, {1.75, 0.98, 1.875}, {2, 1.12, 1.35}, {2, 1.12, 0.9}}};
constexpr std::array<ProfileRing, 4> kLowerBody{
    {{2, 1.12, 0.9}, {2, 1.12, 0.45}, {1.5, 0.84, 0.225}, {1.5, 0.84, 0.15}}};
constexpr std::array<ProfileRing, 4> kKnob{{{0, 0, 3.15}, {0.8, 0.45, 3.15}, {0, 0, 2.85}, {0.2, 0.112, 2.7}}};
constexpr std::array<ProfileRing, 4> kLid{
    {{0.2, 0.112, 2.7}, {0.4, 0.224, 2.55}, {1.3, 0.728, 2.55}, {1.3, 0.728, 2.4}}};
constexpr std::array<ProfileRing, 4> kBottom{{{1.5, 0.84, 0.15}, {1.5, 0.84, 0.075}, {1.425, 0.798, 0}, {0, 0, 0}}};

// One half ring of a bent tube: a loop of four points that starts and ends in the mirror plane. The two middle points
// lie `width` off the plane, one beside the first point and one beside the last.
struct Loop {
  double first_x, first_height, last_x, last_height, width;
};
using LoopTube = std::array<Loop, 7>;

constexpr LoopTube kHandle{{{-1.6, 2.025, -1.5, 2.25, 0.3},
                            {-2.3, 2.025, -2.5, 2.25, 0.3},
                            {-2.7, 2.025, -3, 2.25, 0.3},
                            {-2.7, 1.8, -3, 1.8, 0.3},
                            {-2.7, 1.575, -3, 1.35, 0.3},
                            {-2.5, 1.125, -2.65, 0.9375, 0.3},
                            {-2, 0.9, -1.9, 0.6, 0.3}}};
constexpr LoopTube kSpout{{{1.7, 1.425, 1.7, 0.6, 0.66},
                           {2.6, 1.425, 3.1, 0.825, 0.66},
                           {2.3, 2.1, 2.4, 2.025, 0.25},
                           {2.7, 2.4, 3.3, 2.4, 0.25},
                           {2.8, 2.475, 3.525, 2.49375, 0.25},
                           {2.9, 2.475, 3.45, 2.5125, 0.15},
                           {2.8, 2.4, 3.2, 2.4, 0.15}}};

// Converts Newell's axes (z up) to ours (y up); + 0.0 makes a negative zero positive.
glm::dvec3 upright(double x, double y, double height) { return {x + 0.0, height, 0.0 - y}; }

void add_turned(std::vector<BezierPatch>& patches, const std::array<ProfileRing, 4>& profile) {
  // A quarter starts towards `from` and ends towards `to`, clockwise seen from above.
  constexpr std::array<glm::dvec2, 5> kAxes{{{1, 0}, {0, -1}, {-1, 0}, {0, 1}, {1, 0}}};
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    const glm::dvec2 from = kAxes[quarter], to = kAxes[quarter + 1];
    BezierPatch patch;
    for (std::size_t i = 0; i < 4; ++i) {
      const ProfileRing& ring = profile[i];
      const std::array<glm::dvec2, 4> arc{from * ring.radius, from * ring.radius + to * ring.arm,
                                          to * ring.radius + from * ring.arm, to * ring.radius};
      for (std::size_t j = 0; j < 4; ++j) patch.points[4 * i + j] = upright(arc[j].x, arc[j].y, ring.height);
    }
    patches.push_back(patch);
  }
}

void add_tube(std::vector<BezierPatch>& patches, const LoopTube& tube) {
  for (const std::size_t start : {0u, 3u})
    for (const bool mirrored : {false, true}) {
      BezierPatch patch;
      for (std::size_t i = 0; i < 4; ++i) {
        const Loop& loop = tube[start + i];
        const double y = mirrored ? loop.width : -loop.width;
        const std::array<glm::dvec3, 4> half{
            upright(loop.first_x, 0, loop.first_height), upright(loop.first_x, y, loop.first_height),
            upright(loop.last_x, y, loop.last_height), upright(loop.last_x, 0, loop.last_height)};
        // The mirrored half runs backwards, so that both halves have the same outer side.
        for (std::size_t j = 0; j < 4; ++j) patch.points[4 * i + j] = half[mirrored ? 3 - j : j];
      }
      patches.push_back(patch);
    }
}

constexpr std::size_t kTubes = 24;  // the first patch of the handle; turned patches come before

void place_on_texture(BezierPatch& patch, std::size_t number) {
  const bool is_turned = number < kTubes;
  const std::size_t part = is_turned ? number : (number - kTubes) % 4;
  const std::size_t columns = is_turned ? 4 : 2, rows = is_turned ? 6 : 2;
  patch.texture_low = {double(part % columns) / double(columns), double(part / columns) / double(rows)};
  patch.texture_size = {1.0 / double(columns), 1.0 / double(rows)};
}

}  // namespace

std::vector<BezierPatch> teapot_patches() {
  std::vector<BezierPatch> patches;
  for (const auto* profile : {&kRim, &kUpperBody, &kLowerBody, &kKnob, &kLid, &kBottom}) add_turned(patches, *profile);
  add_tube(patches, kHandle);
  add_tube(patches, kSpout);
  for (std::size_t i = 0; i < patches.size(); ++i) place_on_texture(patches[i], i);
  return patches;
}

namespace {

constexpr std::size_t kFirstHandlePatch = 24, kFirstSpoutPatch = 28;  // first patches; turned patches come before

struct ByCoordinates {
  bool operator()(const glm::vec3& a, const glm::vec3& b) const {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  }
};

// Stores each position of a part once, with the normal of the first patch that reaches it. Patches of one part are
// tangent to each other where they meet, so their normals agree but for rounding. Parts are not tangent: the handle
// touches the body in one point, (-2, 0.9, 0), at an angle.
class Welder {
 public:
  explicit Welder(Mesh& mesh) : mesh_(mesh) {}
  void start_part() { numbers_.clear(); }
  std::uint32_t add(const PatchPoint& point) {
    // + 0.0f: reflected coordinates may be -0, which is the same place.
    const glm::vec3 position = glm::vec3(point.position) + 0.0f;
    const auto [place, is_new] = numbers_.try_emplace(position, std::uint32_t(mesh_.positions.size()));
    if (is_new) {
      mesh_.positions.push_back(position);
      mesh_.normals.values.emplace_back(point.normal);
    }
    return place->second;
  }

 private:
  Mesh& mesh_;
  std::map<glm::vec3, std::uint32_t, ByCoordinates> numbers_;
};

void add_triangle(const glm::uvec3& corners, const glm::uvec3& texcoords, std::uint32_t patch, Mesh& mesh) {
  // At a pole one side of the quad is a point.
  if (corners.x == corners.y || corners.y == corners.z || corners.z == corners.x) return;
  mesh.triangles.push_back(corners);
  mesh.texcoords.triangles.push_back(texcoords);
  mesh.face_ids.push_back(patch);
}

}  // namespace

Mesh teapot(int steps) {
  Mesh mesh;
  Welder welder(mesh);
  const std::vector<BezierPatch> patches = teapot_patches();
  const int side = steps + 1;
  std::vector<std::uint32_t> corners(std::size_t(side) * std::size_t(side));
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    if (p == kFirstHandlePatch || p == kFirstSpoutPatch) welder.start_part();
    const auto first_texcoord = std::uint32_t(mesh.texcoords.values.size());
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; j <= steps; ++j) {
        const PatchParameter u = fraction(i, steps), v = fraction(j, steps);
        corners[std::size_t(i * side + j)] = welder.add(evaluate(patches[p], u, v));
        mesh.texcoords.values.emplace_back(patches[p].texture_low +
                                           patches[p].texture_size * glm::dvec2(v.value, u.value));
      }
    for (int i = 0; i < steps; ++i)
      for (int j = 0; j < steps; ++j) {
        const auto at = std::uint32_t(i * side + j), below = at + std::uint32_t(side);
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
          add_triangle({corners[a], corners[b], corners[c]}, first_texcoord + glm::uvec3(a, b, c), p, mesh);
        };
        add(at, at + 1, below + 1);
        add(at, below + 1, below);
      }
  }
  mesh.patches = patches;
  return mesh;
}

}  // namespace frontmost
