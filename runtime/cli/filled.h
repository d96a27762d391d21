// An option that was given with an empty text, as a shell does with an unset variable, is refused:
// it must not mean the default.
#pragma once

#include <CLI/App.hpp>
#include <string>

namespace probe::cli {

// Puts it on every option of the verb that takes a value.
inline void refuse_empty_values(CLI::App& verb) {
  for (CLI::Option* option : verb.get_options()) {
    if (option->get_expected_max() == 0) continue;
    option->check([](const std::string& value) {
      return value.empty() ? std::string("is empty") : std::string();
    });
  }
}

}  // namespace probe::cli
