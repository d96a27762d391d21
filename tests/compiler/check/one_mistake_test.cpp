// One slip in a text that is fine gives one diagnostic: what follows from it is not said again.
#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "tests/compiler/small_suite.h"

using namespace probe;

namespace {

// Every construct in a few lines, behind the small suite.
const char* const kMore = R"(
object jug like pale { mesh "jug"; name "jug" }
object lid like tray { mesh "lid"; name "lid" }
layout close like pairs { drop 5cm }
role helper
role goods: set
layout three {
  cells all = grid 2 x 2 at (0cm, 0cm) spread (10cm, 10cm)
  place source, helper, target in distinct all
  orient by rest
  drop 10cm settle 0.5s
}
layout heap {
  cells all = grid 2 x 2 at (0cm, 0cm) spread (10cm, 10cm)
  place source, target, goods in distinct all
  orient by rest
  drop 10cm settle 0.5s
}
metrics pair_up like plain { high = once (height(helper) > height(red)) }
metrics all_up like plain { each = at end (all g in goods: height(g) > height(target)) }
task pair like base {
  layout three; metrics pair_up; source red; helper blue; target tray
  say "put {the source} and {the helper} on {the target}"
}
task pile like base {
  layout heap; metrics all_up; source pale; goods red, blue; target tray
  say "put {the source} and {the goods} on {the target}"
}
layout turned like pairs { orient source yaw 0deg, yaw 90deg; jitter 1mm; expect 24 episodes }
template shove frame shove "shove {the source: toy} to {the target: dish}"
predicate near(o: object, gap: length = 2cm) = distance(tcp, o) < gap
predicate apart(a: object, b: object) = all {
  near(a, gap: 1cm)
  not distance_xy(a, b) < 1cm
}
metrics more like plain { near = once near(source); apart = count apart(source, target) }
task judged like red_on_tray { metrics more }
variant pushed of red_on_tray { say shove }
variant named of red_on_tray { refer source as by_color }
variant among of red_on_tray { distractors blue; pose blue yaw 0deg, yaw 45deg }
variant warned of among { say "put {source} on {target}, not {avoid the blue}" }
variants of red_on_tray { dark { light night }; longer { horizon 90 steps } }
variant shaken of red_on_tray { layout turned }
derive "{t}_of_{p}" for t in { red_on_tray }, p in phrases appearance of source { refer source as p }
set wordy = tasks where uses appearance or axis language.action
set rest = tasks - wordy - { pair, pile }
questions asked {
  choice pick "told {instruction}, which one?" answer source among objects and 1 absent
  choice shun "told {instruction}, which one not?" answer avoided among objects where uses negation
  yesno there "is there {a o}?" for o in catalogue answer present(o)
  yesno side "is {the source} left of {the target}?" at start answer left(source, target) pixels 9
  yesno up "is it up?" at end answer near(source)
  yesno done "done?" at end answer success
  number many "how many {category of source}?" answer count(color of source)
  point here "point at {the red}" answer source where not uses appearance
  free say "told {instruction}, what?" answer mentions(source, target)
}
suite all trained on lab { tasks rest | wordy; seeds 1, 2; expect 11 tasks, 264 episodes; questions asked }
)";

std::string whole() { return std::string(test::kSmallSuite) + kMore; }

// Where the words of the text begin; comments do not occur in it.
std::vector<std::pair<std::size_t, std::size_t>> words(const std::string& text) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  const auto is_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  for (std::size_t at = 0; at < text.size();) {
    if (!is_word(text[at])) {
      ++at;
      continue;
    }
    const std::size_t begin = at;
    while (at < text.size() && is_word(text[at])) ++at;
    if (std::isdigit(static_cast<unsigned char>(text[begin])) == 0) found.push_back({begin, at});
  }
  return found;
}

// Errors; what the parser says of one line is one.
std::size_t errors(const test::Analysis& a) {
  std::size_t count = 0;
  std::set<std::uint32_t> lines;
  for (const Diagnostic& item : a.diagnostics.items()) {
    if (item.severity != Severity::kError) continue;
    const std::uint32_t line =
        a.sources.file(item.primary.file).line_column(item.primary.begin).line;
    if (item.code != Code::P0101 || lines.insert(line).second) ++count;
  }
  return count;
}

}  // namespace

TEST_CASE("the text with every construct has nothing to say about") {
  const auto a = test::analyze_text(whole());
  CHECK_MESSAGE(a->codes() == "", a->said());
}

TEST_CASE("a word that is misspelt gives at most one error") {
  const std::string text = whole();
  std::string storms;
  std::size_t tried = 0;
  for (const auto& [begin, end] : words(text)) {
    std::string slipped = text;
    slipped.insert(end, "qx");
    const auto a = test::analyze_text(slipped);
    ++tried;
    if (errors(*a) <= 1) continue;
    const std::size_t line = text.rfind('\n', begin) + 1;
    storms += slipped.substr(line, slipped.find('\n', line) - line) + "\n  " + a->codes() + "\n";
  }
  CHECK(tried > 400);
  CHECK_MESSAGE(storms.empty(), storms);
}

TEST_CASE("what is offered for a misspelt word compiles when it is taken") {
  const std::string text = whole();
  std::size_t taken = 0;
  std::set<std::string> seen;
  for (const auto& [begin, end] : words(text)) {
    std::string slipped = text;
    std::swap(slipped[begin], slipped[begin + (end - begin > 1 ? 1 : 0)]);
    // A slip in a declaration is answered at its uses, which need not be all of one kind.
    const bool is_first = seen.insert(text.substr(begin, end - begin)).second;
    if (slipped == text || is_first) continue;
    const auto a = test::analyze_text(slipped);
    for (const Diagnostic& item : a->diagnostics.items()) {
      if (!item.fix) continue;
      std::string fixed = slipped;
      std::vector<Replacement> parts = item.fix->replacements;
      std::sort(parts.begin(), parts.end(), [](const Replacement& p, const Replacement& q) {
        return p.span.begin > q.span.begin;
      });
      for (const Replacement& part : parts)
        fixed.replace(part.span.begin, part.span.size(), part.text);
      const auto after = test::analyze_text(fixed);
      CHECK_MESSAGE(after->diagnostics.error_count() < a->diagnostics.error_count(), a->said(),
                    after->said());
      ++taken;
    }
  }
  CHECK(taken > 50);
}

TEST_CASE("a statement that is left out gives at most one error") {
  const std::string text = whole();
  std::string storms;
  for (std::size_t at = text.find_first_of(";\n"); at != std::string::npos;) {
    const std::size_t next = text.find_first_of(";\n", at + 1);
    const std::string statement = text.substr(at + 1, next - at - 1);
    // Without its category the toy is neither what a slot nor what a phrase wants: two mistakes.
    const bool counts_twice = statement == " category toy";
    if (statement.find_first_of("{}") == std::string::npos && !counts_twice) {
      std::string shorter = text;
      shorter.erase(at, statement.size() + 1);
      const auto a = test::analyze_text(shorter);
      if (errors(*a) > 1) storms += statement + "\n  " + a->codes() + "\n";
    }
    at = next;
  }
  CHECK_MESSAGE(storms.empty(), storms);
}
