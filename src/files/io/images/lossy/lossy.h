// SPDX-License-Identifier: Apache-2.0
// Formats that hold a picture nearly as it is, in much fewer bytes: JPEG and WebP.
#pragma once

#include "base/output_file.h"
#include "io/images/picture_rows.h"

namespace frontmost::detail {

/// The widest and highest pictures of the formats.
inline constexpr int most_jpeg_side = 65500, most_webp_side = 16383;

/// `quality` is 1 to 100. They check the sides before they ask for memory.
/// \throws Error limit_exceeded; unsupported: JPEG holds no alpha; WebP in a build without libwebp.
void save_jpeg(const PictureRows& picture, int quality, OutputFile& file, const Execution& execution);
void save_webp(const PictureRows& picture, int quality, OutputFile& file, const Execution& execution);

}  // namespace frontmost::detail
