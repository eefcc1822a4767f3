// SPDX-License-Identifier: Apache-2.0
// Errors, versions and conversions that all subjects share.
#include <frontmost/base.h>
#include <frontmost/version.h>

#include <limits>
#include <vector>

#include "python/arrays.h"
#include "python/bindings.h"

namespace frontmost::python {

using namespace py::literals;

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

/// Python's Error. The reference is kept as long as the process, as the interpreter keeps the module.
PyObject* error_type = nullptr;

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const Error& error) {
    const std::string text = utf8_text(error.what());
    py::object raised = py::handle(error_type)(text);
    raised.attr("code") = word_of(error.code());
    raised.attr("file") = utf8_text(error.file());
    raised.attr("place") = utf8_text(error.place());
    raised.attr("reason") = utf8_text(error.reason());
    PyErr_SetObject(error_type, raised.ptr());
  }
}

/// Converts ids to signed integers, because PyTorch and others support few operations on unsigned ones.
py::array signed_ids(const py::array& ids, const std::string& dtype) {
  if (ids.dtype().kind() != 'u' || ids.itemsize() != sizeof(PrimitiveId))
    throw py::type_error("ids: must be an array of uint32");
  if (dtype != "int32" && dtype != "int64") throw py::value_error("dtype: '" + dtype + "' is not one of int32, int64");
  const Array<PrimitiveId> from = Array<PrimitiveId>::ensure(ids);
  py::array_t<std::int64_t> to(std::vector<py::ssize_t>(from.shape(), from.shape() + from.ndim()));
  for (py::ssize_t i = 0; i < from.size(); ++i) {
    const PrimitiveId id = from.data()[i];
    if (id != no_primitive && dtype == "int32" && id > PrimitiveId(std::numeric_limits<std::int32_t>::max()))
      throw py::value_error("ids: int32 does not hold " + std::to_string(id));
    to.mutable_data()[i] = id == no_primitive ? -1 : std::int64_t(id);
  }
  return dtype == "int64" ? py::array(to) : py::array(to.attr("astype")(dtype));
}

}  // namespace

void bind_base(py::module_& m) {
  error_type = PyErr_NewExceptionWithDoc("frontmost.Error", doc("Error"), PyExc_RuntimeError, nullptr);
  m.add_object("Error", error_type);
  py::register_exception_translator(translate);
  m.attr("version") = FRONTMOST_VERSION;
  m.attr("no_primitive") = no_primitive;
  m.attr("no_index") = no_index;
  m.def("signed_ids", &signed_ids, "ids"_a, py::kw_only(), "dtype"_a = "int64", doc("signed_ids"));
}

}  // namespace frontmost::python
