#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "compiler/diag/diagnostic.h"
#include "compiler/syntax/lexer.h"

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
  const std::set<std::string> table = {
#define PROBE_DECL(word) #word,
#define PROBE_STATEMENT(word) #word,
#define PROBE_WORD(word) #word,
#include "compiler/syntax/keywords.def"
  };
  const std::string grammar = read(kDsl / "grammar.ebnf");
  const std::size_t rules = grammar.find("(* ---- file");
  REQUIRE(rules != std::string::npos);
  const std::set<std::string> words = quoted_words(grammar.substr(rules));
  for (const std::string& word : words)
    CHECK_MESSAGE(table.count(word) == 1, "not in keywords.def: ", word);
  const std::set<std::string> conventions = {
      "appearance", "commonsense"};  // axes with a meaning, not words of a rule
  for (const std::string& word : table) {
    if (conventions.count(word) == 0)
      CHECK_MESSAGE(words.count(word) == 1, "not in grammar.ebnf: ", word);
  }
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
