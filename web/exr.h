// SPDX-License-Identifier: Apache-2.0
// OpenEXR's simplest files, for a module without that library: one part, uncompressed 32-bit integers and floats.
#pragma once

#include <frontmost/image.h>

#include <string>

namespace frontmost::web {

/// The bytes of a file with all channels. Precondition: as validate(image). (Technical Introduction to OpenEXR, OpenEXR
/// File Layout.)
[[nodiscard]] std::string exr_bytes(const Image& image);

}  // namespace frontmost::web
