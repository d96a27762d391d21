// An episode that ended with a carrot faster than 50 m/s: trembling, the expert presses its open
// fingers into the table beside it.
#include <doctest/doctest.h>

#include "runtime/run/run.h"
#include "tests/parity/published.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::run {
using namespace probe::store;
namespace {

TEST_CASE("an expert that trembles its fingers into the table comes to the end of its episode") {
  const TemporaryFolder folder;
  RunOptions options;
  options.policy = "noisy:0.01";
  options.out = folder / "run";
  options.tasks = "carrot_on_ramekin_clean";
  options.episodes = {19, 19};
  options.seeds = {42};
  options.assets = VLAPROBE_SOURCE_DIR "/assets";
  const auto summary = run::run(test::suite_plan(), options);
  REQUIRE_MESSAGE(summary.ok(), (summary.ok() ? "" : to_text(summary.failure())));
  CHECK(summary->done == 1);
  const auto rows = read_results(options.out);
  REQUIRE(rows.ok());
  REQUIRE(rows->size() == 1);
  CHECK_MESSAGE(!rows->front().invalid, rows->front().invalid.value_or(""));
  CHECK(rows->front().steps == 60);
}

}  // namespace
}  // namespace probe::run
