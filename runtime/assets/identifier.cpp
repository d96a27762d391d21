#include "runtime/assets/identifier.h"

namespace probe::assets {
std::string identifier_of(std::string_view name, std::string_view first) {
  if (name.empty()) return "unnamed";
  std::string made(name);
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  for (char& c : made) {
    if (!is_letter(c) && !(c >= '0' && c <= '9')) c = '_';
  }
  if (is_letter(made.front())) return made;
  return std::string(first) + (made.front() == '_' ? "" : "_") + made;
}

}  // namespace probe::assets
