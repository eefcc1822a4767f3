// SPDX-License-Identifier: Apache-2.0
// From the coordinates of a file to positions of floats, about an origin that lies where the model is.
//
// Floats hold 24 bits: at 5.4e6, where surveys lie, steps of half a metre. So readers whose files hold more take an
// origin off first, in doubles. Which one fits is known when all vertices were seen; polygons have been cut by then, in
// rounded coordinates. So a model that turns out to lie far from zero is read again, which costs the others nothing:
//
//   return read_about_origin([&](Coordinates& coordinates) { ... mesh.positions.push_back(coordinates(exact)); ... });
//
// A format whose meshes have doubles and are placed by transforms of their own needs no second reading where it keeps
// the doubles of one mesh: include() them all in an OriginSearch, take its origin() off, and multiply the instance's
// transform by the translation to it. Where the zero of the whole scene lies is then for load() to say, for all
// formats: readers of floats and of transforms leave Scene::origin alone.
#pragma once

#include "scene/origin.h"

namespace frontmost {

/// Makes positions of the coordinates in one file, or one mesh.
class Coordinates {
 public:
  /// About zero, looking for an origin that fits better.
  Coordinates() = default;
  /// About an origin that is known, which may be zero.
  explicit Coordinates(const glm::dvec3& origin)
      : origin_(origin), is_home_(origin == glm::dvec3(0)), is_looking_(false) {}

  [[nodiscard]] glm::vec3 operator()(const glm::dvec3& exact) { return (*this)(glm::vec3(exact), exact); }
  /// `rounded` is the nearest float of what `exact` is the nearest double of.
  [[nodiscard]] glm::vec3 operator()(const glm::vec3& rounded, const glm::dvec3& exact) {
    if (!is_home_) return glm::vec3(exact - origin_);
    if (is_looking_) search_.include(exact);
    return rounded;
  }
  /// True once no further coordinates can make found() anything but zero.
  [[nodiscard]] bool is_settled() const { return search_.is_home(); }
  /// What fits all coordinates so far.
  [[nodiscard]] glm::dvec3 found() const { return search_.origin(); }

 private:
  glm::dvec3 origin_{0};
  OriginSearch search_;
  bool is_home_ = true, is_looking_ = true;
};

/// `read` makes a scene with the coordinates that it is handed: once about zero and, where the model lies far from it,
/// once more about a better origin, which the scene then has.
template <class Read>
[[nodiscard]] Scene read_about_origin(const Read& read) {
  Coordinates home;
  Scene scene = read(home);
  const glm::dvec3 origin = home.found();
  if (origin == glm::dvec3(0)) return scene;
  scene = Scene();  // two at once would take twice the memory
  Coordinates away(origin);
  scene = read(away);
  scene.origin = origin;
  for (Mesh& mesh : scene.meshes) mesh.origin = origin;
  return scene;
}

}  // namespace frontmost
