#include "runtime/libero/words.h"

#include <fmt/format.h>

#include <algorithm>

namespace probe::libero {
namespace {

struct ThingWords {
  std::string_view category, name, set, statements;
};
constexpr ThingWords kThings[] = {
#define LIBERO_THING(category, name, set, statements) {#category, name, set, statements},
#include "runtime/libero/words.def"
};

struct PartWords {
  std::string_view category, own, name;
};
constexpr PartWords kParts[] = {
#define LIBERO_NAME(category, own, name) {#category, #own, name},
#include "runtime/libero/words.def"
};

// The line that begins with `begin` calls it `name` at its end.
void call(std::string& text, const std::string& begin, std::string_view name) {
  const std::size_t at = text.find(begin);
  if (at == text.npos) return;
  const std::size_t end = text.find('\n', at);
  const std::size_t said = text.find(" name \"", at);
  if (said < end) text.erase(said, end - said);
  text.insert(text.find('\n', at), fmt::format(" name \"{}\"", name));
}

}  // namespace

std::string_view name_of(std::string_view category) {
  const auto known = std::ranges::find(kThings, category, &ThingWords::category);
  return known == std::end(kThings) ? std::string_view() : known->name;
}

std::string_view set_of(std::string_view category) {
  const auto known = std::ranges::find(kThings, category, &ThingWords::category);
  return known == std::end(kThings) ? std::string_view() : known->set;
}

std::string_view name_of(std::string_view category, std::string_view own) {
  const auto known = std::ranges::find_if(
      kParts, [&](const PartWords& part) { return part.category == category && part.own == own; });
  return known == std::end(kParts) ? std::string_view() : known->name;
}

std::string described(std::string_view category, std::string declaration,
                      const std::function<bool(std::string_view)>& is_there) {
  for (const PartWords& part : kParts) {
    if (part.category != category) continue;
    call(declaration, fmt::format("  part {} link ", part.own), part.name);
    call(declaration, fmt::format("  region {} of ", part.own), part.name);
  }
  const auto known = std::ranges::find(kThings, category, &ThingWords::category);
  if (known == std::end(kThings)) return declaration;
  const std::size_t name = declaration.find("; name \"");
  const std::size_t end = declaration.rfind('}');
  if (name == declaration.npos || end == declaration.npos) return declaration;
  std::string statements;
  for (std::string_view rest = known->statements.substr(1); !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n') + 1);
    rest.remove_prefix(line.size());
    constexpr std::string_view kTo = "nearest(";
    const std::size_t to = line.find(kTo);
    if (to != line.npos) {
      const std::size_t begin = to + kTo.size();
      if (!is_there(line.substr(begin, line.find(')', begin) - begin))) continue;
    }
    statements += line;
  }
  declaration.insert(end, statements);
  declaration.replace(name, declaration.find('\n', name) - name,
                      fmt::format("; name \"{}\"", known->name));
  return declaration;
}

}  // namespace probe::libero
