// SPDX-License-Identifier: Apache-2.0
// Checks all ranges of a glTF file before anything is read through them.
//
//   buffer      bytes of the file, of a URI or of the GLB's second chunk
//   view        a part of a buffer
//   accessor    elements in a view: offset + (count - 1) * stride + size of an element must be within the view's length
//
// All numbers come from the file and may be anything. So the checks use differences and quotients of checked numbers
// instead of sums and products, which could overflow. Later reads need no check.
//
// Sparse accessors are read like dense ones first; then their replacements overwrite elements. Replacements are sorted
// by index, so a binary search finds the first one of a range.
#include "io/models/gltf/data.h"

#include <algorithm>
#include <limits>

#include "io/binary.h"

namespace frontmost::gltf {
namespace {

constexpr const char* no_contents = "its buffer has no contents in this file";
constexpr std::uint32_t component_codes[] = {5120, 5121, 5122, 5123, 5125, 5126};

/// Returns the component type, or nothing for codes that glTF does not define.
std::optional<Component> component_of(const JsonValue& json) {
  const std::uint64_t code = json.to_unsigned();
  for (const std::uint32_t known : component_codes)
    if (code == known) return Component(known);
  return std::nullopt;
}

struct Shape {
  const char* name;
  int columns, rows;
};
constexpr Shape shapes[] = {{"SCALAR", 1, 1}, {"VEC2", 1, 2}, {"VEC3", 1, 3}, {"VEC4", 1, 4},
                            {"MAT2", 2, 2},   {"MAT3", 3, 3}, {"MAT4", 4, 4}};

const Shape* shape_of(const JsonValue& json) {
  const std::string name = json.to_string();
  for (const Shape& shape : shapes)
    if (name == shape.name) return &shape;
  return nullptr;
}

/// Layout of the components of one element. Columns of matrices start at multiples of four bytes, and so do packed
/// matrices; the last column has no padding behind it.
struct RowLayout {
  std::size_t column, column_stride;  ///< bytes of a column, and bytes from one column to the next
  int columns;

  RowLayout(const Shape& shape, Component component)
      : column(std::size_t(shape.rows) * size_of(component)),
        column_stride(shape.columns == 1 ? column : (column + 3) & ~std::size_t(3)),
        columns(shape.columns) {}
  [[nodiscard]] std::size_t stride() const { return std::size_t(columns) * column_stride; }
  [[nodiscard]] std::size_t size() const { return stride() - column_stride + column; }
};

/// Whether `count` elements, `stride` apart, lie within `length` bytes from `offset` on. Correct for all numbers,
/// because nothing overflows.
bool fits(std::uint64_t offset, std::uint64_t count, std::uint64_t stride, std::uint64_t element,
          std::uint64_t length) {
  if (count == 0) return offset <= length;
  if (offset > length || element > length - offset) return false;
  // The last element needs only its own bytes, not a whole stride, because interleaved arrays end there.
  return count - 1 <= (length - offset - element) / stride;
}

/// Throws an error for bytes that are not within their buffer.
void check_bytes(const JsonValue& json, std::uint64_t offset, std::uint64_t size, const ByteExtent& buffer) {
  if (!fits(offset, size, 1, 1, buffer.length))
    json.fail("bytes " + std::to_string(offset) + " + " + std::to_string(size) +
              " are not within the buffer, which has " + std::to_string(buffer.length));
}

/// A copy of elements: the address and stride of the source, the number of components, and the target.
template <class Out>
struct Copy {
  const std::byte* from;
  std::size_t from_stride, count;
  int components;
  Out* to;
  int to_stride;
};

template <class T, class Out, class Convert>
void copy_as(const Copy<Out>& copy, Convert convert) {
  for (std::size_t i = 0; i < copy.count; ++i)
    for (int c = 0; c < copy.components; ++c)
      copy.to[i * std::size_t(copy.to_stride) + std::size_t(c)] =
          convert(read_value<T>(copy.from + i * copy.from_stride + std::size_t(c) * sizeof(T), Endian::little));
}

/// Calls `use` with a zero of the component's type.
template <class Use>
void with_type(Component component, const Use& use) {
  switch (component) {
    case Component::i8: return use(std::int8_t(0));
    case Component::u8: return use(std::uint8_t(0));
    case Component::i16: return use(std::int16_t(0));
    case Component::u16: return use(std::uint16_t(0));
    case Component::u32: return use(std::uint32_t(0));
    case Component::f32: return use(0.0f);
  }
}

/// Copies numbers as floats. Normalised integers are mapped by the format's equations. The format forbids normalised
/// floats and normalised 32-bit integers; if they occur, their values are not scaled.
void convert_columns(const Accessor& accessor, const Copy<float>& copy) {
  with_type(accessor.component, [&](auto zero) {
    using T = decltype(zero);
    constexpr auto greatest = static_cast<float>(std::numeric_limits<T>::max());
    if (accessor.normalized && sizeof(T) < 4)
      copy_as<T>(copy, [](T value) { return std::max(static_cast<float>(value) / greatest, -1.0f); });
    else
      copy_as<T>(copy, [](T value) { return static_cast<float>(value); });
  });
}

void convert_columns(const Accessor& accessor, const Copy<std::uint32_t>& copy) {
  with_type(accessor.component, [&](auto zero) {
    using T = decltype(zero);
    if constexpr (std::is_unsigned_v<T>) copy_as<T>(copy, [](T value) { return std::uint32_t(value); });
  });
}

/// Copies elements column by column, because matrices may have padding between columns.
template <class Out>
void convert(const Accessor& accessor, const Copy<Out>& elements) {
  for (int first = 0; first < elements.components; first += accessor.rows) {
    Copy<Out> column = elements;
    column.from += std::size_t(first / accessor.rows) * accessor.column_stride;
    column.to += first;
    column.components = std::min(accessor.rows, elements.components - first);
    convert_columns(accessor, column);
  }
}

/// Returns the number of the first replacement whose element is not before `element`.
std::size_t lower_bound(const Sparse& sparse, std::size_t element) {
  std::size_t low = 0, high = sparse.count;
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (sparse.index(middle) < element)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

template <class Out>
void replace_sparse(const Accessor& accessor, ElementRange range, Copy<Out> copy) {
  const Sparse& sparse = *accessor.sparse;
  Out* const first = copy.to;
  copy.count = 1;
  for (std::size_t i = lower_bound(sparse, range.first); i < sparse.count; ++i) {
    const std::size_t element = sparse.index(i) - range.first;
    if (element >= range.count) return;
    copy.from = sparse.values.data() + i * sparse.value_stride;
    copy.to = first + element * std::size_t(copy.to_stride);
    convert(accessor, copy);
  }
}

template <class Out>
void read(const Accessor& accessor, ElementRange range, int width, Out* out) {
  const int components = std::min(accessor.components, width);
  Copy<Out> copy{nullptr, accessor.stride, range.count, components, out, width};
  if (accessor.bytes.empty()) {
    for (std::size_t i = 0; i < range.count; ++i)
      for (int c = 0; c < components; ++c) out[i * std::size_t(width) + std::size_t(c)] = 0;
  } else {
    copy.from = accessor.bytes.data() + range.first * accessor.stride;
    convert(accessor, copy);
  }
  if (accessor.sparse) replace_sparse(accessor, range, copy);
}

}  // namespace

std::size_t size_of(Component component) {
  std::size_t size = 0;
  with_type(component, [&](auto zero) { size = sizeof zero; });
  return size;
}

Data::Data(const JsonValue& root, const Container& container)
    : container_bytes_(container.json.size() + container.binary.size()) {
  root.each("buffers", [&](const JsonValue& json) { read_buffer(json, container); });
  Budget decoded(byte_count());
  root.each("bufferViews", [&](const JsonValue& json) { read_view(json, decoded); });
  root.each("accessors", [&](const JsonValue& json) { read_accessor(json); });
}

std::uint64_t Data::byte_count() const {
  std::uint64_t count = container_bytes_;
  for (const auto& [path, file] : files_) count += file.bytes().size();
  return count;
}

Bytes Data::view_bytes(std::uint32_t i, const JsonValue& user) const {
  if (!views_[i].present) user.fail(no_contents);
  return views_[i].bytes;
}

std::uint32_t Data::readable_accessor(const JsonValue& user) const {
  const std::uint32_t id = user.to_index(accessors_.size());
  if (accessors_[id].unreadable != nullptr) user.fail(accessors_[id].unreadable);
  return id;
}

std::uint32_t Data::add(const Accessor& accessor) {
  accessors_.push_back(accessor);
  return std::uint32_t(accessors_.size() - 1);
}

void Data::read_buffer(const JsonValue& json, const Container& container) {
  ByteExtent buffer;
  buffer.length = json.require("byteLength").to_unsigned();
  buffer.present = true;
  if (const std::optional<JsonValue> uri = json.find("uri")) {
    const std::string text = uri->to_string();
    if (is_data_uri(text))
      buffer.bytes = decoded_.emplace_back(decode_data_uri(text, *uri));
    else
      buffer.bytes = file_bytes(percent_decode(text), json.source());
  } else if (buffers_.empty() && container.is_glb) {
    if (!container.has_binary) json.fail("the GLB has no BIN chunk");
    buffer.bytes = container.binary;
  } else {
    buffer.present = false;
  }
  if (buffer.present) {
    if (buffer.length > buffer.bytes.size())
      json.fail("byteLength is " + std::to_string(buffer.length) + ", but there are only " +
                std::to_string(buffer.bytes.size()) + " bytes");
    // A BIN chunk is padded to a multiple of four. Bytes behind the stated length do not belong to the buffer.
    buffer.bytes = buffer.bytes.first(buffer.length);
  }
  buffers_.push_back(buffer);
}

/// Returns the contents of a file. Each file is opened once, however many buffers name it.
Bytes Data::file_bytes(const std::string& path, const ModelSource& source) {
  auto found = files_.find(path);
  if (found == files_.end()) found = files_.emplace(path, source.open(path, max_file_bytes)).first;
  return found->second.bytes();
}

void Data::read_view(const JsonValue& json, Budget& decoded) {
  const ByteExtent& buffer = buffers_[json.require("buffer").to_index(buffers_.size())];
  const std::uint64_t offset = json.unsigned_or("byteOffset", 0);
  ByteExtent view;
  view.length = json.require("byteLength").to_unsigned();
  view.stride = json.unsigned_or("byteStride", 0);
  view.present = buffer.present;
  check_bytes(json, offset, view.length, buffer);
  if (view.present) view.bytes = buffer.bytes.subspan(offset, view.length);
  std::optional<JsonValue> compression = json.extension("EXT_meshopt_compression");
  if (!compression) compression = json.extension("KHR_meshopt_compression");
  if (compression && has_meshopt()) {
    view.bytes = decode_view(*compression, view.length, decoded);
    view.present = true;
  }
  views_.push_back(view);
}

/// Decodes a view whose own buffer is a placeholder. The extension names the buffer with the compressed bytes.
Bytes Data::decode_view(const JsonValue& compression, std::uint64_t length, Budget& decoded) {
  const ByteExtent& buffer = buffers_[compression.require("buffer").to_index(buffers_.size())];
  const std::uint64_t offset = compression.unsigned_or("byteOffset", 0);
  const std::uint64_t size = compression.require("byteLength").to_unsigned();
  if (!buffer.present) compression.fail(no_contents);
  check_bytes(compression, offset, size, buffer);
  decoded.charge(length, 1, compression.place(), compression.source());
  decoded.charge(size, 1, compression.place(), compression.source());
  return keep(decode_meshopt(compression, buffer.bytes.subspan(offset, size), length));
}

void Data::read_accessor(const JsonValue& json) {
  Accessor accessor;
  accessor.count = json.require("count").to_unsigned();
  // Vertices and corners have 32-bit numbers, of which the greatest means "none".
  if (accessor.count >= no_index) json.source().fail_limit(json.place(), std::to_string(accessor.count) + " elements");
  const std::optional<Component> component = component_of(json.require("componentType"));
  const Shape* shape = shape_of(json.require("type"));
  if (component && shape) {
    accessor.component = *component;
    accessor.components = shape->columns * shape->rows;
    accessor.rows = shape->rows;
    accessor.normalized = json.bool_or("normalized", false);
    const RowLayout layout(*shape, *component);
    accessor.column_stride = layout.column_stride;
    accessor.size = layout.size();
    accessor.stride = layout.stride();
    find_elements(json, accessor);
    if (const std::optional<JsonValue> sparse = json.find("sparse")) read_sparse(*sparse, accessor, layout.stride());
  } else {
    // This is no error yet: extensions add accessors for their own use, which readers without the extension never
    // touch.
    accessor.unreadable = "the accessor's type is unknown";
  }
  accessors_.push_back(accessor);
}

/// Sets the accessor's bytes and stride. Precondition: the stride is that of packed elements.
void Data::find_elements(const JsonValue& json, Accessor& accessor) const {
  const std::uint32_t id = json.index_or_none("bufferView", views_.size());
  if (id == no_index) return;
  const ByteExtent& view = views_[id];
  const std::uint64_t offset = json.unsigned_or("byteOffset", 0);
  if (view.stride != 0) accessor.stride = view.stride;
  if (accessor.stride < accessor.size)
    json.fail("byteStride " + std::to_string(view.stride) + " is less than an element, " +
              std::to_string(accessor.size));
  if (!fits(offset, accessor.count, accessor.stride, accessor.size, view.length))
    json.fail(std::to_string(accessor.count) + " elements from byte " + std::to_string(offset) +
              " on are not within bufferViews[" + std::to_string(id) + "], which has " + std::to_string(view.length) +
              " bytes");
  if (view.present)
    accessor.bytes = view.bytes.subspan(offset);
  else
    accessor.unreadable = no_contents;
}

/// Returns the bytes of packed elements in the view that `json` names, from the first one on, or no bytes if the view
/// has no contents.
Bytes Data::packed(const JsonValue& json, std::size_t count, std::size_t stride, std::size_t size) const {
  const ByteExtent& view = views_[json.require("bufferView").to_index(views_.size())];
  const std::uint64_t offset = json.unsigned_or("byteOffset", 0);
  if (!fits(offset, count, stride, size, view.length))
    json.fail(std::to_string(count) + " elements from byte " + std::to_string(offset) +
              " on are not within the buffer view, which has " + std::to_string(view.length) + " bytes");
  return view.present ? view.bytes.subspan(offset) : Bytes();
}

void Data::read_sparse(const JsonValue& json, Accessor& accessor, std::size_t value_stride) const {
  Sparse sparse;
  sparse.value_stride = value_stride;
  sparse.count = json.require("count").to_unsigned();
  if (sparse.count > accessor.count)
    json.fail("replaces " + std::to_string(sparse.count) + " of " + std::to_string(accessor.count) + " elements");
  const JsonValue indices = json.require("indices"), values = json.require("values");
  const std::optional<Component> type = component_of(indices.require("componentType"));
  if (type != Component::u8 && type != Component::u16 && type != Component::u32)
    indices.fail("componentType is not an unsigned integer");
  sparse.index_type = *type;
  sparse.indices = packed(indices, sparse.count, size_of(*type), size_of(*type));
  sparse.values = packed(values, sparse.count, value_stride, accessor.size);
  if (sparse.count == 0) return;
  if (sparse.indices.empty() || sparse.values.empty()) {
    accessor.unreadable = no_contents;
    return;
  }
  // Indices must rise strictly, as the format requires: replace_sparse() finds the first one of a range by bisection.
  std::uint64_t least = 0;
  for (std::size_t i = 0; i < sparse.count; ++i) {
    const std::uint32_t index = sparse.index(i);
    if (index < least || index >= accessor.count)
      indices.fail("index " + std::to_string(i) + " is " + std::to_string(index) + ", which is " +
                   (index < least ? "not greater than the index before" : "not below the accessor's count"));
    least = std::uint64_t(index) + 1;
  }
  accessor.sparse = sparse;
}

std::uint32_t Sparse::index(std::size_t i) const {
  std::uint32_t index = 0;
  with_type(index_type, [&](auto zero) {
    index = std::uint32_t(read_value<decltype(zero)>(indices.data() + i * sizeof zero, Endian::little));
  });
  return index;
}

void read_floats(const Accessor& accessor, ElementRange range, int width, float* out) {
  read(accessor, range, width, out);
}

void read_integers(const Accessor& accessor, ElementRange range, int width, std::uint32_t* out) {
  read(accessor, range, width, out);
}

}  // namespace frontmost::gltf
