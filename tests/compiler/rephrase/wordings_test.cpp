#include "compiler/rephrase/wordings.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "tests/compiler/small_suite.h"

using namespace probe;
using rephrase::Proved;
using rephrase::Refusal;

namespace {

struct Made {
  std::unique_ptr<test::Analysis> analysis;
  Proved proved;

  std::vector<std::string> texts() const {
    std::vector<std::string> all;
    for (const rephrase::Wording& wording : proved.wordings) all.push_back(wording.text);
    return all;
  }
  bool has(const std::string& text) const {
    const std::vector<std::string> all = texts();
    return std::find(all.begin(), all.end(), text) != all.end();
  }
  std::uint64_t refused(Refusal why) const { return proved.refused[why]; }
};

Made make(const std::string& more, const std::string& task = "red_on_tray",
          std::uint64_t seed = 0) {
  Made made{test::analyze_with_suite(more), {}};
  REQUIRE_MESSAGE(!made.analysis->diagnostics.has_errors(), made.analysis->said());
  REQUIRE(made.analysis->task(task).complete);
  made.proved = rephrase::Prover(made.analysis->model).prove(made.analysis->task(task), seed);
  const Proved& proved = made.proved;
  CHECK(proved.candidates ==
        proved.wordings.size() + proved.refused.total() + proved.same_words + proved.not_drawn);
  return made;
}

const std::string kPlace = "template place frame put \"place {the source} on {the target}\"\n";
using Texts = std::vector<std::string>;

}  // namespace

TEST_CASE(
    "every template of the action with every phrase that means the object alone is a wording") {
  const Made made = make(kPlace);
  CHECK(made.texts() == Texts{"put red thing on the tray", "put everybody's darling on the tray",
                              "put toy on the tray", "place the red block on the tray",
                              "place the red thing on the tray",
                              "place everybody's darling on the tray",
                              "place the toy on the tray"});
  CHECK(made.proved.candidates == 12);  // three templates, four ways to call the source
  CHECK(made.refused(Refusal::kFrame) == 4);
  CHECK(made.proved.same_words == 1);  // the instruction itself
}

TEST_CASE("a phrase that means a distractor, too, or perhaps, is refused there and nowhere else") {
  const std::string more = kPlace +
                           "task with_blue like red_on_tray { distractors blue }\n"
                           "task with_pale like red_on_tray { distractors pale }\n";
  const Made blue = make(more, "with_blue");
  CHECK_FALSE(blue.has("place the toy on the tray"));
  CHECK(blue.has("place the red thing on the tray"));
  CHECK(blue.refused(Refusal::kAmbiguous) == 4);  // `blue` is a toy and, being like `red`, loved
  const Made pale = make(more, "with_pale");
  CHECK_FALSE(pale.has("place the red thing on the tray"));
  CHECK(pale.has("place the toy on the tray"));
  CHECK(pale.refused(Refusal::kUnknown) == 2);  // nobody said which color it has
}

TEST_CASE("a phrase that says where things are is a wording where it is clear in every start") {
  // Two starts, `spread` before and behind the middle; the blue block stands aside at 0.
  const auto made = [](const char* middle, const char* spread) {
    return make(
        std::string(
            "relation ahead(a: object) \"first\" = all o in alike - {a}: x(a) < x(o) - 1cm\n"
            "object one like red {\n"
            "  phrase first spatial \"first toy\" means category toy and ahead\n}\n"
            "layout rows {\n  cells row = grid 2 x 1 at (") +
            middle + ", 0cm) spread (" + spread +
            ", 0cm)\n  place one in distinct row; place blue at (0cm, -15cm)\n"
            "  place tray at (0cm, 20cm); orient by rest; drop 10cm settle 0.5s\n}\n"
            "task t like base { layout rows; source one; target tray; distractors blue }\n",
        "t");
  };
  CHECK(made("-15cm", "5cm").has("put first toy on the tray"));
  const Made swapped = made("0cm", "20cm");
  CHECK_FALSE(swapped.has("put first toy on the tray"));
  CHECK(swapped.refused(Refusal::kNotMeant) > 0);
  // In its second start so near that settling may decide which is first.
  const Made near = made("-105.5mm", "94.5mm");
  CHECK_FALSE(near.has("put first toy on the tray"));
  CHECK(near.refused(Refusal::kUnknown) > 0);
}

TEST_CASE("a phrase that an object has from another one and that is not true of it is refused") {
  const Made made =
      make("task blue_on_tray like base { source blue; target tray }\n", "blue_on_tray");
  CHECK_FALSE(made.has("put red thing on the tray"));
  CHECK(made.refused(Refusal::kNotMeant) == 1);
}

TEST_CASE("words that name another object of the scene or a part of its name are refused") {
  const Made made = make(
      "object block like pale { name \"block\"; color blue }\n"
      "object red_twin like red { name \"red\"; phrase first appearance \"block\" means color red "
      "}\n"
      "task twin like base { source red_twin; target tray; distractors block }\n"
      "template place frame put \"place {the source} on {the target}\"\n",
      "twin");
  CHECK(made.refused(Refusal::kName) == 2);
  CHECK_FALSE(made.has("place the block on the tray"));
  CHECK(made.has("place the red on the tray"));
}

TEST_CASE("a phrase whose words name an object is refused, whether it is there or not") {
  const std::string objects =
      "object lemon like pale { name \"lemon\"; color blue }\n"
      "object juice like pale { name \"juice\"; color red\n"
      "  phrase pressed commonsense \"what is pressed from lemon\" means color red }\n"
      "task alone like base { source juice; target tray }\n"
      "task both like base { source juice; target tray; distractors lemon }\n";
  CHECK(make(objects, "alone").refused(Refusal::kAbsent) == 1);
  CHECK(make(objects, "both").refused(Refusal::kName) == 1);
}

TEST_CASE("a template that names other objects than the instruction is refused") {
  // With four ways to call the source each: `lift` names no target, `literal` one more object,
  // `gone` one that is not there.
  const Made made = make(R"(
template lift frame put "put {the source} up"
template literal frame put "put {the source} on {the target}, then the pale block"
template gone frame put "put {the source} on {the target}, then on the blue block"
task crowd like red_on_tray { distractors pale }
)",
                         "crowd");
  CHECK(made.refused(Refusal::kRoles) == 8);
  CHECK(made.refused(Refusal::kAbsent) == 4);
  // Beside another thing is another relation.
  CHECK(make("template beside frame put \"put {the source} on {the target} beside {the blue}\"\n")
            .refused(Refusal::kRelation) == 4);
}

TEST_CASE("what an instruction forbids stays forbidden, and nothing else becomes so") {
  const std::string more = R"(
task kept like red_on_tray { distractors blue; say "put {source} on {target}, not {avoid the blue}" }
template same frame put "place {the source} on {the target} and not on {avoid the blue}"
template instead frame put "place {the source}, not {avoid the blue}, on {the target}"
template other frame put "place {the source} on {the target}, not on {avoid the pale}"
)";
  const Made kept = make(more, "kept");
  CHECK(kept.has("place the red block on the tray and not on the blue block"));
  for (const std::string& text : kept.texts())
    CHECK_MESSAGE((text.find("not on the blue block") != text.npos ||
                   text.find(", not the blue block") == text.size() - 20),
                  text);
  CHECK_FALSE(kept.has("place the red block, not the blue block, on the tray"));
  CHECK(kept.refused(Refusal::kNegation) == 12);        // `put`, `instead`, `other`
  CHECK(make(more).refused(Refusal::kNegation) == 12);  // `same`, `instead`, `other`
}

TEST_CASE("the opposite in one frame is refused, and a category that the object is not of") {
  const Made made = make(R"(
template left frame put "with your left hand, put {source} on {target}"
template right frame put "with your right hand, put {source} on {target}"
template toys frame put "place {the source: toy} on {target}"
template dishes frame put "place {the source: dish} on {target}"
task by_left like red_on_tray { say left }
)",
                         "by_left");
  CHECK(made.refused(Refusal::kContradicts) == 4);
  CHECK(made.refused(Refusal::kCategory) == 4);
  CHECK(made.has("place the red block on tray"));
}

TEST_CASE("an explosion of wordings is drawn from by seed, the same each time") {
  std::string more = "object many like red {\n";
  for (int i = 0; i < 230; ++i)
    more += "  phrase p" + std::to_string(i) + " appearance \"thing " + std::to_string(i) +
            "\" means color red\n";
  more += "}\ntask explosion like base { source many; target tray }\n";
  for (int i = 0; i < 300; ++i)
    more += "template t" + std::to_string(i) + " frame put \"put {source} on {target} " +
            std::to_string(i) + " times\"\n";
  const Made made = make(more, "explosion");
  CHECK(made.proved.candidates > rephrase::kMostEnumerated);
  CHECK(made.proved.wordings.size() <= rephrase::kMostDrawn);
  CHECK(made.proved.wordings.size() > rephrase::kMostDrawn - 100);
  CHECK(made.proved.not_drawn > 50'000);
  CHECK(make(more, "explosion").texts() == made.texts());
  CHECK(make(more, "explosion", 1).texts() != made.texts());
}

TEST_CASE(
    "a template whose own words take back or go on is no rewording, whatever its frame says") {
  const Made made = make(
      "template never frame put \"don't put {the source} on {the target}\"\n"
      "template curly frame put \"don\u2019t put {the source} on {the target}\"\n"
      "template anywhere frame put \"put {the source} anywhere but on {the target}\"\n"
      "template play frame put \"pretend to put {the source} on {the target}\"\n"
      "template failing frame put \"fail to put {the source} on {the target}\"\n"
      "template nearly frame put \"almost put {the source} on {the target}\"\n"
      "template over frame put \"put {the source} upside down on {the target}\"\n"
      "template two frame put \"put two of {the source} on {the target}\"\n"
      "template away frame put \"put {the source} on {the target} and then throw it away\"\n" +
      kPlace);
  for (const std::string& text : made.texts()) {
    for (const char* word :
         {"don", "anywhere", "pretend", "throw", "fail", "almost", "upside", "two of"})
      CHECK_MESSAGE(text.find(word) == text.npos, text);
  }
  CHECK(!made.texts().empty());
  CHECK(made.refused(Refusal::kNegation) > 0);
}
