#include "runtime/cluster/run_words.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "runtime/base/apart.h"
#include "runtime/base/large.h"

namespace probe::cluster {
namespace {

bool says(const std::vector<std::string>& words, const char* word) {
  return std::ranges::find(words, word) != words.end();
}

TEST_CASE("a job reads files as large as the call that submits it, which is of a whole process") {
  CHECK(!says(run_words({}), "--allow-large"));
  const auto answer = run_apart([](const AnswerWriter& write) {
    allow_large();
    return write(says(run_words({}), "--allow-large") ? "passed on" : "");
  });
  REQUIRE_MESSAGE(answer.ok(), (answer ? "" : to_text(answer.failure())));
  CHECK(answer->bytes() == "passed on");
}

}  // namespace
}  // namespace probe::cluster
