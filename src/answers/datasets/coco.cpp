// SPDX-License-Identifier: Apache-2.0
// COCO's annotations as text, one line each. Annotations of many views are long, and a JSON tree takes ten times as
// much memory.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "datasets/dataset_files.h"

namespace frontmost::datasets {
namespace {

Json coco_box(const PixelBox& box) { return Json::array({box.x, box.y, box.width, box.height}); }

Json run_lengths(const PixelMask& mask, MaskPart part, const View& view) {
  return {{"size", {view.height, view.width}}, {"counts", coco_runs(mask, part, {view.width, view.height})}};
}

void append_line(std::string& list, const Json& json) {
  list += list.empty() ? "\n" : ",\n";
  list += json.dump();
}

}  // namespace

void CocoFile::add_category(std::uint32_t number, const std::string& name) {
  const auto [found, is_new] = categories_.emplace(number, name);
  if (!is_new && found->second != name)
    throw Error(ErrorCode::bad_argument, "coco",
                "category " + std::to_string(number) + " is " + printable_text(found->second) + " in one view and " +
                    printable_text(name) + " in another");
  if (is_new) order_.push_back(number);
  last_ = std::max(last_, number);
}

void CocoFile::begin_view(const DatasetView& view, const std::string& picture, const std::vector<bool>& left_out) {
  const Scene& scene = view.surfaces.scene();
  for (const Category& category : scene.categories) add_category(category.number, category.name);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (instance.category == no_index && !left_out[i] && names_.emplace(instance.name, last_ + 1).second)
      add_category(last_ + 1, instance.name);
  }
  append_line(images_, {{"id", ++image_count_},
                        {"file_name", utf8_text(picture)},
                        {"width", view.visible.view.width},
                        {"height", view.visible.view.height}});
}

void CocoFile::add(const DatasetView& view, const ObjectInFrame& object) {
  const Scene& scene = view.surfaces.scene();
  const Instance& instance = scene.instances[object.number];
  const ObjectAccount& account = view.accounts.objects[object.number];
  const View& camera = view.visible.view;
  if (account.visible.count == 0) return;
  const std::uint32_t category =
      instance.category == no_index ? names_.find(instance.name)->second : scene.categories[instance.category].number;
  append_line(annotations_, {{"id", ++annotation_count_},
                             {"image_id", image_count_},
                             {"category_id", category},
                             {"iscrowd", 0},
                             {"area", account.visible.count},
                             {"bbox", coco_box(account.visible.box)},
                             {"segmentation", with_polygons_ ? Json(coco_polygons(object.mask, MaskPart::visible))
                                                             : run_lengths(object.mask, MaskPart::visible, camera)},
                             {"amodal_area", account.in_frame.count},
                             {"amodal_bbox", coco_box(account.in_frame.box)},
                             {"amodal_segmentation", run_lengths(object.mask, MaskPart::whole, camera)},
                             {"visible_share", account.visible_share()},
                             {"hidden_share", account.hidden_share()},
                             {"cut_share", account.cut_share()},
                             {"object", object.number},
                             {"name", utf8_text(instance.name)}});
}

std::string CocoFile::text() const {
  std::string categories;
  for (const std::uint32_t number : order_)
    append_line(categories,
                {{"id", number}, {"name", utf8_text(categories_.find(number)->second)}, {"supercategory", ""}});
  return "{\"images\": [" + images_ + "],\n\"categories\": [" + categories + "],\n\"annotations\": [" + annotations_ +
         "]}\n";
}

}  // namespace frontmost::datasets
