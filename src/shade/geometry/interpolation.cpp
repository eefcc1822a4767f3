// SPDX-License-Identifier: Apache-2.0
// From set-up triangles to fragments. Pictures of fine meshes have runs of one or two fragments, others of hundreds:
// what belongs to a triangle is read once and done in one loop, and all the rest is done for the batch as a whole.
#include <algorithm>
#include <cmath>

#include "shade/geometry/geometry.h"

namespace frontmost::shading {
namespace {

float at_least_zero(float value) { return value > 0.0f ? value : 0.0f; }  // 0 for NaN

/// Barycentric weights of the fragments of a batch, and what they were divided by.
struct Weights {
  Lane3 weight;
  Lane divisor;
};

Lane& lane(Lane3& lanes, int k) { return k == 0 ? lanes.x : k == 1 ? lanes.y : lanes.z; }

void fill(Lane& lane, int count, float value) { std::fill_n(lane.values, count, value); }

/// Fragments [begin, end) of a batch, all of one triangle.
class FragmentRun {
 public:
  FragmentRun(const TriangleSetup& triangle, int begin, int end, Weights& weights)
      : t_(triangle), begin_(begin), end_(end), weight_(weights.weight), divisor_(weights.divisor) {}

  /// Weights, position, the plane's normal, and the corner normals where they differ from that.
  void place(const Lane2& screen, Geometry& out) {
    // Copies: the compiler cannot know that what is written is not the triangle.
    const std::array<Affine, 3> weight = t_.weight;
    const std::array<glm::vec3, 3> corner = t_.corner;
    const glm::vec2 reference = t_.reference;
    const glm::vec3 normal = t_.plane_normal;
    for (int i = begin_; i < end_; ++i) {
      const float dx = screen.x[i] - reference.x, dy = screen.y[i] - reference.y;
      const float a = at_least_zero(weight[0].at_reference + dx * weight[0].step_x + dy * weight[0].step_y);
      const float b = at_least_zero(weight[1].at_reference + dx * weight[1].step_x + dy * weight[1].step_y);
      const float c = at_least_zero(weight[2].at_reference + dx * weight[2].step_x + dy * weight[2].step_y);
      const float sum = a + b + c;
      const bool valid = sum > 1e-30f;
      const float scale = valid ? 1.0f / sum : 0.0f, rest = valid ? 0.0f : 1.0f / 3;
      const float p = a * scale + rest, q = b * scale + rest, r = c * scale + rest;
      weight_.x[i] = p, weight_.y[i] = q, weight_.z[i] = r;
      divisor_[i] = valid ? sum : 1.0f;
      out.position.x[i] = corner[0].x * p + corner[1].x * q + corner[2].x * r;
      out.position.y[i] = corner[0].y * p + corner[1].y * q + corner[2].y * r;
      out.position.z[i] = corner[0].z * p + corner[1].z * q + corner[2].z * r;
      out.plane_normal.x[i] = out.normal.x[i] = normal.x;
      out.plane_normal.y[i] = out.normal.y[i] = normal.y;
      out.plane_normal.z[i] = out.normal.z[i] = normal.z;
    }
  }

  /// Normals between those of the corners, and the point lifted to the surface that they suggest.
  void smooth(Geometry& out) const {
    if (!t_.is_smooth) return;
    for (int k = 0; k < 3; ++k) mix(corner_values(t_.normal, k), lane(out.normal, k));
    Lane3& n = out.normal;
    for (int i = begin_; i < end_; ++i) {
      // Of unit vectors: shorter than one, never long.
      const float length2 = n.x[i] * n.x[i] + n.y[i] * n.y[i] + n.z[i] * n.z[i];
      const bool valid = length2 > 1e-12f;
      const float scale = valid ? 1.0f / std::sqrt(length2) : 0.0f, rest = valid ? 0.0f : 1.0f;
      n.x[i] = n.x[i] * scale + t_.plane_normal.x * rest;
      n.y[i] = n.y[i] * scale + t_.plane_normal.y * rest;
      n.z[i] = n.z[i] * scale + t_.plane_normal.z * rest;
    }
    lift(0, weight_.x, out);
    lift(1, weight_.y, out);
    lift(2, weight_.z, out);
  }

  void find_texcoords(Geometry& out) const {
    if (!t_.has_texcoord) {
      for (int i = begin_; i < end_; ++i)
        for (Lane2* lanes : {&out.texcoord, &out.texcoord_dx, &out.texcoord_dy}) lanes->set(i, glm::vec2(0));
      return;
    }
    for (int i = begin_; i < end_; ++i) {
      const Barycentric b{weight_.at(i), divisor_[i]};
      const glm::vec2 texcoord = interpolate(t_.texcoord, b.weight);
      const Gradient change = gradient(t_, t_.texcoord, texcoord, b);
      out.texcoord.set(i, texcoord);
      out.texcoord_dx.set(i, change.dx);
      out.texcoord_dy.set(i, change.dy);
    }
  }

  void find_colors(Geometry& out) const {
    Lane* lanes[4] = {&out.color.x, &out.color.y, &out.color.z, &out.alpha};
    for (int k = 0; k < 4; ++k) {
      if (t_.has_color) {
        mix(corner_values(t_.color, k), *lanes[k]);
      } else {
        for (int i = begin_; i < end_; ++i) (*lanes[k])[i] = 1.0f;
      }
    }
  }

 private:
  template <class Vector>
  static glm::vec3 corner_values(const std::array<Vector, 3>& corner, int k) {
    return {corner[0][k], corner[1][k], corner[2][k]};
  }
  void mix(const glm::vec3& corner, Lane& out) const {
    for (int i = begin_; i < end_; ++i)
      out[i] = corner.x * weight_.x[i] + corner.y * weight_.y[i] + corner.z * weight_.z[i];
  }

  /// Towards where the point would lie on the curved surface that the corner normals suggest: the mean of its
  /// projections onto the corners' tangent planes, taken only outwards. Shadows looked up there do not show the facets
  /// along the terminator. (J. Hanika, Hacking the Shadow Terminator, in Ray Tracing Gems II, 2021.)
  void lift(std::size_t k, const Lane& weight, Geometry& out) const {
    const glm::vec3 corner = t_.corner[k], n = t_.normal[k];
    const Lane3& p = out.position;
    Lane3& lifted = out.smooth_position;
    for (int i = begin_; i < end_; ++i) {
      const float height = (p.x[i] - corner.x) * n.x + (p.y[i] - corner.y) * n.y + (p.z[i] - corner.z) * n.z;
      const float up = at_least_zero(-height) * weight[i];
      lifted.x[i] += n.x * up;
      lifted.y[i] += n.y * up;
      lifted.z[i] += n.z * up;
    }
  }

  const TriangleSetup& t_;
  int begin_, end_;
  Lane3& weight_;
  Lane& divisor_;
};

/// Calls `visit` with every run of fragments of one triangle.
template <class Visit>
void for_runs(const Coverage& coverage, const std::vector<TriangleSetup>& setups, Weights& weights,
              const Visit& visit) {
  for (int begin = 0; begin < coverage.count;) {
    int end = begin + 1;
    while (end < coverage.count && coverage.triangle[end] == coverage.triangle[begin]) ++end;
    const TriangleSetup& triangle = setups[coverage.triangle[begin]];
    visit(triangle, FragmentRun(triangle, begin, end, weights));
    begin = end;
  }
}

void find_directions(const ScreenRays& rays, int count, Geometry& out) {
  if (rays.is_parallel()) {
    for (int k = 0; k < 3; ++k) fill(lane(out.to_viewer, k), count, float(-rays.forward()[k]));
    return;
  }
  const Lane3& p = out.position;
  for (int i = 0; i < count; ++i) {
    const float length2 = p.x[i] * p.x[i] + p.y[i] * p.y[i] + p.z[i] * p.z[i];
    const float scale = -1.0f / std::sqrt(length2 > 1e-36f ? length2 : 1e-36f);
    out.to_viewer.x[i] = p.x[i] * scale;
    out.to_viewer.y[i] = p.y[i] * scale;
    out.to_viewer.z[i] = p.z[i] * scale;
  }
}

}  // namespace

void interpolate_geometry(const ScreenRays& rays, const std::vector<TriangleSetup>& setups, FragmentBatch& batch) {
  const Coverage& coverage = batch.coverage;
  Geometry& out = batch.geometry;
  const int count = coverage.count;
  Weights weights;
  bool any_smooth = false, any_texcoord = false, any_color = false;
  for_runs(coverage, setups, weights, [&](const TriangleSetup& t, FragmentRun run) {
    run.place(coverage.screen, out);
    any_smooth = any_smooth || t.is_smooth;
    any_texcoord = any_texcoord || t.has_texcoord;
    any_color = any_color || t.has_color;
  });
  find_directions(rays, count, out);
  for (int k = 0; k < 3; ++k) std::copy_n(lane(out.position, k).values, count, lane(out.smooth_position, k).values);
  if (!any_texcoord)
    for (Lane2* lanes : {&out.texcoord, &out.texcoord_dx, &out.texcoord_dy})
      for (Lane* axis : {&lanes->x, &lanes->y}) fill(*axis, count, 0.0f);
  if (!any_color)
    for (Lane* channel : {&out.color.x, &out.color.y, &out.color.z, &out.alpha}) fill(*channel, count, 1.0f);
  if (!any_smooth && !any_texcoord && !any_color) return;
  for_runs(coverage, setups, weights, [&](const TriangleSetup&, FragmentRun run) {
    run.smooth(out);
    if (any_texcoord) run.find_texcoords(out);
    if (any_color) run.find_colors(out);
  });
}

}  // namespace frontmost::shading
