// The table of protocols: what every row must say.
#include "runtime/servers/protocol.h"

#include <doctest/doctest.h>

#include <set>

#include "runtime/servers/profile_check.h"
#include "runtime/servers/profile_library.h"

namespace probe::servers {

TEST_CASE("every protocol has a row with a word of its own, and a ready profile of that name") {
  std::set<std::string_view> words;
  for (const Protocol protocol : all_protocols()) {
    const ProtocolRow& row = row_of(protocol);
    CAPTURE(row.word);
    CHECK(words.insert(row.word).second);
    CHECK(row.word == to_word(protocol));
    CHECK(row.argument.starts_with("//HOST:PORT"));
    CHECK_FALSE(row.meaning.empty());
    CHECK(std::stoi(std::string(row.port)) > 0);
    REQUIRE((row.make != nullptr));
    REQUIRE((row.serve != nullptr));
    const auto profile = find_profile(row.word);
    REQUIRE_MESSAGE(profile.ok(), to_text(profile.failure()));
    CHECK(profile->protocol == protocol);
  }
  CHECK(words.size() == all_protocols().size());
}

TEST_CASE("every protocol says under which keys it sends what a profile has") {
  Profile profile;
  profile.images = {{.camera = "", .key = "front"}, {.camera = "wrist", .key = "hand"}};
  profile.state_layout = StateLayout::kXyzRpyOpenness;
  for (const Protocol protocol : all_protocols()) {
    profile.protocol = protocol;
    CAPTURE(to_word(protocol));
    std::set<std::string> fields;
    for (const KeyUse& use : row_of(protocol).key_uses(profile)) {
      CHECK_FALSE(use.key.empty());
      fields.insert(use.field);
    }
    CHECK(fields.contains("image 1"));
    CHECK(fields.contains("image 2"));
    CHECK(fields.contains("prompt.key"));
    CHECK(fields.contains("state.key") == (protocol != Protocol::kRoboArena));
    CHECK_FALSE(find_key_conflict(profile).has_value());
  }
}

TEST_CASE("a picture under a key that a protocol has for itself is refused") {
  for (const Protocol protocol : all_protocols()) {
    for (const std::string_view key : row_of(protocol).fixed_keys) {
      Profile profile;
      profile.protocol = protocol;
      profile.images = {{.camera = "", .key = "front"}};
      profile.prompt_key = key;
      CAPTURE(key);
      const auto mistake = find_key_conflict(profile);
      REQUIRE(mistake.has_value());
      CHECK(mistake->message == "`prompt.key` has the key `" + std::string(key) + "`, which is " +
                                    std::string(to_word(protocol)) + "'s own");
    }
  }
}

}  // namespace probe::servers
