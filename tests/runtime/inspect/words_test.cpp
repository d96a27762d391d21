#include "runtime/inspect/words.h"

#include <doctest/doctest.h>

using namespace probe::inspect;

TEST_CASE("words that are only in one instruction are in brackets") {
  const WordDiff diff = diff_words("put carrot on plate", "put the orange object on plate");
  CHECK(marked(diff.a) == "put [carrot] on plate");
  CHECK(marked(diff.b) == "put [the orange object] on plate");
}

TEST_CASE("equal instructions have no brackets, those without a common word one pair") {
  CHECK(marked(diff_words("put a on b", "put a on b").a) == "put a on b");
  CHECK(marked(diff_words("put it", "drop them").b) == "[drop them]");
  CHECK(marked(diff_words("", "drop them").a).empty());
}

TEST_CASE("a word that moved is marked in both") {
  const WordDiff diff = diff_words("a b c", "c a b");
  CHECK(marked(diff.a) == "a b [c]");
  CHECK(marked(diff.b) == "[c] a b");
}
