// SPDX-License-Identifier: Apache-2.0
// Why each object is seen, or is not, and what would show it.
//
//   Accounting --samples have the last word--> seen, hidden --probes--> what to take away
//   Surfaces ----places of triangles---------> the others ---remedy--> what to change in the view
//
// Objects in front of a hidden object are found at a few samples of it, the probes:
//
//    eye  ------ A ------ B -----[hidden]----- C        A and B have to be removed for this sample, C does not
//
// The front-most object is not enough: without A the same sample may see B. All triangles are therefore placed once
// more, as in the z-buffer, and tested at these samples alone.
#include <algorithm>
#include <bit>
#include <span>

#include "base/parallel.h"
#include "base/pool.h"
#include "frontmost/report.h"
#include "frontmost/zbuffer.h"
#include "geometry/buckets.h"
#include "report/accounting/object_mask.h"
#include "report/why/places.h"
#include "view/answer.h"

namespace frontmost {

using namespace why_detail;

namespace {

using namespace accounting_detail;
using namespace zbuffer_detail;

/// A sample that an object covers.
struct SampleProbe {
  std::uint32_t object;
  int x, y, sample;
};

constexpr std::uint64_t kProbesOfObject = 4;

/// Adds samples of a mask, at even steps between the first marked sample and the last.
void choose_marked(const ObjectMask& mask, std::uint32_t object, std::vector<SampleProbe>& probes) {
  const PixelRect& rect = mask.touched();
  const auto visit_words = [&](const auto& visit) {
    for (const MaskPlane& plane : mask.planes())
      for (int y = rect.y0; y <= rect.y1; ++y)
        for (int word = rect.x0 / kWordPixels; word <= rect.x1 / kWordPixels; ++word)
          if (const std::uint64_t bits = plane.row(y)[word]) visit(plane, y, word * kWordPixels, bits);
  };
  std::uint64_t total = 0;
  visit_words([&](const MaskPlane&, int, int, std::uint64_t bits) { total += std::uint64_t(std::popcount(bits)); });
  const std::uint64_t count = std::min(total, kProbesOfObject);
  std::uint64_t passed = 0, chosen = 0;
  visit_words([&](const MaskPlane& plane, int y, int x, std::uint64_t bits) {
    for (; chosen < count; ++chosen) {
      const std::uint64_t rank = total * (2 * chosen + 1) / (2 * count);
      if (rank >= passed + std::uint64_t(std::popcount(bits))) break;
      std::uint64_t rest = bits;
      for (std::uint64_t i = passed; i < rank; ++i) rest &= rest - 1;
      probes.push_back({object, x + std::countr_zero(rest), y, int(plane.number)});
    }
    passed += std::uint64_t(std::popcount(bits));
  });
}

/// The probes, in squares of pixels.
class ProbeGrid {
 public:
  ProbeGrid(const std::vector<SampleProbe>& probes, const View& view)
      : across_(std::size_t(view.width) / kSide + 1),
        numbers_(across_ * (std::size_t(view.height) / kSide + 1), probes.size(),
                 [&](std::size_t i, const auto& add) {
                   add(std::size_t(probes[i].y) / kSide * across_ + std::size_t(probes[i].x) / kSide, std::uint32_t(i));
                 },
                 {.threads = 1}) {}

  /// Calls visit(number) for the probes in all squares that a rectangle touches.
  template <class Visit>
  void visit(const PixelRect& rect, const Visit& visit) const {
    const std::size_t left = std::size_t(rect.x0) / kSide, end = std::size_t(rect.x1) / kSide + 1;
    for (std::size_t row = std::size_t(rect.y0) / kSide; row <= std::size_t(rect.y1) / kSide; ++row)
      for (const std::uint32_t number : numbers_.in(row * across_ + left, row * across_ + end)) visit(number);
  }

 private:
  static constexpr std::size_t kSide = 8;

  std::size_t across_;
  const Buckets<std::uint32_t> numbers_;
};

/// A triangle at a probe.
struct ProbeHit {
  std::uint32_t probe, object;
  float key;
  PrimitiveId id;

  [[nodiscard]] bool is_before(const ProbeHit& other) const {
    return key != other.key ? key > other.key : id < other.id;
  }
};

/// The probes of a view, at which triangles are tested.
struct ProbedView {
  const PlacedScene& scene;
  const ObjectCanvas& canvas;
  const std::vector<SampleProbe>& probes;
  const ProbeGrid grid;

  /// Adds a hit to `hits` for every probe that a triangle of an object covers.
  void add_hits(const TriangleRecord& record, std::uint32_t object, std::vector<ProbeHit>& hits) const {
    const View& view = canvas.view;
    grid.visit(pixel_rect(record, view.width, view.height), [&](std::uint32_t number) {
      const SampleProbe& probe = probes[number];
      const glm::ivec2 offset = sample_offsets(view.samples)[std::size_t(probe.sample)];
      visit_covered(record, {probe.x, probe.y, probe.x, probe.y}, offset, [&](int, int) {
        const int x = probe.x * kSubPixels + offset.x, y = probe.y * kSubPixels + offset.y;
        const bool may_be_hole = scene.cutouts && scene.cutouts->has(record.id);
        if (may_be_hole && ScreenCutout((*scene.cutouts)[record.id], canvas.rays).is_hole(x, y)) return;
        hits.push_back({number, object, TriangleKeys(record).at(x, y), record.id});
      });
    });
  }
};

/// Chooses a few samples of each object, spread over the part of the picture that it covers. `canvas` has no margin.
std::vector<SampleProbe> choose_probes(const PlacedScene& scene, const ObjectCanvas& canvas,
                                       std::span<const std::uint32_t> objects, const Execution& execution) {
  constexpr std::size_t kObjectsAtOnce = 64;
  std::vector<std::vector<SampleProbe>> parts((objects.size() + kObjectsAtOnce - 1) / kObjectsAtOnce);
  Pool<ObjectMask> masks;
  parallel_for(execution, objects.size(), kObjectsAtOnce, [&](std::size_t begin, std::size_t end) {
    const auto mask = masks.borrow([&] { return std::make_unique<ObjectMask>(scene, canvas, execution.isa); });
    for (std::size_t i = begin; i < end; ++i) {
      mask->draw(objects[i]);
      if (!mask->touched().is_empty()) choose_marked(*mask, objects[i], parts[begin / kObjectsAtOnce]);
    }
  });
  std::vector<SampleProbe> probes;
  for (const std::vector<SampleProbe>& part : parts) probes.insert(probes.end(), part.begin(), part.end());
  return probes;
}

/// By probe: the objects in front of the probe's own object, ascending.
std::vector<std::vector<std::uint32_t>> find_before(const PlacedScene& scene, const ObjectCanvas& canvas,
                                                    const std::vector<SampleProbe>& probes,
                                                    const Execution& execution) {
  constexpr std::size_t kRangesAtOnce = 16;
  const ProbedView probed{scene, canvas, probes, ProbeGrid(probes, canvas.view)};
  std::vector<std::vector<ProbeHit>> parts((scene.ranges.size() + kRangesAtOnce - 1) / kRangesAtOnce);
  Pool<RecordPlacer> placers;
  parallel_for(execution, scene.ranges.size(), kRangesAtOnce, [&](std::size_t begin, std::size_t end) {
    const auto placer = placers.borrow([&] { return std::make_unique<RecordPlacer>(scene, canvas, execution.isa); });
    for (std::size_t i = begin; i < end; ++i)
      placer->visit(scene.ranges[i], [&](const TriangleRecord& record) {
        probed.add_hits(record, scene.ranges[i].instance, parts[begin / kRangesAtOnce]);
      });
  });
  constexpr ProbeHit kNothing{0, no_index, -1, no_primitive};
  std::vector<ProbeHit> own(probes.size(), kNothing);
  for (const std::vector<ProbeHit>& part : parts)
    for (const ProbeHit& hit : part)
      if (hit.object == probes[hit.probe].object && hit.is_before(own[hit.probe])) own[hit.probe] = hit;
  std::vector<std::vector<std::uint32_t>> before(probes.size());
  for (const std::vector<ProbeHit>& part : parts)  // in the order of objects, so the lists ascend
    for (const ProbeHit& hit : part) {
      std::vector<std::uint32_t>& objects = before[hit.probe];
      if (hit.object != probes[hit.probe].object && hit.is_before(own[hit.probe]) &&
          (objects.empty() || objects.back() != hit.object))
        objects.push_back(hit.object);
    }
  return before;
}

/// The reason that comes last in SightReason among those of the object's triangles.
SightReason reason_of(const TrianglePlaces& triangles) {
  if (triangles.in_view > 0) return SightReason::no_sample;
  if (triangles.faces_away > 0) return SightReason::faces_away;
  if (triangles.outside() > 0) return SightReason::outside;
  if (triangles.beyond_far > 0) return SightReason::beyond_far;
  if (triangles.nearer_than_near > 0) return SightReason::nearer_than_near;
  return triangles.behind_eye > 0 ? SightReason::behind_eye : SightReason::empty;
}

/// Explains some objects of a view.
class Explainer {
 public:
  Explainer(const Surfaces& surfaces, const View& view, const Accounting& accounts, const Execution& execution)
      : surfaces_(surfaces), view_(view), accounts_(accounts), execution_(execution) {}

  /// Explains the objects. Precondition: their numbers ascend.
  [[nodiscard]] std::vector<Explanation> explain(std::span<const std::uint32_t> objects) const {
    constexpr std::size_t kObjectsAtOnce = 16;
    const std::vector<ObjectPlaces> places =
        find_places(placed_scene(surfaces_), view_, accounts_, objects.size() == 1 ? objects[0] : no_index, execution_);
    std::vector<Explanation> all(objects.size());
    parallel_for(execution_, objects.size(), kObjectsAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) all[i] = explain_by_view(objects[i], places[objects[i]]);
    });
    find_what_to_take_away(all);
    return all;
  }

 private:
  [[nodiscard]] Explanation explain_by_view(std::uint32_t object, const ObjectPlaces& places) const {
    const ObjectAccount& account = accounts_.objects[object];
    Explanation why;
    why.object = object;
    why.triangles = places.counts;
    why.visible_share = account.visible_share();
    why.hidden_share = account.hidden_share();
    why.cut_share = account.cut_share();
    note_hiders(why, account);
    if (places.clear > 0 && places.clear == places.counts.in_view)
      why.reason = SightReason::transparent;
    else if (account.in_frame.count > 0)
      why.reason = account.visible.count > 0 ? SightReason::seen : SightReason::hidden;
    else
      explain_without_sample(why, places);
    if (why.remedy.kind == RemedyKind::none) why.remedy = remedy_for(why.reason, places, view_);
    return why;
  }

  void explain_without_sample(Explanation& why, const ObjectPlaces& places) const {
    why.reason = reason_of(places.counts);
    if (why.reason != SightReason::no_sample) return;
    const LoneObject lone(surfaces_.scene(), why.object);
    if (has_holes(why.object) && lone.has_sample(view_, places)) {
      why.reason = SightReason::transparent;
      why.is_all_holes = true;
      return;
    }
    why.pixels = lone.area(view_, places);
    if (why.pixels == 0 && places.counts.faces_away > 0)
      why.reason = SightReason::faces_away;
    else if (why.pixels > 0)
      why.remedy = enlargement_for(lone, places, view_);
  }

  [[nodiscard]] bool has_holes(std::uint32_t object) const {
    const PlacedScene& scene = placed_scene(surfaces_);
    if (!scene.cutouts) return false;
    for (PrimitiveId id = scene.first_primitives[object]; id < scene.first_primitives[object + 1]; ++id)
      if (scene.cutouts->has(id)) return true;
    return false;
  }

  void note_hiders(Explanation& why, const ObjectAccount& account) const {
    const std::vector<HiddenSamples>& all = accounts_.hidden_by_front;
    const auto is_before = [](const HiddenSamples& pair, std::uint32_t number) { return pair.object < number; };
    auto pair = std::lower_bound(all.begin(), all.end(), why.object, is_before);
    for (; pair != all.end() && pair->object == why.object; ++pair)
      why.hiders.push_back({pair->hider, double(pair->count) / double(account.in_frame.count)});
    std::stable_sort(why.hiders.begin(), why.hiders.end(),
                     [](const HiderShare& a, const HiderShare& b) { return a.share > b.share; });
  }

  void find_what_to_take_away(std::vector<Explanation>& all) const {
    std::vector<std::uint32_t> hidden;
    for (const Explanation& why : all)
      if (why.reason == SightReason::hidden) hidden.push_back(why.object);
    if (hidden.empty()) return;
    const ObjectCanvas canvas(view_, 1);
    const std::vector<SampleProbe> probes = choose_probes(placed_scene(surfaces_), canvas, hidden, execution_);
    std::vector<std::vector<std::uint32_t>> before = find_before(placed_scene(surfaces_), canvas, probes, execution_);
    auto why = all.begin();
    for (std::size_t i = 0; i < probes.size(); ++i) {
      while (why->object != probes[i].object) ++why;
      Remedy& remedy = why->remedy;
      if (remedy.kind == RemedyKind::take_away && remedy.objects.size() <= before[i].size()) continue;
      remedy.kind = RemedyKind::take_away;
      remedy.objects = std::move(before[i]);
    }
  }

  const Surfaces& surfaces_;
  const View& view_;
  const Accounting& accounts_;
  const Execution& execution_;
};

}  // namespace

std::vector<Explanation> explain_all(const Surfaces& surfaces, const Visible& visible, const Accounting& accounts,
                                     const Execution& execution) {
  const IeeeScope ieee;
  validate(visible.view);
  check_answer(visible, surfaces.primitive_count(), "explanations", execution);
  const std::size_t count = surfaces.scene().instances.size();
  if (accounts.objects.size() != count)
    throw Error(ErrorCode::bad_argument, "explanations", "the accounts were made for other objects");
  std::vector<std::uint32_t> objects(count);
  for (std::size_t i = 0; i < count; ++i) objects[i] = std::uint32_t(i);
  return Explainer(surfaces, visible.view, accounts, execution).explain(objects);
}

Explanation explain(const Surfaces& surfaces, const View& view, std::uint32_t object, const Execution& execution) {
  const IeeeScope ieee;
  if (object >= surfaces.scene().instances.size())
    throw Error(ErrorCode::bad_argument, "explain", "there is no object " + std::to_string(object));
  const Accounting accounts = account(surfaces, zbuffer(surfaces, view, execution), {}, execution);
  return Explainer(surfaces, view, accounts, execution).explain(std::span(&object, 1))[0];
}

}  // namespace frontmost
