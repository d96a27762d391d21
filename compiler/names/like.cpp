#include "compiler/names/like.h"

#include <algorithm>

namespace probe::sema {

std::vector<std::uint32_t> parents_first(Context& context,
                                         std::vector<std::optional<std::uint32_t>>& parents,
                                         const std::vector<syntax::Name>& names) {
  enum : std::uint8_t { kNew, kOpen, kDone };
  std::vector<std::uint8_t> states(parents.size(), kNew);
  std::vector<std::uint32_t> order;
  std::vector<std::uint32_t> chain;
  for (std::uint32_t start = 0; start < parents.size(); ++start) {
    chain.clear();
    std::optional<std::uint32_t> at = start;
    while (at && states[*at] == kNew) {
      states[*at] = kOpen;
      chain.push_back(*at);
      at = parents[*at];
    }
    if (at && states[*at] == kOpen) {
      std::string circle = "`" + std::string(names[*at].text) + "`";
      for (auto member = std::find(chain.begin(), chain.end(), *at) + 1; member != chain.end();
           ++member) {
        circle += " -> `" + std::string(names[*member].text) + "`";
      }
      context
          .report(Code::P0207, names[*at].span,
                  "`" + std::string(names[*at].text) + "` copies itself")
          .note(circle + " -> `" + std::string(names[*at].text) + "`");
      parents[chain.back()] = std::nullopt;
    }
    for (auto member = chain.rbegin(); member != chain.rend(); ++member) {
      states[*member] = kDone;
      order.push_back(*member);
    }
  }
  return order;
}

}  // namespace probe::sema
