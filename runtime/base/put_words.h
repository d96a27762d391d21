// Sentences and tables for people on standard output: what they hold of others is fit to be shown
// wherever they go, into a file too, which somebody may look at in a terminal. Data (JSON, CSV,
// texts that are files) goes through put().
#pragma once

#include "runtime/base/say.h"

namespace probe {

template <typename... Args>
void put_words(fmt::format_string<Args...> form, Args&&... args) {
  const std::string text = shown(fmt::format(form, std::forward<Args>(args)...));
  std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace probe
