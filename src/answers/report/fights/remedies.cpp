// SPDX-License-Identifier: Apache-2.0
// Remedies for depth fights, tried out by drawing.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "frontmost/precision.h"
#include "report/fights/convex_area.h"
#include "report/fights/screen_faces.h"

namespace frontmost {
namespace {

/// Draws ranges of primitives, with an offset for one of them.
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
  constexpr double kAir = 1e-3;  // share of the distance, so that rounding cuts nothing off
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
