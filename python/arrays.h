// SPDX-License-Identifier: Apache-2.0
// NumPy's arrays in, checked by name, and out, without a copy wherever their owner can be kept.
#pragma once

#include <frontmost/base.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

namespace frontmost::python {

namespace py = pybind11;

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;
using ArrayShape = std::vector<py::ssize_t>;

// In. A length of -1 in a shape is any. Sequences of numbers are arrays as well. Arrays of T in C order are taken as
// they are, all others are copied. Errors are TypeError for what holds no such numbers and ValueError for another shape
// or value; they begin with `name`, that of the argument.

/// Floats or integers as T, which is float or double; NaN and infinities as they are.
template <class T>
[[nodiscard]] Array<T> numbers(const py::handle& given, const std::string& name, const ArrayShape& shape);
/// Whole numbers from 0 to below `end`.
[[nodiscard]] Array<std::uint32_t> indices(const py::handle& given, const std::string& name, const ArrayShape& shape,
                                           std::uint64_t end);
/// The same in two steps, for memory that the caller has: integers of any kind, and a copy of them.
[[nodiscard]] py::array integers(const py::handle& given, const std::string& name, const ArrayShape& shape);
void copy_indices(const py::array& integers, const std::string& name, std::uint64_t end, std::uint32_t* out);
/// Three finite numbers.
[[nodiscard]] glm::dvec3 point(const py::handle& given, const std::string& name);
/// A 4x4 matrix as NumPy has it, rows first; 3x4 without its last row, which is 0 0 0 1.
[[nodiscard]] glm::dmat4 matrix(const py::handle& given, const std::string& name);
[[nodiscard]] Array<double> array_of(const glm::dmat4& matrix);
[[nodiscard]] Array<double> array_of(const glm::dvec3& vector);

// Out.

/// An array of memory that `owner` keeps: it lives as long as the array or any view of it. Not writable.
template <class T>
[[nodiscard]] py::array_t<T> view_of(const T* data, const ArrayShape& shape, std::shared_ptr<const void> owner);
/// A writable array that owns `buffer`, without a copy.
template <class T>
[[nodiscard]] py::array_t<T> owned(Buffer<T>&& buffer, const ArrayShape& shape);
/// An array of records: for each of `things` what `record_of` makes of it. Record is one of PYBIND11_NUMPY_DTYPE's.
template <class Record, class Things, class RecordOf>
[[nodiscard]] py::array_t<Record> records_of(const Things& things, const RecordOf& record_of);

// ---- implementation ----

namespace detail {

[[nodiscard]] py::array checked_array(const py::handle& given, const std::string& name, const ArrayShape& shape,
                                      const char* kinds);
/// A base that keeps `owner` alive.
[[nodiscard]] py::capsule keeper(std::shared_ptr<const void> owner);

}  // namespace detail

template <class T>
Array<T> numbers(const py::handle& given, const std::string& name, const ArrayShape& shape) {
  return Array<T>::ensure(detail::checked_array(given, name, shape, "fiu"));
}

template <class T>
py::array_t<T> view_of(const T* data, const ArrayShape& shape, std::shared_ptr<const void> owner) {
  py::array_t<T> array(shape, data, detail::keeper(std::move(owner)));
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

template <class T>
py::array_t<T> owned(Buffer<T>&& buffer, const ArrayShape& shape) {
  const auto kept = std::make_shared<Buffer<T>>(std::move(buffer));
  return py::array_t<T>(shape, kept->data(), detail::keeper(kept));
}

template <class Record, class Things, class RecordOf>
py::array_t<Record> records_of(const Things& things, const RecordOf& record_of) {
  py::array_t<Record> records(py::ssize_t(things.size()));
  Record* out = records.mutable_data();
  for (const auto& thing : things) *out++ = record_of(thing);
  return records;
}

}  // namespace frontmost::python
