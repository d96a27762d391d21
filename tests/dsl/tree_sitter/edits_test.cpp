// While one types: a tree that is mended is the tree of the whole text, mistakes stay where they
// are, and no text is too odd or too long.
#include <algorithm>
#include <random>

#include "tests/dsl/tree_sitter/tree.h"

using namespace probe;

namespace {

TSPoint point_of(std::string_view text, std::size_t at) {
  const std::string_view before = text.substr(0, at);
  const std::size_t line = before.rfind('\n');
  return {static_cast<std::uint32_t>(std::ranges::count(before, '\n')),
          static_cast<std::uint32_t>(line == before.npos ? at : at - line - 1)};
}

// In place of `size` bytes.
struct Edit {
  std::size_t at, size;
  std::string by;
};

std::string after(const Edit& edit, std::string text) {
  return text.replace(edit.at, edit.size, edit.by);
}

TSInputEdit told(const Edit& edit, std::string_view before, std::string_view behind) {
  const std::size_t old_end = edit.at + edit.size, new_end = edit.at + edit.by.size();
  return {static_cast<std::uint32_t>(edit.at), static_cast<std::uint32_t>(old_end),
          static_cast<std::uint32_t>(new_end), point_of(before, edit.at),
          point_of(before, old_end),           point_of(behind, new_end)};
}

// Whether a declaration of that name was found.
bool declares(const test::Tree& tree, const std::string& text, std::string_view name) {
  bool found = false;
  const std::function<void(TSNode)> look = [&](TSNode node) {
    const TSNode own = ts_node_child_by_field_name(node, "name", 4);
    if (!ts_node_is_null(own) && std::string_view(ts_node_type(node)).ends_with("_declaration"))
      found |=
          std::string_view(text).substr(ts_node_start_byte(own),
                                        ts_node_end_byte(own) - ts_node_start_byte(own)) == name;
    for (std::uint32_t i = 0; i < ts_node_child_count(node); ++i) look(ts_node_child(node, i));
  };
  look(tree.root());
  return found;
}

}  // namespace

TEST_CASE("a tree that is mended edit by edit is the tree of the text without mistakes") {
  std::minstd_rand random(7);
  const auto below = [&](std::size_t limit) { return random() % limit; };
  static constexpr const char* kTyped[] = {"(", ")",   "{",  "}",      "\n",   ";",
                                           ",", "\"",  "#",  " ",      "x",    "task ",
                                           "=", "1cm", "..", "any { ", "{the "};
  for (const char* file :
       {"suite/beyond.probe", "suite/manipulation.probe", "suite/kitchen_stage.probe"}) {
    const std::string original = test::text_of(test::kRoot / file);
    for (int round = 0; round < 60; ++round) {
      // Some slips, then each taken back: what remains must be as if nothing had been typed.
      std::string text = original;
      test::Tree tree(text);
      std::vector<Edit> back;
      for (int i = 0; i < 3; ++i) {
        Edit edit{below(text.size()), 0, kTyped[below(std::size(kTyped))]};
        if (below(3) == 0) {
          edit.by.clear();
          edit.size = std::min<std::size_t>(1 + below(4), text.size() - edit.at);
        }
        back.push_back({edit.at, edit.by.size(), text.substr(edit.at, edit.size)});
        const std::string next = after(edit, text);
        tree.edit(told(edit, text, next));
        tree = test::Tree(next, tree);
        text = next;
      }
      while (!back.empty()) {
        const std::string next = after(back.back(), text);
        tree.edit(told(back.back(), text, next));
        tree = test::Tree(next, tree);
        text = next;
        back.pop_back();
      }
      REQUIRE(text == original);
      CHECK_MESSAGE(tree.shape() == test::Tree(original).shape(), file, ", round ", round);
    }
  }
}

TEST_CASE("what is not closed yet leaves the declarations below it alone") {
  for (const std::string open : {"task a like b { distractors 3 of (c, d", "object a { box 1cm x",
                                 "predicate p(a: object) = (near(a", "set a = { b, ",
                                 "task a { say \"put", "questions q { yesno a \"b\" answer (",
                                 "layout l { place a at (1cm,", "suite s { tasks (variants of"}) {
    const std::string text =
        "role first\n" + open + "\n\ntask last like b { }\nset later = { a }\n";
    const test::Tree tree(text);
    CHECK(tree.has_error());
    CHECK_MESSAGE(declares(tree, text, "first"), open);
    CHECK_MESSAGE(declares(tree, text, "later"), open, "\n", tree.shape());
  }
}

TEST_CASE("any bytes give a tree, in time that grows with the text") {
  std::minstd_rand random(11);
  for (int round = 0; round < 400; ++round) {
    std::string text(random() % 300, ' ');
    static constexpr std::string_view kLikely =
        "(){}[],;:.=+-*/<>!|&@#\"\\ \n\r\t09azAZ_\xc3\xa4\xff";
    for (char& c : text)
      c = random() % 4 == 0 ? static_cast<char>(random() % 256)
                            : kLikely[random() % kLikely.size()];
    test::Tree tree(text);
    CHECK(ts_node_end_byte(tree.root()) <= text.size());
  }
  for (const std::string& deep :
       {std::string(5000, '('), std::string(5000, '{'), std::string(5000, ')'),
        "predicate p() = " + std::string(5000, '(') + "a" + std::string(5000, ')')})
    CHECK(ts_node_end_byte(test::Tree(deep).root()) <= deep.size());
}

TEST_CASE("parentheses may be as deep as the scanner can remember") {
  for (const std::size_t depth : {100u, 199u, 900u}) {
    const std::string text = "predicate p() = " + std::string(depth, '(') + "\na\n" +
                             std::string(depth, ')') + "\npredicate q() = (\n b)\n";
    CHECK_MESSAGE(!test::Tree(text).has_error(), depth);
  }
}
