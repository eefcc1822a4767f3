// SPDX-License-Identifier: Apache-2.0
// Why two methods see different things at a sample, and whether both may be right.
//
// The z-buffer snaps corners to 1/256 pixel, rays snap nothing, and the A-buffer answers in layers. So along edges and
// where surfaces nearly coincide their answers differ, and an exact comparison of pictures would prove nothing. Here
// every sample that differs is put to exact arithmetic: either it is shown why both answers are possible, or one of
// them is wrong.
#pragma once

#include "frontmost/surfaces.h"
#include "frontmost/visible.h"

namespace frontmost {

/// Why two answers part at a sample.
enum class Difference : std::uint8_t {
  none,         ///< they do not
  edge,         ///< an edge of a triangle passes within 1/128 pixel
  depth,        ///< all that is shown covers the sample surely, at depths closer than can be told apart
  translucent,  ///< one shows what lies behind a translucent triangle that the other shows
  unexplained,  ///< one of the answers is wrong
};
/// "edge", "depth" and so on.
[[nodiscard]] std::string_view name(Difference difference);

/// How far two answers agree.
struct Agreement {
  View view;
  /// Samples by Difference; `none` counts those where both show the same, at a right depth.
  std::array<std::uint64_t, 5> counts{};
  Buffer<Difference> differences;  ///< in the order of Visible

  [[nodiscard]] std::uint64_t count(Difference difference) const { return counts[std::size_t(difference)]; }
  [[nodiscard]] std::uint64_t differing() const;
};

/// Compares two answers, and puts every sample where they part to exact arithmetic. Methods place corners on the screen
/// in their own way, all within 1/128 pixel of the truth, so about a sample lies the square of +-1/128 pixel in which
/// they may be looking. An answer is possible when
/// - what it shows meets that square, or it shows nothing;
/// - no triangle of the scene that contains the whole square, and is not left out by View::culling, is surely nearer
///   (for nothing: none contains it). Surely nearer: its least key over the square exceeds the other's greatest by more
///   than float arithmetic makes of them: 20 roundings, 2^-24 each, of the key itself, and 6 times as many as the
///   corner farthest aside is farther from the eye than deep (beside the guard band nothing counts; in parallel
///   projection 20 roundings of the greatest key, and 6 of the distance from the eye to the farthest corner).
/// Two possible answers part for the reason `depth` where both triangles contain the square, otherwise for `edge` (the
/// rim that the near and far plane cut counts as one). Any other difference is `unexplained`; and so is a key, of
/// either answer and at any sample, that its triangle does not have in the square, with the same allowance.
///
/// Corners are the floats of Surfaces::corners(), rays the doubles of the view; from there on signs are exact, as long
/// as coordinates are 0 or between 2^-100 and 2^100.
/// O(samples + triangles + differing samples * triangles over them), in parallel.
/// \throws Error bad_argument when the two are of different views.
[[nodiscard]] Agreement check_agreement(const Surfaces& surfaces, const Visible& a, const Visible& b,
                                        const Execution& execution = {});

/// Adds what shows through, for methods that answer in layers: of the samples that agree, those where `behind` shows
/// something become `translucent` where the material of what `front` shows lets light through (alpha mode blend), and
/// `unexplained` where it is opaque. O(samples).
/// \throws Error bad_argument when they are of different views.
void see_through(Agreement& agreement, const Surfaces& surfaces, const Visible& front, const Visible& behind);

}  // namespace frontmost
