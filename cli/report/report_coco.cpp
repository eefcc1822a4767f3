// SPDX-License-Identifier: Apache-2.0
// COCO's annotations of what is seen: https://cocodataset.org/#format-data, and beside them what is hidden.
#include <algorithm>
#include <map>

#include "cli/outputs.h"
#include "cli/report/report_files.h"

namespace frontmost::cli {
namespace {

Json coco_box(const PixelBox& box) { return Json::array({box.x, box.y, box.width, box.height}); }

Json run_lengths(const PixelMask& mask, MaskPart part, const View& view) {
  return {{"size", {view.height, view.width}}, {"counts", coco_runs(mask, part, {view.width, view.height})}};
}

/// Numbers of categories: the scene's own, and behind them one for each name of objects without one.
class CocoCategories {
 public:
  explicit CocoCategories(const Scene& scene) : scene_(scene) {
    std::uint32_t last = 0;
    for (const Category& category : scene.categories) {
      last = std::max(last, category.number);
      add(category.number, category.name);
    }
    for (const Instance& instance : scene.instances)
      if (instance.category == no_index && numbers_.emplace(instance.name, last + 1).second) add(++last, instance.name);
  }

  [[nodiscard]] std::uint32_t of(std::uint32_t object) const {
    const Instance& instance = scene_.instances[object];
    return instance.category == no_index ? numbers_.find(instance.name)->second
                                         : scene_.categories[instance.category].number;
  }
  [[nodiscard]] const Json& list() const { return list_; }

 private:
  void add(std::uint32_t number, const std::string& name) {
    list_.push_back({{"id", number}, {"name", name}, {"supercategory", ""}});
  }

  const Scene& scene_;
  std::map<std::string, std::uint32_t> numbers_;
  Json list_ = Json::array();
};

}  // namespace

Json coco_json(const ReportRun& run, bool with_polygons, const Execution& execution) {
  const View& view = run.view();
  const CocoCategories categories(run.scene());
  PixelMasks masks(run.surfaces, run.visible, execution);
  Json annotations = Json::array();
  for (std::uint32_t i = 0; i < run.accounts.objects.size(); ++i) {
    const ObjectAccount& account = run.accounts.objects[i];
    if (account.visible.count == 0) continue;
    const PixelMask mask = masks.of(i);
    annotations.push_back({{"id", annotations.size() + 1},
                           {"image_id", 1},
                           {"category_id", categories.of(i)},
                           {"iscrowd", 0},
                           {"area", account.visible.count},
                           {"bbox", coco_box(account.visible.box)},
                           {"segmentation", with_polygons ? Json(coco_polygons(mask, MaskPart::visible))
                                                          : run_lengths(mask, MaskPart::visible, view)},
                           {"amodal_area", account.in_frame.count},
                           {"amodal_bbox", coco_box(account.in_frame.box)},
                           {"amodal_segmentation", run_lengths(mask, MaskPart::whole, view)},
                           {"visible_share", account.visible_share()},
                           {"hidden_share", account.hidden_share()},
                           {"cut_share", account.cut_share()},
                           {"object", i},
                           {"name", run.scene().instances[i].name}});
  }
  const Json image = {{"id", 1},
                      {"file_name", model_name(run.settings.model) + ".png"},
                      {"width", view.width},
                      {"height", view.height}};
  return {{"images", Json::array({image})}, {"categories", categories.list()}, {"annotations", std::move(annotations)}};
}

}  // namespace frontmost::cli
