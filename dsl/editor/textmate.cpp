#include "dsl/editor/textmate.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "compiler/syntax/words.h"
#include "runtime/base/json.h"

namespace probe::editor {
namespace {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '/' || c == '.') out += '\\';
    out += c;
  }
  return out;
}

// The longest first, for an alternative that matches early hides those behind it; each once.
std::string alternatives(std::vector<std::string_view> words) {
  std::ranges::sort(words, [](std::string_view a, std::string_view b) {
    return a.size() != b.size() ? a.size() > b.size() : a < b;
  });
  words.erase(std::unique(words.begin(), words.end()), words.end());
  std::string out;
  for (const std::string_view word : words) out += (out.empty() ? "" : "|") + escaped(word);
  return out;
}

std::string declarations() {
  const auto words = syntax::declaration_words();
  return alternatives({words.begin(), words.end()});
}

std::string statements() {
  std::vector<std::string_view> words;
  for (const syntax::StatementWord& statement : syntax::statement_words())
    words.push_back(statement.word);
  return alternatives(std::move(words));
}

std::string words() {
  std::vector<std::string_view> all = syntax::inner_words();
  std::erase(all, "x");  // a word between numbers only
  return alternatives(std::move(all));
}

std::string units() {
  return alternatives({
#define PROBE_UNIT(id, text, scale, length, time, angle, mass, pixel) text,
#include "compiler/syntax/units.def"
  });
}

Json rule(const std::string& name, const std::string& match) {
  return {{"name", name}, {"match", match}};
}

Json captures(std::initializer_list<std::pair<const char*, const char*>> names) {
  Json out = Json::object();
  for (const auto& [group, name] : names) out[group] = {{"name", name}};
  return out;
}

Json declaration_rules() {
  return Json::array({{{"match", "^\\s*(?:(abstract)\\s+)?(variants\\s+of|" + declarations() +
                                     ")\\b(?:\\s+([A-Za-z][A-Za-z0-9_]*))?"},
                       {"captures", captures({{"1", "storage.modifier.probe"},
                                              {"2", "keyword.declaration.probe"},
                                              {"3", "entity.name.type.probe"}})}},
                      {{"match", "(@)(allow)\\b"},
                       {"captures", captures({{"1", "punctuation.definition.annotation.probe"},
                                              {"2", "storage.type.annotation.probe"}})}}});
}

Json string_rule() {
  const Json slot = {
      {"name", "meta.interpolation.probe"},
      {"match", "(\\{)\\s*(?:(avoid)\\s+)?(?:(the)\\s+)?([A-Za-z][A-Za-z0-9_]*)?([^}\"]*)(\\})"},
      {"captures", captures({{"1", "punctuation.section.interpolation.begin.probe"},
                             {"2", "keyword.operator.word.probe"},
                             {"3", "keyword.other.probe"},
                             {"4", "variable.parameter.probe"},
                             {"6", "punctuation.section.interpolation.end.probe"}})}};
  return {{"name", "string.quoted.double.probe"},
          {"begin", "\""},
          {"end", "\"|$"},
          {"patterns", Json::array({rule("constant.character.escape.probe", "\\\\[\"\\\\n]"),
                                    rule("invalid.illegal.escape.probe", "\\\\."), slot})}};
}

}  // namespace

std::string textmate_grammar() {
  Json grammar;
  grammar["$schema"] =
      "https://raw.githubusercontent.com/martinring/tmlanguage/master/tmlanguage.json";
  grammar["name"] = "Probe";
  grammar["scopeName"] = "source.probe";
  grammar["fileTypes"] = Json::array({"probe"});
  grammar["patterns"] = Json::array();
  for (const char* part :
       {"comments", "strings", "declarations", "statements", "numbers", "words", "operators"}) {
    grammar["patterns"].push_back({{"include", std::string("#") + part}});
  }
  const auto repository = [&grammar](const char* name, Json rules) {
    grammar["repository"][name]["patterns"] = std::move(rules);
  };
  repository("comments", Json::array({rule("comment.line.documentation.probe", "##(?!#).*$"),
                                      rule("comment.line.number-sign.probe", "#.*$")}));
  repository("strings", Json::array({string_rule()}));
  repository("declarations", declaration_rules());
  repository("statements",
             Json::array({{{"match", "(?:^|(?<=[{;]))\\s*(" + statements() + ")\\b"},
                           {"captures", captures({{"1", "keyword.statement.probe"}})}}}));
  repository(
      "numbers",
      Json::array({{{"match", "(?<![A-Za-z0-9_])([0-9]+(?:\\.[0-9]+)?(?:[eE][+-]?[0-9]+)?)(?:(" +
                                  units() + ")(?![A-Za-z0-9_]))?"},
                    {"captures", captures({{"1", "constant.numeric.probe"},
                                           {"2", "keyword.other.unit.probe"}})}},
                   rule("keyword.operator.word.probe", "(?<=[0-9])\\s+x\\s+(?=[0-9])")}));
  repository("words", Json::array({rule("keyword.operator.logical.probe", "\\b(?:and|or|not)\\b"),
                                   rule("keyword.other.probe", "\\b(?:" + words() + ")\\b")}));
  repository("operators",
             Json::array({rule("keyword.operator.probe", "<=|>=|==|!=|\\.\\.|[<>=+*/|&-]")}));
  return grammar.dump(2) + "\n";
}

}  // namespace probe::editor
