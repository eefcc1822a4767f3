// SPDX-License-Identifier: Apache-2.0
// Errors, versions and numbers that every subject shares.
#include <frontmost/base.h>
#include <frontmost/version.h>

#include "python/bindings.h"

namespace frontmost::python {
namespace {

const char* word_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::bad_argument: return "bad_argument";
    case ErrorCode::file_unreadable: return "file_unreadable";
    case ErrorCode::file_malformed: return "file_malformed";
    case ErrorCode::file_unwritable: return "file_unwritable";
    case ErrorCode::unsupported: return "unsupported";
    case ErrorCode::limit_exceeded: return "limit_exceeded";
    case ErrorCode::singular_camera: return "singular_camera";
    case ErrorCode::cancelled: return "cancelled";
  }
  return "";
}

/// Python's Error; kept for the time of the process, as the interpreter keeps the module.
PyObject* error_type = nullptr;

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const Error& error) {
    const std::string text = utf8_text(error.what());
    py::object raised = py::handle(error_type)(text);
    raised.attr("code") = word_of(error.code());
    PyErr_SetObject(error_type, raised.ptr());
  }
}

}  // namespace

void bind_base(py::module_& m) {
  error_type = PyErr_NewExceptionWithDoc("frontmost.Error", doc("Error"), PyExc_RuntimeError, nullptr);
  m.add_object("Error", error_type);
  py::register_exception_translator(translate);
  m.attr("version") = FRONTMOST_VERSION;
  m.attr("no_primitive") = no_primitive;
  m.attr("no_index") = no_index;
}

}  // namespace frontmost::python
