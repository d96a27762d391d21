#include "tests/campaigns/check_campaign.h"

using namespace probe::test;

TEST_CASE("traces, pictures and verdicts do not depend on what surrounds a run") {
  // Of 20 ways those that borrow a package are skipped where there is no network.
  check_campaign(one_round_of("determinism.sh"),
                 {"runs have the first one's traces, pictures and verdicts",
                  "8 of 8 runs of another processor, compiler or library are refused"});
}
