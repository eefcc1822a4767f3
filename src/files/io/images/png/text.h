// SPDX-License-Identifier: Apache-2.0
// Keywords of the text chunks that say what the numbers in a PNG map mean, so that load_image() can turn them back.
#pragma once

namespace frontmost::detail {

inline constexpr const char* png_channel_key =
    "frontmost:channel";                                         ///< the channel's name; N: the three of a direction
inline constexpr const char* png_scale_key = "frontmost:scale";  ///< depth = (value - offset) / scale
inline constexpr const char* png_offset_key = "frontmost:offset";
inline constexpr const char* png_ids_key = "frontmost:ids";  ///< there: id = value - 1

}  // namespace frontmost::detail
