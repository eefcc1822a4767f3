// SPDX-License-Identifier: Apache-2.0
// The subject of a picture of a scene, by objects.
//
//   . .:. .   . . . . gap . . . .                         Objects by how far they reach from the middle. Objects behind
//   |subject|                    | ground |   | sky |       the first gap are left out, if little interest lies beyond
//   0       r                    at least 8 r     reach ->  it.
//
// Interest is the fourth root of the number of triangles: many plain objects outweigh one fine mesh, and a fine mesh a
// few plain ones. With the number itself, a sphere around a village would be the subject.
//
// An object with more than half of the interest holds the weighted median on each axis. So the middle lies among the
// objects that matter, however far away the others are, and distance from the middle separates them. The size of all
// objects together, or their mean, would mostly depend on how far the lost objects are.

#include <algorithm>
#include <array>
#include <cmath>

#include "frontmost/view.h"

namespace frontmost {
namespace {

constexpr double gap = 8;
constexpr double least_share = 0.6;

double interest_of(const Scene& scene, std::size_t instance) {
  return std::sqrt(std::sqrt(double(scene.meshes[scene.instances[instance].mesh].triangles.size())));
}

/// A place on an axis, and its weight.
struct Weighted {
  double place, weight;
};

/// The least place up to which at least half of the weight lies. Halves that cannot hold it are dropped: O(places).
double median(std::vector<Weighted> places) {
  double half = 0, below = 0;
  for (const Weighted& one : places) half += one.weight / 2;
  auto begin = places.begin(), end = places.end();
  while (end - begin > 1) {
    const auto middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, [](const Weighted& a, const Weighted& b) { return a.place < b.place; });
    double weight = 0;
    for (auto one = begin; one != middle; ++one) weight += one->weight;
    if (below + weight >= half) {
      end = middle;
    } else {
      below += weight;
      begin = middle;
    }
  }
  return begin->place;
}

/// The middle of the objects; a sample stands for very many objects.
glm::dvec3 middle_of(const Surfaces& surfaces) {
  constexpr std::size_t enough = 4096;
  const Scene& scene = surfaces.scene();
  const std::size_t step = scene.instances.size() / enough + 1;
  std::vector<Weighted> places[3];
  for (std::size_t i = 0; i < scene.instances.size(); i += step) {
    const Box& box = surfaces.bounds(std::uint32_t(i));
    if (box.is_empty()) continue;
    const glm::dvec3 twice = glm::dvec3(box.low) + glm::dvec3(box.high);
    for (int axis = 0; axis < 3; ++axis) places[axis].push_back({twice[axis] / 2, interest_of(scene, i)});
  }
  if (places[0].empty()) return glm::dvec3(0);
  return {median(std::move(places[0])), median(std::move(places[1])), median(std::move(places[2]))};
}

double reach_of(const Box& box, const glm::dvec3& middle) {
  return glm::length(glm::max(glm::abs(glm::dvec3(box.low) - middle), glm::abs(glm::dvec3(box.high) - middle)));
}

/// Objects that reach within a factor of two.
struct Octave {
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0, interest = 0;
};

/// Octaves by the exponents of all possible distances of floats, in order. A gap lies between octaves, so nothing needs
/// to be sorted.
class Octaves {
 public:
  void include(double reach, double interest) {
    Octave& octave = octaves_[std::size_t(reach > 0 ? std::clamp(std::ilogb(reach), lowest + 1, highest) - lowest : 0)];
    octave.nearest = std::min(octave.nearest, reach);
    octave.farthest = std::max(octave.farthest, reach);
    octave.interest += interest;
    whole_ += interest;
  }
  /// How far the subject reaches; infinite if the subject is everything.
  [[nodiscard]] double reach_of_subject() const {
    double within = 0, reach = 0;
    for (const Octave& octave : octaves_) {
      if (octave.interest == 0) continue;
      if (reach > 0 && octave.nearest >= gap * reach && within >= least_share * whole_) return reach;
      within += octave.interest;
      reach = octave.farthest;
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  static constexpr int lowest = -152, highest = 152;
  std::array<Octave, std::size_t(highest - lowest + 1)> octaves_;
  double whole_ = 0;
};

}  // namespace

Subject find_subject(const Surfaces& surfaces) {
  Subject subject{surfaces.bounds(), {}};
  const Scene& scene = surfaces.scene();
  const auto count = std::uint32_t(scene.instances.size());
  if (count < 2) return subject;
  const glm::dvec3 middle = middle_of(surfaces);
  Octaves octaves;
  for (std::uint32_t i = 0; i < count; ++i)
    if (const Box& box = surfaces.bounds(i); !box.is_empty())
      octaves.include(reach_of(box, middle), interest_of(scene, i));
  const double reach = octaves.reach_of_subject();
  if (reach == std::numeric_limits<double>::infinity()) return subject;
  subject.bounds = {};
  for (std::uint32_t i = 0; i < count; ++i) {
    const Box& box = surfaces.bounds(i);
    if (box.is_empty()) continue;
    if (reach_of(box, middle) <= reach)
      subject.bounds.include(box);
    else
      subject.left_out.push_back(i);
  }
  return subject;
}

}  // namespace frontmost
