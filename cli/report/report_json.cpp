// SPDX-License-Identifier: Apache-2.0
// The report as JSON: all objects by number, each with the pairs that it is the hidden one of.
#include <frontmost/version.h>

#include "cli/report/report_run.h"

namespace frontmost::cli {
namespace {

Json box_json(const PixelBox& box) { return Json::array({box.x, box.y, box.width, box.height}); }

Json samples_json(const SampleSet& samples) {
  return {{"samples", samples.count}, {"box", samples.box.is_empty() ? Json(nullptr) : box_json(samples.box)}};
}

Json object_json(const ReportRun& run, std::uint32_t number) {
  const ObjectAccount& object = run.accounts.objects[number];
  const bool is_seen = object.visible.count > 0;
  Json hiders = Json::array();
  for (const HiddenSamples& pair : run.hiders_of(number))
    hiders.push_back({{"object", pair.hider}, {"samples", pair.count}});
  return {{"object", number},
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
          {"hidden_by", std::move(hiders)}};
}

}  // namespace

Json report_json(const ReportRun& run) {
  Json json = {{"frontmost", FRONTMOST_VERSION},
               {"model", run.settings.model},
               {"width", run.view().width},
               {"height", run.view().height},
               {"canvas", box_json(run.accounts.canvas)},
               {"background", run.accounts.background}};
  Json& objects = json["objects"] = Json::array();
  for (std::uint32_t i = 0; i < run.accounts.objects.size(); ++i) objects.push_back(object_json(run, i));
  json["files"] = run.files;
  return json;
}

}  // namespace frontmost::cli
