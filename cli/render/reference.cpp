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

ReferenceResult compare_with_reference(const Image& picture, const Job& job, const Execution& execution) {
  const Image reference = load_image(*job.output.reference);
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
