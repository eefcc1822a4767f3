// SPDX-License-Identifier: Apache-2.0
// Samples at which an answer differs from the exact one, by how much, and between which objects.
//
// An answer is wrong where it shows a surface strictly behind the nearest one. Bounds in doubles decide most differing
// samples; where bounds overlap, exact depths decide. Surfaces that are exactly as near are therefore never called
// wrong.
#include <algorithm>
#include <cmath>
#include <map>

#include "base/parallel.h"
#include "frontmost/precision.h"
#include "image/srgb_pixels.h"
#include "report/exact_depth.h"
#include "view/answer.h"

namespace frontmost {
namespace {

constexpr float kNothingSeen = std::numeric_limits<float>::infinity();

double middle(const DepthBounds& bounds) { return 0.5 * (bounds.low + bounds.high); }

class Judge {
 public:
  Judge(const Surfaces& surfaces, const View& view) : surfaces_(surfaces), rays_(view) {}

  /// The error of showing `seen` where `nearest` is, as in DepthFights::errors; never 0 if the answer is wrong.
  [[nodiscard]] float error(PrimitiveId seen, PrimitiveId nearest, const SampleRay& ray) const {
    if (seen == nearest) return 0;
    if (seen == no_primitive || nearest == no_primitive) return kNothingSeen;
    const auto a = surfaces_.corners(seen), b = surfaces_.corners(nearest);
    const DepthBounds at_seen = BoundedPlane(a, rays_).at(ray), at_nearest = BoundedPlane(b, rays_).at(ray);
    // Exact numbers cost far more than bounds, so they decide only what bounds leave open.
    const bool is_decided = at_seen.low > at_nearest.high;
    if (!is_decided && compare(ExactDepth(a, rays_, ray), ExactDepth(b, rays_, ray)) <= 0) return 0;
    const double behind = middle(at_seen) - middle(at_nearest);
    // In orthographic views, depths may be 0.
    const auto share = float(behind / std::max(std::abs(middle(at_nearest)), 1e-300));
    return std::max(share, std::numeric_limits<float>::min());
  }
  [[nodiscard]] const SampleRays& rays() const { return rays_; }
  [[nodiscard]] double distance(PrimitiveId id, const SampleRay& ray) const {
    return middle(BoundedPlane(surfaces_.corners(id), rays_).at(ray));
  }

 private:
  const Surfaces& surfaces_;
  SampleRays rays_;
};

/// Visits (index, ray) of every sample in a row of a plane.
template <class Visit>
void for_each_sample(const View& view, const SampleRays& rays, std::size_t row, const Visit& visit) {
  const auto height = std::size_t(view.height), width = std::size_t(view.width);
  // Planes of samples follow each other in memory, and row numbers run through all of them.
  const glm::ivec2 offset = sample_offsets(view.samples)[row / height];
  for (std::size_t x = 0; x < width; ++x)
    visit(row * width + x, [&, x] { return rays.at(int(x), int(row % height), offset); });
}

void check_views(const ExactVisible& exact, const Visible& answer) {
  const View &a = exact.view, &b = answer.view;
  if (a.width != b.width || a.height != b.height || a.samples != b.samples || a.world_from_eye != b.world_from_eye ||
      exact.primitives.size() != a.sample_count() || exact.tied.size() != a.sample_count())
    throw Error(ErrorCode::bad_argument, "depth fights",
                "the two results were made for different views; both must have the same view");
}

glm::vec3 heat(float share) {
  constexpr glm::vec3 kStops[] = {{0.25f, 0.02f, 0.45f}, {0.75f, 0.03f, 0.20f}, {1.0f, 0.25f, 0.02f}, {1, 0.85f, 0.2f}};
  const float at = std::clamp((std::log10(share) + 6) / 5, 0.0f, 1.0f) * 3;
  const int i = std::min(int(at), 2);
  return glm::mix(kStops[i], kStops[i + 1], at - float(i));
}

}  // namespace

DepthFights find_depth_fights(const Surfaces& surfaces, const ExactVisible& exact, const Visible& answer,
                              const Execution& execution) {
  check_views(exact, answer);
  check_answer(answer, surfaces.primitive_count(), "depth fights", execution);
  check_ids({exact.primitives.data(), exact.primitives.size()}, surfaces.primitive_count(), "depth fights", execution);
  const IeeeScope ieee;
  const View& view = exact.view;
  DepthFights fights;
  fights.view = view;
  fights.errors = Buffer<float>(exact.primitives.size());
  const Judge judge(surfaces, view);
  const std::size_t rows = std::size_t(view.height) * std::size_t(view.samples);
  parallel_for(execution, rows, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for_each_sample(view, judge.rays(), row, [&](std::size_t i, const auto& ray) {
        const PrimitiveId seen = answer.primitives[i], nearest = exact.primitives[i];
        fights.errors[i] = seen == nearest ? 0.0f : judge.error(seen, nearest, ray());
      });
  });

  // One thread suffices: wrong samples are rare, and all others only take a look at an array.
  std::map<std::pair<std::uint32_t, std::uint32_t>, FightingPair> pairs;
  const auto object = [&](PrimitiveId id) { return id == no_primitive ? no_index : surfaces.source(id).instance; };
  for (std::size_t row = 0; row < rows; ++row)
    for_each_sample(view, judge.rays(), row, [&](std::size_t i, const auto& ray) {
      const PrimitiveId nearest = exact.primitives[i];
      fights.covered += nearest != no_primitive;
      fights.tied += exact.tied[i];
      if (fights.errors[i] == 0) return;
      ++fights.wrong;
      const std::uint32_t seen = object(answer.primitives[i]), nearer = object(nearest);
      FightingPair& pair = pairs[{seen, nearer}];
      pair.seen = seen;
      pair.nearer = nearer;
      ++pair.samples;
      if (seen == no_index || nearer == no_index) return;
      pair.farthest = std::max(pair.farthest, double(fights.errors[i]) * judge.distance(nearest, ray()));
    });
  // From a map by a stable sort: pairs with equally many samples are ordered by their objects, on every machine.
  for (const auto& [key, pair] : pairs) fights.pairs.push_back(pair);
  std::stable_sort(fights.pairs.begin(), fights.pairs.end(),
                   [](const FightingPair& a, const FightingPair& b) { return a.samples > b.samples; });
  return fights;
}

Image fight_image(const DepthFights& fights, const Image& backdrop) {
  validate(backdrop);
  const std::optional<ColorPlanes> planes = color_planes(backdrop);
  if (backdrop.width != fights.view.width || backdrop.height != fights.view.height || !planes)
    throw Error(ErrorCode::bad_argument, "fight image", "the backdrop must be a picture of the same size");
  const std::size_t count = fights.view.pixel_count();
  Image image{backdrop.width, backdrop.height, {}};
  for (const char* name : {"R", "G", "B", "A"}) image.channels.push_back({name, Buffer<float>(count, 1.0f)});
  for (std::size_t i = 0; i < count; ++i) {
    const float grey = 0.2126f * planes->color[0][i] + 0.7152f * planes->color[1][i] + 0.0722f * planes->color[2][i];
    glm::vec3 color(0.02f + 0.12f * grey);
    if (fights.errors[i] == kNothingSeen)
      color = {0.25f, 0.75f, 1.0f};
    else if (fights.errors[i] > 0)
      color = heat(fights.errors[i]);
    for (std::size_t c = 0; c < 3; ++c) image.channels[c].floats()[i] = color[int(c)];
  }
  return image;
}

}  // namespace frontmost
