// SPDX-License-Identifier: Apache-2.0
// Stands for webp.cpp in builds without libwebp.
#include "io/images/lossy/lossy.h"

namespace frontmost::detail {

void save_webp(const PictureRows&, int, OutputFile& file, const Execution&) {
  throw Error(ErrorCode::unsupported,
              file.name() + ": this Frontmost was built without libwebp (Debian package libwebp-dev, FRONTMOST_WEBP)");
}

}  // namespace frontmost::detail
