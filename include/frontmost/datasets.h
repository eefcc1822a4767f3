// SPDX-License-Identifier: Apache-2.0
// Reports as files of data sets: COCO's annotations, scenes of BOP, and masks.
//
//   DatasetWriter writer({.bop = "scene"});
//   for (const View& view : views) {
//     const Visible visible = zbuffer(surfaces, view);
//     writer.add({surfaces, visible, account(surfaces, visible)}, "");
//   }
//   writer.finish();
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "frontmost/accounting.h"

namespace frontmost {

/// Which samples of an object BOP's files call visible: those that see it, or what is at most 15 mm behind.
enum class BopVisible : std::uint8_t { exact, bop19 };

struct DatasetOptions {
  std::optional<std::string> coco;        ///< the file of the annotations: JSON; "-" is standard output
  std::optional<std::string> bop, masks;  ///< folders, which are made where they are missing
  bool coco_polygons = false;             ///< masks of COCO as polygons, not as run lengths
  BopVisible bop_visible = BopVisible::exact;
  bool are_masks_numbered = false;  ///< names of masks begin with the number of the view, as for several views
  /// Names of objects, or of categories, that get no annotation, mask or pose. They still hide others.
  std::vector<std::string> leave_out;
};

/// One view with what was found out about its objects. Borrows all of it.
struct DatasetView {
  const Surfaces& surfaces;
  const Visible& visible;      ///< as zbuffer() gave it, with one sample a pixel
  const Accounting& accounts;  ///< of both
};

/// Which objects of a scene have one of these names, or a category of one of these names; by instance.
/// O(instances * names). \throws Error bad_argument for a name that no object and no category has.
[[nodiscard]] std::vector<bool> named_objects(const Scene& scene, const std::vector<std::string>& names);

/// Writes the objects of one view after another. docs/command-line.md says what the files hold. BOP's and the masks'
/// files are written into a hidden folder and moved when all views are there; COCO's text is kept until then.
class DatasetWriter {
 public:
  /// Makes the folders. \throws Error file_unwritable where one cannot be made.
  explicit DatasetWriter(const DatasetOptions& options);
  ~DatasetWriter();
  DatasetWriter(const DatasetWriter&) = delete;
  DatasetWriter& operator=(const DatasetWriter&) = delete;

  /// Views count from 0, in this order; `picture` is COCO's file_name. Views may be of several scenes.
  /// \throws Error file_unwritable; unsupported for BOP of a parallel view, or of an object that is stretched or
  /// mirrored; bad_argument as named_objects() does, for more samples than one, and for two categories of one number.
  /// After an error only the destructor may be called.
  void add(const DatasetView& view, const std::string& picture, const Execution& execution = {});

  /// Moves the files to their places, and removes masks and depths that an earlier writer left in the same folders:
  /// files of the same kinds of names.
  /// \returns the paths of all files. \throws Error file_unwritable. Call once.
  std::vector<std::string> finish();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace frontmost
