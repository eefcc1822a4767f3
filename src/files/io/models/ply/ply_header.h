// SPDX-License-Identifier: Apache-2.0
// The header of a PLY file, which describes its rows. Also helpers shared by reading whole files and by streaming.
//
//   ply
//   format binary_little_endian 1.0
//   element vertex 8                       an element: a number of rows; rows are in the order of the elements
//   property float x                       a property: one number of each row
//   ...
//   element face 12
//   property list uchar int vertex_indices a list: the count, then so many numbers
//   end_header
#pragma once

#include <string>
#include <vector>

#include "io/models/bytes.h"
#include "io/models/reader.h"

namespace frontmost {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

[[nodiscard]] constexpr std::size_t size_of(PlyType type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[std::size_t(type)];
}
[[nodiscard]] constexpr bool is_integer(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  bool is_list = false;
  PlyType count_type = PlyType::uint8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// The size of a row whose lists are empty; without lists, the size of each row.
  [[nodiscard]] std::size_t least_row_size() const;
  [[nodiscard]] bool has_lists() const;
};

enum class PlyEncoding : std::uint8_t { ascii, little, big };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> texture_files;  ///< from "comment TextureFile NAME", as MeshLab writes them
  std::vector<std::string> warnings;
  std::size_t size = 0;        ///< bytes before the first row
  std::size_t line_count = 0;  ///< lines before the first row
};

/// The byte order of a binary file's rows.
[[nodiscard]] inline Endian endian_of(const PlyHeader& header) {
  return header.encoding == PlyEncoding::big ? Endian::big : Endian::little;
}

/// Reads the header. `bytes` start the file and hold at least its header; the whole file has `file_size` bytes.
/// \throws Error file_malformed, also when the file is too short for the rows that the header promises.
[[nodiscard]] PlyHeader read_ply_header(Bytes bytes, std::uint64_t file_size, const ModelSource& source);
[[nodiscard]] inline PlyHeader read_ply_header(Bytes bytes, const ModelSource& source) {
  return read_ply_header(bytes, bytes.size(), source);
}

/// Adds materials for the texture files that the header names; the scene's first mesh uses them.
void add_texture_materials(const PlyHeader& header, const ModelSource& source, Scene& scene);

/// A warning for Scene::warnings.
[[nodiscard]] std::string skipped_faces_warning(std::uint64_t count);

}  // namespace frontmost
