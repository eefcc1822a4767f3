// SPDX-License-Identifier: Apache-2.0
// Arbitrary spheres, patches, transforms and cameras, cut into triangles and met by rays. Must not crash or hang;
// threads change no bit; and what a ray is told to meet is where it says, within the bound that CurvedIndex states.
// Input: ViewBytes, CurvedBytes, then spheres of 4 floats, then patches of 48.
#include <array>
#include <cmath>
#include <cstdlib>

#include "scene/bezier_patch.h"
#include "support/geometry_fuzz.h"
#include "view/tessellate/level.h"

using namespace frontmost;

namespace {

struct CurvedBytes {
  std::uint8_t spheres;   ///< how many, of 8 at most
  std::int8_t exponent;   ///< all is scaled by 2^(8 exponent)
  std::uint8_t placing;   ///< which transforms
  std::uint8_t fineness;  ///< of tessellation
};

constexpr std::size_t kMostPatches = 4;
constexpr double kMostTriangles = 1 << 15;  ///< more would take the time of an input
constexpr Execution kWide{.threads = 2, .isa = Isa::best, .watch = nullptr};
constexpr Execution kPlain{.threads = 1, .isa = Isa::scalar, .watch = nullptr};

void require(bool holds) {
  if (!holds) std::abort();
}

/// Takes floats off the front of the input.
class Floats {
 public:
  Floats(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  [[nodiscard]] bool has(std::size_t count) const { return size_ >= count * sizeof(float); }
  double next() {
    float value;
    std::memcpy(&value, data_, sizeof value);
    data_ += sizeof value, size_ -= sizeof value;
    return double(value);
  }
  glm::dvec3 next_point() {
    const double x = next(), y = next(), z = next();
    return {x, y, z};
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

Mesh mesh_of(Floats floats, int spheres) {
  Mesh mesh;
  for (int i = 0; i < spheres && floats.has(4); ++i) {
    const glm::dvec3 centre = floats.next_point();
    mesh.spheres.push_back({centre, floats.next()});
  }
  while (mesh.patches.size() < kMostPatches && floats.has(48)) {
    mesh.patches.emplace_back();
    for (glm::dvec3& p : mesh.patches.back().points) p = floats.next_point();
  }
  return mesh;
}

glm::dmat4 placing_of(int choice, double scale) {
  glm::dmat4 m(1.0);
  if (choice == 1) m[0] = -m[0];
  if (choice == 2) m[2] = glm::dvec4(0);
  if (choice == 3) m[0] *= 1e3, m[1].x = 0.5;
  if (choice == 4) m[3] = glm::dvec4(1e6, -1e6, 1e6, 1);
  if (choice == 5) m[1] *= 1e-9;
  if (choice == 6) m[1].y = std::nan("");
  for (int k = 0; k < 3; ++k) m[k] *= scale;
  return m;
}

Scene scene_of(Floats floats, const CurvedBytes& bytes) {
  Scene scene;
  scene.meshes.push_back(mesh_of(floats, bytes.spheres % 9));
  const double scale = std::ldexp(1.0, 8 * bytes.exponent);
  scene.instances.push_back({"", 0, placing_of(bytes.placing % 8, scale)});
  if (bytes.placing >= 128) scene.instances.push_back({"", 0, placing_of(bytes.placing / 8 % 8, 1.0)});
  return scene;
}

/// True where the bound means something: nothing overflows.
bool is_moderate(const glm::dmat4& m, const BezierPatch& patch) {
  for (const glm::dvec3& p : patch.points) {
    const glm::dvec3 world(m * glm::dvec4(p, 1));
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(world[k]) < 0x1p400)) return false;
  }
  return true;
}

/// The hit lies on the patch, and on the ray, within 2^-30 s + 2^-44 d.
void check_place(const Scene& scene, const CurvedIndex& index, const Ray& ray, const CurvedHit& hit) {
  require(hit.primitive < index.element_count() && hit.t >= 0 && std::isfinite(hit.t));
  require(hit.parameters.x >= 0 && hit.parameters.x <= 1 && hit.parameters.y >= 0 && hit.parameters.y <= 1);
  require(std::abs(glm::length(hit.normal) - 1) < 1e-9);
  require(hit.is_front == (glm::dot(hit.normal, glm::dvec3(ray.direction)) <= 0));
  const PrimitiveSource source = index.source(hit.primitive);
  const Mesh& mesh = scene.meshes[source.mesh];
  if (source.triangle < mesh.spheres.size()) return;
  BezierPatch patch = mesh.patches[source.triangle - mesh.spheres.size()];
  const glm::dmat4& m = scene.instances[source.instance].world_from_mesh;
  if (!is_moderate(m, patch)) return;
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  double away = 0;
  for (glm::dvec3& p : patch.points) {
    p = glm::dvec3(m * glm::dvec4(p, 1));
    low = glm::min(low, p), high = glm::max(high, p);
    away = std::max(away, glm::length(p - glm::dvec3(ray.origin)));
  }
  const glm::dvec3 sides = high - low, on_ray = glm::dvec3(ray.origin) + hit.t * glm::dvec3(ray.direction);
  const double bound = 0x1p-30 * std::max(sides.x, std::max(sides.y, sides.z)) + 0x1p-44 * away + 0x1p-900;
  const glm::dvec2& uv = hit.parameters;
  require(glm::length(evaluate(patch, {uv.x, 1 - uv.x}, {uv.y, 1 - uv.y}).position - on_ray) <= 2 * bound);
}

void check_rays(const Scene& scene, const View& view) {
  const CurvedIndex index(scene, kWide);
  const CurvedVisible wide = raycast(index, view, kWide), plain = raycast(index, view, kPlain);
  require(content_hash(wide.visible) == content_hash(plain.visible));
  for (std::size_t i = 0; i < wide.visible.primitives.size(); ++i) {
    const PrimitiveId id = wide.visible.primitives[i];
    if (id == no_primitive) continue;
    require(id < index.element_count() && wide.visible.keys[i] >= 0 && wide.visible.keys[i] <= 1);
    require(wide.normals[i] == plain.normals[i] && wide.parameters[i] == plain.parameters[i]);
  }
  for (int k = 0; k < 8; ++k) {
    const glm::dvec3 aim(k & 1 ? 0.3 : -0.2, k & 2 ? 0.25 : -0.4, k & 4 ? 0.5 : 0.0);
    const Ray ray{glm::vec3(view.eye()), glm::vec3(aim - view.eye())};
    if (const CurvedHit hit = closest_hit(index, ray)) check_place(scene, index, ray, hit);
  }
  const Facets shown = facets_of(index, scene, {&wide, 1});
  require(shown.visible[0].primitives.size() == wide.visible.primitives.size());
}

void check_triangles(const Scene& scene, const View& view, double pixels) {
  double triangles = 0;
  for (const Instance& instance : scene.instances)
    triangles += level_of(scene.meshes[0], instance.world_from_mesh, ScreenTolerance(view, pixels)).triangle_count();
  if (triangles > kMostTriangles) return;
  const Scene cut = tessellate(scene, view, pixels);
  for (const Mesh& mesh : cut.meshes)
    for (const std::uint32_t face : mesh.face_ids) require(face < mesh.curved_count());
  const Surfaces surfaces(cut);
  const Visible seen = zbuffer(surfaces, view, kWide);
  for (const PrimitiveId id : seen.primitives) require(id == no_primitive || id < surfaces.primitive_count());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  struct {
    test::ViewBytes view;
    CurvedBytes curved;
  } bytes;
  if (size < sizeof(bytes)) return 0;
  std::memcpy(&bytes, data, sizeof(bytes));
  bytes.view.width %= 4, bytes.view.height %= 4, bytes.view.samples %= 2;  // a degenerate patch takes long for each ray
  const Scene scene = scene_of({data + sizeof(bytes), size - sizeof(bytes)}, bytes.curved);
  try {
    const View view = test::view_of(bytes.view);
    check_rays(scene, view);
    check_triangles(scene, view, 0.25 * (1 + bytes.curved.fineness));
  } catch (const Error&) {
    // A camera at its own target, or not finite; a transform that is not: a stated outcome.
  }
  return 0;
}
