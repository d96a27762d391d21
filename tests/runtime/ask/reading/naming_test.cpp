#include "runtime/ask/reading/naming.h"

#include <doctest/doctest.h>

#include <string>

#include "tests/runtime/ask/reading/reading.h"

namespace probe::ask {
namespace {

// "7.0 5.1": options and the number of the words that named each.
std::string named_in(const std::string& text) {
  const auto options = shown_options();
  const Tokens tokens = tokens_of(plain_form(text));
  std::string out;
  for (const Named& name : NameTable(options).find(tokens)) {
    out += (out.empty() ? "" : " ") + std::to_string(options[name.place].option) + "." +
           std::to_string(name.word) + (name.is_head ? "h" : "");
  }
  return out;
}

}  // namespace

TEST_CASE("options are named by plain names, by other words, in the plural and by their noun") {
  CHECK(named_in("the carrot on a plate") == "7.0 5.0");
  CHECK(named_in("Carrots! PLATES?") == "7.0 5.0");
  CHECK(named_in("the orange object") == "7.2");
  CHECK(named_in("the rabbit\u2019s favorite vegetable") == "7.3");
  CHECK(named_in("the drink rich in the vitamin C") == "2.2");
  CHECK(named_in("into the basket") == "0.0h");
  CHECK(named_in("into the blue basket") == "");
  CHECK(named_in("carrottop, plated, pla te") == "");
}

TEST_CASE("the longest words win, and what only describes names nothing") {
  CHECK(named_in("orange juice") == "2.0");
  CHECK(named_in("the plate object") == "");
  CHECK(named_in("round-shaped object") == "5.2");
  CHECK(named_in("") == "");
}

TEST_CASE("the end of a plain name among an option's words is the plain name, and no phrase") {
  const std::vector<ShownOption> options = {
      {0, "yellow basket", {"basket", "where the dishes usually get dried"}},
      {1, "green wicker basket", {"wicker basket"}}};
  const NameTable names(options);
  const auto found = names.find(tokens_of("the basket, the wicker basket, a red basket"));
  REQUIRE(found.size() == 2);
  CHECK(found[0].place == 0);
  CHECK(found[0].word == 0);
  CHECK(found[0].is_head);
  CHECK(found[1].place == 1);
  CHECK(found[1].word == 0);
}

TEST_CASE("one noun is the plural of the other, or it is another one") {
  CHECK(is_same_noun("carrot", "carrots"));
  CHECK(is_same_noun("boxes", "box"));
  CHECK(is_same_noun("berry", "berries"));
  CHECK(is_same_noun("potato", "potatoes"));
  CHECK(is_same_noun("knife", "knives"));
  CHECK_FALSE(is_same_noun("plate", "plated"));
  CHECK_FALSE(is_same_noun("glass", "glas"));
  CHECK_FALSE(is_same_noun("can", "cane"));
  CHECK_FALSE(is_same_noun("", "es"));
}

TEST_CASE("thoughts are taken out wherever they begin and end") {
  CHECK(without_thoughts("a<think>b</think>c") == "ac");
  CHECK(without_thoughts("a<think>b") == "a");
  CHECK(without_thoughts("b</think>c") == "c");
  CHECK(without_thoughts("<think>a</think>b<THOUGHT>c</THOUGHT>d") == "bd");
  CHECK(without_thoughts("<thinker>a <think a") == "<thinker>a <think a");
  CHECK(without_thoughts("<") == "<");
  CHECK(without_thoughts("</") == "</");
}

TEST_CASE("one form of a text keeps its lines and cases and nothing that a terminal obeys") {
  CHECK(plain_form("A\r\nB\rC\u2028D") == "A\nB\nC\nD");
  CHECK(plain_form("\u2018a\u2019 \u201cb\u201d \u22123\u20145") == "'a' \"b\" -3 - 5");
  CHECK(plain_form("\x1b[0m\xffx") == " [0m x");
  CHECK(plain_form("") == "");
}

}  // namespace probe::ask
