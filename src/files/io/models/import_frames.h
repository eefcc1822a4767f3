// SPDX-License-Identifier: Apache-2.0
// What frontmost-import writes to its standard output, for load(): frames, each a kind, the payload's size in 8 bytes
// (least significant first), and the payload.
//
//   | 'p' | 3 | 0.4 |   | 'w' | 24 | face 7 has no triangles |   | 's' | 7 | 0.001 z |   | 'm' | 81,312 | glTF ... |
//
// A model or an error ends the answer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace frontmost::import_frames {

enum class Kind : char {
  progress = 'p',  ///< a number from 0 to 1, as text
  warning = 'w',   ///< a sentence about something that was left out
  space = 's',  ///< metres for one unit, or "-" if the file does not say; a blank; the upward axis: x, y, z or -x ...
  file = 'f',   ///< the path of a program or library that made the answer; if there are none, the answer is not kept
  model = 'm',  ///< a binary glTF file; its coordinates are the file's, whatever glTF's unit
  error = 'e',  ///< the reason why there is no model
};

inline constexpr std::size_t header_bytes = 9;
/// Greatest size of a payload that is text.
inline constexpr std::uint64_t longest_text = 4096;

using Header = std::array<unsigned char, header_bytes>;

[[nodiscard]] inline Header header_of(Kind kind, std::uint64_t size) {
  Header header{static_cast<unsigned char>(kind)};
  for (std::size_t i = 1; i < header_bytes; ++i) header[i] = static_cast<unsigned char>(size >> 8 * (i - 1));
  return header;
}

/// The size of the payload of a frame. Precondition: its header is there.
[[nodiscard]] inline std::uint64_t payload_size(const std::byte* frame) {
  std::uint64_t size = 0;
  for (std::size_t i = 1; i < header_bytes; ++i) size |= std::uint64_t(frame[i]) << 8 * (i - 1);
  return size;
}

}  // namespace frontmost::import_frames
