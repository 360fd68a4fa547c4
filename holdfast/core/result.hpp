#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace holdfast {

/// Why something outside the program could not be used: file, place, what was expected, what was
/// found.
struct Error {
  std::string message;
};

/// A value or the reason why there is none. Used at the boundary with files, YAML, logs and
/// sockets; misuse by our own code is an assertion instead, a bad day of the robot a status in a
/// report.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : content_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool ok() const { return std::holds_alternative<T>(content_); }
  explicit operator bool() const { return ok(); }

  T& value() & { return checked(); }
  const T& value() const& { return const_cast<Result*>(this)->checked(); }
  T&& value() && { return std::move(checked()); }
  T& operator*() { return checked(); }
  const T& operator*() const { return const_cast<Result*>(this)->checked(); }
  T* operator->() { return &checked(); }
  const T* operator->() const { return &const_cast<Result*>(this)->checked(); }

  const Error& error() const {
    assert(!ok());
    return std::get<Error>(content_);
  }

 private:
  T& checked() {
    assert(ok());
    return std::get<T>(content_);
  }

  std::variant<T, Error> content_;
};

/// The value of an operation that yields nothing but success.
struct Done {};
using Status = Result<Done>;

}  // namespace holdfast
