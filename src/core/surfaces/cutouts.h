// SPDX-License-Identifier: Apache-2.0
// Cutouts: triangles of alpha mode MASK, which have holes wherever their alpha is below the cutoff.
//
// Holes belong to the surface, as its outline does. They are looked up in the stored texture, without filtering by
// distance. So every method finds the same holes from every eye, and shading need not test them again.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "scene/texture_lookup.h"

namespace frontmost {

/// The rule that tells where a material has holes.
struct CutoutPattern {
  float alpha = 1, cutoff = 0.5f;  ///< alpha factor, and the least alpha that is solid
  TexcoordTransform transform{TextureUse{}};
  int width = 0, height = 0;  ///< size of the texture; 0 if there is none
  std::vector<std::uint8_t> alphas;
  Texture::Wrap wrap_u = Texture::Wrap::repeat, wrap_v = Texture::Wrap::repeat;
  bool nearest = false;

  [[nodiscard]] bool is_hole(const glm::vec2& texcoord, float vertex_alpha) const;

 private:
  [[nodiscard]] float texture_alpha(const glm::vec2& texcoord) const;
};

/// Weights proportional to `values`, with the sum 1 and none negative; equal weights if the values define none.
[[nodiscard]] glm::vec3 normalized_weights(const glm::dvec3& values);

struct CutoutTriangle {
  std::array<glm::vec3, 3> corner;  ///< world space, as Surfaces::corners()
  std::array<glm::vec2, 3> texcoord;
  std::array<float, 3> alpha;  ///< vertex alphas
  const CutoutPattern* pattern;

  /// Whether the point with these barycentric weights is in a hole.
  [[nodiscard]] bool is_hole(const glm::vec3& weight) const;
  /// Whether a point of the triangle's plane, in world space, is in a hole.
  [[nodiscard]] bool is_hole_at(const glm::dvec3& point) const;
};

/// All triangles of a scene that may have holes. Needs neither the scene nor the surfaces once it is made.
class Cutouts {
 public:
  /// The cutouts of a scene, or null if there are none. O(triangles), and O(texels) of the textures that cut.
  [[nodiscard]] static std::shared_ptr<Cutouts> of(const Scene& scene,
                                                   const std::vector<PrimitiveId>& first_primitives);

  [[nodiscard]] bool has(PrimitiveId id) const { return words_[id / 64].bits >> (id % 64) & 1; }
  /// Precondition: has(id).
  [[nodiscard]] const CutoutTriangle& operator[](PrimitiveId id) const;
  [[nodiscard]] std::size_t count() const { return triangles_.size(); }
  [[nodiscard]] std::size_t byte_count() const;
  /// Moves the triangles of an instance to their current places; `first` is the instance's first id.
  void move(const Mesh& mesh, const glm::dmat4& world_from_mesh, PrimitiveId first);

 private:
  /// A word of 64 primitives: those that may have holes, and how many such primitives come before the word.
  struct Word {
    std::uint64_t bits = 0;
    std::uint32_t before = 0;
  };
  [[nodiscard]] std::size_t place_of(PrimitiveId id) const;  ///< index in triangles_
  void add_mesh(const Scene& scene, const Instance& instance, PrimitiveId first);

  std::shared_ptr<std::vector<CutoutPattern>> patterns_;  ///< by material; copies share them
  std::vector<bool> cuts_;                                ///< by material: whether it may have holes
  std::vector<Word> words_;
  std::vector<CutoutTriangle> triangles_;
};

}  // namespace frontmost
