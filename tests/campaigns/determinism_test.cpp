#include "tests/campaigns/check_campaign.h"

using namespace probe::test;

TEST_CASE("traces, pictures and verdicts do not depend on what surrounds a run") {
  check_campaign(one_round_of("determinism.sh"), {"13 of 13 runs"});
}
