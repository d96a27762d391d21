// Words for people on standard error, and data on standard output. Nobody may be listening to the
// words any more (a closed terminal, a full log disk), which is no reason to end what is under way:
// what cannot be said is dropped. Both often hold texts of others: none reaches a terminal that
// could repaint it.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <string>
#include <utility>

#include "runtime/base/printable.h"

namespace probe {

// As it is, with our own colours and cursor movements: for what holds no text of others, or only
// such that went through shown().
inline void say_drawn(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stderr); }

template <typename... Args>
void say(fmt::format_string<Args...> form, Args&&... args) {
  say_drawn(shown(fmt::format(form, std::forward<Args>(args)...)));
}

// Data: every byte as it is into a file or a pipe, fit to be shown on a terminal. What cannot be
// written is found at the end of the program, in the stream's state.
template <typename... Args>
void put(fmt::format_string<Args...> form, Args&&... args) {
  static const bool to_terminal = ::isatty(STDOUT_FILENO) != 0;
  std::string text = fmt::format(form, std::forward<Args>(args)...);
  if (to_terminal) text = shown(text);
  std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace probe
