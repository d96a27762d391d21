// The grammar's words, units and generated files against the tables that the compiler reads.
#include <unistd.h>

#include <cctype>
#include <map>
#include <regex>
#include <set>

#include "compiler/syntax/ast.h"
#include "compiler/syntax/words.h"
#include "runtime/base/json.h"
#include "runtime/plan/axes.h"
#include "tests/dsl/tree_sitter/tree.h"
#include "tests/node_program.h"

using namespace probe;

namespace {

using Words = std::set<std::string>;

const Json& grammar() {
  static const Json kGrammar = Json::parse(test::text_of(test::kGrammar / "src/grammar.json"));
  return kGrammar;
}

// What one has and the other has not.
std::string difference(const Words& found, const Words& wanted) {
  std::string out;
  for (const std::string& word : found) out += wanted.contains(word) ? "" : " +" + word;
  for (const std::string& word : wanted) out += found.contains(word) ? "" : " -" + word;
  return out;
}

bool is_word(std::string_view text) {
  return !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) != 0;
}

// The words that a rule asks for; those of units stand in a token.
void add_words(const Json& rule, Words& out) {
  const std::string& type = rule["type"].text();
  if (type == "STRING" && is_word(rule["value"].text())) out.insert(rule["value"].text());
  if (type == "TOKEN" || type == "IMMEDIATE_TOKEN") return;
  if (const Json* content = rule.find("content")) add_words(*content, out);
  if (const Json* members = rule.find("members")) {
    for (const Json& member : *members) add_words(member, out);
  }
}

Words words_of_rules(const std::function<bool(const std::string&)>& wanted) {
  Words out;
  for (const auto& [name, rule] : grammar()["rules"].items()) {
    if (wanted(name)) add_words(rule, out);
  }
  return out;
}

// What stands between `before` and `behind` in the names of rules.
Words parts_of_names(const std::string& before, const std::string& behind) {
  Words out;
  for (const auto& [name, rule] : grammar()["rules"].items()) {
    if (name.starts_with(before) && name.ends_with(behind))
      out.insert(name.substr(before.size(), name.size() - before.size() - behind.size()));
  }
  return out;
}

std::string name_of(syntax::Block block) {
  switch (block) {
    case syntax::Block::kDataset:
      return "dataset";
    case syntax::Block::kObject:
      return "object";
    case syntax::Block::kRobot:
      return "robot";
    case syntax::Block::kControl:
      return "control";
    case syntax::Block::kCamera:
      return "camera";
    case syntax::Block::kLight:
      return "light";
    case syntax::Block::kFixture:
      return "fixture";
    case syntax::Block::kPart:
      return "part";
    case syntax::Block::kScene:
      return "scene";
    case syntax::Block::kLayout:
      return "layout";
    case syntax::Block::kTask:
      return "task";
    case syntax::Block::kSolution:
      return "solution";
    case syntax::Block::kQuestions:
      return "questions";
    case syntax::Block::kSuite:
      return "suite";
    case syntax::Block::kSpace:
      return "space";
  }
  return "";
}

}  // namespace

TEST_CASE("declarations and statements of tree-sitter's grammar are those of keywords.def") {
  Words declarations;
  for (const std::string_view word : syntax::declaration_words()) declarations.emplace(word);
  declarations.insert("");  // `_declaration` is any of them
  CHECK(difference(parts_of_names("", "_declaration"), declarations) == "");

  std::map<std::string, Words> wanted, found;
  for (const syntax::StatementWord& statement : syntax::statement_words()) {
    const std::string block = name_of(statement.block);
    wanted[block].emplace(statement.word);
    const Json* choice = grammar()["rules"].find("_" + block + "_statement");
    REQUIRE_MESSAGE(choice != nullptr, block);
    for (const Json& member : (*choice)["members"]) {
      const std::string name = member["name"].text(), start = block + "_";
      if (!name.starts_with(start)) continue;  // an attribute, a role
      found[block].insert(name.substr(start.size()));
      const Json& first = grammar()["rules"][name]["members"][0];
      CHECK_MESSAGE(first["value"].text() == name.substr(start.size()), name);
    }
  }
  CHECK(found.size() == wanted.size());
  for (const auto& [block, words] : wanted)
    CHECK_MESSAGE(difference(found[block], words) == "", block);
}

TEST_CASE("tree-sitter's grammar asks for every word of the language and for no other") {
  Words wanted;
  for (const std::string_view word : syntax::declaration_words()) wanted.emplace(word);
  for (const syntax::StatementWord& word : syntax::statement_words()) wanted.emplace(word.word);
  for (const std::string_view word : syntax::inner_words()) wanted.emplace(word);
  // Any name can stand where the axis of a phrase does; which are axes is told later.
  for (const plan::AxisInfo& axis : plan::kAxisTable) {
    if (axis.is_phrase) wanted.erase(std::string(axis.word()));
  }
  // `all three goods`: the words of numbers are none of the language's.
  const Words found = words_of_rules([](const std::string& name) { return name != "number_word"; });
  CHECK(difference(found, wanted) == "");
}

TEST_CASE("units of tree-sitter's grammar are those of units.def") {
  Words wanted, found;
#define PROBE_UNIT(id, text, scale, length, time, angle, mass, pixel) wanted.insert(text);
#include "compiler/syntax/units.def"
  for (const Json& unit : grammar()["rules"]["unit"]["content"]["content"]["members"])
    found.insert(unit["value"].text());
  CHECK(difference(found, wanted) == "");
}

TEST_CASE("what tree-sitter's scanner takes for the next declaration is what begins one") {
  const std::string text = test::text_of(test::kGrammar / "src/scanner.c");
  const std::size_t begin = text.find("DECLARATIONS[] = {"), end = text.find("};", begin);
  REQUIRE(end != text.npos);
  const std::string table = text.substr(begin, end - begin);
  static const std::regex kText("\"([a-z]+)\"");
  Words wanted, found;
  for (std::sregex_iterator at(table.begin(), table.end(), kText), none; at != none; ++at)
    found.insert((*at)[1]);
  for (const std::string_view word : syntax::declaration_words()) wanted.emplace(word);
  CHECK(difference(found, wanted) == "");
  std::size_t longest = 0;
  for (const std::string& word : wanted) longest = std::max(longest, word.size());
  CHECK(text.find("LONGEST_DECLARATION = " + std::to_string(longest) + " ") != text.npos);
}

TEST_CASE("grammar.json and parser.c are those of grammar.js") {
  const test::ShellOutcome outcome =
      test::run_node("tests/dsl/tree_sitter/grammar_json.mjs", "'" + test::kGrammar.string() + "'");
  CHECK_MESSAGE(outcome.status == 0, outcome.words,
                "dsl/editor/tree-sitter/generate makes src/ anew");
  // The parser is not made here; it has each rule that is seen, each word and no other.
  Words in_parser, in_grammar = words_of_rules([](const std::string&) { return true; });
  const TSLanguage* language = tree_sitter_probe();
  for (TSSymbol i = 0; i < ts_language_symbol_count(language); ++i) {
    const std::string name = ts_language_symbol_name(language, i);
    const TSSymbolType type = ts_language_symbol_type(language, i);
    const bool is_seen =
        type == TSSymbolTypeRegular || (type == TSSymbolTypeAnonymous && is_word(name));
    if (is_seen && name != "ERROR" && name != "end") in_parser.insert(name);
  }
  if (in_grammar.contains("end")) in_parser.insert("end");
  const std::function<void(const Json&)> add_aliases = [&](const Json& rule) {
    if (rule["type"].text() == "ALIAS" && rule["named"].get<bool>())
      in_grammar.insert(rule["value"].text());
    if (const Json* content = rule.find("content")) add_aliases(*content);
    if (const Json* members = rule.find("members")) {
      for (const Json& member : *members) add_aliases(member);
    }
  };
  for (const auto& [name, rule] : grammar()["rules"].items()) {
    if (!name.starts_with("_") && name != "abstract_declaration") in_grammar.insert(name);
    add_aliases(rule);
  }
  in_parser.erase("abstract_declaration");  // stands as a task's
  CHECK(difference(in_parser, in_grammar) == "");
}

// The order of states is that of the Rust that the generator was built with; what stands before
// their tables is not.
static std::string without_states(const std::string& parser) {
  const std::size_t states = parser.find("ts_primary_state_ids");
  REQUIRE(states != parser.npos);
  return parser.substr(0, states);
}

TEST_CASE("the generator makes the files that are here") {
  const test::fs::path program =
      VLAPROBE_BINARY_DIR "/tree_sitter_generator-0.20.7-1/crate/target/release/generate";
  if (!test::fs::exists(program)) {
    MESSAGE("SKIPPED: the generator was not built (dsl/editor/tree-sitter/generate)");
    return;
  }
  std::string pattern = (test::fs::temp_directory_path() / "probe_grammar_XXXXXX").string();
  const test::fs::path folder = mkdtemp(pattern.data());
  test::fs::copy_file(test::kGrammar / "grammar.js", folder / "grammar.js");
  CHECK(std::system(("'" + program.string() + "' '" + folder.string() + "'").c_str()) == 0);
  const auto made = [&](const char* file) { return test::text_of(folder / "src" / file); };
  const auto here = [&](const char* file) { return test::text_of(test::kGrammar / "src" / file); };
  for (const char* file : {"grammar.json", "node-types.json", "tree_sitter/parser.h"})
    CHECK_MESSAGE((made(file) == here(file)), file,
                  ": dsl/editor/tree-sitter/generate makes it anew");
  const bool same_symbols = without_states(made("parser.c")) == without_states(here("parser.c"));
  CHECK_MESSAGE(same_symbols, "parser.c: dsl/editor/tree-sitter/generate makes it anew");
  test::fs::remove_all(folder);
}
