// SPDX-License-Identifier: Apache-2.0
//   Accounting --samples have the last word--> seen, hidden --probes--> what to take away
//   Surfaces ----places of triangles---------> the others ---remedy--> what to change in the view
#include <algorithm>

#include "base/parallel.h"
#include "frontmost/report.h"
#include "frontmost/zbuffer.h"
#include "report/why/lone_object.h"
#include "report/why/probes.h"
#include "report/why/remedy.h"
#include "view/answer.h"

namespace frontmost {

using namespace why_detail;

namespace {

/// The last reason of any of the object's triangles.
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
    for (Explanation& explanation : all)
      if (!explanation.hiders.empty()) sort_hiders(explanation);
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
  }

  static void sort_hiders(Explanation& why) {
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
    throw Error(ErrorCode::bad_argument, "explanations", "the accounts are of other objects");
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
