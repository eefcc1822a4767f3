// SPDX-License-Identifier: Apache-2.0
// Pictures: shading, files, and arrays.
#include <frontmost/files.h>
#include <frontmost/pictures.h>

#include <cstring>
#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/held.h"
#include "python/pictures.h"
#include "python/running.h"
#include "python/shade_words.h"

FRONTMOST_WORDS(frontmost::ImageFormat, "format",
                {{frontmost::ImageFormat::png, "png"},
                 {frontmost::ImageFormat::exr, "exr"},
                 {frontmost::ImageFormat::pfm, "pfm"},
                 {frontmost::ImageFormat::npy, "npy"},
                 {frontmost::ImageFormat::jpeg, "jpeg"},
                 {frontmost::ImageFormat::webp, "webp"}});

namespace frontmost::python {

using namespace py::literals;

namespace {

py::object shown(py::object array) {
  return array.attr("view")(py::module_::import("frontmost._bitmap").attr("Bitmap"));
}

// Conversion of arrays to images.

template <class T>
Buffer<T> buffer_of(const Array<T>& values) {
  Buffer<T> buffer{std::size_t(values.size())};
  if (!buffer.empty()) std::memcpy(buffer.data(), values.data(), std::size_t(values.nbytes()));
  return buffer;
}

/// A channel of floats, or of integers from 0 to 2^32 - 1. Masks are 0 and 1, or floats if the channel is luminance.
Channel channel_of(const std::string& name, const py::handle& given, const ArrayShape& shape) {
  const py::array array = py::array::ensure(given);
  if (array && array.dtype().kind() == 'b' && name == "Y")
    return {name, buffer_of(numbers<float>(array.attr("astype")("u1"), name, shape))};
  if (array && array.dtype().kind() == 'f') return {name, buffer_of(numbers<float>(given, name, shape))};
  if (array && array.dtype().kind() == 'b')
    return {name, buffer_of(indices(array.attr("astype")("u4"), name, shape, 2))};
  return {name, buffer_of(indices(given, name, shape, std::uint64_t(1) << 32))};
}

/// An image from a dict, with one plane for each name.
Image image_of_planes(const py::dict& planes) {
  Image image;
  for (const auto& [key, plane] : planes) {
    if (!py::isinstance<py::str>(key)) throw py::type_error("image: names of planes must be text");
    const std::string name = py::cast<std::string>(key);
    const ArrayShape shape =
        image.channels.empty() ? ArrayShape{-1, -1} : ArrayShape{py::ssize_t(image.height), py::ssize_t(image.width)};
    image.channels.push_back(channel_of(name, plane, shape));
    const py::array array = py::array::ensure(plane);
    image.height = int(array.shape(0));
    image.width = int(array.shape(1));
  }
  return image;
}

Bitmap bitmap_of(const py::array& array) {
  const auto values = Array<std::uint8_t>::ensure(array);
  Bitmap bitmap{int(array.shape(1)), int(array.shape(0)),
                Buffer<std::uint8_t>(std::size_t(array.size() / array.shape(2) * 4), 255)};
  const auto channels = std::size_t(array.shape(2));
  for (std::size_t i = 0; i < bitmap.rgba.size() / 4; ++i)
    std::memcpy(&bitmap.rgba[4 * i], values.data() + channels * i, channels);
  return bitmap;
}

void save_picture(const py::object& image, const py::object& path, const std::optional<ImageFormat>& format, int bits,
                  const std::optional<double>& depth_scale, int quality) {
  const SaveOptions options{format, bits, depth_scale, quality};
  const auto file = py::cast<std::string>(py::module_::import("os").attr("fspath")(path));
  const auto write = [&](const auto& what) {
    run(0, py::none(), [&](const Execution& execution) { save(what, file, options, execution); });
  };
  if (py::isinstance<py::dict>(image)) return write(image_of_planes(py::cast<py::dict>(image)));
  const py::array array = py::array::ensure(image);
  const bool is_color = array && array.ndim() == 3 && (array.shape(2) == 3 || array.shape(2) == 4);
  if (is_color && array.dtype().kind() == 'u' && array.itemsize() == 1) return write(bitmap_of(array));
  if (is_color && array.dtype().kind() == 'f') return write(image_of_colors(array, "image", {-1, -1, array.shape(2)}));
  if (array && array.ndim() == 2 && array.dtype().kind() == 'b') return write(image_of_planes(py::dict("Y"_a = image)));
  throw py::type_error(
      "image: must be (height, width, 3 or 4) of uint8 or floats, a bool mask (height, width), or a dict "
      "of planes by name, such as {'Z': depth}");
}

py::dict load_picture(const py::object& path) {
  const auto file = py::cast<std::string>(py::module_::import("os").attr("fspath")(path));
  Image image = run(0, py::none(), [&](const Execution&) { return load_image(file); });
  py::dict planes;
  for (Channel& channel : image.channels) {
    const std::string name = channel.name;
    planes[py::str(name)] = plane_array(std::move(channel), image.width, image.height);
  }
  return planes;
}

// Pictures of visible surfaces.

Bitmap shaded_bitmap(const HeldVisible& held, const ShadeOptions& options, const Execution& execution) {
  const std::shared_lock lock(held.of->scene->reading);
  const std::unique_lock alone(held.of->shading, std::try_to_lock);
  if (!alone) return shade_bitmap(held.of->surfaces, *held.visible, options, execution);
  if (!held.of->shader) held.of->shader = std::make_unique<Shader>(held.of->surfaces);
  held.of->shader->shade_bitmap({.visible = held.visible.get()}, options, execution);
  return held.of->shader->take_bitmap();
}

template <class Make>
Image image_of(const HeldVisible& held, const Make& make) {
  held.check_current();
  return run(0, py::none(), [&](const Execution& execution) {
    const std::shared_lock lock(held.of->scene->reading);
    return make(held.of->surfaces, *held.visible, execution);
  });
}

void bind_environment(py::module_& m) {
  py::class_<Environment>(m, "Environment", doc("Environment"))
      .def(py::init([](const py::object& source, int threads, const py::object& progress) {
             if (!py::isinstance<py::array>(source)) return environment_of(source);
             const py::array array = py::array::ensure(source);
             if (array.ndim() != 3 || array.shape(2) != 3 || array.dtype().kind() != 'f')
               throw py::value_error("source: must be (height, width, 3) of floats, or a name");
             return run(threads, progress,
                        [image = image_of_colors(array, "source", {-1, -1, 3})](const Execution& execution) {
                          return Environment(image, execution);
                        });
           }),
           "source"_a, py::kw_only(), "threads"_a = 0, "progress"_a = py::none())
      .def_property_readonly("turns_with_camera", &Environment::turns_with_camera, doc("Environment.turns_with_camera"))
      .def("__repr__", [](const Environment& environment) {
        return environment.turns_with_camera() ? "Environment that turns with the camera" : "Environment";
      });
}

}  // namespace

Environment environment_of(const py::object& given) {
  if (py::isinstance<Environment>(given)) return py::cast<Environment>(given);
  const auto name = py::cast<std::string>(py::module_::import("os").attr("fspath")(given));
  return run(0, py::none(), [&](const Execution& execution) {
    if (name == "studio") return Environment::studio(execution);
    if (name == "sky") return Environment::sky(execution);
    if (name == "none") return Environment::none();
    return Environment(load_environment(name), execution);
  });
}

py::object plane_array(Channel&& channel, int width, int height) {
  const ArrayShape shape{py::ssize_t(height), py::ssize_t(width)};
  if (channel.is_integer()) return owned(std::move(channel.integers()), shape);
  return owned(std::move(channel.floats()), shape);
}

py::object stacked(const Image& image, std::initializer_list<const char*> names) {
  const auto count = names.size();
  Array<float> out(ArrayShape{image.height, image.width, py::ssize_t(count)});
  float* const data = out.mutable_data();
  std::size_t place = 0;
  for (const char* const name : names) {
    const Buffer<float>& plane = image.find(name)->floats();
    for (std::size_t i = 0; i < plane.size(); ++i) data[i * count + place] = plane[i];
    ++place;
  }
  return out;
}

py::object bitmap_array(Bitmap&& bitmap) {
  return shown(owned(std::move(bitmap.rgba), {bitmap.height, bitmap.width, 4}));
}

py::object bitmap_array(const Image& image) { return bitmap_array(bitmap_of(image)); }

Image image_of_colors(const py::handle& given, const std::string& name, const ArrayShape& shape) {
  const auto values = numbers<float>(given, name, shape);
  Image image;
  image.height = int(values.shape(0));
  image.width = int(values.shape(1));
  const auto channels = std::size_t(values.shape(2));
  const char* const names[] = {"R", "G", "B", "A"};
  for (std::size_t c = 0; c < channels; ++c) {
    Buffer<float> plane{std::size_t(image.width) * std::size_t(image.height)};
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = values.data()[i * channels + c];
    image.channels.push_back({names[c], std::move(plane)});
  }
  return image;
}

void bind_pictures(py::module_& m) {
  bind_environment(m);
  auto visible = py::class_<HeldVisible>(m.attr("Visible"));
  bind_shading(visible, "shade", doc("Visible.shade"),
               [](const HeldVisible& v, const ShadeOptions& options, int threads, const py::object& progress) {
                 v.check_current();
                 return bitmap_array(run(threads, progress, [&](const Execution& execution) {
                   return shaded_bitmap(v, options, execution);
                 }));
               });
  bind_shading(visible, "shade_linear", doc("Visible.shade_linear"),
               [](const HeldVisible& v, const ShadeOptions& options, int threads, const py::object& progress) {
                 v.check_current();
                 return stacked(run(threads, progress,
                                    [&](const Execution& execution) {
                                      const std::shared_lock lock(v.of->scene->reading);
                                      return shade(v.of->surfaces, *v.visible, options, execution);
                                    }),
                                {"R", "G", "B", "A"});
               });
  visible.def_property_readonly(
      "normals",
      [](const HeldVisible& v) {
        return stacked(image_of(v, [](const auto& surfaces, const auto& seen,
                                      const auto& execution) { return normal_image(surfaces, seen, execution); }),
                       {"N.X", "N.Y", "N.Z"});
      },
      doc("Visible.normals"));
  visible.def_property_readonly(
      "ray_distance",
      [](const HeldVisible& v) {
        Image image = run(0, py::none(), [&](const Execution&) { return ray_distance_image(*v.visible); });
        return plane_array(std::move(image.channels[0]), image.width, image.height);
      },
      doc("Visible.ray_distance"));
  m.def("save", &save_picture, "image"_a, "path"_a, py::kw_only(), "format"_a = py::none(), "bits"_a = 8,
        "depth_scale"_a = py::none(), "quality"_a = 90, doc("save"));
  m.def("load_image", &load_picture, "path"_a, doc("load_image"));
}

}  // namespace frontmost::python
