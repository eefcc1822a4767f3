// SPDX-License-Identifier: Apache-2.0
// usage: faces_of_models [NAME]
// Compares visible areas of models with 64 samples a pixel, and zooms in on the smallest faces. The models are those of
// FRONTMOST_MODELS whose names contain NAME, the built-in ones and random ones. Each is seen from outside, from within
// and from one of its vertices. The exit status is 0 if nothing is wrong.
//
// Sample counts of a face are wrong along its rim, by up to half a row where an edge runs along a row of samples. Four
// grids a quarter of a step apart show how much the counts themselves vary.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "frontmost/files.h"
#include "frontmost/precision.h"
#include "frontmost/report.h"
#include "support/models.h"
#include "support/random_scene.h"

using namespace frontmost;
using namespace frontmost::test;

namespace {

constexpr int kWidth = 112, kHeight = 84;
constexpr int kAlong = 8;  // 64 samples a pixel
constexpr int kGrids = 4;
constexpr std::uint64_t kLargestFile = 60'000'000;

/// The part of a view's picture from `low` to `high`, in pixels, with width x height samples.
View part_of(const View& view, const glm::dvec2& low, const glm::dvec2& high, int width, int height) {
  View part = view;
  const Projection& q = view.projection;
  const double step_x = (q.right - q.left) / view.width, step_y = (q.top - q.bottom) / view.height;
  part.width = width;
  part.height = height;
  part.projection.left = q.left + low.x * step_x;
  part.projection.right = q.left + high.x * step_x;
  part.projection.top = q.top - low.y * step_y;
  part.projection.bottom = q.top - high.y * step_y;
  return part;
}

/// For each primitive, the number of samples that show it, on each of the grids.
std::vector<std::array<int, kGrids>> counts_of(const Surfaces& surfaces, const View& view) {
  std::vector<std::array<int, kGrids>> counts(surfaces.primitive_count(), std::array<int, kGrids>{});
  for (int grid = 0; grid < kGrids; ++grid) {
    const glm::dvec2 shift = (glm::dvec2(grid % 2, grid / 2) - 0.5) * (0.5 / kAlong);
    const glm::dvec2 size(view.width, view.height);
    const View fine = part_of(view, shift, size + shift, view.width * kAlong, view.height * kAlong);
    for (const PrimitiveId id : find_exact_visible(surfaces, fine).primitives)
      if (id != no_primitive) ++counts[id][std::size_t(grid)];
  }
  return counts;
}

/// Bounds of a triangle on the screen, within the picture; none if it reaches behind the near plane.
std::optional<std::pair<glm::dvec2, glm::dvec2>> screen_box(const Surfaces& surfaces, const View& view,
                                                            PrimitiveId id) {
  glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
  const Projection& q = view.projection;
  for (const glm::vec3& corner : surfaces.corners(id)) {
    const glm::dvec3 d = glm::dvec3(corner) - view.eye();
    const double ahead = glm::dot(view.forward(), d), unit = q.orthographic ? 1 : ahead;
    if (ahead < q.clip.near) return std::nullopt;
    const glm::dvec2 at((glm::dot(view.right(), d) / unit - q.left) * view.width / (q.right - q.left),
                        (q.top - glm::dot(view.up(), d) / unit) * view.height / (q.top - q.bottom));
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  return std::pair(glm::max(low, glm::dvec2(0)), glm::min(high, glm::dvec2(view.width, view.height)));
}

struct Tally {
  std::uint64_t views = 0, faces = 0, wrong_faces = 0, wrong_views = 0, zoomed = 0, too_thin = 0, not_found = 0;
  double worst_total = 0;
};

void compare_areas(const Surfaces& surfaces, const View& view, const std::vector<VisibleFace>& faces, Tally& tally) {
  const auto counts = counts_of(surfaces, view);
  std::vector<double> pixels(counts.size(), 0);
  for (const VisibleFace& face : faces) pixels[face.id] = face.pixels;
  constexpr double sample = 1.0 / (kAlong * kAlong);
  std::array<double, kGrids> noise{};
  double difference = 0, sum = 0, sampled = 0;
  for (PrimitiveId id = 0; id < counts.size(); ++id) {
    const auto [least, most] = std::minmax_element(counts[id].begin(), counts[id].end());
    if (*most == 0 && pixels[id] == 0) continue;
    const double counted = counts[id][0] * sample;
    difference += std::abs(pixels[id] - counted);
    for (std::size_t grid = 0; grid < kGrids; ++grid)
      noise[grid] += std::abs(counts[id][grid] - counts[id][0]) * sample;
    sum += pixels[id];
    sampled += counted;
    const auto box = screen_box(surfaces, view, id);
    const glm::dvec2 size =
        box ? glm::max(box->second - box->first, glm::dvec2(0)) : glm::dvec2(view.width, view.height);
    const double allowed = (size.x + size.y) / kAlong + 4 * sample + 4 * (*most - *least) * sample;
    ++tally.faces;
    if (std::abs(pixels[id] - counted) <= allowed) continue;
    ++tally.wrong_faces;
    std::printf("  face %u: area %.6f, counted %.6f of 64 a pixel\n", id, pixels[id], counted);
  }
  // Counts of two grids differ from each other more than from the truth, unless many edges run along their rows.
  const double most_noise = *std::max_element(noise.begin(), noise.end());
  const bool is_wrong = difference > 1.5 * most_noise + 4;
  tally.wrong_views += is_wrong;
  tally.worst_total = std::max(tally.worst_total, std::abs(sum - sampled) / double(view.pixel_count()));
  if (is_wrong)
    std::printf("  areas differ from counts by %.3f pixels in all, counts from each other by %.3f\n", difference,
                most_noise);
}

/// The smallest faces must appear in a picture that they fill.
void zoom_in(const Surfaces& surfaces, const View& view, std::vector<VisibleFace> faces, Tally& tally) {
  constexpr std::size_t most_faces = 10;
  // Not square, as slivers along a diagonal would then follow a diagonal of samples.
  constexpr int width = 512, height = 389;
  const std::size_t count = std::min(faces.size(), most_faces);
  std::partial_sort(faces.begin(), faces.begin() + std::ptrdiff_t(count), faces.end(),
                    [](const VisibleFace& a, const VisibleFace& b) { return a.pixels < b.pixels; });
  for (std::size_t i = 0; i < count; ++i) {
    const auto box = screen_box(surfaces, view, faces[i].id);
    const glm::dvec2 size = box ? box->second - box->first : glm::dvec2(0);
    const double expected = faces[i].pixels / (size.x * size.y) * width * height;
    // Faces as thin as a sample, or as the steps that vertices are snapped to, may fall between samples.
    if (!(std::min(size.x, size.y) > 1e-6) || !(expected > 400)) {
      ++tally.too_thin;
      continue;
    }
    ++tally.zoomed;
    std::size_t found = 0;
    for (const PrimitiveId id :
         find_exact_visible(surfaces, part_of(view, box->first, box->second, width, height)).primitives)
      found += id == faces[i].id;
    if (std::abs(double(found) - expected) <= 0.5 * expected) continue;
    ++tally.not_found;
    std::printf("  face %u of %.3g pixels: zooming shows %zu samples of %.1f\n", faces[i].id, faces[i].pixels, found,
                expected);
  }
}

View view_from(const glm::dvec3& eye, const Box& bounds, Random& random) {
  View view;
  view.width = kWidth;
  view.height = kHeight;
  view.world_from_eye = look_at(eye, eye + glm::dvec3(random.point(1)) + glm::dvec3(0, 0, 1e-3), {0.1, 1, 0.2});
  const double far = 1.01 * double(bounds.diagonal());
  view.projection = make_projection(glm::radians(90.0), double(kWidth) / kHeight, {far / 10000, far});
  return view;
}

void look_at_model(const std::string& name, Scene scene, Tally& tally) {
  for (Material& material : scene.materials) material.alpha = Material::Alpha::opaque;  // holes count as whole
  const Surfaces surfaces(scene);
  if (surfaces.bounds().is_empty()) return;
  Random random(7);
  const glm::dvec3 low(surfaces.bounds().low), size = glm::dvec3(surfaces.bounds().high) - low;
  const PrimitiveId vertex_of = PrimitiveId(random.next() % surfaces.primitive_count());
  const glm::dvec3 vertex(surfaces.corners(vertex_of)[0]);
  std::printf("%s\n", name.c_str());
  std::vector<View> views{frame(surfaces, kWidth, kHeight)};
  views.push_back(
      view_from(low + glm::dvec3(random.unit(), random.unit(), random.unit()) * size, surfaces.bounds(), random));
  if (is_finite(surfaces.corners(vertex_of)[0])) views.push_back(view_from(vertex, surfaces.bounds(), random));
  for (const View& view : views) {
    ++tally.views;
    const VisibleFaces seen = visible_faces(surfaces, view);
    compare_areas(surfaces, view, seen.faces, tally);
    zoom_in(surfaces, view, seen.faces, tally);
  }
}

}  // namespace

int main(int count, char** arguments) {
  std::setvbuf(stdout, nullptr, _IOLBF, 1 << 12);
  const std::string wanted = count > 1 ? arguments[1] : "";
  Tally tally;
  int models = 0, skipped = 0;
  for (const std::string& name : good_models()) {
    if (name.find(wanted) == std::string::npos) continue;
    if (std::filesystem::file_size(model(name)) > kLargestFile) {
      ++skipped;
      continue;
    }
    ++models;
    look_at_model(name, load(model(name)), tally);
  }
  for (const std::string_view name : builtin_names()) {
    if (std::string(name).find(wanted) == std::string::npos) continue;
    ++models;
    look_at_model(std::string(name), builtin(name), tally);
  }
  for (const Kind kind : all_kinds) {
    const std::string name = "random kind " + std::to_string(int(kind));
    // If triangles are all or nearly coplanar, an exact answer takes microseconds a sample. visible_faces_test.cpp
    // compares those kinds with every triangle less all others.
    if (kind == Kind::coplanar || kind == Kind::sheets || name.find(wanted) == std::string::npos) continue;
    ++models;
    look_at_model(name, scene_of(random_mesh(kind, 400, 1)), tally);
  }
  std::printf(
      "%d models (%d skipped), %llu views, %llu faces: %llu beyond the noise of 64 samples a pixel, %llu views; "
      "the totals differ by at most %.2g of the picture\n%llu smallest faces zoomed in on (%llu too thin): %llu not "
      "found\n",
      models, skipped, (unsigned long long)tally.views, (unsigned long long)tally.faces,
      (unsigned long long)tally.wrong_faces, (unsigned long long)tally.wrong_views, tally.worst_total,
      (unsigned long long)tally.zoomed, (unsigned long long)tally.too_thin, (unsigned long long)tally.not_found);
  return tally.faces > 0 && tally.wrong_faces + tally.wrong_views + tally.not_found == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
