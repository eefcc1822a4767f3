// SPDX-License-Identifier: Apache-2.0
// Files of data sets: COCO annotations, BOP scenes and masks as pictures.
//
//   DatasetWriter::add() --every object in the picture--> CocoFile       text, kept
//                                                     --> BopFolder      masks and depths, staged; poses, kept
//                                                     --> MaskFolder     masks, staged
//
// The mask of every object is made once. Files are written into a hidden folder, and moved when all are complete.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/parallel.h"
#include "frontmost/files.h"
#include "frontmost/report.h"
#include "frontmost/zbuffer.h"

namespace frontmost {
namespace datasets {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// An object with samples in the picture.
struct ObjectInFrame {
  std::uint32_t number;  ///< number of the instance
  PixelMask mask;
};

/// A picture of the view's size, white in the pixels of the part and black elsewhere.
Image mask_image(const PixelMask& mask, MaskPart part, const View& view) {
  Buffer<float> values(view.pixel_count(), 0.0f);
  for (int y = mask.box.y; y < mask.box.y + mask.box.height; ++y)
    for (int x = mask.box.x; x < mask.box.x + mask.box.width; ++x) {
      const MaskPixel pixel = mask.at(x, y);
      if (pixel == MaskPixel::visible || (part == MaskPart::whole && pixel == MaskPixel::hidden))
        values[std::size_t(y) * std::size_t(view.width) + std::size_t(x)] = 1;
    }
  Image image{view.width, view.height, {}};
  image.channels.push_back({"Y", std::move(values)});
  return image;
}

/// A number in file names: "000042".
std::string six_digits(std::size_t number) {
  const std::string digits = std::to_string(number);
  return std::string(6 - std::min<std::size_t>(6, digits.size()), '0') + digits;
}

/// Whether a file name matches one of the patterns, in which 0 stands for any digit.
bool has_pattern(std::string name, const std::vector<std::string>& patterns) {
  for (char& c : name)
    if (c >= '1' && c <= '9') c = '0';
  return std::find(patterns.begin(), patterns.end(), name) != patterns.end();
}

/// A folder whose files appear together: all of them after finish(), none without it.
class DatasetFolder {
 public:
  /// A subfolder of numbered files; the name "" stands for the folder itself.
  struct Within {
    std::string name;
    std::vector<std::string> patterns;  ///< patterns of the file names; 0 stands for any digit
  };

  /// \throws Error file_unwritable.
  DatasetFolder(const std::string& folder, std::vector<Within> within)
      : folder_(folder), made_(folder), staged_(folder), within_(std::move(within)) {
    for (const Within& made : within_)
      if (!made.name.empty()) fs::create_directory(staged_.path(made.name));
  }

  void add(const std::string& name, const Image& image, const SaveOptions& options, const Execution& execution) {
    write(name, [&](const std::string& path) { save(image, path, options, execution); });
  }
  void add(const std::string& name, const std::string& text) {
    write(name, [&](const std::string& path) { save_text(text, path); });
  }

  /// Moves the files to their places, and removes all other numbered files from the subfolders. \returns the paths.
  [[nodiscard]] std::vector<std::string> finish() {
    for (const Within& made : within_)
      if (const fs::path path = fs::path(folder_) / made.name; fs::exists(path) && !fs::is_directory(path))
        throw Error(ErrorCode::file_unwritable, path.string(), "", "not a folder");
    for (const Within& made : within_) fs::create_directories(fs::path(folder_) / made.name);
    staged_.commit(names_);
    remove_stale();
    for (std::string& name : names_) name = (fs::path(folder_) / name).string();
    return std::move(names_);
  }

 private:
  template <class Write>
  void write(const std::string& name, const Write& write) {
    try {
      write(staged_.path(name));
    } catch (const Error& error) {
      throw Error(error.code(), staged_.told(error.file()), error.place(), error.reason());
    }
    names_.push_back(name);
  }

  /// Removes numbered files of an earlier data set, because programs would take them for files of this data set.
  void remove_stale() const {
    const fs::path folder = folder_;
    std::set<fs::path> written;
    for (const std::string& name : names_) written.insert(folder / name);
    std::error_code ignored;
    for (const auto& [name, patterns] : within_) {
      const fs::path place = name.empty() ? folder : folder / name;
      std::vector<fs::path> stale;
      for (const fs::directory_entry& entry : fs::directory_iterator(place, ignored))
        if (has_pattern(entry.path().filename().string(), patterns) && !written.contains(entry.path()))
          stale.push_back(entry.path());
      for (const fs::path& path : stale) fs::remove(path, ignored);
    }
  }

  std::string folder_;
  MadeFolder made_;
  StagedFolder staged_;
  std::vector<Within> within_;
  std::vector<std::string> names_;
};

Json coco_box(const PixelBox& box) { return Json::array({box.x, box.y, box.width, box.height}); }

Json run_lengths(const PixelMask& mask, MaskPart part, const View& view) {
  return {{"size", {view.height, view.width}}, {"counts", coco_runs(mask, part, {view.width, view.height})}};
}

void append_line(std::string& list, const Json& json) {
  list += list.empty() ? "\n" : ",\n";
  list += json.dump();
}

/// COCO annotations of visible parts (https://cocodataset.org/#format-data), with fields for hidden parts. They are
/// kept as text, one line each: a JSON tree takes ten times as much memory.
class CocoFile {
 public:
  explicit CocoFile(bool with_polygons) : with_polygons_(with_polygons) {}

  /// `left_out` tells for each instance whether it gets no annotation. \throws Error bad_argument for two categories of
  /// one number.
  void begin_view(const DatasetView& view, const std::string& picture, const std::vector<bool>& left_out) {
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

  void add(const DatasetView& view, const ObjectInFrame& object) {
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

  [[nodiscard]] std::string text() const {
    std::string categories;
    for (const std::uint32_t number : order_)
      append_line(categories,
                  {{"id", number}, {"name", utf8_text(categories_.find(number)->second)}, {"supercategory", ""}});
    return "{\"images\": [" + images_ + "],\n\"categories\": [" + categories + "],\n\"annotations\": [" + annotations_ +
           "]}\n";
  }

 private:
  void add_category(std::uint32_t number, const std::string& name) {
    const auto [found, is_new] = categories_.emplace(number, name);
    if (!is_new && found->second != name)
      throw Error(ErrorCode::bad_argument, "coco",
                  "category " + std::to_string(number) + " is " + printable_text(found->second) + " in one view and " +
                      printable_text(name) + " in another");
    if (is_new) order_.push_back(number);
    last_ = std::max(last_, number);
  }

  bool with_polygons_;
  std::map<std::uint32_t, std::string> categories_;  ///< names of the categories, by number
  std::map<std::string, std::uint32_t> names_;       ///< names of objects without a category, and their numbers
  std::uint32_t last_ = 0;                           ///< the highest category number so far
  std::vector<std::uint32_t> order_;                 ///< category numbers in the order in which they were added
  std::size_t image_count_ = 0, annotation_count_ = 0;
  std::string images_, annotations_;
};

double millimetres_per_unit(const Scene& scene) { return 1000 * scene.source.metres_per_unit.value_or(0.001); }

/// Adding 0 turns -0 into 0.
Json vector_json(const glm::dvec3& v) { return Json::array({v.x + 0.0, v.y + 0.0, v.z + 0.0}); }

Json rows_json(const glm::dmat3& m) {
  Json json = Json::array();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) json.push_back(m[column][row] + 0.0);
  return json;
}

/// Converts a matrix for points relative to `origin` into one for points relative to zero.
glm::dmat4 from_zero(glm::dmat4 m, const glm::dvec3& origin) {
  m[3] = m * glm::dvec4(-origin, 1);
  return m;
}

glm::dmat4 camera_from_world(const DatasetView& view) {
  return pose_of(view.visible.view.world_from_eye, PoseConvention::opencv_world_to_camera);
}

Json camera_json(const DatasetView& view, double millimetres, double depth_scale) {
  const View& camera = view.visible.view;
  const Intrinsics k = intrinsics_of(camera.projection, camera.width, camera.height, PixelRule::centre_at_integer);
  const glm::dmat4 pose = from_zero(camera_from_world(view), view.surfaces.scene().origin);
  return {{"cam_K", {k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1}},
          {"depth_scale", depth_scale},
          {"cam_R_w2c", rows_json(glm::dmat3(pose))},
          {"cam_t_w2c", vector_json(glm::dvec3(pose[3]) * millimetres)}};
}

/// The number of the object's category. Objects without a category are numbered by mesh, after the highest category.
std::uint64_t object_number(const Scene& scene, const Instance& instance) {
  if (instance.category != no_index) return scene.categories[instance.category].number;
  std::uint64_t highest = 0;
  for (const Category& category : scene.categories) highest = std::max<std::uint64_t>(highest, category.number);
  return highest + instance.mesh + 1;
}

/// \throws Error unsupported for an object that is stretched or mirrored: BOP's poses hold rotation and translation
/// alone.
Json pose_json(const DatasetView& view, std::uint32_t object, double millimetres) {
  const Scene& scene = view.surfaces.scene();
  const Instance& instance = scene.instances[object];
  const glm::dmat4 pose =
      from_zero(camera_from_world(view) * instance.world_from_mesh, scene.meshes[instance.mesh].origin);
  const double scale = std::cbrt(glm::determinant(glm::dmat3(pose)));
  const glm::dmat3 turn = glm::dmat3(pose) * (1 / scale), rest = glm::transpose(turn) * turn - glm::dmat3(1.0);
  double most = 0;
  for (int column = 0; column < 3; ++column) most = std::max(most, glm::length(rest[column]));
  if (!(scale > 0 && most < 1e-4))
    throw Error(ErrorCode::unsupported, "bop",
                "object " + std::to_string(object) + " (" + printable_text(instance.name) +
                    ") is stretched or mirrored, which BOP's poses cannot be; leave it out");
  return {{"cam_R_m2c", rows_json(turn)},
          {"cam_t_m2c", vector_json(glm::dvec3(pose[3]) * millimetres)},
          {"obj_id", object_number(scene, instance)}};
}

/// A box as in bop_toolkit: its size is the distance from the first pixel to the last, which is one less than the
/// number of pixels.
Json bop_box(const PixelBox& box, bool is_seen) {
  return is_seen ? Json::array({box.x, box.y, box.width - 1, box.height - 1}) : Json::array({-1, -1, -1, -1});
}

/// Marks as visible the pixels whose object lies at most 15 mm behind the seen surface, along the ray.
void mark_within_tolerance(const DatasetView& view, ObjectInFrame& object, const Image& seen,
                           const Execution& execution) {
  const Scene& scene = view.surfaces.scene();
  Scene alone;
  alone.meshes = {scene.meshes[scene.instances[object.number].mesh]};
  alone.instances = {scene.instances[object.number]};
  alone.instances[0].mesh = 0;
  alone.materials = scene.materials;
  alone.textures = scene.textures;
  alone.categories = scene.categories;
  const Surfaces surfaces(alone, execution);
  const Image distances = ray_distance_image(zbuffer(surfaces, view.visible.view, execution));
  constexpr double kTolerance = 15;  // millimetres, as in bop_toolkit's visibility tests
  const double most = kTolerance / millimetres_per_unit(scene);
  const PixelBox& box = object.mask.box;
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x) {
      MaskPixel& pixel = object.mask.pixels[std::size_t(y) * std::size_t(box.width) + std::size_t(x)];
      if (pixel == MaskPixel::outside) continue;
      const std::size_t at = std::size_t(box.y + y) * std::size_t(seen.width) + std::size_t(box.x + x);
      const double behind = double(distances.channels[0].floats()[at]) - double(seen.channels[0].floats()[at]);
      pixel = behind <= most ? MaskPixel::visible : MaskPixel::hidden;
    }
}

SampleSet visible_of(const PixelMask& mask) {
  SampleSet set;
  int x0 = mask.box.width, y0 = mask.box.height, x1 = -1, y1 = -1;
  for (int y = 0; y < mask.box.height; ++y)
    for (int x = 0; x < mask.box.width; ++x) {
      if (mask.at(mask.box.x + x, mask.box.y + y) != MaskPixel::visible) continue;
      ++set.count;
      x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = y;
    }
  if (set.count > 0) set.box = {mask.box.x + x0, mask.box.y + y0, x1 - x0 + 1, y1 - y0 + 1};
  return set;
}

Json info_json(const ObjectAccount& account, const PixelMask& mask) {
  const SampleSet seen = visible_of(mask);
  return {{"px_count_all", account.alone.count},
          {"px_count_valid", account.in_frame.count},
          {"px_count_visib", seen.count},
          {"visib_fract", double(seen.count) / double(account.alone.count)},
          {"bbox_obj", bop_box(account.alone.box, seen.count > 0)},
          {"bbox_visib", bop_box(seen.box, seen.count > 0)}};
}

/// Millimetres for one step of the depth file: the least power of ten, from 0.1 on, with which all depths fit.
double depth_scale_of(const Image& depths, double millimetres) {
  double farthest = 0, scale = 0.1;
  for (const float depth : depths.channels[0].floats())
    if (std::isfinite(depth)) farthest = std::max(farthest, double(depth) * millimetres);
  while (farthest / scale > 65535) scale *= 10;
  return scale;
}

void append_element(std::string& list, const Json& json) { list += (list.empty() ? "" : ", ") + json.dump(); }

/// Appends the line of a view, as bop_toolkit writes it.
void append_view(std::string& file, std::size_t view, const std::string& text) {
  file += (file.empty() ? "  \"" : ",\n  \"") + std::to_string(view) + "\": " + text;
}

/// A scene of BOP: https://github.com/thodan/bop_toolkit, docs/bop_datasets_format.md.
///
///    scene_camera.json  scene_gt.json  scene_gt_info.json  depth/000000.png  mask/000000_*.png mask_visib/000000_*.png
///
/// Poses and depths are in millimetres, in the coordinates of the model files.
class BopFolder {
 public:
  BopFolder(const std::string& folder, BopVisible visible)
      : folder_(folder,
                {{"depth", {"000000.png"}}, {"mask", {"000000_000000.png"}}, {"mask_visib", {"000000_000000.png"}}}),
        visible_(visible) {}

  /// \throws Error unsupported for parallel views.
  void begin_view(const DatasetView& view, const Execution& execution) {
    if (view.visible.view.projection.orthographic)
      throw Error(ErrorCode::unsupported, "bop",
                  "the view is a parallel projection; BOP stores perspective cameras only");
    millimetres_ = millimetres_per_unit(view.surfaces.scene());
    const Image depths = depth_image(view.visible);
    if (visible_ == BopVisible::bop19) distances_ = ray_distance_image(view.visible);
    const double scale = depth_scale_of(depths, millimetres_);
    SaveOptions options;
    options.depth_scale = millimetres_ / scale;
    folder_.add("depth/" + six_digits(view_) + ".png", depths, options, execution);
    append_view(cameras_, view_, camera_json(view, millimetres_, scale).dump());
    object_ = 0;
    poses_.clear();
    infos_.clear();
  }

  /// \throws Error unsupported for an object that is stretched or mirrored.
  void add(const DatasetView& view, ObjectInFrame object, const Execution& execution) {
    if (visible_ == BopVisible::bop19) mark_within_tolerance(view, object, distances_, execution);
    const std::string name = "/" + six_digits(view_) + "_" + six_digits(object_++) + ".png";
    const View& camera = view.visible.view;
    folder_.add("mask" + name, mask_image(object.mask, MaskPart::whole, camera), {}, execution);
    folder_.add("mask_visib" + name, mask_image(object.mask, MaskPart::visible, camera), {}, execution);
    append_element(poses_, pose_json(view, object.number, millimetres_));
    append_element(infos_, info_json(view.accounts.objects[object.number], object.mask));
  }

  void end_view() {
    append_view(all_poses_, view_, "[" + poses_ + "]");
    append_view(all_infos_, view_, "[" + infos_ + "]");
    ++view_;
  }

  [[nodiscard]] std::vector<std::string> finish() {
    const auto add = [&](const char* name, const std::string& views) { folder_.add(name, "{\n" + views + "\n}\n"); };
    add("scene_camera.json", cameras_);
    add("scene_gt.json", all_poses_);
    add("scene_gt_info.json", all_infos_);
    return folder_.finish();
  }

 private:
  DatasetFolder folder_;
  BopVisible visible_;
  std::size_t view_ = 0, object_ = 0;  ///< number of the view, and of the object within the view
  double millimetres_ = 1;             ///< millimetres in a unit of the scene
  Image distances_;                    ///< distances along the rays of the view
  std::string poses_, infos_;          ///< JSON of the view
  std::string cameras_, all_poses_, all_infos_;
};

/// Masks as pictures: the visible part of each object, and the whole object within the frame.
///
///    000003_visible.png  000003_amodal.png                    of object 3
///    000012_000003_visible.png  000012_000003_amodal.png      of object 3 in view 12, if views are numbered
class MaskFolder {
 public:
  MaskFolder(const std::string& folder, bool is_numbered)
      : folder_(
            folder,
            {{"",
              {"000000_visible.png", "000000_amodal.png", "000000_000000_visible.png", "000000_000000_amodal.png"}}}),
        is_numbered_(is_numbered) {}

  void add(const DatasetView& view, std::size_t number, const ObjectInFrame& object, const Execution& execution) {
    const std::string begin = (is_numbered_ ? six_digits(number) + "_" : "") + six_digits(object.number);
    for (const auto& [part, word] : {std::pair(MaskPart::visible, "_visible.png"), {MaskPart::whole, "_amodal.png"}})
      folder_.add(begin + word, mask_image(object.mask, part, view.visible.view), {}, execution);
  }
  [[nodiscard]] std::vector<std::string> finish() { return folder_.finish(); }

 private:
  DatasetFolder folder_;
  bool is_numbered_;
};

/// For each instance: whether it has one of these names, or a category with one of these names. O(instances * names).
/// \throws Error bad_argument for a name that no object and no category has.
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

}  // namespace datasets

using namespace datasets;

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
