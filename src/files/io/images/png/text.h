// SPDX-License-Identifier: Apache-2.0
// Keywords of the text chunks that tell the meaning of the numbers in a PNG map, for load_image().
#pragma once

namespace frontmost::detail {

inline constexpr const char* png_channel_key =
    "frontmost:channel";  ///< the channel's name; "N" for the three of a direction
inline constexpr const char* png_scale_key = "frontmost:scale";  ///< depth = (value - offset) / scale
inline constexpr const char* png_offset_key = "frontmost:offset";
inline constexpr const char* png_ids_key = "frontmost:ids";  ///< marks an id map; id = value - 1

}  // namespace frontmost::detail
