// SPDX-License-Identifier: Apache-2.0
// Samples at which an answer differs from the exact one, by how much, and between which objects.
//
// An answer is wrong where it shows a surface strictly behind the nearest one. Bounds in doubles decide most differing
// samples; where bounds overlap, exact depths decide. Surfaces that are exactly as near are therefore never called
// wrong.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/parallel.h"
#include "frontmost/precision.h"
#include "image/srgb_pixels.h"
#include "report/exact_depth.h"
#include "report/fights/faces_at_risk.h"
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
    if (!is_decided && exact_depth(a, rays_, ray).compare(exact_depth(b, rays_, ray)) <= 0) return 0;
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

/// Calls visit(index, ray) for every sample in a row of a plane; ray() returns the sample's ray.
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

/// Draws all primitives into a depth buffer, those of the remedy's instance with the remedy's offset.
Visible draw(const Surfaces& surfaces, const View& view, const DepthSetup& setup,
             const std::optional<OffsetRemedy>& remedy, const Execution& execution) {
  DepthBuffer buffer(view.width, view.height, view.samples, setup.format);
  buffer.clear(setup.reversed ? 0 : 1);
  DepthDraw call;
  call.state.func = setup.reversed ? DepthFunc::greater : DepthFunc::less;
  call.state.nearer_is_greater = setup.reversed;
  if (!remedy) {
    buffer.draw(surfaces, view, call, execution);
    return std::move(buffer).visible(view);
  }
  const PrimitiveId begin = surfaces.first_primitive(remedy->instance);
  const bool is_last = remedy->instance + 1 == surfaces.scene().instances.size();
  const PrimitiveId end = is_last ? surfaces.primitive_count() : surfaces.first_primitive(remedy->instance + 1);
  const PrimitiveId ends[] = {begin, end, surfaces.primitive_count()};
  PrimitiveId next = 0;
  for (int part = 0; part < 3; ++part) {
    call.begin = std::exchange(next, ends[part]);
    call.end = next;
    call.state.offset = part == 1 ? remedy->offset : PolygonOffset{};
    if (call.begin < call.end) buffer.draw(surfaces, view, call, execution);
  }
  return std::move(buffer).visible(view);
}

View with_clip(View view, const ClipDistances& clip) {
  view.projection.clip = clip;
  return view;
}

/// Near and far planes as close as the faces in the picture allow.
ClipDistances tight_planes(const Surfaces& surfaces, const View& view, const DepthSetup& setup,
                           const Execution& execution) {
  constexpr double kAir = 1e-3;  // margin, as a share of the distance, so that rounding cuts nothing off
  float least = 2, greatest = 0;
  for (const ScreenFace& face : screen_faces(surfaces, view, KeyStep(setup), {}, execution))
    for (const float key : face.record.key) {
      least = std::min(least, key);
      greatest = std::max(greatest, key);
    }
  ClipDistances tight = setup.clip;
  if (least > greatest) return tight;
  const double nearest = depth_of_key(view, greatest), farthest = depth_of_key(view, least);
  const double air = setup.orthographic ? kAir * (farthest - nearest) : 0;
  tight.near = std::max(tight.near, setup.orthographic ? nearest - air : nearest * (1 - kAir));
  tight.far = std::min(tight.far, setup.orthographic ? farthest + air : farthest * (1 + kAir));
  return tight.near < tight.far ? tight : setup.clip;
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
  // The map is ordered and the sort is stable, so pairs with equally many samples are ordered by their objects on every
  // machine.
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

std::vector<FightRemedy> try_remedies(const Surfaces& surfaces, const ExactVisible& exact, const DepthSetup& setup,
                                      const Execution& execution) {
  const IeeeScope ieee;
  const auto wrong_with = [&](const DepthSetup& tried) {
    const View view = with_clip(exact.view, tried.clip);
    return find_depth_fights(surfaces, exact, draw(surfaces, view, tried, {}, execution), execution).wrong;
  };
  DepthSetup tight = setup, finer = setup, floats = setup;
  tight.clip = tight_planes(surfaces, exact.view, setup, execution);
  finer.format = DepthFormat::d24;
  floats.format = DepthFormat::f32;
  floats.reversed = true;
  DepthSetup both = floats;
  both.clip = tight.clip;
  std::vector<FightRemedy> remedies;
  const std::uint64_t now = wrong_with(setup);
  if (now == 0) return remedies;
  const auto is_same = [](const DepthSetup& a, const DepthSetup& b) {
    return a.format == b.format && a.reversed == b.reversed && a.clip.near == b.clip.near && a.clip.far == b.clip.far;
  };
  for (const DepthSetup& tried : {tight, finer, floats, both}) {
    if (is_same(tried, setup) || (tried.format == DepthFormat::d24 && integer_bits(setup.format) == 0)) continue;
    const FightRemedy remedy{tried, wrong_with(tried)};
    if (remedy.wrong < now) remedies.push_back(remedy);
  }
  return remedies;
}

std::optional<OffsetRemedy> find_offset(const Surfaces& surfaces, const ExactVisible& exact, const FightAreas& fights,
                                        const FightingObjects& pair, const Execution& execution) {
  if (pair.kind == FightKind::clear || pair.first == pair.second) return std::nullopt;
  const IeeeScope ieee;
  const auto instance = [&](PrimitiveId id) { return id == no_primitive ? no_index : surfaces.source(id).instance; };
  std::vector<std::uint8_t> is_wanted(exact.primitives.size(), 0);
  for (const FightingFaces& fight : fights.faces) {
    if (fight.kind != pair.kind || instance(fight.first) != pair.first || instance(fight.second) != pair.second)
      continue;
    visit_samples(fights.polygon(fight), fights.view, 1,
                  [&](std::size_t i, int, int, const glm::dvec2&) { is_wanted[i] = 1; });
  }
  std::vector<std::size_t> samples;
  for (std::size_t i = 0; i < is_wanted.size(); ++i) {
    if (!is_wanted[i]) continue;
    const std::uint32_t nearest = instance(exact.primitives[i]);
    if (nearest == pair.first || nearest == pair.second) samples.push_back(i);
  }
  constexpr int kMostDoublings = 16;
  for (int k = 0; k <= kMostDoublings; ++k) {
    OffsetRemedy remedy{pair.second, {}};
    remedy.offset.units = std::ldexp(fights.setup.reversed ? 1.0 : -1.0, k);
    remedy.offset.factor = fights.setup.reversed ? 1 : -1;
    const Visible answer = draw(surfaces, fights.view, fights.setup, remedy, execution);
    const bool ends = std::all_of(samples.begin(), samples.end(),
                                  [&](std::size_t i) { return instance(answer.primitives[i]) == pair.second; });
    if (ends) return remedy;
  }
  return std::nullopt;
}

}  // namespace frontmost
