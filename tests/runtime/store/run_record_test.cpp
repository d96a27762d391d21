// What has changed between a folder's record and a run that would go on in it.
#include "runtime/store/run_record.h"

#include <doctest/doctest.h>

namespace probe::store {
namespace {

RunRecord run_of(const std::string& plan, const std::string& program, const std::string& assets) {
  return {{plan, "expert", "policy expert"},
          "smoke",
          {42},
          {{{"assets", assets}, {"program", program}}}};
}

}  // namespace

TEST_CASE(
    "what could not be asked at a call's end is shown by a later call that meets the same policy") {
  RunCall unclear, later;
  unclear.reading = policy::Reading{.server = "gpu:443", .answers = 3, .answers_sha256 = "ab"};
  unclear.reading->questions_sha256 = "cd";
  unclear.reading->is_steady = true;
  unclear.reading->at_end = policy::AtEnd::kUnclear;
  later.reading = unclear.reading;
  later.reading->at_end = policy::AtEnd::kSame;
  REQUIRE(summarize_readings({unclear}).findings.size() == 1);
  CHECK(summarize_readings({unclear}).findings[0].find("is not shown") != std::string::npos);
  CHECK(summarize_readings({unclear, later}).findings.empty());
  CHECK(summarize_readings({later, unclear}).findings.size() == 1);
  CHECK(summarize_readings({unclear, later}).good != "");
  later.reading->answers_sha256 = "ef";
  CHECK(summarize_readings({unclear, later}).findings.size() == 2);
  CHECK(summarize_readings({later}, 7).findings[0].starts_with("7 episodes "));
}

TEST_CASE("a run that stops by what it finds says so, and another rule is another run") {
  const RunRecord run = run_of("aa", "1f", "c0");
  RunRecord until = run;
  until.identity.until = "width 10 % of each task";
  const std::string text = record_to_text(until);
  CHECK(text.find(R"("schema":"5")") != std::string::npos);
  CHECK(record_from_text(text, "x").value().identity == until.identity);
  RunRecord live = until;
  live.identity.live = "live, 80 ms, at most 90 % held";
  CHECK(record_from_text(record_to_text(live), "x").value().identity == live.identity);
  std::string without = text;
  without.replace(without.find("\"until\":"), 8, "\"un_til\":");
  CHECK(record_from_text(without, "x").failure().message.find("until") != std::string::npos);
  CHECK(changes_between(until, run).identity ==
        "holds a run that stops by `--until` (width 10 % of each task), not one that runs all its "
        "episodes; `--until none` runs the others and makes it an ordinary one");
  RunRecord other = until;
  other.identity.until = "width 5 % of each task";
  CHECK(changes_between(until, other).identity.find("(width 5 % of each task)") != std::string::npos);
  CHECK(changes_between(run, until).identity.find("runs all its episodes, not one") !=
        std::string::npos);
}

TEST_CASE("a folder of successes says so, and older programs do not take it for a run") {
  RunRecord run = run_of("aa", "1f", "c0"), demos = run;
  demos.identity.only_success = true;
  CHECK(record_to_text(run).find("only_success") == std::string::npos);
  const std::string text = record_to_text(demos);
  CHECK(text.find(R"("schema":"4")") != std::string::npos);
  for (const RunRecord& record : {run, demos}) {
    const auto read = record_from_text(record_to_text(record), "x");
    REQUIRE_MESSAGE(read.ok(), (read.ok() ? "" : to_text(read.failure())));
    CHECK(read->identity == record.identity);
  }
  RunRecord live = demos;
  live.identity.live = "live, 80 ms, at most 90 % held";
  CHECK(record_from_text(record_to_text(live), "x").value().identity == live.identity);
  std::string without = text;
  without.replace(without.find("\"only_success\":true"), 19, "\"only_success\":false");
  CHECK(record_from_text(without, "x").failure().message.find("only_success") != std::string::npos);
  CHECK(changes_between(demos, run).identity ==
        "holds successes alone (`vlaprobe demos`), not every episode that was run");
  CHECK(changes_between(run, demos).identity ==
        "holds every episode that was run, not successes alone (`vlaprobe demos`)");
}

TEST_CASE("a change is said of what changed: the plan, the assets or the build") {
  const RunRecord begun = run_of("aa", "1f", "c0");
  CHECK_FALSE(changes_between(begun, begun).any());
  const RunChanges assets = changes_between(begun, run_of("aa", "1f", "c1"));
  CHECK(assets.build == "was begun with other assets (assets: recorded c0, here c1)");
  CHECK(assets.identity.empty());
  const RunChanges program = changes_between(begun, run_of("aa", "20", "c0"));
  CHECK(program.build == "was begun by another build or machine (program: recorded 1f, here 20)");
  const RunChanges plan = changes_between(begun, run_of("bb", "1f", "c1"));
  CHECK(plan.identity == "holds a run of another plan (root aa, this one is bb)");
  CHECK(plan.build.empty());
  const RunChanges both = changes_between(begun, run_of("bb", "20", "c1"));
  CHECK(both.build ==
        "was begun by another build or machine (assets: recorded c0, here c1; program: recorded "
        "1f, here 20)");
}

}  // namespace probe::store
