// SPDX-License-Identifier: Apache-2.0
// Shadows by rays: as sharp as the samples are dense, and exact for lights at infinite distance.
//
// The rule at the terminator: a flat triangle that faces away from the light is in its own shadow, whatever its
// material's normals say. A triangle with smooth normals never shadows itself, and its points start on the curved
// surface that the normals suggest, so that facets do not show.
//
// Segments to a lamp end beside the surface on the lamp's side, at a hundred-thousandth of their length and the
// rounding error of floats. So no surface casts a shadow on its own points.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/work_limit.h"
#include "frontmost/raycast.h"
#include "shade/batch.h"
#include "shade/geometry/triangle_setup.h"
#include "shade/light/lamps.h"

namespace frontmost::shading {

/// The fragments whose shadow is asked for.
struct AskedFragments {
  const std::vector<TriangleSetup>& setups;
  const bool* is_asked;
  FragmentBatch& batch;  ///< its `shadow` is filled
};

class RayShadows {
 public:
  /// The most rays of a picture, and the message of the error if there are more.
  struct Limit {
    std::uint64_t most;
    std::string error;
  };

  /// Borrows all but the limit. The index holds the casters; `samples` of a pixel are in 1/256 of it. `view` is that of
  /// the picture, or a pinhole if the picture is a scan.
  RayShadows(const RayIndex& index, std::span<const glm::ivec2> samples, const View& view, const Execution& execution,
             Limit limit);

  /// Call if the index has other ids than the shaded surfaces. Triangles are then identified by corners, which is
  /// slower.
  void forget_ids() { knows_ids_ = false; }

  /// Treats fragments as single points, not as pixels.
  void ask_at_points() { at_points_ = true; }

  /// Fills batch.shadow of the asked fragments: the share of each fragment's samples that the light reaches.
  /// \throws Error limit_exceeded.
  void find_light(const DirectLight& light, const AskedFragments& asked) const;
  void find_light(const Lamp& lamp, const AskedFragments& asked) const;

 private:
  class LightQuestions;
  class LampQuestions;

  /// Calls questions.add(point, fragment) for every sample of fragments whose triangle `may_face` the light.
  template <class Questions, class MayFace>
  void ask(Questions& questions, const MayFace& may_face, const AskedFragments& asked) const;

  void count(std::size_t rays) const {
    rays_.add(rays, [this] { return too_many_; });
  }
  /// Counts triangles that needed exact decisions. A few for each ray are usual and do not count.
  void count_decided(std::uint64_t triangles, std::size_t rays) const {
    const std::uint64_t usual = kUsualOfRay * rays;
    if (triangles <= usual) return;
    crowd_.add(triangles - usual, [this] {
      return "too many of " + std::to_string(index_.triangle_count()) +
             " triangles lie over each other for shadows by rays; ask for shadows by maps";
    });
  }

  const RayIndex& index_;
  glm::dvec3 eye_;
  bool is_one_way_;  ///< one-sided triangles let light through from behind
  Isa isa_;
  bool knows_ids_ = true, at_points_ = false;
  std::span<const glm::ivec2> samples_;
  static constexpr std::uint64_t kMostOfCrowd = std::uint64_t(1) << 24, kMostOfTriangle = 64, kUsualOfRay = 4;
  mutable WorkLimit rays_, crowd_;
  std::string too_many_;
};

}  // namespace frontmost::shading
