// SPDX-License-Identifier: Apache-2.0
// The jobs of a run of `frontmost render`: views, each with its files.
//
//   command line ---------------------> one Job
//   batch file ----> view 0, 1, 2 ... > a Job each: settings that the file omits are taken from the command line
//
// Jobs are planned before the model is read, so that errors in any of them are reported first.
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
  std::string name;        ///< text for {view} in file names
  std::size_t number = 0;  ///< number of the view in the batch file, from 0
  std::uint64_t said = 0;  ///< as Settings::said
  ViewSettings view;
  OutputSettings output;
  std::vector<FileToWrite> files, layer_files;  ///< files of the front-most surface or of all surfaces, and files of
                                                ///< single layers
  std::vector<std::string> figures;             ///< pictures of polygons
  std::string difference;                       ///< path of the difference to the reference; empty: no reference
  std::shared_ptr<const Image> reference;       ///< contents of output.reference; null: to be read again
};

/// Plans one job, or those of the batch file, and checks all their files.
/// \throws UsageError and Error as plan_outputs() and check_outputs() do; errors in the batch file name the place.
[[nodiscard]] std::vector<Job> plan_jobs(const Settings& settings);

/// Returns all files that the jobs write.
[[nodiscard]] std::vector<std::string> output_paths(const std::vector<Job>& jobs);

/// Returns the settings of each view of a batch file. \throws UsageError naming file and place; Error file_unreadable,
/// or limit_exceeded for more than 64 MiB.
[[nodiscard]] std::vector<Settings> read_batch(const std::string& path, const Settings& defaults);
/// Returns the settings of each view from a batch file's text. `name` stands for the file in messages.
[[nodiscard]] std::vector<Settings> parse_batch(const std::string& text, const std::string& name,
                                                const Settings& defaults);

}  // namespace frontmost::cli
