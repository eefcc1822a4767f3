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
/// `start` holds the first bytes, 1024 of them where there are as many, of a file of `file_size`.
[[nodiscard]] StlEncoding stl_encoding(Bytes start, std::uint64_t file_size);
[[nodiscard]] inline StlEncoding stl_encoding(Bytes bytes) { return stl_encoding(bytes, bytes.size()); }
/// The same, or an error that says why it is neither.
[[nodiscard]] StlEncoding known_stl_encoding(Bytes start, std::uint64_t file_size, const ModelSource& source);

[[nodiscard]] Scene read_binary_stl(Bytes bytes, const ModelSource& source);
[[nodiscard]] Scene read_ascii_stl(Bytes bytes, const ModelSource& source);

// The parts of a binary file: 84 bytes of header, and records of 50.
inline constexpr std::size_t stl_prelude_size = 84, stl_record_size = 50;

/// The count in the header, which is not to be trusted.
[[nodiscard]] std::uint64_t stl_promised_count(Bytes prelude);
/// How many triangles to read, after holding the header against the size. Writers that cannot seek back leave 0 or
/// 0xFFFFFFFF as the count; then the size decides, if it fits whole records. Oddities become warnings.
[[nodiscard]] std::uint64_t stl_checked_count(Bytes prelude, std::uint64_t file_size, const ModelSource& source,
                                              std::vector<std::string>& warnings);
/// The solid's name, if the header is text. Exporters often put "solid NAME" there.
[[nodiscard]] std::string stl_header_name(Bytes prelude);
/// Appends the triangles of whole records.
void append_stl_records(Bytes records, Mesh& mesh);

}  // namespace frontmost
