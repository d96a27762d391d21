// The page on reading and the tables it is about.
#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "runtime/ask/reading/read_answer.h"
#include "runtime/plan/questions.h"

namespace probe::ask {

TEST_CASE("the page on reading has every place and every rule of each form, and no other") {
  std::ifstream file(VLAPROBE_SOURCE_DIR "/runtime/ask/reading/README.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  std::size_t rows = 0;
  for (const RuleInfo& place : places()) {
    CAPTURE(place.name);
    CHECK(page.find("| `" + std::string(place.name) + "` |") != std::string::npos);
    ++rows;
  }
  std::size_t at = 0;  // forms follow one another as the plan's table has them
  for (const plan::QuestionFormInfo& form : plan::kQuestionForms) {
    at = page.find("| " + std::string(form.word) + " | `", at);
    REQUIRE(at != std::string::npos);
    for (const RuleInfo& rule : rules(form.id)) {
      CAPTURE(rule.name);
      at = page.find("| `" + std::string(rule.name) + "` |", at);
      REQUIRE(at != std::string::npos);
      ++rows;
    }
  }
  std::size_t written = 0;
  for (std::size_t line = page.find("| `"); line != std::string::npos;
       line = page.find("| `", line + 1))
    ++written;
  CHECK(written == rows);
}

}  // namespace probe::ask
