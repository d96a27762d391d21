// The layout of a text has no meaning: whatever blanks a person left, the formatter gives one
// layout, twice the same, and the plan does not change.
#include <doctest/doctest.h>

#include "compiler/format/format.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/plan.h"
#include "tests/dsl/tree_copy.h"

using namespace probe;
using test::overwrite;
using test::read_text;
using test::TreeCopy;
namespace fs = std::filesystem;

namespace {

std::string formatted(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto result = format::format_file(sources, sources.add("t.probe", text), diagnostics);
  REQUIRE(result.ok());
  REQUIRE_MESSAGE(result->has_value(), render_text(diagnostics, sources));
  return **result;
}

// Two blanks for one and none at the begin of lines, outside of strings and comments.
std::string untidy(const std::string& text) {
  std::string out;
  bool in_string = false, in_comment = false, at_begin = true;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') {
      in_string = in_comment = false;
      at_begin = true;
      out += "  \n";
      continue;
    }
    if (at_begin && c == ' ') continue;
    at_begin = false;
    if (c == '#' && !in_string) in_comment = true;
    if (c == '"' && !in_comment && !(in_string && text[i - 1] == '\\')) in_string = !in_string;
    out += c;
    if (c == ' ' && !in_string && !in_comment) out += "\t ";
  }
  return out;
}

// Hex of the plan's root; "" for a text of which no plan can be made.
std::string root_of(const TreeCopy& tree, const fs::path& file) {
  const Compilation built = tree.compile(file);
  if (!built.ok) return {};
  const auto plan = plan::Plan::from_bytes(built.plan);
  REQUIRE_MESSAGE(plan.ok(), to_text(plan.failure()));
  return to_hex(plan->root());
}

}  // namespace

TEST_CASE("every text of the tree is in its canonical layout, and formatting it changes nothing") {
  const TreeCopy tree;
  CHECK(tree.files().size() > 15);
  for (const fs::path& file : tree.files()) {
    const std::string text = read_text(file), once = formatted(text);
    CHECK_MESSAGE(once == text, file.filename().string(), ": `vlaprobe fmt` lays it out anew");
    CHECK_MESSAGE(formatted(once) == once, file.filename().string());
  }
}

// Columns are the author's: the formatter keeps them where blanks made them. Apart from those.
std::string without_columns(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c != ' ' || out.empty() || out.back() != ' ') out += c;
  }
  return out;
}

TEST_CASE("an untidy text is laid out as the tidy one, but for columns") {
  const TreeCopy tree;
  for (const fs::path& file : tree.files()) {
    const std::string text = read_text(file), worse = untidy(text);
    CHECK(worse != text);
    const std::string laid_out = formatted(worse);
    CHECK_MESSAGE(without_columns(laid_out) == without_columns(formatted(text)),
                  file.filename().string());
    CHECK_MESSAGE(formatted(laid_out) == laid_out, file.filename().string());
  }
}

TEST_CASE("neither blanks nor the formatter change the root of any plan") {
  const TreeCopy tree;
  std::vector<std::string> roots;
  for (const fs::path& file : tree.files()) roots.push_back(root_of(tree, file));
  // The robot of one is the user's own and not among the assets; the rules of another measure parts
  // that only tasks put into roles.
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const fs::path stem = tree.files()[i].stem();
    CHECK_MESSAGE((roots[i] == "") == (stem == "my_robot" || stem == "rules" || stem == "photos"), stem.string());
  }
  for (const fs::path& file : tree.files()) overwrite(file, untidy(read_text(file)));
  for (std::size_t i = 0; i < roots.size(); ++i)
    CHECK_MESSAGE(root_of(tree, tree.files()[i]) == roots[i], tree.files()[i].string());
  for (const fs::path& file : tree.files()) overwrite(file, formatted(read_text(file)));
  for (std::size_t i = 0; i < roots.size(); ++i)
    CHECK_MESSAGE(root_of(tree, tree.files()[i]) == roots[i], tree.files()[i].string());
}
