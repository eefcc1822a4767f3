// SPDX-License-Identifier: Apache-2.0
// Shared by the files of the Python module: one bind_ function for each subject, and docstrings, which come from the
// stubs.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>  // here, so that every file converts containers alike

namespace frontmost::python {

namespace py = pybind11;

/// The docstring of a name in the stubs (python/frontmost/__init__.pyi): "load", "View.look_at". Empty for unknown
/// names, which a test finds.
[[nodiscard]] const char* doc(const char* name);

// One function a subject, in bind_<subject>.cpp. The order makes types known before others use them.
void bind_base(py::module_& m);
void bind_scene(py::module_& m);
void bind_models(py::module_& m);
void bind_view(py::module_& m);
void bind_surfaces(py::module_& m);
void bind_inspect(py::module_& m);
void bind_derived(py::module_& m);
void bind_pictures(py::module_& m);
void bind_rays(py::module_& m);
void bind_scans(py::module_& m);
void bind_layers(py::module_& m);
void bind_accounts(py::module_& m);
void bind_datasets(py::module_& m);
void bind_depth_buffer(py::module_& m);
void bind_lines(py::module_& m);
void bind_sheets(py::module_& m);
void bind_painter(py::module_& m);
void bind_occlusion(py::module_& m);
void bind_faces(py::module_& m);
void bind_agreement(py::module_& m);
void bind_precision(py::module_& m);
void bind_fights(py::module_& m);

}  // namespace frontmost::python
