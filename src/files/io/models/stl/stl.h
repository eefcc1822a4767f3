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

/// The colours of triangles, which two groups of programs keep in the two bytes behind each, 5 bits a channel:
/// - VisCAM and SolidView: with bit 15 set a triangle has a colour, blue in the lowest bits;
/// - Magics: the header has "COLOR=" and the colour of the whole part. With bit 15 clear a triangle has a colour of its
///   own, red in the lowest bits. MeshLab writes such files with bit 15 set.
class StlColors {
 public:
  explicit StlColors(Bytes prelude);
  /// Whether any of these records has a colour. Without one the bytes are all 0, or mean something else.
  [[nodiscard]] bool are_in(Bytes records) const;
  /// Linear and opaque: some writers leave alpha open. White for a triangle that has none.
  [[nodiscard]] glm::vec4 of(Bytes record) const;

 private:
  glm::vec4 part_{1};
  bool is_red_lowest_ = false, is_own_by_bit_ = true;
};

/// Appends the triangles of whole records, with colours where `colors` is not null.
void append_stl_records(Bytes records, const StlColors* colors, Mesh& mesh);

}  // namespace frontmost
