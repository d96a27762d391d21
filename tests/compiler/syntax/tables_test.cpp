#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "compiler/diag/diagnostic.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/words.h"
#include "runtime/plan/axes.h"
#include "runtime/plan/readouts.h"

using namespace probe;
using namespace probe::syntax;

namespace {

std::string read(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

const std::filesystem::path kDsl = std::filesystem::path(VLAPROBE_SOURCE_DIR) / "dsl";

// Words in double quotes of the rules behind `from`, without comments.
std::set<std::string> quoted_words(const std::string& text) {
  std::set<std::string> words;
  for (std::size_t at = 0; at < text.size();) {
    if (text.compare(at, 2, "(*") == 0) {
      at = text.find("*)", at) + 2;
      continue;
    }
    if (text[at] != '"') {
      ++at;
      continue;
    }
    const std::size_t end = text.find('"', at + 1);
    const std::string word = text.substr(at + 1, end - at - 1);
    if (!word.empty() && is_letter(word.front())) words.insert(word);
    at = end + 1;
  }
  return words;
}

}  // namespace

TEST_CASE("the keyword table holds exactly the words of the grammar") {
  std::set<std::string> table;
  for (const std::string_view word : declaration_words()) table.emplace(word);
  for (const StatementWord& statement : statement_words()) table.emplace(statement.word);
  for (const std::string_view word : inner_words()) table.emplace(word);
  const std::string grammar = read(kDsl / "grammar.ebnf");
  const std::size_t rules = grammar.find("(* ---- file");
  REQUIRE(rules != std::string::npos);
  const std::set<std::string> words = quoted_words(grammar.substr(rules));
  for (const std::string& word : words)
    CHECK_MESSAGE(table.count(word) == 1, "not in keywords.def: ", word);
  std::set<std::string> conventions;  // axes with a meaning, not words of a rule
  for (const plan::AxisInfo& axis : plan::kAxisTable) {
    if (axis.is_phrase) conventions.emplace(axis.word());
  }
  for (const std::string& word : table) {
    if (conventions.count(word) == 0)
      CHECK_MESSAGE(words.count(word) == 1, "not in grammar.ebnf: ", word);
  }
}

namespace {

// The right side of a rule, by its name at the beginning of a line.
std::string rule_of(const std::string& grammar, const std::string& name) {
  const std::size_t begin = grammar.find("\n" + name + " ");
  REQUIRE_MESSAGE(begin != std::string::npos, name);
  return grammar.substr(begin, grammar.find(" ;", begin) - begin);
}

}  // namespace

TEST_CASE("each block of the grammar has the statements of its block in the table") {
  const std::string grammar = read(kDsl / "grammar.ebnf");
  const std::pair<Block, const char*> blocks[] = {
      {Block::kDataset, "dataset"},    {Block::kObject, "object_st"},
      {Block::kRobot, "robot_st"},     {Block::kControl, "control_st"},
      {Block::kCamera, "camera_st"},   {Block::kLight, "light_st"},
      {Block::kScene, "scene_st"},     {Block::kFixture, "fixture_st"},
      {Block::kLayout, "layout_st"},   {Block::kTask, "task_st"},
      {Block::kSolution, "skill"},     {Block::kPart, "part_st"},
      {Block::kQuestions, "question"}, {Block::kSuite, "suite_st"},
      {Block::kSpace, "space_st"}};
  std::size_t checked = 0;
  for (const auto& [block, rule] : blocks) {
    const std::set<std::string> words = quoted_words(rule_of(grammar, rule));
    for (const StatementWord& statement : statement_words()) {
      if (statement.block != block) continue;
      CHECK_MESSAGE(words.contains(std::string(statement.word)), rule, ": ", statement.word);
      CHECK(find_statement(block, statement.word) == &statement);
      ++checked;
    }
  }
  CHECK(checked == statement_words().size());
}

TEST_CASE("the read-outs of the grammar are those of the table") {
  // `ends when` stands in the table and reads nothing out: it is a statement of its own.
  const std::string grammar = read(kDsl / "grammar.ebnf");
  const std::string rule = rule_of(grammar, "metric") + rule_of(grammar, "readout");
  std::set<std::string> words;
  for (const plan::ReadoutInfo& readout : plan::kReadoutTable) {
    std::istringstream text{std::string(readout.words)};
    for (std::string word; text >> word;) words.insert(word);
  }
  std::set<std::string> written = quoted_words(rule);
  written.erase("=");
  CHECK(written == words);
}

TEST_CASE("the units of the grammar are those of the table") {
  const std::string grammar = read(kDsl / "grammar.ebnf");
  const std::size_t begin = grammar.find("\nunit ");
  REQUIRE(begin != std::string::npos);
  const std::string rule = grammar.substr(begin, grammar.find(';', begin) - begin);
  for (const std::string& word : quoted_words(rule)) {
    CHECK_MESSAGE(unit_from_text(word) != Unit::kNone, word);
  }
  const std::string all = all_units();
  CHECK(quoted_words(rule).size() ==
        static_cast<std::size_t>(std::count(all.begin(), all.end(), ',')) + 1);
}

TEST_CASE("every code of the syntax has an essay under its title") {
  for (const Code code : {Code::P0101, Code::P0102, Code::P0103, Code::P0104, Code::P0105,
                          Code::P0106, Code::P0107, Code::P0202, Code::P0301, Code::P0406}) {
    const std::string name = std::string(info(code).text);
    const std::string essay = read(kDsl / "errors" / (name + ".md"));
    const std::string head = "# " + name + ": " + std::string(info(code).title) + "\n";
    CHECK_MESSAGE(essay.rfind(head, 0) == 0, name);
  }
}
