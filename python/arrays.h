// SPDX-License-Identifier: Apache-2.0
// Conversions from and to NumPy's arrays. Input is checked; output is not copied if its owner can be kept alive.
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

// Input. A length of -1 in a shape means any length. Sequences of numbers count as arrays. Arrays of T in C order are
// used in place, others are copied. \throws TypeError for other contents, ValueError for another shape or value;
// messages begin with `name`, the argument's name.

/// Floats or integers as T, which is float or double. NaN and infinities are kept.
template <class T>
[[nodiscard]] Array<T> numbers(const py::handle& given, const std::string& name, const ArrayShape& shape);
/// Integers from 0 to below `end`.
[[nodiscard]] Array<std::uint32_t> indices(const py::handle& given, const std::string& name, const ArrayShape& shape,
                                           std::uint64_t end);
/// indices() in two steps, for memory of the caller: integers() checks the type, copy_indices() the range.
[[nodiscard]] py::array integers(const py::handle& given, const std::string& name, const ArrayShape& shape);
void copy_indices(const py::array& integers, const std::string& name, std::uint64_t end, std::uint32_t* out);
/// Three finite numbers.
[[nodiscard]] glm::dvec3 point(const py::handle& given, const std::string& name);
/// A 4x4 matrix by rows, or 3x4 without its last row, which is 0 0 0 1.
[[nodiscard]] glm::dmat4 matrix(const py::handle& given, const std::string& name);
[[nodiscard]] Array<double> array_of(const glm::dmat4& matrix);
[[nodiscard]] Array<double> array_of(const glm::dvec3& vector);

// Output.

/// A read-only array of memory that `owner` keeps. The owner lives as long as the array or any view of it.
template <class T>
[[nodiscard]] py::array_t<T> view_of(const T* data, const ArrayShape& shape, std::shared_ptr<const void> owner);
/// A writable array that owns `buffer`, without a copy.
template <class T>
[[nodiscard]] py::array_t<T> owned(Buffer<T>&& buffer, const ArrayShape& shape);
/// An array of records, with record_of(thing) for each of `things`. Record is registered by PYBIND11_NUMPY_DTYPE.
template <class Record, class Things, class RecordOf>
[[nodiscard]] py::array_t<Record> records_of(const Things& things, const RecordOf& record_of);

// ---- implementation ----

namespace detail {

[[nodiscard]] py::array checked_array(const py::handle& given, const std::string& name, const ArrayShape& shape,
                                      const char* kinds);
/// A NumPy base object that keeps `owner` alive.
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
