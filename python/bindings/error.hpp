#pragma once

#include "crashrank/base/result.hpp"

#include <nanobind/nanobind.h>

#include <exception>
#include <utility>

namespace crashrank::python {

/// An Error of the library on its way to Python, where it becomes a crashrank.Error.
class Failure : public std::exception {
public:
  explicit Failure(Error error) : error_(std::move(error)) {}

  const Error& error() const noexcept { return error_; }
  const char* what() const noexcept override { return error_.reason.c_str(); }

private:
  Error error_;
};

/// The value of a result. Throws Failure where there is none.
template <class T> T value_of(Result<T> result) {
  if (!result) throw Failure(std::move(result.error()));
  return std::move(result).value();
}

/// Throws Failure unless it is a success.
inline void check(const Status& status) {
  if (!status) throw Failure(status.error());
}

/// The name of an error's kind, as `.code` has it: "bad_input".
const char* error_code_name(ErrorCode code) noexcept;

/// Lets Failure and std::bad_alloc reach Python as exceptions of crashrank._errors.
void register_errors();

}  // namespace crashrank::python
