// Words for people, on standard error. Nobody may be listening any more (a closed terminal, a full
// log disk), which is no reason to end what is under way: what cannot be said is dropped.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace probe {

template <typename... Args>
void say(fmt::format_string<Args...> form, Args&&... args) {
  const std::string text = fmt::format(form, std::forward<Args>(args)...);
  std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace probe
