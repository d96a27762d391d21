#include "runtime/policy/sent_prompt.h"

#include "runtime/base/sha256.h"

namespace probe::policy {

std::string in_lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

std::string with_full_stop(std::string text) {
  if (!text.ends_with('.')) text.push_back('.');
  return text;
}

std::string without_full_stop(std::string text) {
  if (text.ends_with('.')) text.pop_back();
  return text;
}

bool can_be_sent_as(const std::string& prompt, std::string_view sent) {
  for (const std::string& text : {prompt, in_lower_case(prompt)}) {
    for (const std::string& made : {text, with_full_stop(text), without_full_stop(text)}) {
      if (to_hex(sha256(made)) == sent) return true;
    }
  }
  return false;
}

}  // namespace probe::policy
