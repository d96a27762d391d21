// What is said of folders whose episodes depend on how they ended.
#include "runtime/store/until_words.h"

#include <doctest/doctest.h>

#include "runtime/store/run_record.h"

namespace probe::store {

TEST_CASE("a run that stops by a rule and one of a search each have their words and their way out") {
  const std::string rule = "width 10 % of each task", search(kBySearch);
  CHECK(what_chose(rule) == "stopped by what it found (width 10 % of each task)");
  CHECK(way_out(rule) == "`run --until none` runs the others");
  CHECK(what_chose(search) == "is of a search, which chose its episodes by what it found");
  CHECK(way_out(search).find("`vlaprobe search show DIR`") != std::string::npos);
  CHECK(way_out(search).find("--until") == std::string::npos);
  // Somebody else's folder paints nobody's terminal.
  CHECK(what_chose("decided against `\x1b[31mx` (outcomes 0)").find('\x1b') == std::string::npos);
  RunRecord plain, strange;
  strange.identity.until = "decided against `\x1b[31mx` (outcomes 0)";
  CHECK(changes_between(strange, plain).identity.find('\x1b') == std::string::npos);
}

}  // namespace probe::store
