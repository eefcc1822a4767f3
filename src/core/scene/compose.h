// SPDX-License-Identifier: Apache-2.0
// Functions that compose scenes from paint, places and cameras, and the scenes of builtin() that are composed this way.
// All are bit-identical on every machine, as shapes.h says.
//
//   paint() --add()--> a material's number --add(mesh)--> a mesh's number --place()--> a visible instance
#pragma once

#include <string>

#include "frontmost/scene.h"

namespace frontmost {

/// A plain material: base colour in sRGB as 0xRRGGBB.
[[nodiscard]] Material paint(std::string name, std::uint32_t srgb, float roughness = 0.6f, float metallic = 0);

/// Appends a material. \returns its number.
std::uint32_t add(Scene& scene, Material material);
/// Appends a mesh whose triangles all get `material`. \returns its number.
std::uint32_t add(Scene& scene, std::string name, Mesh mesh, std::uint32_t material);
void place(Scene& scene, std::string name, std::uint32_t mesh, const glm::dmat4& world_from_mesh = glm::dmat4(1.0));

[[nodiscard]] glm::dmat4 moved(const glm::dvec3& by);
[[nodiscard]] glm::dmat4 scaled(double by);
/// A turn about the y axis, counter-clockwise seen from above, by part / whole of a full turn.
[[nodiscard]] glm::dmat4 turned(int part, int whole);
/// A turn about the x axis, counter-clockwise seen from +x.
[[nodiscard]] glm::dmat4 tilted(int part, int whole);

/// A camera at `eye` that looks at `target` with y up. `vertical` is the full field of view in degrees.
[[nodiscard]] Camera camera_at(std::string name, const glm::dvec3& eye, const glm::dvec3& target, double vertical);

/// Linear light from a colour in designers' notation (0xRRGGBB, sRGB).
[[nodiscard]] glm::vec4 color(std::uint32_t srgb, double alpha = 1);

[[nodiscard]] Scene make_teapot();
[[nodiscard]] Scene make_cubes();
[[nodiscard]] Scene make_cycle();
[[nodiscard]] Scene make_city();
[[nodiscard]] Scene make_spheres();
[[nodiscard]] Scene make_gallery();

}  // namespace frontmost
