// SPDX-License-Identifier: Apache-2.0
// Paper and scales, as drawing standards have them.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <string_view>

namespace frontmost {

/// A sheet of paper, before it is known how large the drawing on it is.
struct Paper {
  glm::dvec2 size{210, 297};  ///< millimetres, 1 to 100000 each
  bool may_turn = true;       ///< the sides change places where that suits the drawing better
  bool fits_drawing = false;  ///< as large as the drawing and its margins; the size does not count
};

/// The paper of a name: "a0" to "a6", "letter", "legal" or "tabloid", in small letters or capitals. With "-portrait" or
/// "-landscape" behind the name it does not turn. \throws Error bad_argument for any other name.
[[nodiscard]] Paper named_paper(std::string_view name);
/// The name of paper of that size in millimetres, whichever way it lies: "A3"; "420 x 200" where it has none.
[[nodiscard]] std::string paper_name(const glm::dvec2& size);

/// A scale as drawings write it: "1:5", "2:1", "1:3.2".
[[nodiscard]] std::string scale_text(double scale);
/// The largest scale of ISO 5455 (1, 2 and 5 times powers of ten, and their reciprocals) that is not above `most`: from
/// 5e9:1 to 1:1e10; `most` itself where that is below them.
[[nodiscard]] double standard_scale(double most);

}  // namespace frontmost
