// SPDX-License-Identifier: Apache-2.0
// What one run of `frontmost render` has to do: the views, each with its files.
//
//   command line ---------------------> one Job
//   batch file ----> view 0, 1, 2 ... > a Job each: what the file does not say is taken from the command line
//
// Jobs are planned before the model is read. Whatever can be refused is refused then, for all of them.
#pragma once

#include <frontmost/image.h>

#include <memory>
#include <string>
#include <vector>

#include "cli/outputs.h"
#include "cli/settings.h"

namespace frontmost::cli {

/// One view, ready to be rendered.
struct Job {
  std::string name;        ///< {view}
  std::size_t number = 0;  ///< in the batch file, from 0
  std::uint64_t said = 0;  ///< as in Settings
  ViewSettings view;
  OutputSettings output;
  std::vector<FileToWrite> files, layer_files;  ///< of what is nearest, or of all; of single layers
  std::vector<std::string> figures;             ///< pictures of polygons
  std::string difference;                       ///< where the difference to the reference goes; empty: no reference
  std::shared_ptr<const Image> reference;       ///< what output.reference holds; none: to be read again
};

/// One job, or those of the batch file; all files have been checked.
/// \throws UsageError and Error as plan_outputs() and check_outputs() do; the batch file's complaints name the place.
[[nodiscard]] std::vector<Job> plan_jobs(const Settings& settings);

/// All files that the jobs write.
[[nodiscard]] std::vector<std::string> output_paths(const std::vector<Job>& jobs);

/// The settings of each view of a batch file. \throws UsageError naming file and place; Error file_unreadable, or
/// limit_exceeded for more than 64 MiB.
[[nodiscard]] std::vector<Settings> read_batch(const std::string& path, const Settings& defaults);
/// The same from text; `name` stands for the file in messages.
[[nodiscard]] std::vector<Settings> parse_batch(const std::string& text, const std::string& name,
                                                const Settings& defaults);

}  // namespace frontmost::cli
