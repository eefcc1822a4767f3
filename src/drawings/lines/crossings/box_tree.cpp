// SPDX-License-Identifier: Apache-2.0
// Triangles are sorted once by (class of size, place on D. Hilbert's curve). The tree consists of groups of sixteen of
// them, groups of sixteen groups, and so on: nothing has to be decided while it is built.
//
//    key    | size: 3 bits | place on the curve: 27 bits |
//
// Nine tenths of the triangles are one class. The few larger ones have classes by factors of 4, because one large
// triangle in a group would make the group's box as large as itself. Vertices are scaled by a power of two, which
// rounds nothing, so that products of many lengths stay within the range of floats.
#include "lines/crossings/box_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/parallel.h"
#include "surfaces/hilbert.h"
#include "surfaces/radix_sort.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kPerPart = 4096, kBoxGroupsPerPart = 256;
constexpr int kBitsAnAxis = 9, kKeyBits = 3 + 3 * kBitsAnAxis;
constexpr int kExponents = 160;  // more than floats have

/// Spreads the low 9 bits, with two zeros between neighbours.
std::uint32_t spread(std::uint32_t bits) {
  std::uint32_t out = 0;
  for (int i = 0; i < kBitsAnAxis; ++i) out |= (bits >> i & 1u) << 3 * i;
  return out;
}

Box box_of(const WeldedMesh& mesh, std::size_t triangle) {
  Box box;
  for (int k = 0; k < 3; ++k) box.include(mesh.positions.places()[mesh.triangles[triangle][k]]);
  return box;
}

/// The exponent that std::frexp() gives for the box's longest side, but many times faster. That side is not 0.
int exponent_of(const Box& box) {
  const glm::dvec3 size = glm::dvec3(box.high) - glm::dvec3(box.low);
  const double longest = std::max({size.x, size.y, size.z});
  std::uint64_t bits;
  std::memcpy(&bits, &longest, sizeof bits);
  return std::clamp(int(bits >> 52) - 1022, -kExponents, kExponents - 1);
}

/// Classes of triangles by size.
struct SizeClasses {
  /// By exponent: 0 for nine tenths of all triangles; each class beyond spans a factor of 4.
  std::array<std::uint32_t, 2 * kExponents> of{};
  int usual = 0;  ///< the largest exponent of those nine tenths
};

/// Determined from every sixteenth triangle.
SizeClasses size_classes(const WeldedMesh& mesh, const Execution& execution) {
  const std::size_t asked = (mesh.triangles.size() + 15) / 16;
  Buffer<std::int16_t> exponents(asked);
  parallel_for(execution, asked, kPerPart / 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) exponents[i] = std::int16_t(exponent_of(box_of(mesh, 16 * i)));
  });
  std::array<std::size_t, 2 * kExponents> counts{};
  for (const std::int16_t exponent : exponents) ++counts[std::size_t(exponent + kExponents)];
  SizeClasses classes;
  std::size_t seen = 0;
  std::uint32_t above = 0;
  for (std::size_t e = 0; e < counts.size(); ++e) {
    if (10 * seen >= 9 * asked) ++above;
    if (above == 0) classes.usual = int(e) - kExponents;
    classes.of[e] = std::min(7u, above / 2);
    seen += counts[e];
  }
  return classes;
}

Box bounds_of(const Buffer<glm::vec3>& places, const Execution& execution) {
  std::vector<Box> parts((places.size() + kPerPart - 1) / kPerPart);
  parallel_for(execution, places.size(), kPerPart, [&](std::size_t begin, std::size_t end) {
    Box box;
    for (std::size_t i = begin; i < end; ++i) box.include(places[i]);
    parts[begin / kPerPart] = box;
  });
  Box all;
  for (const Box& box : parts) all.include(box);
  return all;
}

/// Keys on D. Hilbert's curve, 30 bits: the class of size, then the place of the box's middle.
class Curve {
 public:
  Curve(const WeldedMesh& mesh, const Execution& execution) : classes_(size_classes(mesh, execution)) {
    const Box all = bounds_of(mesh.positions.places(), execution);
    low_ = glm::dvec3(all.low);
    const glm::dvec3 extent = glm::dvec3(all.high) - low_;
    scale_ = kSteps / std::max({extent.x, extent.y, extent.z, 1e-300});
    for (std::uint32_t i = 0; i < spread_.size(); ++i) spread_[i] = spread(i);
  }
  [[nodiscard]] std::uint32_t place_of(const Box& box) const {
    const glm::dvec3 at = ((glm::dvec3(box.low) + glm::dvec3(box.high)) * 0.5 - low_) * scale_;
    const auto step = [&](double t) { return spread_[std::size_t(std::clamp(t, 0.0, kSteps))]; };
    const std::uint32_t size = classes_.of[std::size_t(exponent_of(box) + kExponents)];
    return size << 3 * kBitsAnAxis | hilbert_place(step(at.x) | step(at.y) << 1 | step(at.z) << 2, kBitsAnAxis);
  }
  /// A power of two that makes most triangles about 1 in size. The kernels take products of many lengths, and denormal
  /// floats cost hundreds of cycles. The scaling rounds nothing; what becomes infinite is left open by the kernels.
  [[nodiscard]] float scale() const { return std::ldexp(1.0f, std::clamp(-classes_.usual, 0, kMostScale)); }

 private:
  static constexpr double kSteps = (1 << kBitsAnAxis) - 1;
  static constexpr int kMostScale = 60;
  SizeClasses classes_;
  glm::dvec3 low_{0};
  double scale_ = 0;
  std::array<std::uint32_t, 1 << kBitsAnAxis> spread_;
};

}  // namespace

BoxTree::BoxTree(const WeldedMesh& mesh, const Features& features, const Execution& execution)
    : kernels_(space_kernels(execution.isa)), triangles_(mesh.triangles.size() - features.twins.size()) {
  const std::vector<std::uint32_t>& left_out = features.twins;
  const std::size_t count = triangles_.count;
  const Curve curve(mesh, execution);
  Buffer<std::uint64_t> keys(count);
  parallel_for(execution, count, kPerPart, [&](std::size_t begin, std::size_t end) {
    // Index i counts triangles that are not left out; `t` is the triangle's number with those before it added.
    std::size_t t = begin;
    auto next = left_out.begin();
    for (; next != left_out.end() && *next <= t; ++next) ++t;
    for (std::size_t i = begin; i < end; ++i, ++t) {
      for (; next != left_out.end() && *next == t; ++next) ++t;
      keys[i] = std::uint64_t(curve.place_of(box_of(mesh, t))) << 32 | t;
    }
  });
  keys = radix_sort(std::move(keys), kKeyBits, execution);
  const float scale = curve.scale();
  const bool knows_spread = !features.is_spread.empty();
  levels_.emplace_back(group_count());
  parallel_for(execution, group_count(), kBoxGroupsPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t group = begin; group < end; ++group) {
      Box box;
      for (std::size_t i = group * kSpaceLanes; i < (group + 1) * kSpaceLanes; ++i) {
        const auto number = std::uint32_t(keys[std::min(i, count - 1)]);
        triangles_.numbers[i] = number;
        for (int k = 0; k < 3; ++k) {
          const std::uint32_t vertex = (&mesh.triangles[number].x)[k];
          const glm::vec3 corner = mesh.positions.places()[vertex] * scale;
          triangles_.vertices[k][i] = knows_spread && features.is_spread[vertex] ? vertex : vertex | kNotSpread;
          triangles_.corners[3 * k][i] = corner.x;
          triangles_.corners[3 * k + 1][i] = corner.y;
          triangles_.corners[3 * k + 2][i] = corner.z;
          box.include(corner);
        }
      }
      levels_[0].set(group, box);
    }
  });
  while (levels_.back().group_count() > 1) {
    const SpaceBoxes& below = levels_.back();
    SpaceBoxes level(below.group_count());
    for (std::size_t group = 0; group < below.group_count(); ++group) {
      Box box;
      for (std::size_t i = 0; i < kSpaceLanes; ++i) box.include(below.get(group * kSpaceLanes + i));
      level.set(group, box);
    }
    levels_.push_back(std::move(level));
  }
}

}  // namespace frontmost::lines_detail
