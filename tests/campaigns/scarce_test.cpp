#include "tests/campaigns/check_campaign.h"

using namespace probe::test;

TEST_CASE("what lacks handles, memory, room or time says so, and goes on where it does not") {
  check_campaign(one_round_of("scarce.sh"), {" 0 findings"});
}
