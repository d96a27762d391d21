// Who may ask the studio: the page that it gave to the browser of this machine, and nobody else. A
// page of another place cannot know the token; one whose name was made to mean this machine (DNS
// rebinding) asks under another Host; one that guesses says where it comes from.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "runtime/wire/page_listener.h"

namespace probe::studio {

struct Gate {
  std::string token;  // the first part of every path
  std::string port;

  // Why this is not answered, as a page; nothing: it is.
  std::optional<wire::Page> refuse(const wire::Visit& visit) const;
  // What stands behind the token: "/TOKEN/page.js?x" gives "page.js". Of what refuse() passes.
  std::string_view path(std::string_view target) const;
};

// 128 bits of the system's randomness as 32 hexadecimal digits.
Result<std::string> make_token();

}  // namespace probe::studio
