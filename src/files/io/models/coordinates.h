// SPDX-License-Identifier: Apache-2.0
// Turns coordinates of a file into positions of floats, relative to an origin near the model.
//
// Floats hold 24 bits: at 5.4e6, where surveys lie, they have steps of half a metre. So readers of more precise files
// subtract an origin first, in doubles. The best origin is known only after all vertices were read, and by then
// polygons have already been cut by rounded coordinates. So a model that turns out to lie far from zero is read again;
// other models pay nothing. load() chooses the origin of the whole scene for all formats, so readers of floats and
// transforms leave Scene::origin alone.
#pragma once

#include "scene/origin.h"

namespace frontmost {

/// Converts the coordinates of one file, or of one mesh, to positions.
class Coordinates {
 public:
  /// Makes positions relative to zero, and searches for a better origin.
  Coordinates() = default;
  /// Makes positions relative to a known origin, which may be zero.
  explicit Coordinates(const glm::dvec3& origin)
      : origin_(origin), is_home_(origin == glm::dvec3(0)), is_looking_(false) {}

  [[nodiscard]] glm::vec3 operator()(const glm::dvec3& exact) { return (*this)(glm::vec3(exact), exact); }
  /// Returns the position of `exact`. `rounded` is the same number, rounded to the nearest float.
  [[nodiscard]] glm::vec3 operator()(const glm::vec3& rounded, const glm::dvec3& exact) {
    if (!is_home_) return glm::vec3(exact - origin_);
    if (is_looking_) search_.include(exact);
    return rounded;
  }
  /// Whether found() will stay zero, whatever coordinates follow.
  [[nodiscard]] bool is_settled() const { return search_.is_home(); }
  /// Returns the origin that suits all coordinates so far.
  [[nodiscard]] glm::dvec3 found() const { return search_.origin(); }

 private:
  glm::dvec3 origin_{0};
  OriginSearch search_;
  bool is_home_ = true, is_looking_ = true;
};

/// Reads a model once, or twice if it lies far from zero: calls `read` with coordinates about zero, and perhaps again
/// with a better origin, which becomes the scene's.
template <class Read>
[[nodiscard]] Scene read_about_origin(const Read& read) {
  Coordinates home;
  Scene scene = read(home);
  const glm::dvec3 origin = home.found();
  if (origin == glm::dvec3(0)) return scene;
  scene = Scene();  // two scenes at once would take twice the memory
  Coordinates away(origin);
  scene = read(away);
  scene.origin = origin;
  for (Mesh& mesh : scene.meshes) mesh.origin = origin;
  return scene;
}

}  // namespace frontmost
