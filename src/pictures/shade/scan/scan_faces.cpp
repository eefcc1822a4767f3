// SPDX-License-Identifier: Apache-2.0
#include "shade/scan/scan_faces.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "raycast/camera_rays.h"

namespace frontmost::shading {
namespace {

/// The size of a face is about the scan's resolution, so that steps are about 1.
int face_size(const RayCamera& camera) {
  const glm::ivec2 grid = grid_of(camera);
  return std::clamp(std::max(grid.x, grid.y) / 4, 64, 16384);
}

template <class Model>
std::function<glm::dvec3(int, int)> directions_at(const Model& model, const glm::ivec2& offset) {
  const auto directions = std::make_shared<const raycast_detail::GridDirections<Model>>(model, offset);
  return [directions](int x, int y) { return directions->at(x, y); };
}

}  // namespace

ScanDirections::ScanDirections(const RayCamera& camera) : grid_(grid_of(camera)) {
  const auto set = [&](const auto& model) {
    for (const glm::ivec2& offset : sample_offsets(camera.samples)) samples_.push_back(directions_at(model, offset));
    middle_ = directions_at(model, sample_offsets(1)[0]);
  };
  std::visit(set, camera.model);
}

glm::dvec3 ScanDirections::middle(const glm::ivec2& at) const {
  if (at.x < 0 || at.y < 0 || at.x >= grid_.x || at.y >= grid_.y) return glm::dvec3(0);
  const glm::dvec3 direction = middle_(at.x, at.y);
  return is_finite(direction) && direction != glm::dvec3(0) ? glm::normalize(direction) : glm::dvec3(0);
}

/// The step to the neighbour in the direction of `step`, or from the one on the opposite side.
glm::dvec3 ScanDirections::step_to(const glm::ivec2& from, const glm::ivec2& step) const {
  const glm::dvec3 here = middle(from), next = middle(from + step);
  if (next != glm::dvec3(0)) return next - here;
  const glm::dvec3 last = middle(from - step);
  return last != glm::dvec3(0) ? here - last : glm::dvec3(0);
}

ScanDirections::Steps ScanDirections::steps(int x, int y) const {
  glm::ivec2 at(x, y);
  // The middle of a border pixel may see nothing although one of its samples does; the next pixel inwards then stands
  // in.
  if (middle(at) == glm::dvec3(0)) at += glm::ivec2(x < grid_.x / 2 ? 1 : -1, y < grid_.y / 2 ? 1 : -1);
  if (middle(at) == glm::dvec3(0)) return {};
  return {step_to(at, {1, 0}), step_to(at, {0, 1})};
}

ScanFaces::Axes ScanFaces::axes_of(int face) {
  glm::dvec3 ahead(0);
  ahead[face / 2] = face % 2 == 0 ? -1 : 1;
  const glm::dvec3 up = face / 2 == 1 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  return {glm::cross(ahead, up), up, ahead};
}

int ScanFaces::face_of(const glm::dvec3& direction) {
  const glm::dvec3 size = glm::abs(direction);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return 2 * axis + (direction[axis] > 0);
}

ScanFaces::ScanFaces(const TriangleStore& store, const RayCamera& camera, const BitSet* large, bool has_texcoords)
    : half_size_(face_size(camera) * 0.5) {
  for (int face = 0; face < cube_faces; ++face) {
    const Axes axes = axes_of(face);
    View view;
    view.width = view.height = face_size(camera);
    const glm::dmat3 eye_from_face(axes.right, axes.up, -axes.ahead);
    view.world_from_eye = glm::dmat4(glm::dmat3(camera.world_from_eye) * eye_from_face);
    view.world_from_eye[3] = camera.world_from_eye[3];
    view.projection.left = view.projection.bottom = -1;
    view.projection.right = view.projection.top = 1;
    sources_.emplace_back(store, view, large);
    if (!has_texcoords) sources_.back().leave_out_texcoords();
  }
}

glm::vec2 ScanFaces::screen(int face, const glm::dvec3& direction) const {
  const Axes axes = axes_of(face);
  const glm::dvec2 tangent =
      glm::dvec2(glm::dot(direction, axes.right), -glm::dot(direction, axes.up)) / glm::dot(direction, axes.ahead);
  return glm::vec2(half_size_ * (tangent + 1.0));
}

glm::vec2 ScanFaces::screen_step(int face, const glm::dvec3& direction, const glm::dvec3& step) const {
  const Axes axes = axes_of(face);
  const double ahead = glm::dot(direction, axes.ahead);
  // Derivative of the quotient: the component of the step along the ray has no effect.
  const glm::dvec3 across = step - direction * (glm::dot(step, axes.ahead) / ahead);
  return glm::vec2(half_size_ / ahead * glm::dvec2(glm::dot(across, axes.right), -glm::dot(across, axes.up)));
}

}  // namespace frontmost::shading
