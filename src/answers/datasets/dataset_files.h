// SPDX-License-Identifier: Apache-2.0
// The three kinds of files that DatasetWriter fills, one object at a time.
//
//   DatasetWriter::add() --every object in the picture--> CocoFile       text, kept
//                                                     --> BopFolder      masks and depths, staged; poses, kept
//                                                     --> MaskFolder     masks, staged
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "frontmost/base.h"
#include "frontmost/files.h"
#include "frontmost/report.h"

namespace frontmost::datasets {

using Json = nlohmann::ordered_json;

/// An object with samples in the picture.
struct ObjectInFrame {
  std::uint32_t number;  ///< of the instance
  PixelMask mask;
};

/// A picture of the view's size, white in the pixels of the part and black elsewhere.
[[nodiscard]] Image mask_image(const PixelMask& mask, MaskPart part, const View& view);

/// A number in file names: "000042".
[[nodiscard]] std::string six_digits(std::size_t number);

/// Patterns of numbered file names: 000001.png; 000001_000002.png; 000002_visible.png or 000001_000002_amodal.png.
enum class FileNames : std::uint8_t { one_number, two_numbers, parts_of_masks };

/// A folder of files. After finish() all of them are there; without it, none.
class DatasetFolder {
 public:
  /// A subfolder of numbered files; the name "" stands for the folder itself.
  struct Within {
    std::string name;
    FileNames files;
  };

  /// \throws Error file_unwritable.
  DatasetFolder(const std::string& folder, std::vector<Within> within);

  void add(const std::string& name, const Image& image, const SaveOptions& options, const Execution& execution);
  void add(const std::string& name, const std::string& text);
  /// Moves the files to their places, and removes other numbered files from the folders within. \returns the paths.
  [[nodiscard]] std::vector<std::string> finish();

 private:
  template <class Write>
  void write(const std::string& name, const Write& write);

  std::string folder_;
  MadeFolder made_;
  StagedFolder staged_;
  std::vector<Within> within_;
  std::vector<std::string> names_;
};

/// COCO annotations of visible parts (https://cocodataset.org/#format-data), with fields for hidden parts.
class CocoFile {
 public:
  explicit CocoFile(bool with_polygons) : with_polygons_(with_polygons) {}

  /// `left_out` is by instance. \throws Error bad_argument for two categories of one number.
  void begin_view(const DatasetView& view, const std::string& picture, const std::vector<bool>& left_out);
  void add(const DatasetView& view, const ObjectInFrame& object);
  [[nodiscard]] std::string text() const;

 private:
  void add_category(std::uint32_t number, const std::string& name);

  bool with_polygons_;
  std::map<std::uint32_t, std::string> categories_;  ///< by number
  std::map<std::string, std::uint32_t> names_;       ///< objects without a category, and their numbers
  std::uint32_t last_ = 0;                           ///< the highest number
  std::vector<std::uint32_t> order_;                 ///< the numbers in the order of their arrival
  std::size_t image_count_ = 0, annotation_count_ = 0;
  std::string images_, annotations_;
};

/// A scene of BOP: https://github.com/thodan/bop_toolkit, docs/bop_datasets_format.md.
///
///    scene_camera.json  scene_gt.json  scene_gt_info.json  depth/000000.png  mask/000000_*.png mask_visib/000000_*.png
class BopFolder {
 public:
  BopFolder(const std::string& folder, BopVisible visible)
      : folder_(folder, {{"depth", FileNames::one_number},
                         {"mask", FileNames::two_numbers},
                         {"mask_visib", FileNames::two_numbers}}),
        visible_(visible) {}

  /// \throws Error unsupported for parallel views.
  void begin_view(const DatasetView& view, const Execution& execution);
  /// \throws Error unsupported for an object that is stretched or mirrored.
  void add(const DatasetView& view, ObjectInFrame object, const Execution& execution);
  void end_view();
  [[nodiscard]] std::vector<std::string> finish();

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
      : folder_(folder, {{"", FileNames::parts_of_masks}}), is_numbered_(is_numbered) {}

  void add(const DatasetView& view, std::size_t number, const ObjectInFrame& object, const Execution& execution);
  [[nodiscard]] std::vector<std::string> finish() { return folder_.finish(); }

 private:
  DatasetFolder folder_;
  bool is_numbered_;
};

}  // namespace frontmost::datasets
