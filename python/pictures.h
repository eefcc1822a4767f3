// SPDX-License-Identifier: Apache-2.0
// The library's pictures and NumPy's arrays: a Bitmap is an array of bytes that shows itself, an Image a plane or
// several.
#pragma once

#include <frontmost/image.h>
#include <pybind11/pybind11.h>

#include <initializer_list>
#include <string>

namespace frontmost::python {

namespace py = pybind11;

/// frontmost.Bitmap: (height, width, 4) uint8, without a copy.
[[nodiscard]] py::object bitmap_array(Bitmap&& bitmap);
/// The same of a picture of linear light, sRGB with straight alpha.
[[nodiscard]] py::object bitmap_array(const Image& image);
/// (height, width, channels) float32 of channels of floats, in the order of `names`.
[[nodiscard]] py::object stacked(const Image& image, std::initializer_list<const char*> names);
/// (height, width) of a channel, without a copy.
[[nodiscard]] py::object plane_array(Channel&& channel, int width, int height);

}  // namespace frontmost::python
