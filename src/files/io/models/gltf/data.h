// SPDX-License-Identifier: Apache-2.0
// The binary part of a glTF file: buffers, buffer views and accessors. Every range is checked once, here, before
// anything is read.
//
//   GLB   | "glTF" | 2 | length |   | size | "JSON" | text ... |   | size | "BIN" | bytes ... |   | others
//           12 bytes                  8 bytes                        8 bytes; may be missing         passed over
//
// Arrays may be compressed. Each decoder is an optional part of a build; io/absent.cpp replaces it if it is left out.
//
//   bufferViews[3]             --EXT_meshopt_compression----> bytes of the view
//   meshes[0].primitives[0]    --KHR_draco_mesh_compression-> corners and attributes, as further accessors
#pragma once

#include <deque>
#include <map>
#include <tuple>
#include <vector>

#include "io/input_file.h"
#include "io/models/gltf/json.h"

namespace frontmost::gltf {

struct Container {
  std::string_view json;
  std::span<const std::byte> binary;  ///< the BIN chunk
  bool has_binary = false;
  bool is_glb = false;
};

/// Borrows `bytes`. Skips bytes behind a GLB's stated length, and chunks of unknown types, as the format requires.
[[nodiscard]] Container open_container(std::span<const std::byte> bytes, const ModelSource& source);

[[nodiscard]] bool is_data_uri(std::string_view uri);
/// Decodes "data:[TYPE][;base64],...". `place` is the value that holds the URI.
[[nodiscard]] std::vector<std::byte> decode_data_uri(std::string_view uri, const JsonValue& place);
/// Decodes %20 and the like. Text that is no valid escape stays.
[[nodiscard]] std::string percent_decode(std::string_view text);

enum class Component : std::uint16_t { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };
[[nodiscard]] std::size_t size_of(Component component);

/// A buffer, or a view of one.
struct ByteExtent {
  Bytes bytes;               ///< empty if not present
  std::uint64_t length = 0;  ///< as stated in the file
  std::size_t stride = 0;    ///< stride of the buffer view; 0: elements are tightly packed
  bool present = false;      ///< false: the file provides no contents, which is an error if they are read
};

/// Elements that replace some of an accessor's elements.
struct Sparse {
  std::size_t count = 0, value_stride = 0;
  Component index_type{};
  Bytes indices, values;                                   ///< packed; values have the accessor's type
  [[nodiscard]] std::uint32_t index(std::size_t i) const;  ///< strictly increasing
};

struct Accessor {
  std::size_t count = 0;
  Component component{};
  int components = 0;
  int rows = 0;  ///< components in a column; less than `components` for matrices
  bool normalized = false;
  Bytes bytes;                    ///< from the first element on; empty: all elements are zero
  std::size_t stride = 0;         ///< bytes from one element to the next
  std::size_t size = 0;           ///< bytes of an element, from its first component to the end of its last
  std::size_t column_stride = 0;  ///< bytes from one column of an element to the next
  std::optional<Sparse> sparse;
  const char* unreadable = nullptr;  ///< the reason if its elements cannot be read, else null
};

/// Elements [first, first + count) of an accessor.
struct ElementRange {
  std::size_t first = 0, count = 0;
};

/// The binary part of a glTF file.
class Data {
 public:
  Data(const JsonValue& root, const Container& container);

  [[nodiscard]] std::size_t view_count() const { return views_.size(); }
  [[nodiscard]] std::size_t accessor_count() const { return accessors_.size(); }
  [[nodiscard]] const Accessor& accessor(std::uint32_t i) const { return accessors_[i]; }
  /// Returns the number of the accessor that `user` names. \throws Error if it cannot be read.
  [[nodiscard]] std::uint32_t readable_accessor(const JsonValue& user) const;
  /// Returns the bytes of a view, which must have contents. `user` is the place that refers to the view.
  [[nodiscard]] Bytes view_bytes(std::uint32_t i, const JsonValue& user) const;
  /// Returns the size of the file and of the files that it names, in bytes.
  [[nodiscard]] std::uint64_t byte_count() const;

  /// Keeps decoded bytes. \returns a view of them, valid during the object's lifetime.
  [[nodiscard]] Bytes keep(std::vector<std::byte> bytes) { return decoded_.emplace_back(std::move(bytes)); }
  /// Adds an accessor. \returns its number, which follows those of the file.
  std::uint32_t add(const Accessor& accessor);

 private:
  void read_buffer(const JsonValue& json, const Container& container);
  [[nodiscard]] Bytes file_bytes(const std::string& path, const ModelSource& source);
  void read_view(const JsonValue& json, Budget& decoded);
  [[nodiscard]] Bytes decode_view(const JsonValue& compression, std::uint64_t length, Budget& decoded);
  void read_accessor(const JsonValue& json);
  void find_elements(const JsonValue& json, Accessor& accessor) const;
  void read_sparse(const JsonValue& json, Accessor& accessor, std::size_t value_stride) const;
  [[nodiscard]] Bytes packed(const JsonValue& json, std::size_t count, std::size_t stride, std::size_t size) const;

  std::deque<std::vector<std::byte>> decoded_;  ///< data URIs and output of decoders; a deque keeps addresses valid
  std::map<std::string, InputFile> files_;
  std::vector<ByteExtent> buffers_, views_;
  std::vector<Accessor> accessors_;
  std::uint64_t container_bytes_ = 0;
};

/// Reads a range of an accessor as floats, `width` of them for each element. Normalised integers are mapped to [0, 1]
/// or [-1, 1]; others keep their values. If the accessor has fewer components than `width`, the rest of `out` is not
/// changed; components beyond `width` are skipped.
void read_floats(const Accessor& accessor, ElementRange range, int width, float* out);
/// Reads a range as unsigned integers. Precondition: the accessor has an unsigned type.
void read_integers(const Accessor& accessor, ElementRange range, int width, std::uint32_t* out);

/// Whether this build contains the decoder.
[[nodiscard]] bool has_meshopt();
[[nodiscard]] bool has_draco();

/// Decodes a compressed view to `length` bytes. `json` is the extension. Precondition: has_meshopt().
/// \throws Error file_malformed, unsupported.
[[nodiscard]] std::vector<std::byte> decode_meshopt(const JsonValue& json, Bytes compressed, std::uint64_t length);

/// The numbers of the accessors of a primitive's decoded arrays.
struct DecodedPrimitive {
  std::uint32_t indices = no_index;
  std::map<std::string, std::uint32_t> attributes;
};

/// Decodes each buffer view of KHR_draco_mesh_compression once, and adds its arrays to the file's accessors.
class DracoPrimitives {
 public:
  explicit DracoPrimitives(Data& data) : data_(data), budget_(data.byte_count()) {}
  /// Returns the decoded arrays, or nothing if the primitive is not compressed or if this build has no Draco. \throws
  /// Error file_malformed, unsupported, limit_exceeded.
  [[nodiscard]] std::optional<DecodedPrimitive> decode(const JsonValue& primitive);

 private:
  struct View {
    std::uint32_t indices = no_index;
    std::map<std::uint32_t, Accessor> attributes;
  };
  const View& view_of(const JsonValue& extension);

  Data& data_;
  Budget budget_;
  std::map<std::uint32_t, View> views_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, bool>, std::uint32_t> accessors_;
};

}  // namespace frontmost::gltf
