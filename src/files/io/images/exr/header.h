// SPDX-License-Identifier: Apache-2.0
// Checks the sizes in an OpenEXR header before the library, which allocates memory by them, sees the file.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace frontmost::detail {

/// \throws Error file_malformed, limit_exceeded, or unsupported for tiled, deep and multi-part files.
void check_exr_header(std::span<const std::byte> bytes, const std::string& name);

}  // namespace frontmost::detail
