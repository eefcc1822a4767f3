// SPDX-License-Identifier: Apache-2.0
// Cuts arbitrary triangles or solids by an arbitrary plane. The section must not crash or hang; the rest lies behind
// the plane, and cut faces lie in it; threads change no bit. Input: support/geometry_fuzz.h.
#include <cmath>
#include <cstdlib>

#include "support/geometry_fuzz.h"

using namespace frontmost;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// Moves vertices to a coarse lattice, so that they touch each other and the plane. Infinite, NaN and huge values stay.
void put_on_lattice(Mesh& mesh) {
  for (glm::vec3& p : mesh.positions) p = glm::round(p * 2.0f) / 2.0f;
}

/// Replaces triangles by a tetrahedron for every four vertices: closed solids that may pass through each other.
void make_solids(Mesh& mesh) {
  mesh.triangles.clear();
  for (std::uint32_t i = 0; i + 3 < mesh.positions.size(); i += 4)
    for (const glm::uvec3& t : {glm::uvec3(0, 2, 1), glm::uvec3(0, 1, 3), glm::uvec3(1, 2, 3), glm::uvec3(0, 3, 2)})
      mesh.triangles.push_back(t + i);
}

void check(const Section& section, const CuttingPlane& plane) {
  const int axis = int(plane.towards) % 3;
  const float sign = int(plane.towards) < 3 ? 1.0f : -1.0f, at = float(plane.at);
  require(section.scene.meshes.size() == 1 && section.faces.size() <= 1);
  const Mesh& mesh = section.scene.meshes[0];
  require(mesh.material_ids.size() == mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const bool is_face = !section.faces.empty() && mesh.material_of(t) == section.faces[0].material;
    for (int k = 0; k < 3; ++k) {
      const float place = mesh.positions[mesh.triangles[t][k]][axis];
      require(is_face ? place == at : sign * place <= sign * at);
    }
  }
  for (const CutFace& face : section.faces)
    for (const std::vector<glm::vec3>& outline : face.outlines) {
      require(outline.size() >= 3);
      for (const glm::vec3& p : outline) require(p[axis] == at);
    }
}

bool equal(const Section& a, const Section& b) {
  if (a.faces.size() != b.faces.size()) return false;
  for (std::size_t i = 0; i < a.faces.size(); ++i)
    if (a.faces[i].outlines != b.faces[i].outlines || a.faces[i].open_count != b.faces[i].open_count) return false;
  const Mesh &m = a.scene.meshes[0], &n = b.scene.meshes[0];
  return m.triangles == n.triangles && m.material_ids == n.material_ids;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::optional<test::FuzzInput> input = test::read_input(data, size);
  if (!input) return 0;
  auto& [bytes, scene] = *input;
  if (bytes.spare & 1) put_on_lattice(scene.meshes[0]);
  if (bytes.spare & 2) make_solids(scene.meshes[0]);
  if (bytes.spare & 4) scene.instances[0].world_from_mesh[0][0] = -1;
  const CuttingPlane plane{Axis(bytes.up % 6), bytes.eye_x};
  try {
    const Surfaces surfaces(scene);
    const Section section = cut(surfaces, plane, {.threads = 2, .isa = Isa::best, .watch = nullptr});
    check(section, plane);
    require(equal(section, cut(surfaces, plane, {.threads = 1, .isa = Isa::scalar, .watch = nullptr})));
    const Surfaces left(section.scene);
    const Section* const sections[] = {&section};
    require(section_hatch_sets(section, hatch_styles(sections)).size() == section.faces.size());
  } catch (const Error&) {
    // A plane that is not finite is a documented error.
  }
  return 0;
}
