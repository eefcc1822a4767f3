// SPDX-License-Identifier: Apache-2.0
// Drawings of CAD files beside those of OpenCASCADE's exact hidden-line removal: the length that one has and the other
// lacks. The reference errs where solids pass through each other: it draws rims within a rod, and lacks outlines beside
// a nut. So rays judge where the two differ: a line that the reference has alone counts if it is seen, and a line that
// it lacks counts if it is hidden.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "frontmost/frontmost.h"
#include "io/import/impostor.h"
#include "support/models.h"

namespace frontmost::test {
namespace {

/// A line in world space.
struct Line {
  glm::dvec3 from, to;
};
using Lines = std::vector<Line>;

/// Lines as they are seen from one direction.
class Sketch {
 public:
  Sketch(const Surfaces& surfaces, const glm::dvec3& to_viewer, double slack)
      : surfaces_(surfaces), index_(surfaces), to_viewer_(glm::normalize(to_viewer)), slack_(slack) {}

  /// The line's length as it is seen.
  [[nodiscard]] double length(const Line& line) const { return glm::length(flat(line.to - line.from)); }

  struct Away {
    double all = 0, judged = 0;
  };
  /// The length of `lines` farther than the slack from all `others`; and the part of it whose points rays call seen (or
  /// hidden, by `is_seen`).
  [[nodiscard]] Away away(const Lines& lines, const Lines& others, bool is_seen) const {
    Away sum;
    for (const Line& line : lines) {
      const Lines near = lines_near(line, others);
      const int count = 1 + int(2 * length(line) / slack_);
      for (int i = 0; i < count; ++i) {
        const glm::dvec3 p = line.from + (line.to - line.from) * ((i + 0.5) / count);
        if (std::any_of(near.begin(), near.end(), [&](const Line& other) { return distance(p, other) <= slack_; }))
          continue;
        sum.all += length(line) / count;
        if (this->is_seen(p) == is_seen) sum.judged += length(line) / count;
      }
    }
    return sum;
  }

 private:
  [[nodiscard]] glm::dvec3 flat(const glm::dvec3& v) const { return v - to_viewer_ * glm::dot(v, to_viewer_); }

  [[nodiscard]] double distance(const glm::dvec3& point, const Line& line) const {
    const glm::dvec3 along = flat(line.to - line.from), to_point = flat(point - line.from);
    const double square = glm::dot(along, along);
    const double t = square > 0 ? std::clamp(glm::dot(to_point, along) / square, 0.0, 1.0) : 0;
    return glm::length(to_point - along * t);
  }

  [[nodiscard]] Lines lines_near(const Line& line, const Lines& others) const {
    const glm::dvec3 middle = (line.from + line.to) * 0.5;
    Lines near;
    for (const Line& other : others)
      if (distance(middle, other) <= slack_ + length(line) / 2) near.push_back(other);
    return near;
  }

  /// Whether a ray from somewhere around the point reaches the viewer. The surface at the point does not count.
  [[nodiscard]] bool is_seen(const glm::dvec3& point) const {
    const glm::dvec3 across = glm::normalize(glm::cross(to_viewer_, glm::dvec3(0.3, 0.5, 0.8)));
    const glm::dvec3 other = glm::cross(to_viewer_, across);
    for (const glm::dvec2 by : {glm::dvec2(0, 0), {1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const glm::dvec3 from = point + slack_ * (2.0 * to_viewer_ + by.x * across + by.y * other);
      const Ray ray{glm::vec3(from), glm::vec3(to_viewer_)};
      if (!closest_hit(index_, ray)) return true;
    }
    return false;
  }

  const Surfaces& surfaces_;
  const RayIndex index_;
  const glm::dvec3 to_viewer_;
  const double slack_;
};

struct Reference {
  const char *folder, *model;
};

class CadReference : public testing::TestWithParam<Reference> {};

TEST_P(CadReference, DrawingsEqualExactOnes) {
  FRONTMOST_NEEDS_MODELS();
  constexpr double most = 0.001;
  const Importer importer(FRONTMOST_IMPORT_BUILT);
  const Scene scene = load(model(GetParam().model));
  const Surfaces surfaces(scene);
  // The reference has 24 chords for a circle, which leave the circle by more than our own tolerance.
  const double slack = 0.001 * double(surfaces.bounds().diagonal());
  std::ifstream file(model(std::string("reference/hidden-lines/") + GetParam().folder + "/visible-lines.json"));
  const nlohmann::json reference = nlohmann::json::parse(file);
  for (const nlohmann::json& view_json : reference["views"]) {
    const std::string name = view_json["name"];
    const auto vector = [](const nlohmann::json& json) { return glm::dvec3(json[0], json[1], json[2]); };
    const glm::dvec3 to_viewer = vector(view_json["direction_towards_viewer"]);
    const Drawing drawing =
        draw_lines(surfaces, frame(surfaces, 1000, 1000, {.orthographic = true, .forward = -to_viewer}));
    Lines ours, exact;
    for (const DrawnPart& part : drawing.parts) {
      const DrawnEdge& edge = drawing.edges[part.edge];
      const glm::dvec3 along = edge.to - edge.from;
      if (part.hidden_by == 0) ours.push_back({edge.from + along * part.begin, edge.from + along * part.end});
    }
    double length = 0;
    const Sketch sketch(surfaces, to_viewer, slack);
    for (const nlohmann::json& line : view_json["visible_lines"])
      for (std::size_t i = 1; i < line["points"].size() && line["class"] != "smooth"; ++i) {
        exact.push_back({vector(line["points"][i - 1]), vector(line["points"][i])});
        length += sketch.length(exact.back());
      }
    const Sketch::Away missing = sketch.away(exact, ours, true), extra = sketch.away(ours, exact, false);
    EXPECT_LE(missing.judged, most * length) << name;
    EXPECT_LE(extra.judged, most * length) << name;
    EXPECT_LE(missing.all, 0.01 * length) << name;
    EXPECT_LE(extra.all, 0.01 * length) << name;
    const auto percent = [&](const Sketch::Away& away) {
      return std::to_string(100 * away.judged / length) + " % (without judgement " +
             std::to_string(100 * away.all / length) + " %)";
    };
    std::cout << GetParam().folder << ", " << name << ": " << length << " long; missing " << percent(missing)
              << ", extra " << percent(extra) << "\n";
  }
}

INSTANTIATE_TEST_SUITE_P(Views, CadReference,
                         testing::Values(Reference{"as1", "brep/as1-oc-214.stp"},
                                         Reference{"crank-arm", "brep/CrankArm.brep"}));

}  // namespace
}  // namespace frontmost::test
