// SPDX-License-Identifier: Apache-2.0
// What is in a scene, and what is odd in it.
//
// Files in the wild have holes, faces that stand twice, and faces that are inside out; printers, solvers and drawings
// care. Everything here is counted by the positions of corners as they are stored, bit for bit, so that two programs
// that look at the same file find the same numbers:
//
//    +---+---+     an edge of two triangles joins them to a shell
//    | / | / |     an edge of one is a boundary: the rim of a hole
//    +---+---+     an edge of three and more is not manifold
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "frontmost/base.h"
#include "frontmost/scene.h"

namespace frontmost {

/// What is odd in a mesh. Corners are the same when their positions are (bit for bit, but +0 = -0), whatever their
/// numbers. Nothing is rounded and nothing has a tolerance.
struct Oddities {
  std::uint64_t non_finite_triangles = 0;  ///< a corner is NaN or infinite; left out of everything below
  std::uint64_t degenerate_triangles = 0;  ///< area exactly zero: corners repeated, or on one line
  std::uint64_t duplicate_triangles = 0;   ///< the three corners of an earlier triangle, in any order
  // Edges of all triangles whose corners are three different points.
  std::uint64_t boundary_edges = 0;      ///< of one triangle
  std::uint64_t non_manifold_edges = 0;  ///< of more than two triangles
  std::uint64_t inconsistent_edges = 0;  ///< of two triangles that run along it the same way: one is inside out

  [[nodiscard]] bool any() const {
    return (non_finite_triangles | degenerate_triangles | duplicate_triangles | boundary_edges | non_manifold_edges |
            inconsistent_edges) != 0;
  }
  friend bool operator==(const Oddities&, const Oddities&) = default;
};

/// Triangles of one material.
struct MaterialUse {
  std::uint32_t material = no_index;
  std::uint64_t triangles = 0;
};

struct MeshReport {
  std::string name;
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;   ///< as stored
  std::uint64_t positions = 0;  ///< different finite ones that triangles use
  std::uint64_t faces = 0;      ///< polygons of the file
  bool has_normals = false, has_texcoords = false, has_colors = false;
  std::vector<MaterialUse> materials;  ///< by number; no_index, the default material, last
  Oddities odd;
  std::uint64_t pieces = 0;  ///< parts that hang together, be it in one corner
  std::uint64_t shells = 0;  ///< parts that hang together over edges: as many or more
  bool closed = false;       ///< has triangles, and no boundary edge
  /// Handles of all shells together; none unless closed, without non-manifold and inconsistent edges.
  std::optional<std::uint64_t> genus;
};

/// One instance.
struct ObjectReport {
  std::string name;
  std::uint32_t mesh = no_index;
  std::uint64_t triangles = 0;
  Box bounds;       ///< of its finite triangles, in world space
  double area = 0;  ///< of its finite triangles, in world space
  /// Enclosed in world space; of meshes with a genus alone. Shells that wind the other way are taken off, as hollows.
  std::optional<double> volume;
};

struct MaterialReport {
  std::string name;
  std::uint64_t triangles = 0;  ///< over all instances
  std::uint32_t textures = 0;   ///< how many maps it has
  Material::Alpha alpha = Material::Alpha::opaque;
  bool double_sided = false;
};

struct CameraReport {
  std::string name;
  glm::dvec3 position{0}, direction{0, 0, -1}, up{0, 1, 0};  ///< world space; both directions of unit length
  bool orthographic = false;
  double vertical = 0;  ///< as in Camera: radians, or height
};

/// One of the scene's, placed in the world.
struct LightReport {
  std::string name;
  Light::Kind kind = Light::Kind::point;
  glm::dvec3 position{0}, direction{0, 0, -1};  ///< world space; the way it shines, of unit length
  glm::vec3 color{1};
  double intensity = 0;                   ///< as in Light: lux, or candela
  std::optional<double> range;            ///< of points and spots
  double inner_cone = 0, outer_cone = 0;  ///< of spots: radians
};

struct SceneReport {
  std::string name;
  Axis up = Axis::y;
  std::uint64_t triangles = 0;         ///< over all instances
  std::uint64_t stored_triangles = 0;  ///< over all meshes
  std::uint64_t vertices = 0;          ///< stored, over all meshes
  std::uint64_t texture_count = 0;
  glm::dvec3 origin{0};          ///< of the scene: world space is about it
  Box bounds;                    ///< world space
  double area = 0;               ///< of all objects
  std::optional<double> volume;  ///< of the objects that have one; none without any
  /// How far from where the file has it a vertex may lie, because floats are kept: half a step of the farthest.
  double rounding = 0;
  std::vector<MeshReport> meshes;
  std::vector<ObjectReport> objects;
  std::vector<MaterialReport> materials;
  std::vector<CameraReport> cameras;
  std::vector<LightReport> lights;
  Oddities odd;  ///< summed over meshes, each counted once
  std::vector<std::string> warnings;
};

/// O(stored triangles * log + triangles over all instances), in parallel; about 100 bytes a triangle of the largest
/// mesh while it runs. The same result for any number of threads.
/// \throws Error as validate(scene) does, and limit_exceeded for a mesh of more than 2^29 triangles.
[[nodiscard]] SceneReport inspect(const Scene& scene, const Execution& execution = {});

/// The units that the coordinates of a model may be in, by its greatest extent alone, as metres to a unit: millimetres
/// where that is then 5 mm to 2 m, as of parts and prints; metres where millimetres would be a grain of sand, below 1;
/// in between metres, centimetres and inches, since anything may be meant. None where nothing tells: below 0.001, above
/// 2000, or without anything. Files that say their unit need no guess: SceneSource::metres_per_unit.
[[nodiscard]] std::vector<double> likely_units(const Box& bounds);

}  // namespace frontmost
