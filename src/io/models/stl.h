// SPDX-License-Identifier: Apache-2.0
// STL in both encodings, and how to tell them apart.
#pragma once

#include "io/models/reader.h"

namespace frontmost {

enum class StlEncoding : std::uint8_t { binary, ascii, neither };

/// Which encoding the bytes are in. The word "solid" at the start proves nothing, since many binary files have it:
/// - a size that fits the triangle count exactly, or the count plus trailing bytes where the contents are not text,
///   is binary;
/// - text that starts with "solid" is ASCII;
/// - anything else of at least 84 bytes that is not text may be a broken binary file only if its name says STL, which
///   is for the caller to know: `neither`.
[[nodiscard]] StlEncoding stl_encoding(Bytes bytes);

[[nodiscard]] Scene read_binary_stl(Bytes bytes, const ModelSource& source);
[[nodiscard]] Scene read_ascii_stl(Bytes bytes, const ModelSource& source);

}  // namespace frontmost
