// SPDX-License-Identifier: Apache-2.0
// Cut-outs: triangles of alpha mode MASK, which have holes wherever their alpha is below the cutoff.
//
// Where a hole is belongs to the surface as its outline does: it is looked up in the texture as it is stored, not as it
// would be filtered for some distance. So every method finds the same holes, from whichever eye, and what shades a
// picture need not ask again.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "scene/texture_lookup.h"

namespace frontmost {

/// A material's holes.
struct CutoutPattern {
  float alpha = 1, cutoff = 0.5f;  ///< the factor, and what is solid from there on
  TexcoordTransform transform{TextureUse{}};
  int width = 0, height = 0;  ///< of the texture; 0 where there is none
  std::vector<std::uint8_t> alphas;
  Texture::Wrap wrap_u = Texture::Wrap::repeat, wrap_v = Texture::Wrap::repeat;
  bool nearest = false;

  [[nodiscard]] bool is_hole(const glm::vec2& texcoord, float vertex_alpha) const;

 private:
  [[nodiscard]] float texture_alpha(const glm::vec2& texcoord) const;
};

/// Weights with the sum 1, none negative, of values that are proportional to them; all the same where that says
/// nothing.
[[nodiscard]] glm::vec3 normalized_weights(const glm::dvec3& values);

struct CutoutTriangle {
  std::array<glm::vec3, 3> corner;  ///< world space, as Surfaces::corners()
  std::array<glm::vec2, 3> texcoord;
  std::array<float, 3> alpha;  ///< of the vertices
  const CutoutPattern* pattern;

  /// At the point with these barycentric weights.
  [[nodiscard]] bool is_hole(const glm::vec3& weight) const;
  /// At a point of its plane, in world space.
  [[nodiscard]] bool is_hole_at(const glm::dvec3& point) const;
};

/// All triangles of a scene that may have holes. Needs neither the scene nor the surfaces once it is made.
class Cutouts {
 public:
  /// Null where there are none. O(triangles), and O(texels) of the textures that cut.
  [[nodiscard]] static std::shared_ptr<Cutouts> of(const Scene& scene,
                                                   const std::vector<PrimitiveId>& first_primitives);

  [[nodiscard]] bool has(PrimitiveId id) const { return words_[id / 64].bits >> (id % 64) & 1; }
  /// Precondition: has(id).
  [[nodiscard]] const CutoutTriangle& operator[](PrimitiveId id) const;
  [[nodiscard]] std::size_t count() const { return triangles_.size(); }
  [[nodiscard]] std::size_t byte_count() const;
  /// Where the triangles of an instance are now, of those that `first` is the first of.
  void move(const Mesh& mesh, const glm::dmat4& world_from_mesh, PrimitiveId first);

 private:
  /// 64 primitives: which of them may have holes, and how many do before them.
  struct Word {
    std::uint64_t bits = 0;
    std::uint32_t before = 0;
  };
  [[nodiscard]] std::size_t place_of(PrimitiveId id) const;  ///< within triangles_
  void add_mesh(const Scene& scene, const Instance& instance, PrimitiveId first);

  std::shared_ptr<std::vector<CutoutPattern>> patterns_;  ///< by material; copies share them
  std::vector<bool> cuts_;                                ///< likewise
  std::vector<Word> words_;
  std::vector<CutoutTriangle> triangles_;
};

}  // namespace frontmost
