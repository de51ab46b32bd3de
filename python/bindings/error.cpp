#include "error.hpp"

#include <nanobind/stl/string.h>

#include <new>

namespace crashrank::python {
namespace {

namespace nb = nanobind;

/// Sets Python's error indicator. What cannot be decoded as UTF-8 (file names are bytes) is
/// replaced.
void raise(const Error& error) {
  const auto text = [](const std::string& bytes) {
    return nb::steal(
        PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "replace"));
  };
  const nb::object make = nb::module_::import_("crashrank._errors").attr("make_error");
  const nb::object made = make(error_code_name(error.code), text(error.file), text(error.place),
                               text(error.reason), text(error.remedy));
  PyErr_SetObject(made.type().ptr(), made.ptr());
}

void translate(const std::exception_ptr& problem, void*) {
  // What is thrown while the exception is made, a nanobind::python_error, has set the indicator
  // or sets it here.
  try {
    try {
      std::rethrow_exception(problem);
    } catch (const Failure& failure) {
      raise(failure.error());
    } catch (const std::bad_alloc&) {
      raise(out_of_memory());
    }
  } catch (nb::python_error& error) {
    error.restore();
  }
}

}  // namespace

const char* error_code_name(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::usage:
      return "usage";
    case ErrorCode::bad_input:
      return "bad_input";
    case ErrorCode::not_found:
      return "not_found";
    case ErrorCode::limit_exceeded:
      return "limit_exceeded";
    case ErrorCode::out_of_budget:
      return "out_of_budget";
    case ErrorCode::out_of_memory:
      return "out_of_memory";
    case ErrorCode::internal:
      break;
  }
  return "internal";
}

void register_errors() { nb::register_exception_translator(&translate, nullptr); }

}  // namespace crashrank::python
