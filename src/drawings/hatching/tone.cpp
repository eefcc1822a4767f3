// SPDX-License-Identifier: Apache-2.0
// A normal that changes linearly along a segment is darker than a limit where a quadratic function is negative. So the
// ends of dark stretches are roots, without sampling. The middle between two roots shows which side is dark.
//
// Normals at vertices are means over the triangles around them. Triangles beyond a fold of more than the crease angle
// do not count. The weights are exact on a sphere, for any tessellation.
#include "hatching/tone.h"

#include <algorithm>
#include <cmath>

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t most_at_vertex = 256;  // the tip of a cone with more sides is flat: its normal means nothing

glm::dvec3 unit(const glm::dvec3& v, const glm::dvec3& otherwise) {
  const double length = glm::length(v);
  return length > 0 && length < std::numeric_limits<double>::infinity() ? v / length : otherwise;
}

}  // namespace

double NormalAlong::cosine_at(double t, const glm::dvec3& to_light) const {
  const glm::dvec3 n = from + (to - from) * t;
  const double length = glm::length(n);
  return length > 0 ? glm::dot(n, to_light) / length : 0;
}

void find_dark(const NormalAlong& normal, const glm::dvec3& to_light, double limit, std::vector<Interval>& dark) {
  dark.clear();
  // (N.L)^2 = limit^2 N.N is a quadratic equation; its roots are where N.L = +-limit |N|.
  const glm::dvec3 step = normal.to - normal.from;
  const double p = glm::dot(normal.from, to_light), q = glm::dot(step, to_light), square = limit * limit;
  const double a = q * q - square * glm::dot(step, step), b = p * q - square * glm::dot(normal.from, step),
               c = p * p - square * glm::dot(normal.from, normal.from);
  double cuts[4] = {0, 1, 1, 1};
  int count = 1;
  const auto cut_at = [&](double t) {
    if (t > 0 && t < 1) cuts[count++] = t;
  };
  if (const double discriminant = b * b - a * c; discriminant > 0) {
    // Each root has two forms; the one without cancellation is used.
    const double sum = -b - std::copysign(std::sqrt(discriminant), b);
    if (a != 0) cut_at(sum / a);
    if (sum != 0) cut_at(c / sum);
  }
  std::sort(cuts + 1, cuts + count);
  cuts[count] = 1;
  for (int i = 0; i < count; ++i) {
    if (!(normal.cosine_at(0.5 * (cuts[i] + cuts[i + 1]), to_light) < limit)) continue;
    if (!dark.empty() && dark.back().end == cuts[i])
      dark.back().end = cuts[i + 1];
    else
      dark.push_back({cuts[i], cuts[i + 1]});
  }
}

CornerNormals::CornerNormals(const SeenMesh& seen, const Surfaces& surfaces, double crease_angle,
                             const Execution& execution)
    : mesh_(seen.mesh),
      normals_(mesh_.triangles.size()),
      surfaces_(surfaces),
      cosine_(float(std::cos(crease_angle))),
      corners_(corner_table(mesh_, execution)) {
  for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) normals_[i] = normal_of(mesh_, i);
}

glm::dvec3 CornerNormals::unit_normal(std::uint32_t triangle) const { return unit(normals_[triangle], glm::dvec3(0)); }

/// The mean with weights by N. Max (Weights for Computing Vertex Normals from Facet Normals, 1999), exact on spheres
/// for any tessellation.
glm::dvec3 CornerNormals::at(std::uint32_t triangle, int corner, const glm::dvec3& own) const {
  const std::uint32_t vertex = mesh_.triangles[triangle][corner];
  const std::span<const Corner> around = corners_[vertex];
  if (around.size() > most_at_vertex) return own;
  const std::uint32_t instance = surfaces_.source(mesh_.ids[triangle]).instance;
  glm::dvec3 sum(0);
  for (const Corner& one : around) {
    const std::uint32_t other = one.triangle();
    const glm::dvec3& normal = normals_[other];
    const double cosine = glm::dot(unit(normal, glm::dvec3(0)), own);
    // Neighbours with the opposite winding are reversed.
    if (other != triangle && (std::abs(cosine) < cosine_ || surfaces_.source(mesh_.ids[other]).instance != instance))
      continue;
    const glm::dvec3 &place = mesh_.positions[vertex], &next = mesh_.positions[one.next(mesh_)],
                     &last = mesh_.positions[one.last(mesh_)];
    const double weight = glm::dot(next - place, next - place) * glm::dot(last - place, last - place);
    if (weight > 0) sum += normal * (std::copysign(1.0, cosine) / weight);
  }
  return unit(sum, own);
}

std::array<glm::dvec3, 3> CornerNormals::of(std::uint32_t triangle) const {
  const glm::dvec3 own = unit_normal(triangle);
  return {at(triangle, 0, own), at(triangle, 1, own), at(triangle, 2, own)};
}

}  // namespace frontmost::lines_detail
