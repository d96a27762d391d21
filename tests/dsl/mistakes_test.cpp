// The mistakes that published suites shipped and that authors make, each in a file behind the
// suite: which code, under which words, and what is said around it.
#include <doctest/doctest.h>
#include <unistd.h>

#include "tests/dsl/tree_copy.h"

using namespace probe;
namespace fs = std::filesystem;

namespace {

// The diagnostics of `text` as a file of its own; `use "suite/intact.probe"` stands in front.
class Said {
 public:
  explicit Said(const std::string& text) {
    const fs::path folder = fs::temp_directory_path() / ("probe_said_" + std::to_string(getpid()));
    fs::create_directories(folder);
    file_ = (folder / "mine.probe").string();
    test::overwrite(file_, "use \"suite/intact.probe\"\n" + text);
    auto result = check(std::span<const std::string>(&file_, 1),
                        {.asset_root = VLAPROBE_SOURCE_DIR "/assets",
                         .suite = "",
                         .library_folders = {VLAPROBE_SOURCE_DIR "/dsl", VLAPROBE_SOURCE_DIR}});
    fs::remove_all(folder);
    REQUIRE_MESSAGE(result.ok(), to_text(result.failure()));
    compilation_ = std::make_unique<Compilation>(std::move(result).value());
    text_ = render_text(compilation_->diagnostics, compilation_->sources);
  }

  std::string codes() const {
    std::string codes;
    for (const Diagnostic& item : compilation_->diagnostics.items())
      codes += (codes.empty() ? "" : " ") + std::string(info(item.code).text);
    return codes;
  }
  const Diagnostic& first() const {
    REQUIRE(!compilation_->diagnostics.empty());
    return compilation_->diagnostics.items().front();
  }
  // What stands over the carets, and that it is in the author's own file.
  std::string underlined() const {
    CHECK_MESSAGE(compilation_->sources.file(first().primary.file).name() == file_, text_);
    return std::string(compilation_->sources.text(first().primary));
  }
  // "text|text": what the labels stand under.
  std::string labelled() const {
    std::string out;
    for (const Label& label : first().labels)
      out += (out.empty() ? "" : "|") + std::string(compilation_->sources.text(label.span));
    return out;
  }
  bool says(const std::string& words) const { return text_.find(words) != std::string::npos; }
  const std::string& text() const { return text_; }

 private:
  std::string file_;
  std::unique_ptr<Compilation> compilation_;
  std::string text_;
};

}  // namespace

TEST_CASE(
    "a new distractor that makes an inherited phrase ambiguous is marked where it was added") {
  const Said said(
      "variant hard_color of carrot_on_plate_lang_color { distractors orange, spoon }\n");
  CHECK_MESSAGE(said.first().code == Code::P0402, said.text());
  CHECK(said.underlined() == "orange");
  CHECK(said.says("\"orange object\" denotes 2 objects in `hard_color`"));
  CHECK(said.says("color orange"));
  CHECK(said.says("meant for `carrot`"));
  CHECK(said.says("holds for `carrot` and not for `orange`"));
}

TEST_CASE("a length without a unit") {
  const Said said(
      "layout l like grid_24 {\n  cells corners = grid 2 x 2 at (-16, 0cm) spread (7.5cm, "
      "7.5cm)\n}\n"
      "variant v of carrot_on_plate { layout l }\n");
  CHECK(said.first().code == Code::P0302);
  CHECK(said.underlined() == "-16");
  CHECK(said.says("expected a length, found a number"));
  CHECK(said.says("`grid ... at` takes lengths"));
  CHECK(said.says("did you mean `-16cm`?"));
}

TEST_CASE("a copy without its braces, a horizon without steps, a metric that reads another") {
  const auto helps = [](const std::string& text, const std::string& help) {
    const Said said(text);
    CHECK_MESSAGE(said.text().find("= help: " + help) != std::string::npos, said.text());
  };
  helps("object can_two like coke_can\n", "a copy has a block, too, if only an empty one: `{ }`");
  helps("layout twenty like grid_24\ntask t like carrot_on_plate { layout twenty }\n",
        "a copy has a block, too, if only an empty one: `{ }`");
  helps("variant t of carrot_on_plate { horizon 60 }\n",
        "write `60 steps`, or a time with its unit: `12s`");
  helps("metrics m { success = at end on_top_of(source, target)\n  alone = at end not success }\n",
        "no metric reads another: what several share is a `predicate`, which each of them calls");
}

TEST_CASE("a size written without blanks") {
  const Said said("layout l like grid_24 { cells c = grid 2x2 at (0cm, 0cm) spread (1cm, 1cm) }\n");
  CHECK(said.first().code == Code::P0301);
  CHECK(said.says("unknown unit `x"));
  CHECK(said.says("write `2 x 2`"));
}

TEST_CASE("a misspelt object") {
  const Said said("variant bad of carrot_on_plate { source carot }\n");
  CHECK(said.codes() == "P0201");
  CHECK(said.underlined() == "carot");
  CHECK(said.says("unknown object `carot`"));
  CHECK(said.says("did you mean `carrot`?"));
}

TEST_CASE("objects that overlap at the start, with the spread that fits") {
  const Said said(
      "layout tight like grid_24 { cells corners = grid 2 x 2 at (-16cm, 0cm) spread (4cm, 4cm) "
      "}\n\n"
      "variant bad of spoon_on_towel_distract { layout tight }\n");
  CHECK(said.first().code == Code::P0501);
  CHECK(said.underlined() == "tight");
  CHECK(said.says("overlap by "));
  CHECK(said.says(" starts of `bad`"));
  CHECK(said.says("first in start "));
  CHECK(said.says(" other pairs of its objects"));
  CHECK(said.labelled() == "(4cm, 4cm)");
  CHECK(said.says(" is the least that fits these objects"));
}

TEST_CASE("a mention of what is not there") {
  const Said said(
      "variant bad of carrot_on_plate {\n"
      "  say \"put {the source} on {the target}, not {avoid the towel}\"\n}\n");
  CHECK(said.first().code == Code::P0404);
  CHECK(said.underlined() == "{avoid the towel}");
  CHECK(said.says("not in the scene"));
  CHECK(said.says("carrot, plate"));
  CHECK(said.says("add `distractors towel`"));
}

TEST_CASE("a comparison on two axes says which, and with what only one would move") {
  const Said said(
      "variant neg of carrot_on_plate_distract against carrot_on_plate {\n"
      "  say \"put {the source} on {the target}, not {avoid the towel}\"\n}\n");
  CHECK(said.codes() == "P0701");
  CHECK(said.first().severity == Severity::kWarning);
  CHECK(said.says("`neg` differs from its baseline on 2 axes"));
  CHECK(said.says("compared with this"));
  CHECK(said.says("language.negation"));
  CHECK(said.says("distractors"));
  CHECK(said.says("compare with `carrot_on_plate_distract`, where only language.negation moves"));
  CHECK(said.says("put @allow(confounded, \"why\") above the declaration"));
}

TEST_CASE("a metric that needs more steps than there are") {
  const Said said(
      "metrics m like put_strict {\n  steady = once (grasped(source) for 80 steps)\n}\n"
      "variant v of carrot_on_plate { metrics m }\n");
  CHECK(said.first().code == Code::P0604);
  CHECK(said.underlined() == "for 80 steps");
  CHECK(said.says("can never become true"));
  CHECK(said.says("the horizon is 60 steps"));
}
