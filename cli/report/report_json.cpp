// SPDX-License-Identifier: Apache-2.0
// The report as JSON: all objects by number, each with the pairs in which it is the hidden object.
#include <frontmost/version.h>

#include "cli/report/report_run.h"

namespace frontmost::cli {
namespace {

Json box_json(const PixelBox& box) { return Json::array({box.x, box.y, box.width, box.height}); }

Json samples_json(const SampleSet& samples) {
  return {{"samples", samples.count}, {"box", samples.box.is_empty() ? Json(nullptr) : box_json(samples.box)}};
}

Json pairs_json(std::span<const HiddenSamples> pairs) {
  Json json = Json::array();
  for (const HiddenSamples& pair : pairs) json.push_back({{"object", pair.hider}, {"samples", pair.count}});
  return json;
}

Json places_json(const TrianglePlaces& triangles) {
  return {{"empty", triangles.empty},
          {"behind_eye", triangles.behind_eye},
          {"nearer_than_near", triangles.nearer_than_near},
          {"beyond_far", triangles.beyond_far},
          {"left", triangles.left},
          {"right", triangles.right},
          {"above", triangles.above},
          {"below", triangles.below},
          {"past_corner", triangles.past_corner},
          {"faces_away", triangles.faces_away},
          {"in_view", triangles.in_view}};
}

/// Returns a remedy, with the numbers of its kind.
Json remedy_json(const Remedy& remedy) {
  if (remedy.kind == RemedyKind::none) return nullptr;
  Json json = {{"kind", name(remedy.kind)}};
  switch (remedy.kind) {
    case RemedyKind::turn:
      json["right_degrees"] = glm::degrees(remedy.right);
      json["up_degrees"] = glm::degrees(remedy.up);
      break;
    case RemedyKind::move:
      json["right"] = remedy.right;
      json["up"] = remedy.up;
      break;
    case RemedyKind::take_away: json["objects"] = remedy.objects; break;
    case RemedyKind::set_near:
    case RemedyKind::set_far:
    case RemedyKind::enlarge: json["value"] = remedy.value; break;
    default: break;
  }
  return json;
}

Json why_json(const ReportRun& run, std::uint32_t number) {
  const Explanation& why = run.why[number];
  Json json = {{"reason", name(why.reason)},
               {"sentence", utf8_text(sentence(why, run.names))},
               {"triangles", places_json(why.triangles)},
               {"remedy", remedy_json(why.remedy)}};
  if (why.reason == SightReason::no_sample) json["square_pixels"] = why.pixels;
  return json;
}

}  // namespace

Json object_json(const ReportRun& run, std::uint32_t number) {
  const ObjectAccount& object = run.accounts.objects[number];
  const bool is_seen = object.visible.count > 0;
  Json json = {{"object", number},
               {"name", run.scene().instances[number].name},
               {"alone", samples_json(object.alone)},
               {"in_frame", samples_json(object.in_frame)},
               {"visible", samples_json(object.visible)},
               {"visible_share", object.visible_share()},
               {"hidden_share", object.hidden_share()},
               {"cut_share", object.cut_share()},
               {"distance", finite_or_null(object.distance)},
               {"centroid", is_seen ? to_json(object.centroid) : Json(nullptr)},
               {"cut_by_near", object.is_cut_by_near},
               {"hidden_by", pairs_json(run.hiders_of(number))},
               {"why", why_json(run, number)}};
  if (run.settings.report.all_hiders) {
    json["hidden_by_any"] = pairs_json(pairs_of(run.accounts.hidden_by_any, number));
    json["hidden_only_by"] = pairs_json(pairs_of(run.accounts.hidden_only_by, number));
  }
  return json;
}

Json view_report_json(const ReportRun& run) {
  Json json = {{"width", run.view().width},
               {"height", run.view().height},
               {"canvas", box_json(run.accounts.canvas)},
               {"background", run.accounts.background}};
  Json& objects = json["objects"] = Json::array();
  const HidingOrder order = find_hiding_order(run.accounts.objects.size(), run.accounts.hidden_by_front);
  for (const std::uint32_t i : objects_asked_for(run.settings, run.scene())) {
    objects.push_back(object_json(run, i));
    objects.back()["rank"] = order.ranks[i];
  }
  json["hidden_by_file"] = hidden_asked_for(run.settings, run.scene());
  json["cycles"] = order.cycles;
  return json;
}

Json report_json(const ReportRun& run) {
  Json json = {{"frontmost", FRONTMOST_VERSION}, {"model", run.settings.model}};
  json.update(view_report_json(run));
  json["files"] = run.files;
  return json;
}

}  // namespace frontmost::cli
