// SPDX-License-Identifier: Apache-2.0
// STL in both encodings, and how to tell them apart.
#pragma once

#include "io/models/reader.h"

namespace frontmost {

enum class StlEncoding : std::uint8_t { binary, ascii, neither };

/// The encoding of a file of `file_size` bytes. `start` holds its first 1024 bytes, or all. The word "solid" at the
/// start proves nothing, since many binary files have it:
/// - binary: the size fits the triangle count exactly, or bytes that are no text exceed the count's size;
/// - ascii: text that starts with "solid";
/// - neither: anything else. At least 84 bytes that are no text may be a broken binary file, but only the caller knows
///   whether the file's name says STL.
[[nodiscard]] StlEncoding stl_encoding(Bytes start, std::uint64_t file_size);
[[nodiscard]] inline StlEncoding stl_encoding(Bytes bytes) { return stl_encoding(bytes, bytes.size()); }
/// The encoding of a file that should be STL; binary for one that may be a broken binary file. \throws Error with the
/// reason if it is neither.
[[nodiscard]] StlEncoding known_stl_encoding(Bytes start, std::uint64_t file_size, const ModelSource& source);

[[nodiscard]] Scene read_binary_stl(Bytes bytes, const ModelSource& source);
[[nodiscard]] Scene read_ascii_stl(Bytes bytes, const ModelSource& source);

// Sizes in a binary file: 84 bytes of header, and records of 50.
inline constexpr std::size_t stl_prelude_size = 84, stl_record_size = 50;

/// The count in the header, which cannot be trusted.
[[nodiscard]] std::uint64_t stl_promised_count(Bytes prelude);
/// The number of triangles to read, by comparing the header with the size. Writers that cannot seek back leave 0 or
/// 0xFFFFFFFF as the count; then the size decides, if it fits whole records. Oddities cause warnings.
[[nodiscard]] std::uint64_t stl_checked_count(Bytes prelude, std::uint64_t file_size, const ModelSource& source,
                                              std::vector<std::string>& warnings);
/// The solid's name, if the header is text. Exporters often put "solid NAME" there.
[[nodiscard]] std::string stl_header_name(Bytes prelude);

/// Colours of triangles. Two groups of programs store them in the two bytes behind each triangle, 5 bits a channel:
/// - VisCAM and SolidView: if bit 15 is set, the triangle has a colour, with blue in the lowest bits;
/// - Magics: the header has "COLOR=" and the colour of the whole part. If bit 15 is clear, a triangle has its own
///   colour, with red in the lowest bits. MeshLab writes such files with bit 15 set.
class StlColors {
 public:
  explicit StlColors(Bytes prelude);
  /// Whether any of these records has a colour. Otherwise the bytes are all 0 or mean something else.
  [[nodiscard]] bool are_in(Bytes records) const;
  /// The colour of a triangle, linear and opaque, because some writers leave alpha open. White if it has none.
  [[nodiscard]] glm::vec4 of(Bytes record) const;

 private:
  glm::vec4 part_{1};
  bool is_red_lowest_ = false, is_own_by_bit_ = true;
};

/// Appends the triangles of whole records, with colours unless `colors` is null.
void append_stl_records(Bytes records, const StlColors* colors, Mesh& mesh);

}  // namespace frontmost
