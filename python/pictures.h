// SPDX-License-Identifier: Apache-2.0
// Conversions of pictures to NumPy's arrays: a Bitmap becomes an array of bytes that displays itself, an Image becomes
// one plane or several.
#pragma once

#include <frontmost/image.h>
#include <pybind11/pybind11.h>

#include <initializer_list>
#include <string>

#include "python/arrays.h"

namespace frontmost::python {

namespace py = pybind11;

/// frontmost.Bitmap: (height, width, 4) uint8, without a copy.
[[nodiscard]] py::object bitmap_array(Bitmap&& bitmap);
/// frontmost.Bitmap of a picture in linear light, converted to sRGB with straight alpha.
[[nodiscard]] py::object bitmap_array(const Image& image);
/// An image from an array of floats (height, width, 3 or 4): linear light, premultiplied. `name` and `shape` as for
/// numbers().
[[nodiscard]] Image image_of_colors(const py::handle& given, const std::string& name, const ArrayShape& shape);
/// The float channels `names`, in this order, as (height, width, channels) float32.
[[nodiscard]] py::object stacked(const Image& image, std::initializer_list<const char*> names);
/// A channel as (height, width), without a copy.
[[nodiscard]] py::object plane_array(Channel&& channel, int width, int height);

}  // namespace frontmost::python
