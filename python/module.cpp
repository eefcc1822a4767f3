// SPDX-License-Identifier: Apache-2.0
// The extension module frontmost._core: each subject binds its own names.
#include "python/bindings.h"

PYBIND11_MODULE(_core, m) {
  using namespace frontmost::python;
  // Bound names get the package as their module, so that help() and messages show the name that users import.
  const pybind11::object name = m.attr("__name__");
  m.attr("__name__") = "frontmost";
  bind_base(m);
  bind_scene(m);
  bind_models(m);
  bind_view(m);
  bind_surfaces(m);
  bind_inspect(m);
  bind_derived(m);
  bind_pictures(m);
  bind_rays(m);
  bind_scans(m);
  bind_layers(m);
  bind_accounts(m);
  bind_datasets(m);
  bind_depth_buffer(m);
  bind_lines(m);
  bind_sheets(m);
  bind_painter(m);
  bind_occlusion(m);
  bind_faces(m);
  bind_agreement(m);
  bind_precision(m);
  bind_fights(m);
  m.attr("__name__") = name;
}
