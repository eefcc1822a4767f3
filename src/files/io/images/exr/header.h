// SPDX-License-Identifier: Apache-2.0
// The sizes in an OpenEXR header, read before the library sees the file: it asks for memory as the header says.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace frontmost::detail {

/// \throws Error file_malformed, limit_exceeded, or unsupported for tiled, deep and multi-part files.
void check_exr_header(std::span<const std::byte> bytes, const std::string& name);

}  // namespace frontmost::detail
