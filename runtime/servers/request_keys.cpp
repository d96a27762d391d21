// What would stand under one key of a request.
#include "runtime/servers/profile_check.h"
#include "runtime/servers/protocol.h"

namespace probe::servers {

std::optional<Mistake> find_key_conflict(const Profile& profile) {
  const ProtocolRow& row = row_of(profile.protocol);
  std::vector<KeyUse> uses;
  for (const std::string_view key : row.fixed_keys) uses.push_back({"", std::string(key), "", ""});
  for (KeyUse& use : row.key_uses(profile)) uses.push_back(std::move(use));
  for (std::size_t i = 0; i < uses.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const KeyUse &one = uses[j], &other = uses[i];
      if (one.map != other.map || one.key != other.key) continue;
      if (one.field.empty()) {
        return Mistake{other.shown + " has the key `" + other.key + "`, which is " +
                           std::string(row.word) + "'s own",
                       {other.field}};
      }
      return Mistake{one.shown + " and " + other.shown + " have the same key `" + other.key +
                         "`: one of them would never arrive",
                     {one.field, other.field}};
    }
  }
  return std::nullopt;
}

}  // namespace probe::servers
