// SPDX-License-Identifier: Apache-2.0
// Reads elements of accessors, whose ranges are checked already.
//
//   element 0          element 1                       stride from one to the next
//   | c c c | other    | c c c | other    | ...        components of one of six types, as floats or as whole numbers
//
// Sparse accessors are read like dense ones first; then their replacements overwrite elements. Replacements are sorted
// by index, so a binary search finds the first one of a range.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include "io/models/bytes.h"
#include "io/models/gltf/data.h"

namespace frontmost::gltf {
namespace {

/// A copy of elements: address and stride of the components, and the target.
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

/// Integers become floats by the format's equations for normalised values.
template <class T>
void copy_integers(const Copy<float>& copy, bool normalized) {
  constexpr auto greatest = static_cast<float>(std::numeric_limits<T>::max());
  if (normalized)
    copy_as<T>(copy, [](T value) { return std::max(static_cast<float>(value) / greatest, -1.0f); });
  else
    copy_as<T>(copy, [](T value) { return static_cast<float>(value); });
}

void convert_columns(const Accessor& accessor, const Copy<float>& copy) {
  switch (accessor.component) {
    case Component::i8: return copy_integers<std::int8_t>(copy, accessor.normalized);
    case Component::u8: return copy_integers<std::uint8_t>(copy, accessor.normalized);
    case Component::i16: return copy_integers<std::int16_t>(copy, accessor.normalized);
    case Component::u16: return copy_integers<std::uint16_t>(copy, accessor.normalized);
    // The format forbids normalised floats and normalised 32-bit integers; if they occur, their values are not scaled.
    case Component::u32: return copy_integers<std::uint32_t>(copy, false);
    case Component::f32: return copy_as<float>(copy, [](float value) { return value; });
  }
}

void convert_columns(const Accessor& accessor, const Copy<std::uint32_t>& copy) {
  const auto widen = [](auto value) { return static_cast<std::uint32_t>(value); };
  switch (accessor.component) {
    case Component::u8: return copy_as<std::uint8_t>(copy, widen);
    case Component::u16: return copy_as<std::uint16_t>(copy, widen);
    case Component::u32: return copy_as<std::uint32_t>(copy, widen);
    case Component::i8:
    case Component::i16:
    case Component::f32: return;
  }
}

/// Copies column by column, because matrices may have padding between columns.
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

/// The first replacement whose element is not before `element`.
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

std::uint32_t Sparse::index(std::size_t i) const {
  const std::byte* from = indices.data() + i * size_of(index_type);
  switch (index_type) {
    case Component::u8: return read_value<std::uint8_t>(from, Endian::little);
    case Component::u16: return read_value<std::uint16_t>(from, Endian::little);
    default: return read_value<std::uint32_t>(from, Endian::little);
  }
}

void read_floats(const Accessor& accessor, ElementRange range, int width, float* out) {
  read(accessor, range, width, out);
}

void read_integers(const Accessor& accessor, ElementRange range, int width, std::uint32_t* out) {
  read(accessor, range, width, out);
}

}  // namespace frontmost::gltf
