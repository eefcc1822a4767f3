// SPDX-License-Identifier: Apache-2.0
// Whether what is in a picture can be told from its background.
#pragma once

#include <frontmost/figure.h>
#include <frontmost/image.h>
#include <frontmost/visible.h>

#include <optional>
#include <span>
#include <string>

namespace frontmost::cli {

/// A pixel stands out when one of its channels differs from the background's by more than 8 of 255 steps, which is
/// about what an eye can tell on a screen. Nothing stands out where fewer than one in a thousand of the pixels do that
/// see something at their first sample; `primitives` are those samples, or more. O(pixels), but ends at the first
/// thousandth that stands out. False where nothing is seen.
[[nodiscard]] bool nothing_stands_out(const Image& picture, std::span<const PrimitiveId> primitives,
                                      const glm::vec3& background);
[[nodiscard]] bool nothing_stands_out(const Bitmap& picture, std::span<const PrimitiveId> primitives,
                                      const glm::vec3& background);
/// The same of shapes, however large: all of them are like the background.
[[nodiscard]] bool nothing_stands_out(const Figure& figure, const glm::vec3& background);

/// What to say then.
[[nodiscard]] std::string contrast_warning();

}  // namespace frontmost::cli
