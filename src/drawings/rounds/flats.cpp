// SPDX-License-Identifier: Apache-2.0
// Hexagons and squares of plane faces, as of nuts and heads of bolts:
//
//      .----.      From a face, an edge along the axis leads to the next face, which is turned by 60 or 90 degrees.
//      After
//     /      .     six or four faces the walk is back. The polygon is regular if all opposite faces have one distance
//     and .      /     all faces one distance from the axis. Chamfers at the ends of a nut leave these edges.
//      '----'
#include <algorithm>

#include "base/parallel.h"
#include "rounds/found_rounds.h"

namespace frontmost::lines_detail {
namespace {

constexpr double kSamePlane = 0.999998;                            // cosine of 0.11 degrees
constexpr double kSameTurn = 4e-3;                                 // greatest error of a cosine
constexpr double kAlong = 0.999;                                   // least cosine between an edge and the axis
constexpr double kRegular = 1e-3;                                  // tolerance, as a share of the width
constexpr std::size_t kMostTriangles = 1024, kMostNeighbours = 8;  // of a face
constexpr double kWidestRound = 0.75;  // in widths: radius of a round about the axis of a square

class FlatsFinder {
 public:
  FlatsFinder(const SmoothMesh& mesh, std::span<const Round> rounds, const Execution& execution)
      : mesh_(mesh), face_of_(mesh.mesh.triangles.size(), no_index) {
    for (const Round& round : rounds) rounds_.emplace_back(AxisKey(round.from, round.axis, 0, 0).key, &round);
    std::sort(rounds_.begin(), rounds_.end());
    for (std::uint32_t t = 0; t < face_of_.size(); ++t) {
      if (t % 4096 == 0) check_cancelled(execution);
      if (face_of_[t] == no_index) add_face(t);
    }
    first_.push_back(std::uint32_t(triangles_.size()));
    is_used_.resize(first_.size() - 1);
  }

  [[nodiscard]] std::vector<FoundFlats> run(const Execution& execution) {
    std::vector<FoundFlats> found;
    for (std::uint32_t face = 0; face < is_used_.size(); ++face) {
      if (face % 256 == 0) check_cancelled(execution);
      if (is_used_[face] || triangles_of(face).size() > kMostTriangles) continue;
      for (const std::uint32_t other : neighbours_of(face)) {
        const glm::dvec3 axis = glm::normalize(glm::cross(normal(face), normal(other)));
        auto flats = flats_about(axis, face, sides_between(face, other));
        if (!flats) continue;
        found.push_back(std::move(*flats));
        break;
      }
    }
    return found;
  }

 private:
  [[nodiscard]] std::span<const std::uint32_t> triangles_of(std::uint32_t face) const {
    return std::span(triangles_).subspan(first_[face], first_[face + 1] - first_[face]);
  }
  [[nodiscard]] const glm::dvec3& normal(std::uint32_t face) const { return mesh_.normals[triangles_[first_[face]]]; }

  /// The number of sides of the regular polygon that two neighbouring faces may belong to; 0 if there is none.
  [[nodiscard]] std::uint32_t sides_between(std::uint32_t face, std::uint32_t other) const {
    const glm::dvec3 &a = normal(face), &b = normal(other);
    if (a == glm::dvec3(0) || b == glm::dvec3(0)) return 0;
    const double cosine = glm::dot(a, b);
    return std::abs(cosine - 0.5) <= kSameTurn ? 6 : std::abs(cosine) <= kSameTurn ? 4 : 0;
  }

  /// The faces that meet a face at 60 or 90 degrees, each once; at most 8, those with the longest shared edges.
  [[nodiscard]] std::vector<std::uint32_t> neighbours_of(std::uint32_t face) const {
    std::vector<std::pair<std::uint32_t, double>> shared;  // neighbours and lengths of edges
    for (const std::uint32_t t : triangles_of(face))
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t other = mesh_.across(t, k);
        if (other == no_index || face_of_[other] == face || sides_between(face, face_of_[other]) == 0) continue;
        shared.emplace_back(face_of_[other], glm::distance(mesh_.corner(t, k), mesh_.corner(t, (k + 1) % 3)));
      }
    std::sort(shared.begin(), shared.end());
    std::size_t count = 0;
    for (const auto& [other, length] : shared)
      if (count > 0 && shared[count - 1].first == other)
        shared[count - 1].second += length;
      else
        shared[count++] = {other, length};
    shared.resize(count);
    std::stable_sort(shared.begin(), shared.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    std::vector<std::uint32_t> neighbours;
    for (std::size_t i = 0; i < std::min(count, kMostNeighbours); ++i) neighbours.push_back(shared[i].first);
    return neighbours;
  }

  void add_face(std::uint32_t seed) {
    const auto face = std::uint32_t(first_.size());
    first_.push_back(std::uint32_t(triangles_.size()));
    face_of_[seed] = face;
    triangles_.push_back(seed);
    for (std::size_t i = first_.back(); i < triangles_.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t next = mesh_.across(triangles_[i], k);
        if (next == no_index || face_of_[next] != no_index) continue;
        if (glm::dot(mesh_.normals[next], mesh_.normals[seed]) < kSamePlane) continue;
        face_of_[next] = face;
        triangles_.push_back(next);
      }
  }

  /// The face beyond an edge along the axis that has the wanted normal; no_index if there is none.
  [[nodiscard]] std::uint32_t next_face(std::uint32_t face, const glm::dvec3& axis, const glm::dvec3& wanted) const {
    for (const std::uint32_t t : triangles_of(face))
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t other = mesh_.across(t, k);
        if (other == no_index || face_of_[other] == face) continue;
        if (glm::dot(mesh_.normals[other], wanted) < 1 - kSameTurn * kSameTurn) continue;
        const glm::dvec3 edge = mesh_.corner(t, (k + 1) % 3) - mesh_.corner(t, k);
        if (std::abs(glm::dot(unit_of(edge), axis)) >= kAlong) return face_of_[other];
      }
    return no_index;
  }

  /// The flats of which `first` is the first face in the order of faces. Other walks around them find nothing, so each
  /// polygon is looked at once.
  [[nodiscard]] std::optional<FoundFlats> flats_about(const glm::dvec3& axis, std::uint32_t first,
                                                      std::uint32_t sides) {
    const double cosine = sides == 6 ? 0.5 : 0, sine = std::sqrt(1 - cosine * cosine);
    std::vector<std::uint32_t> faces{first};
    while (faces.size() <= sides) {
      const glm::dvec3& n = normal(faces.back());
      const std::uint32_t next = next_face(faces.back(), axis, cosine * n + sine * glm::cross(axis, n));
      if (next == no_index || next < first || is_used_[next] || triangles_of(next).size() > kMostTriangles)
        return std::nullopt;
      faces.push_back(next);
    }
    if (faces.back() != first) return std::nullopt;
    faces.pop_back();
    const glm::dvec3 origin = mesh_.corner(triangles_of(first)[0], 0);
    std::vector<double> offsets;  // of the faces' planes from the origin
    for (const std::uint32_t face : faces)
      offsets.push_back(glm::dot(normal(face), mesh_.corner(triangles_of(face)[0], 0) - origin));
    const double width = offsets[0] + offsets[sides / 2];
    const double slack = std::max(8 * mesh_.noise, kRegular * std::abs(width));
    if (!(std::abs(width) > 4 * slack)) return std::nullopt;
    // The point of the axis, alpha * n0 + beta * n1, lies half a width behind the first two planes.
    const double a = offsets[0] - width / 2, b = offsets[1] - width / 2, det = 1 - cosine * cosine;
    const glm::dvec3 middle = (a - cosine * b) / det * normal(faces[0]) + (b - cosine * a) / det * normal(faces[1]);
    for (std::size_t i = 0; i < sides; ++i)
      if (std::abs(offsets[i] - width / 2 - glm::dot(normal(faces[i]), middle)) > slack) return std::nullopt;
    FoundFlats found{{}, {}};
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const std::uint32_t face : faces)
      for (const std::uint32_t t : triangles_of(face)) {
        found.triangles.push_back(t);
        for (int k = 0; k < 3; ++k) {
          const double height = glm::dot(mesh_.corner(t, k) - origin, axis);
          low = std::min(low, height);
          high = std::max(high, height);
        }
      }
    const glm::dvec3 centre = origin + middle - glm::dot(middle, axis) * axis;
    found.flats = {centre + low * axis, centre + high * axis, normal(first), std::abs(width), sides};
    if (sides == 4 && (width < 0 || !is_about_a_round(found.flats, axis, slack))) return std::nullopt;
    for (const std::uint32_t face : faces) is_used_[face] = true;
    return found;
  }

  /// Whether a round about this axis begins or ends at most a width from the flats.
  [[nodiscard]] bool is_about_a_round(const Flats& flats, const glm::dvec3& axis, double slack) const {
    const Tube tube{flats.from, axis, flats.width / 2};
    const double height = glm::distance(flats.from, flats.to);
    const AxisKey near(flats.from, axis, slack, 2 * kSameTurn);
    auto each = std::lower_bound(rounds_.begin(), rounds_.end(), near.key - near.slack,
                                 [](const auto& known, double key) { return known.first < key; });
    for (; each != rounds_.end() && each->first <= near.key + near.slack; ++each) {
      const Round& round = *each->second;
      const double from = glm::dot(round.from - flats.from, axis), to = glm::dot(round.to - flats.from, axis);
      if (round.radius <= kWidestRound * flats.width && glm::length(glm::cross(round.axis, axis)) <= kSameTurn &&
          glm::length(tube.outwards(round.from)) <= slack && std::max(from, to) >= -flats.width &&
          std::min(from, to) <= height + flats.width)
        return true;
    }
    return false;
  }

  const SmoothMesh& mesh_;
  std::vector<std::pair<double, const Round*>> rounds_;  ///< ascending by the keys of their axes
  std::vector<std::uint32_t> face_of_;                   ///< by triangle
  std::vector<std::uint32_t> triangles_;                 ///< face by face
  std::vector<std::uint32_t> first_;                     ///< by face, with one more at the end
  std::vector<bool> is_used_;                            ///< by face
};

}  // namespace

std::vector<FoundFlats> find_flats(const SmoothMesh& mesh, std::span<const Round> rounds, const Execution& execution) {
  return FlatsFinder(mesh, rounds, execution).run(execution);
}

}  // namespace frontmost::lines_detail
