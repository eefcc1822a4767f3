// SPDX-License-Identifier: Apache-2.0
// The mask of every object is made once and written to all files.
#include <algorithm>
#include <iterator>

#include "base/parallel.h"
#include "datasets/dataset_files.h"

namespace frontmost {

using namespace datasets;

namespace {

/// The objects of a scene with one of these names, or with a category of one of these names; by instance. O(instances *
/// names). \throws Error bad_argument for a name that no object and no category has.
std::vector<bool> named_objects(const Scene& scene, const std::vector<std::string>& names) {
  std::vector<bool> named(scene.instances.size());
  for (const std::string& name : names) {
    bool is_known = std::any_of(scene.categories.begin(), scene.categories.end(),
                                [&](const Category& category) { return category.name == name; });
    for (std::size_t i = 0; i < named.size(); ++i) {
      const Instance& instance = scene.instances[i];
      const bool is_it =
          instance.name == name || (instance.category != no_index && scene.categories[instance.category].name == name);
      named[i] = named[i] || is_it;
      is_known |= is_it;
    }
    if (!is_known)
      throw Error(ErrorCode::bad_argument, "leave_out",
                  "no object and no category has the name " + printable_text(name));
  }
  return named;
}

}  // namespace

struct DatasetWriter::Parts {
  DatasetOptions options;
  std::optional<CocoFile> coco;
  std::optional<BopFolder> bop;
  std::optional<MaskFolder> masks;
  std::size_t view_count = 0;
};

DatasetWriter::DatasetWriter(const DatasetOptions& options) : parts_(std::make_unique<Parts>()) {
  parts_->options = options;
  if (options.coco) parts_->coco.emplace(options.coco_polygons);
  if (options.bop) parts_->bop.emplace(*options.bop, options.bop_visible);
  if (options.masks) parts_->masks.emplace(*options.masks, options.are_masks_numbered);
}

DatasetWriter::~DatasetWriter() = default;

void DatasetWriter::add(const DatasetView& view, const std::string& picture, const Execution& execution) {
  if (view.visible.view.samples != 1)
    throw Error(ErrorCode::bad_argument, "samples", "views of data sets have one sample a pixel");
  Parts& parts = *parts_;
  const std::vector<bool> left_out = named_objects(view.surfaces.scene(), parts.options.leave_out);
  if (parts.coco) parts.coco->begin_view(view, picture, left_out);
  if (parts.bop) parts.bop->begin_view(view, execution);
  PixelMasks masks(view.surfaces, view.visible, execution);
  for (std::uint32_t i = 0; i < left_out.size(); ++i) {
    if (left_out[i] || view.accounts.objects[i].in_frame.count == 0) continue;
    check_cancelled(execution);
    const ObjectInFrame object{i, masks.of(i)};
    if (parts.coco) parts.coco->add(view, object);
    if (parts.masks) parts.masks->add(view, parts.view_count, object, execution);
    if (parts.bop) parts.bop->add(view, object, execution);
  }
  if (parts.bop) parts.bop->end_view();
  ++parts.view_count;
}

std::vector<std::string> DatasetWriter::finish() {
  std::vector<std::string> files;
  const auto add = [&](std::vector<std::string> more) {
    std::move(more.begin(), more.end(), std::back_inserter(files));
  };
  Parts& parts = *parts_;
  if (parts.coco) {
    save_text(parts.coco->text(), *parts.options.coco);
    files.push_back(*parts.options.coco);
  }
  if (parts.bop) add(parts.bop->finish());
  if (parts.masks) add(parts.masks->finish());
  return files;
}

}  // namespace frontmost
