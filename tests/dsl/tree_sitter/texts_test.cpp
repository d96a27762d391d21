// Which texts tree-sitter's grammar accepts: those that the compiler's parser does.
#include <algorithm>
#include <set>

#include "compiler/syntax/token.h"
#include "compiler/syntax/words.h"
#include "tests/dsl/tree_sitter/tree.h"

using namespace probe;

namespace {

// Where the two differ by intent, whatever the text.
struct Difference {
  const char* why;
  bool (*fits)(const test::Said& said, std::string_view line);
};

bool has_code(const test::Said& said, Code code) { return said.code == code; }

constexpr Difference kAcceptedMore[] = {
    {"a unit that there is not is still a unit (node unknown_unit)",
     [](const test::Said& said, std::string_view) {
       return has_code(said, Code::P0301) && said.message.starts_with("unknown unit");
     }},
    {"a name behind `5m/` without blanks is part of such a unit",
     [](const test::Said& said, std::string_view) {
       return said.message.starts_with("found `/`");
     }},
    {"a statement of a task that is misspelt may be one of a role that is called so",
     [](const test::Said& said, std::string_view) {
       return said.message.ends_with("expected a statement of a task");
     }},
    {"bytes that are not UTF-8 are characters",
     [](const test::Said& said, std::string_view) { return has_code(said, Code::P0102); }},
    {"any height",
     [](const test::Said& said, std::string_view) { return has_code(said, Code::P0103); }},
    {"any size of a text",
     [](const test::Said& said, std::string_view) { return has_code(said, Code::P0104); }},
    {"any size of a number",
     [](const test::Said& said, std::string_view) { return has_code(said, Code::P0106); }},
    {"any number of mistakes",
     [](const test::Said& said, std::string_view) { return has_code(said, Code::P0107); }},
    {"`in distinct` at the end of a line may be in a thing that is called so",
     [](const test::Said& said, std::string_view line) {
       return said.message.starts_with("found end of line") &&
              (line.find("in distinct") != line.npos || line.find("in remaining") != line.npos);
     }},
    {"the effects of a sensor may be said twice",
     [](const test::Said&, std::string_view line) { return line.find("sensor ") != line.npos; }},
    {"the value of a fact may be called `not`",
     [](const test::Said& said, std::string_view line) {
       return said.message.starts_with("found `not`") && line.find("means") != line.npos;
     }},
};

// Where tree-sitter finds a mistake and the compiler does not.
struct Refusal {
  const char* why;
  bool (*fits)(std::string_view text);
};

// A word that begins declarations at the first column, where parentheses are open.
bool declares_at_margin(std::string_view text) {
  return text.find("(\n") != text.npos || text.find(",\n") != text.npos;
}

constexpr Refusal kRefusedMore[] = {
    {"a declaration's word at the first column ends open parentheses", declares_at_margin},
};

std::string_view line_of(std::string_view text, std::uint32_t number) {
  std::size_t begin = 0;
  for (std::uint32_t i = 1; i < number; ++i) begin = text.find('\n', begin) + 1;
  return text.substr(begin, text.find('\n', begin) - begin);
}

bool is_accepted_more(const test::Said& said, const std::string& text) {
  return std::ranges::any_of(kAcceptedMore, [&](const Difference& known) {
    return known.fits(said, line_of(text, said.line));
  });
}

// Declarations as texts of their own.
std::vector<std::string> declarations_of(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  const FileId id = sources.add("t.probe", text);
  const syntax::ParseResult parsed = syntax::parse(sources, id, diagnostics);
  std::vector<std::string> out;
  if (!parsed.ok) return out;
  for (const syntax::Decl& decl : parsed.file.decls)
    out.emplace_back(text.substr(decl.span.begin, decl.span.end - decl.span.begin));
  return out;
}

}  // namespace

TEST_CASE("tree-sitter accepts every text of the tree that the compiler's parser accepts") {
  std::size_t accepted = 0;
  for (const test::fs::path& path : test::all_texts()) {
    const std::string text = test::text_of(path);
    if (!test::said_of(text).empty()) continue;
    const test::Tree tree(text);
    ++accepted;
    CHECK_MESSAGE(!tree.has_error(), test::in_tree(path), ":",
                  tree.has_error() ? tree.mistakes().front().first : 0);
    const bool knows_units = tree.shape().find("(unknown_unit)") == std::string::npos;
    CHECK_MESSAGE(knows_units, test::in_tree(path));
  }
  CHECK(accepted > 140);
}

TEST_CASE("tree-sitter finds mistakes in the lines of golden texts in which the parser does") {
  std::size_t lines = 0;
  for (const test::fs::path& path : test::all_texts()) {
    const std::string text = test::text_of(path);
    const std::vector<test::Said> said = test::said_of(text);
    const std::vector<test::Lines> mistakes = test::Tree(text).mistakes();
    for (const test::Said& mistake : said) {
      if (is_accepted_more(mistake, text)) continue;
      ++lines;
      const bool found = std::ranges::any_of(mistakes, [&](const test::Lines& in) {
        return in.first <= mistake.line && mistake.line <= in.last;
      });
      CHECK_MESSAGE(found, test::in_tree(path), ":", mistake.line, ": ", mistake.message);
    }
    const bool gave_up = std::ranges::any_of(
        said, [](const test::Said& mistake) { return has_code(mistake, Code::P0107); });
    for (const test::Lines& in : mistakes) {
      const bool known = gave_up || std::ranges::any_of(said, [&](const test::Said& mistake) {
                           return in.first <= mistake.line && mistake.line <= in.last;
                         });
      CHECK_MESSAGE(known, test::in_tree(path), ":", in.first, "-", in.last);
    }
  }
  CHECK(lines > 100);
}

// Where such a word goes on with what stands before it, as in `any and in all_of_them: ..`,
// tree-sitter reads no further.
const std::set<std::string_view> kNeverNames = {"and", "or", "for", "of", "where"};

TEST_CASE(
    "any word of the language can be a name wherever the compiler's parser takes it for one") {
  static constexpr std::string_view kTexts[] = {
      "object W like W { W W, W; is W; seen in W; region W box (1cm) .. (2cm) }",
      "object a { phrase W W \"t\" means W W and not W or W(W, W); paint W }",
      "dataset W \"t\" { relations W W W, W W W }",
      "attribute W { W, W }",
      "facts {\n W\n }",
      "robot W like W { tcp W points +W; fingers W opens -W, W opens +W; control W 5Hz; drive W, W "
      "}",
      "camera a { mount W.W at (1) look (2); sensor none }",
      "fixture W { joint W stay; part W link W { W W }; region W of W box (1) .. (2) name \"t\" }",
      "scene W like W { robot W at (1) yaw 1deg; fixture W, W; camera W as W overlay \"t\", W }",
      "layout W like W { cells W = grid 2 x 2 at (1) spread (2); place W, W in distinct W }",
      "layout a { place W on W.W; orient W yaw 1deg; start W.W 1cm }",
      "layout a { place b in W; start W.W none }",
      "role W: set",
      "template W frame W \"{the W} {W.W: W} {avoid W} {all three W}\"",
      "predicate W(W: object, b: length = W) = W(W, W: W) < W.W and not W or W > 2 * -W",
      "predicate a(b: object) = any W in W - { W } | whole W: W(W) for 3 steps",
      "metrics W like W { W = once W; ends when W }",
      "task W like W against W { scene W; layout W where clear W of W; source W.W; distractors W, "
      "W }",
      "task a { say W; refer W as W; pose W yaw 1deg; start W.W W; horizon W steps; delay W }",
      "task a { moves W none; moves W along (1) at W once; set W = at end W; camera W as W }",
      "task a { solution { pick W; put W.W on W; turn W.W by 5deg } }",
      "variants of W { W { light W }; W { } }",
      "derive \"{W}\" for W in W of W, b in phrases W of W, W in lights (W, W) where axis W.W { }",
      "derive \"a\" for W in W | W, b in variants of W, c in sample 3 of W seed 4 { }",
      "set W = W & { W, W } - (W where uses W)",
      "questions W { choice W \"{the W of W}\" for W in catalogue answer W among objects }",
      "questions a { number W \"t\" answer count(W of W); free W \"t\" answer mentions(W, W) }",
      "questions a { yesno W \"t\" answer present(W); yesno b \"t\" answer W(W) pixels 4 }",
      "suite W trained on W { tasks W; sample 3 episodes of W seed 4; questions W, W }",
      "@allow(W, \"t\") use \"t\"",
  };
  std::vector<std::string_view> words = syntax::inner_words();
  for (const std::string_view word : syntax::declaration_words()) words.push_back(word);
  for (const syntax::StatementWord& word : syntax::statement_words()) words.push_back(word.word);
  for (const std::string_view pattern : kTexts) {
    for (const std::string_view word : words) {
      // One place at a time, the others have a name of their own.
      for (std::size_t at = pattern.find('W'); at != pattern.npos; at = pattern.find('W', at + 1)) {
        std::string text(pattern);
        for (std::size_t i = text.size(); i-- > 0;) {
          if (text[i] == 'W') text.replace(i, 1, i == at ? std::string(word) : "zz");
        }
        const std::vector<test::Said> said = test::said_of(text);
        const bool is_refused = test::Tree(text).has_error();
        const bool agree = said.empty() != is_refused ||
                           (is_refused && kNeverNames.contains(word)) ||
                           (!is_refused && std::ranges::all_of(said, [&](const test::Said& one) {
                             return is_accepted_more(one, text);
                           }));
        CHECK_MESSAGE(agree, (is_refused ? "refused: " : "accepted: "), text, "\n",
                      (said.empty() ? "" : said.front().message));
      }
    }
  }
}

// Each token of each declaration of the suites and examples, left out, doubled, with a line end
// behind it, in the place of the next, and replaced by a name.
TEST_CASE("a declaration with one slip is refused by both parsers or by neither") {
  std::set<std::string> seen;
  std::size_t tried = 0, refused = 0;
  for (const test::fs::path& path : test::all_texts()) {
    if (test::in_tree(path).starts_with("tests/")) continue;
    for (const std::string& whole : declarations_of(test::text_of(path))) {
      if (whole.size() > 1500 || !seen.insert(whole).second) continue;
      SourceSet sources;
      Diagnostics diagnostics;
      const FileId id = sources.add("t.probe", whole);
      const syntax::TokenStream stream = syntax::parse(sources, id, diagnostics).tokens;
      std::vector<syntax::Token> tokens;
      for (const syntax::Token& token : stream.tokens) {
        if (!syntax::is_trivia(token.kind)) tokens.push_back(token);
      }
      for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {
        const auto text = [&](const syntax::Token& token) {
          return whole.substr(token.begin, token.end - token.begin);
        };
        const std::string before = whole.substr(0, tokens[i].begin);
        const std::string behind = whole.substr(tokens[i].end), own = text(tokens[i]);
        const syntax::Token& next = tokens[i + 1];
        const std::string between = whole.substr(tokens[i].end, next.begin - tokens[i].end);
        for (const std::string& slip :
             {before + behind, before + own + " " + own + behind, before + own + "\n" + behind,
              before + text(next) + between + own + whole.substr(next.end),
              before + "zz" + behind}) {
          const std::vector<test::Said> said = test::said_of(slip);
          const bool is_refused = test::Tree(slip).has_error();
          ++tried;
          refused += is_refused ? 1 : 0;
          if (said.empty() != is_refused) continue;
          const bool known =
              is_refused ? std::ranges::any_of(kRefusedMore,
                                               [&](const Refusal& more) { return more.fits(slip); })
                         : std::ranges::all_of(said, [&](const test::Said& mistake) {
                             return is_accepted_more(mistake, slip);
                           });
          CHECK_MESSAGE(known, test::in_tree(path), (is_refused ? ": refused: " : ": accepted: "),
                        (is_refused ? "" : said.front().message), "\n", slip);
        }
      }
    }
  }
  MESSAGE(tried, " slips, ", refused, " refused");
  CHECK(tried > 10000);
}
