#pragma once

#include "crashrank/base/result.hpp"

#include <exception>
#include <new>
#include <stdexcept>

namespace crashrank::detail {

/// Runs a function that returns a Result and turns what it throws into an error: no exception
/// leaves the library.
template <class Function> auto guarded(const Function& function) -> decltype(function()) {
  try {
    try {
      return function();
    } catch (const std::bad_alloc&) {
      return out_of_memory();
    } catch (const std::length_error&) {
      return out_of_memory();  // more than any memory holds was asked for
    } catch (const std::exception& error) {
      return make_error(ErrorCode::internal, error.what(), "report this as a defect");
    }
  } catch (const std::bad_alloc&) {
    return out_of_memory();  // there was no room for the other failure's words
  }
}

}  // namespace crashrank::detail
