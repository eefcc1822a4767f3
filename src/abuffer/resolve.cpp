// SPDX-License-Identifier: Apache-2.0
#include "abuffer/composite/composite_kernel.h"
#include "abuffer/options.h"
#include "abuffer/visit_tiles.h"
#include "base/float_environment.h"

namespace frontmost {
namespace {

using namespace abuffer_detail;

// Colours are looked up by 32-bit offsets.
constexpr std::size_t kMostColors = (std::size_t(1) << 29) - 1;
// Bytes of a picture that would drive everything else out of the caches.
constexpr std::size_t kStreamFrom = std::size_t(4) << 20;

void check_colors(const Surfaces& surfaces, std::span<const glm::vec4> colors) {
  if (colors.size() != surfaces.primitive_count())
    throw Error(ErrorCode::bad_argument, "resolve: colors: " + std::to_string(colors.size()) + " for " +
                                             std::to_string(surfaces.primitive_count()) + " primitives");
  if (colors.size() > kMostColors) throw Error(ErrorCode::limit_exceeded, "resolve: colors: more than 2^29 - 1");
}

void clear(const Rectangle& r, const PicturePlanes& out) {
  for (float* plane : {out.red, out.green, out.blue, out.alpha})
    for (int y = r.y; y < r.y + r.height; ++y)
      std::fill_n(plane + std::size_t(y) * std::size_t(out.width) + std::size_t(r.x), r.width, 0.0f);
}

}  // namespace

struct Resolver::State {
  FragmentPlan plan;
  Pool<GatherScratch> scratches;
  ResolvedPicture picture;
  /// By tile: nothing is seen in it, and its pixels say so. Such tiles need not be cleared again.
  std::vector<std::uint8_t> blank;

  void prepare(const View& view);
};

void Resolver::State::prepare(const View& view) {
  if (picture.width == view.width && picture.height == view.height) return;
  const std::size_t pixels = view.pixel_count();
  picture = {};  // whatever fails for want of memory below, the next call begins here again
  blank.assign(plan.tile_count(), 0);
  picture = {view.width,           view.height, Buffer<float>(pixels), Buffer<float>(pixels), Buffer<float>(pixels),
             Buffer<float>(pixels)};
}

Resolver::Resolver() : state_(std::make_unique<State>()) {}
Resolver::~Resolver() = default;
Resolver::Resolver(Resolver&&) noexcept = default;
Resolver& Resolver::operator=(Resolver&&) noexcept = default;

const ResolvedPicture& Resolver::draw(const Surfaces& surfaces, const View& view, std::span<const glm::vec4> colors,
                                      const AbufferOptions& options, const Execution& execution) {
  validate(view);
  validate(options);
  check_colors(surfaces, colors);
  const IeeeScope ieee;
  const SamplePattern pattern = sample_pattern(view, options.grid);
  State& state = *state_;
  state.plan.make(surfaces, view, execution);
  state.prepare(view);
  // Holes are taken out of masks, which flat frames do not have.
  const bool has_holes = surfaces.placed().cutouts != nullptr;
  const CopyRule copies{[&](PrimitiveId id) { return colors[id].a * options.opacity >= 1.0f; }};
  const GatherInput frame{state.plan, pattern, pattern.count == 1 && !has_holes, execution.isa, copies, colors.data()};
  ResolvedPicture& picture = state.picture;
  const bool streams = view.pixel_count() * 4 * sizeof(float) >= kStreamFrom;
  const PicturePlanes out{
      picture.red.data(), picture.green.data(), picture.blue.data(), picture.alpha.data(), view.width, 0, 0, streams};
  const FragmentColors paint{colors.data(), false, options.opacity};
  visit_tiles(frame, state.scratches, execution, [&](const GatherJob& job, GatherScratch* scratch) {
    std::uint8_t& blank = state.blank[job.tile];
    if (scratch) {
      blank = 0;
      composite_tile(frame, job, *scratch, paint, out);
    } else if (!blank) {
      clear(job.pixels, out);
      // Of a tile in parts every part is looked at anew.
      const Rectangle whole = frame.plan.tile(job.tile);
      blank = job.pixels.width == whole.width && job.pixels.height == whole.height;
    }
  });
  return picture;
}

ResolvedPicture Resolver::take() {
  State& state = *state_;
  ResolvedPicture picture = std::move(state.picture);
  state.picture = {};
  return picture;
}

ResolvedPicture resolve(const Surfaces& surfaces, const View& view, std::span<const glm::vec4> colors,
                        const AbufferOptions& options, const Execution& execution) {
  Resolver resolver;
  resolver.draw(surfaces, view, colors, options, execution);
  return resolver.take();
}

}  // namespace frontmost
