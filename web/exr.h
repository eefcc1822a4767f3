// SPDX-License-Identifier: Apache-2.0
// OpenEXR's simplest files, for a module without that library: one part, whole numbers and floats of 32 bits as they
// are, uncompressed.
#pragma once

#include <frontmost/image.h>

#include <string>

namespace frontmost::web {

/// The bytes of a file of all channels. Precondition: as validate(image). (Technical Introduction to OpenEXR, OpenEXR
/// File Layout.)
[[nodiscard]] std::string exr_bytes(const Image& image);

}  // namespace frontmost::web
