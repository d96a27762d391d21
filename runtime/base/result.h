// How the outside fails: files, plans, assets, sockets. A user's wrong text is a Diagnostic
// (compiler/diag) instead, and our own mistakes are PROBE_CHECK. No exception crosses a function of
// ours.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace probe {

// What kind of thing failed, so that callers can decide; its words are for programs. faults.def
// says what each stands for.
enum class Fault : std::uint8_t {
#define PROBE_FAULT(name, word) name,
#include "runtime/base/faults.def"
#undef PROBE_FAULT
};

constexpr std::string_view to_word(Fault fault) {
  constexpr std::string_view kWords[] = {
#define PROBE_FAULT(name, word) word,
#include "runtime/base/faults.def"
#undef PROBE_FAULT
  };
  return kWords[static_cast<std::size_t>(fault)];
}

// A failure names the thing and the place. `message` is lower case, no full stop; `where` is a
// path, a path with line, or a section with offset; it may be empty when the message already says
// it.
struct Failure {
  Fault code = Fault::kInternal;
  std::string message;
  std::string where;
};

// "where: message", or the message alone.
inline std::string to_text(const Failure& failure) {
  return failure.where.empty() ? failure.message : failure.where + ": " + failure.message;
}

template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Failure failure) : state_(std::in_place_index<1>, std::move(failure)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  // Only after ok().
  T& value() & { return std::get<0>(state_); }
  const T& value() const& { return std::get<0>(state_); }
  T&& value() && { return std::get<0>(std::move(state_)); }
  T* operator->() { return &std::get<0>(state_); }
  const T* operator->() const { return &std::get<0>(state_); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }

  // Only after !ok().
  const Failure& failure() const { return std::get<1>(state_); }

 private:
  std::variant<T, Failure> state_;
};

template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Failure failure) : failure_(std::move(failure)), ok_(false) {}

  bool ok() const { return ok_; }
  explicit operator bool() const { return ok_; }
  const Failure& failure() const { return failure_; }

 private:
  Failure failure_;
  bool ok_ = true;
};

using Status = Result<void>;

}  // namespace probe

#define PROBE_JOIN_(a, b) a##b
#define PROBE_JOIN(a, b) PROBE_JOIN_(a, b)

// PROBE_TRY(status_expression): returns the failure to the caller.
#define PROBE_TRY(expression)                                  \
  do {                                                         \
    auto probe_status_ = (expression);                         \
    if (!probe_status_.ok()) return probe_status_.failure();   \
  } while (false)

// PROBE_ASSIGN(auto x, result_expression): declares or assigns x, or returns the failure.
#define PROBE_ASSIGN(target, expression) \
  PROBE_ASSIGN_(target, expression, PROBE_JOIN(probe_result_, __LINE__))
#define PROBE_ASSIGN_(target, expression, name) \
  auto name = (expression);                     \
  if (!name.ok()) return name.failure();        \
  target = std::move(name).value()
