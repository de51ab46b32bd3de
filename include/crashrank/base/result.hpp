#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace crashrank {

/// The kind of an Error. The program maps kinds to exit codes.
enum class ErrorCode {
  usage,           ///< the arguments contradict each other or are out of range (exit code 2)
  bad_input,       ///< a file, mesh, scenario or pose is not acceptable (3)
  not_found,       ///< a file or program is missing or unreadable (3)
  limit_exceeded,  ///< input larger than a stated limit (3)
  out_of_budget,   ///< a deadline, memory or work budget ended the work (4)
  internal,        ///< the library's or the machine's own failure (1)
  out_of_memory,   ///< an allocation failed; nothing was kept, and the call may be repeated (4)
};

/// A failure: where it occurred, what is wrong, and what the user can do about it.
struct Error {
  ErrorCode code = ErrorCode::internal;  ///< the kind of failure
  std::string file;                      ///< file concerned, empty where none is
  std::string place;   ///< element, line or key in the file, empty where the whole file is meant
  std::string reason;  ///< what is wrong, a clause without a full stop
  std::string remedy;  ///< what the user can do about it, empty where nothing is known

  /// "FILE: PLACE: REASON; REMEDY" on one line, absent members left out. Names in it are not
  /// escaped: escape before showing it in HTML or on a terminal.
  std::string message() const {
    std::string text;
    for (const std::string* head : {&file, &place}) {
      if (!head->empty()) text += *head + ": ";
    }
    text += reason;
    if (!remedy.empty()) text += "; " + remedy;
    return text;
  }
};

/// Makes an Error without a file; callers that know the file add it.
inline Error make_error(ErrorCode code, std::string reason, std::string remedy = {}) {
  return Error{code, {}, {}, std::move(reason), std::move(remedy)};
}

/// The Error of a failed allocation. Allocates nothing itself: its text fits into the string.
inline Error out_of_memory() noexcept {
  return Error{ErrorCode::out_of_memory, {}, {}, "out of memory", {}};
}

/// A value or an Error (std::expected needs C++23). Reading the one that is absent is an error of
/// the caller and asserts.
template <class T> class [[nodiscard]] Result {
public:
  /// Success.
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  /// Failure.
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  /// True where there is a value.
  bool ok() const noexcept { return state_.index() == 0; }
  /// The same.
  explicit operator bool() const noexcept { return ok(); }

  /// The value, which has to be present.
  T& value() & {
    assert(ok());
    return *std::get_if<0>(&state_);
  }
  /// The value, which has to be present.
  const T& value() const& {
    assert(ok());
    return *std::get_if<0>(&state_);
  }
  /// The value, moved out.
  T&& value() && {
    assert(ok());
    return std::move(*std::get_if<0>(&state_));
  }
  /// The value, which has to be present.
  T& operator*() & { return value(); }
  /// The value, which has to be present.
  const T& operator*() const& { return value(); }
  /// The value, which has to be present.
  T* operator->() { return &value(); }
  /// The value, which has to be present.
  const T* operator->() const { return &value(); }

  /// The error, which has to be present.
  const Error& error() const& {
    assert(!ok());
    return *std::get_if<1>(&state_);
  }
  /// The error, which has to be present.
  Error& error() & {
    assert(!ok());
    return *std::get_if<1>(&state_);
  }

private:
  std::variant<T, Error> state_;
};

/// Success without a value.
struct Success {};
using Status = Result<Success>;

}  // namespace crashrank
