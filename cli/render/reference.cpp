// SPDX-License-Identifier: Apache-2.0
#include "cli/render/reference.h"

#include "cli/interruption.h"

namespace frontmost::cli {
namespace {

/// Sizes or channels that are not the same are the reference's fault.
Comparison compared(const Image& picture, const Image& reference, const Job& job, const Execution& execution) {
  try {
    return compare(picture, reference, job.output.reference_threshold, execution);
  } catch (const Error& error) {
    throw Error(error.code(), *job.output.reference + ": " + error.what());
  }
}

}  // namespace

void read_references(std::vector<Job>& jobs) {
  constexpr std::size_t most_pixels = std::size_t(1) << 26;
  std::size_t pixels = 0;
  for (Job& job : jobs) {
    if (!job.output.reference) continue;
    stop_if_interrupted();
    auto reference = std::make_shared<const Image>(load_image(*job.output.reference));
    pixels += std::size_t(reference->width) * std::size_t(reference->height);
    if (pixels <= most_pixels) job.reference = std::move(reference);
  }
}

ReferenceResult compare_with_reference(const Image& picture, const Job& job, const Execution& execution) {
  const auto kept = job.reference ? job.reference : std::make_shared<const Image>(load_image(*job.output.reference));
  const Image& reference = *kept;
  const Comparison comparison = compared(picture, reference, job, execution);
  ReferenceResult result{*job.output.reference, {}, comparison.error, comparison.mean, comparison.differing, true};
  if (comparison.differing == 0) return result;
  result.passed = false;
  result.difference_path = job.difference;
  const Image difference = difference_image(picture, reference, job.output.reference_threshold, execution);
  const WritingFiles writing;
  save(difference, job.difference, {}, execution);
  return result;
}

}  // namespace frontmost::cli
