// SPDX-License-Identifier: Apache-2.0
// Lossy formats, which hold a picture nearly as it is in far fewer bytes: JPEG and WebP.
#pragma once

#include "base/output_file.h"
#include "io/images/picture_rows.h"

namespace frontmost::detail {

/// Greatest width and height that the formats allow.
inline constexpr int most_jpeg_side = 65500, most_webp_side = 16383;

/// `quality` is 1 to 100. The writers check the sides before they allocate memory.
/// \throws Error limit_exceeded; unsupported: JPEG holds no alpha; WebP in a build without libwebp.
void save_jpeg(const PictureRows& picture, int quality, OutputFile& file, const Execution& execution);
void save_webp(const PictureRows& picture, int quality, OutputFile& file, const Execution& execution);

}  // namespace frontmost::detail
