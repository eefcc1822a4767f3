// SPDX-License-Identifier: Apache-2.0
// Paper and scales, as drawing standards have them.
#pragma once

#include <string>
#include <string_view>

#include "cli/settings.h"

namespace frontmost::cli {

/// "A4", "a3-landscape", "letter-portrait", "210,297" or "210x297" in millimetres, or "fit".
/// \throws UsageError
[[nodiscard]] PaperSettings parse_paper(std::string_view text);

/// "A3" and the like, however it lies; "420 x 200" in millimetres where it has no name.
[[nodiscard]] std::string paper_text(const glm::dvec2& size);

/// "1:5", "2:1" or "0.2". \throws UsageError
[[nodiscard]] double parse_scale(std::string_view text);
/// The other way round: "1:5", "2:1", "1:3.2".
[[nodiscard]] std::string scale_text(double scale);
/// The largest scale of ISO 5455 (1, 2 and 5 times powers of ten, and their reciprocals) that is not above `most`.
/// From 5e9:1 to 1:1e10; `most` itself where it is below them.
[[nodiscard]] double standard_scale(double most);

}  // namespace frontmost::cli
