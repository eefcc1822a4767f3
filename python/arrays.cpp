// SPDX-License-Identifier: Apache-2.0
#include "python/arrays.h"

#include <cstring>

namespace frontmost::python {
namespace {

std::string text_of(const ArrayShape& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (i > 0) text += ", ";
    text += shape[i] < 0 ? "n" : std::to_string(shape[i]);
  }
  return text + (shape.size() == 1 ? ",)" : ")");
}

bool fits(const py::array& array, const ArrayShape& shape) {
  if (array.ndim() != py::ssize_t(shape.size())) return false;
  for (py::ssize_t i = 0; i < array.ndim(); ++i)
    if (shape[std::size_t(i)] >= 0 && array.shape(i) != shape[std::size_t(i)]) return false;
  return true;
}

/// Converts integers of any kind to 32 bits. \throws py::value_error naming the first number that is out of range.
template <class T>
void convert_indices(const py::array& given, const std::string& name, std::uint64_t end, std::uint32_t* out) {
  const auto values = Array<T>::ensure(given);
  const T* const in = values.data();
  const py::ssize_t size = values.size();
  bool is_good = true;
  for (py::ssize_t i = 0; i < size; ++i) {
    is_good &= std::uint64_t(in[i]) < end;  // negative numbers become greater than `end`
    out[i] = std::uint32_t(in[i]);
  }
  if (is_good) return;
  py::ssize_t bad = 0;
  while (std::uint64_t(in[bad]) < end) ++bad;
  const py::ssize_t across = given.ndim() > 1 ? given.shape(given.ndim() - 1) : 1;
  throw py::value_error(name + ": row " + std::to_string(bad / across) + " holds " + std::to_string(in[bad]) +
                        ", which is not 0 to " + std::to_string(std::int64_t(end) - 1));
}

}  // namespace

namespace detail {

py::array checked_array(const py::handle& given, const std::string& name, const ArrayShape& shape, const char* kinds) {
  py::array array = py::array::ensure(given);
  if (!array || !std::strchr("biufcSUOVmM", array.dtype().kind()))
    throw py::type_error(name + ": must be an array of shape " + text_of(shape));
  if (!std::strchr(kinds, array.dtype().kind()) && array.size() > 0)
    throw py::type_error(name + ": must be of " + (std::strchr(kinds, 'f') ? "numbers" : "integers") + ", not of " +
                         std::string(py::str(array.dtype())));
  if (!fits(array, shape)) {
    const ArrayShape is(array.shape(), array.shape() + array.ndim());
    throw py::value_error(name + ": must have the shape " + text_of(shape) + ", not " + text_of(is));
  }
  return array;
}

py::capsule keeper(std::shared_ptr<const void> owner) {
  auto kept = std::make_unique<std::shared_ptr<const void>>(std::move(owner));
  py::capsule capsule(kept.get(), [](void* pointer) { delete static_cast<std::shared_ptr<const void>*>(pointer); });
  kept.release();
  return capsule;
}

}  // namespace detail

py::array integers(const py::handle& given, const std::string& name, const ArrayShape& shape) {
  return detail::checked_array(given, name, shape, "iu");
}

void copy_indices(const py::array& array, const std::string& name, std::uint64_t end, std::uint32_t* out) {
  const bool is_signed = array.dtype().kind() == 'i';
  switch (array.size() == 0 ? 0 : array.itemsize()) {
    case 0: break;
    case 4:
      is_signed ? convert_indices<std::int32_t>(array, name, end, out)
                : convert_indices<std::uint32_t>(array, name, end, out);
      break;
    default:
      is_signed ? convert_indices<std::int64_t>(array, name, end, out)
                : convert_indices<std::uint64_t>(array, name, end, out);
  }
}

Array<std::uint32_t> indices(const py::handle& given, const std::string& name, const ArrayShape& shape,
                             std::uint64_t end) {
  const py::array array = integers(given, name, shape);
  Array<std::uint32_t> out(ArrayShape(array.shape(), array.shape() + array.ndim()));
  copy_indices(array, name, end, out.mutable_data());
  return out;
}

glm::dvec3 point(const py::handle& given, const std::string& name) {
  const auto values = numbers<double>(given, name, {3});
  const glm::dvec3 result(values.at(0), values.at(1), values.at(2));
  if (!is_finite(result)) throw py::value_error(name + ": is not finite");
  return result;
}

glm::dmat4 matrix(const py::handle& given, const std::string& name) {
  const bool is_short = py::hasattr(given, "shape") && py::len(given) == 3;
  const auto values = numbers<double>(given, name, {is_short ? 3 : 4, 4});
  glm::dmat4 result(1.0);
  for (int row = 0; row < values.shape(0); ++row)
    for (int column = 0; column < 4; ++column) {
      const double value = values.at(row, column);
      if (!std::isfinite(value)) throw py::value_error(name + ": holds a number that is not finite");
      if (row == 3 && value != (column == 3 ? 1 : 0)) throw py::value_error(name + ": its last row is not 0 0 0 1");
      result[column][row] = value;
    }
  return result;
}

Array<double> array_of(const glm::dmat4& matrix) {
  Array<double> result({4, 4});
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) result.mutable_at(row, column) = matrix[column][row];
  return result;
}

Array<double> array_of(const glm::dvec3& vector) {
  Array<double> result(3);
  for (int i = 0; i < 3; ++i) result.mutable_at(i) = vector[i];
  return result;
}

}  // namespace frontmost::python
