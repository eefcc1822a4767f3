// SPDX-License-Identifier: Apache-2.0
// What frontmost-import writes to its standard output, for load(): frames, each a kind, the payload's size in 8 bytes
// (least significant first), and the payload.
//
//   | 'p' | 3 | 0.4 |   | 'w' | 24 | face 7 has no triangles |   | 's' | 7 | 0.001 z |   | 'm' | 81,312 | glTF ... |
//
// A model or an error ends the answer.
#pragma once

#include <cstddef>
#include <cstdint>

namespace frontmost::import_frames {

enum class Kind : char {
  progress = 'p',  ///< a number from 0 to 1, as text
  warning = 'w',   ///< a sentence about something that was left out
  space = 's',  ///< metres for one unit, or "-" if the file does not say; a blank; the upward axis: x, y, z or -x ...
  model = 'm',  ///< a binary glTF file; its coordinates are the file's, whatever glTF's unit
  error = 'e',  ///< the reason why there is no model
};

inline constexpr std::size_t header_bytes = 9;
/// Greatest size of a payload that is text.
inline constexpr std::uint64_t longest_text = 4096;

}  // namespace frontmost::import_frames
