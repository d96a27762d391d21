#include <doctest/doctest.h>

#include <algorithm>

#include "tests/compiler/small_suite.h"

using namespace probe;

namespace {

// One set of one statement, asked of all tasks of a text without a suite.
std::unique_ptr<test::Analysis> ask(const std::string& statement, const std::string& more = "") {
  return test::analyze_with_suite(more + "\nquestions q {\n  " + statement + "\n}\n");
}

const sema::AskedQuestion* asked_of(const test::Analysis& a, std::string_view task) {
  for (const sema::AskedQuestion& question : a.model.asked) {
    if (a.model.tasks[question.task].name == task) return &question;
  }
  return nullptr;
}

std::string options_of(const test::Analysis& a, const sema::AskedQuestion& question) {
  std::vector<std::string> names;
  for (const sema::AskedOption& option : question.options)
    names.push_back(a.model.objects[option.object].name + (option.body ? "" : "?"));
  std::sort(names.begin(), names.end());
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
  return text;
}

plan::OmissionReason reason(const test::Analysis& a) {
  REQUIRE_FALSE(a.model.left_out.empty());
  return a.model.left_out.front().reason;
}

const std::string kPick =
    R"(choice pick "Told: \"{instruction}\". Which one?" answer source among objects)";

}  // namespace

TEST_CASE("a choice offers the scene's objects, and the right one is what the instruction tells") {
  const auto a = ask(kPick, "variant among_others of red_on_tray { distractors blue }");
  CHECK_MESSAGE(a->codes() == "", a->said());
  REQUIRE(a->model.asked.size() == 2);
  const auto* question = asked_of(*a, "red_on_tray");
  REQUIRE(question != nullptr);
  CHECK(question->text == "Told: \"put red block on the tray\". Which one?");
  CHECK(options_of(*a, *question) == "red tray");
  REQUIRE(question->right < 2);
  const sema::AskedOption& right = question->options[question->right];
  CHECK(a->model.objects[right.object].name == "red");
  CHECK(right.must_be_seen);
  CHECK_FALSE(question->options[1 - question->right].must_be_seen);
  CHECK(options_of(*a, *asked_of(*a, "among_others")) == "blue red tray");
}

TEST_CASE("an option is also called by its last word and by phrases, where they fit it alone") {
  const auto a = ask(kPick, "variant among_others of red_on_tray { distractors blue }");
  const auto words = [&](std::string_view task) {
    for (const sema::AskedOption& option : asked_of(*a, task)->options) {
      if (a->model.objects[option.object].name == "red") return option.words;
    }
    return std::vector<std::string>{};
  };
  CHECK(words("red_on_tray") ==
        std::vector<std::string>{"block", "red thing", "everybody's darling", "toy"});
  // The blue block is a block, a toy, and perhaps a favorite.
  CHECK(words("among_others") == std::vector<std::string>{"red thing"});
}

namespace {

// Two things that look and are called otherwise than what is in the small suite.
const std::string kMoreThings = R"(
object cup {
  mesh "cup"; box 2cm x 2cm x 2cm; density 500kg/m3; friction 0.5
  color blue; category dish; unseen; rest yaw 0deg; name "cup"
}
object fork like cup { mesh "fork"; name "fork" }
)";

}  // namespace

TEST_CASE(
    "absent options are in no scene, look otherwise, and no name or phrase of the task fits") {
  const std::string two = kPick + " and 2 absent";
  const auto a = ask(two, kMoreThings);
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(options_of(*a, *asked_of(*a, "red_on_tray")) == "cup? fork? red tray");
  // The other blocks are of one shape with the red one: fewer than two are left.
  CHECK(options_of(*ask(two), *asked_of(*ask(two), "red_on_tray")) == "red tray");
  // Whether a thing of unknown color is red cannot be said.
  const auto described = ask(two, kMoreThings + R"(
object plain { mesh "plain"; box 2cm x 2cm x 2cm; density 500kg/m3; friction 0.5; unseen; rest yaw 0deg; name "plain" }
task named like red_on_tray { refer source as by_color })");
  CHECK(options_of(*described, *asked_of(*described, "named")) == "cup? fork? red tray");
  const auto small =
      ask(two, kMoreThings + R"(object small like fork { mesh "small"; name "small tray" })");
  CHECK(options_of(*small, *asked_of(*small, "red_on_tray")) == "cup? fork? red tray");
}

TEST_CASE("another task or object shifts no draw of those that stay") {
  const auto order = [](const test::Analysis& a) {
    std::string names;
    for (const sema::AskedOption& option : asked_of(a, "red_on_tray")->options)
      names += a.model.objects[option.object].name + " ";
    return names;
  };
  CHECK(order(*ask(kPick)) ==
        order(*ask(kPick, "task first like base { source blue; target tray }")));
}

TEST_CASE("a yes or no is asked for each object of its pool") {
  const auto a = ask(
      R"(yesno there "Is there {a o} in the picture?" for o in objects and 1 absent answer present(o))",
      kMoreThings);
  CHECK_MESSAGE(a->codes() == "", a->said());
  REQUIRE(a->model.asked.size() == 3);
  CHECK(a->model.asked[0].text == "Is there a red block in the picture?");
  CHECK(a->model.asked[0].right == 1);
  CHECK(a->model.asked[0].options[0].must_be_seen);
  CHECK(a->model.asked[2].right == 0);
  CHECK_FALSE(a->model.asked[2].options[0].body.has_value());
  CHECK_FALSE(a->model.asked[2].options[0].must_be_seen);
}

TEST_CASE("a free answer speaks of all objects, and has to name two in their roles") {
  const auto a = ask(R"(free say "Told: \"{instruction}\". What?" answer mentions(source, target))",
                     "variant among_others of red_on_tray { distractors blue }");
  CHECK_MESSAGE(a->codes() == "", a->said());
  const auto* question = asked_of(*a, "among_others");
  REQUIRE(question != nullptr);
  CHECK(question->truth == plan::QuestionTruth::kMentions);
  CHECK(question->options.size() == 3);
  CHECK(question->a == 0);
  CHECK(question->b == 1);
  CHECK(question->right == plan::kNone);
}

TEST_CASE("points and sides are read off the picture") {
  const auto a = ask(R"(point where "Point at {the source}." answer source pixels 9
  yesno side "Is {the source} left of {the target}?" answer left(source, target)
  yesno near "Is {the target} nearer?" answer nearer(target, source))");
  CHECK_MESSAGE(a->codes() == "", a->said());
  REQUIRE(a->model.asked.size() == 3);
  CHECK(a->model.question_sets[sema::QuestionSetId{0}].families[0].pixels == 9);
  CHECK(a->model.question_sets[sema::QuestionSetId{0}].families[1].pixels == 64);
  CHECK(a->model.asked[0].truth == plan::QuestionTruth::kPixelsOf);
  CHECK(a->model.asked[1].truth == plan::QuestionTruth::kLeftOf);
  CHECK(a->model.asked[2].truth == plan::QuestionTruth::kNearerThan);
  CHECK(a->model.asked[2].options[a->model.asked[2].a].object == a->task("red_on_tray").target);
}

TEST_CASE("a number counts what has the same value of an attribute") {
  const std::string many =
      R"(number many "How many {category of source}s?" answer count(category of source))";
  const auto a = ask(many, "variant among_others of red_on_tray { distractors blue }");
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(asked_of(*a, "red_on_tray")->right == 1);
  CHECK(asked_of(*a, "among_others")->right == 2);
  CHECK(asked_of(*a, "among_others")->text == "How many toys?");
  // The pale block has no color: whether it is red cannot be said.
  const auto open = ask(R"(number many "How many?" answer count(color of source))",
                        "variant among_others of red_on_tray { distractors pale }");
  CHECK_MESSAGE(open->codes() == "P0901", open->said());
}

TEST_CASE("at the end, a metric of the task or any condition is judged") {
  const auto a = ask(R"(yesno done "Done?" at end answer success
  yesno high "Is it up?" at end answer height(source) > 1m)");
  CHECK_MESSAGE(a->codes() == "", a->said());
  REQUIRE(a->model.asked.size() == 2);
  CHECK(a->model.asked[0].truth == plan::QuestionTruth::kRecorded);
  REQUIRE(a->model.asked[0].judged.has_value());
  CHECK(a->model.asked[0].judged->name == "success");
  CHECK(a->model.asked[1].judged->name == "high");
  const auto late = ask(R"(yesno done "Done?" at end answer success)",
                        "variant soon of red_on_tray { set success = once (height(source) > 1m) }");
  REQUIRE(late->model.left_out.size() == 1);
  CHECK(reason(*late) == plan::OmissionReason::kNoSuchMetric);
}

TEST_CASE("at the start, any condition is judged where things have come to rest") {
  const auto a = ask(R"(yesno high "Is it up?" answer height(source) > 1m)");
  CHECK_MESSAGE(a->codes() == "", a->said());
  REQUIRE(a->model.asked.size() == 1);
  CHECK(a->model.asked[0].truth == plan::QuestionTruth::kSettled);
  CHECK(a->model.asked[0].judged->name == "high");
  CHECK(ask(R"(yesno it "Is it?" answer source)")->said().find("`present(source)`") !=
        std::string::npos);
  // What is read behind the last step is not known there.
  const auto early = ask(R"(yesno done "Done?" answer success)");
  CHECK_MESSAGE(early->codes() == "P0904", early->said());
  CHECK(early->said().find("`success` is no condition of the start") != std::string::npos);
}

TEST_CASE("a question whether something is open is not answered by whether it is closed") {
  const std::string shut = "predicate closed(o: object) = height(o) < 1m\n";
  const auto asked = [&](const char* words) {
    return ask("yesno shut \"" + std::string(words) + "\" answer closed(target)", shut)->codes();
  };
  CHECK(asked("Is {the target} closed?") == "");
  CHECK(asked("Is {the target} open or closed?") == "P0904");
  CHECK(asked("Is {the target} open?") == "P0904");
  CHECK(asked("Is {the target} not closed?") == "P0904");
  CHECK(asked("Is {the target} closed or not?") == "");
}

TEST_CASE("what looks as the one that is asked about, whatever it is called, leaves it open") {
  const std::string copy =
      "object toy like red { name \"toy\" }\n"
      "variant among_copies of red_on_tray { distractors toy }\n";
  for (const std::string& statement :
       {kPick, std::string(R"(point where "Point at {the source}." answer source)"),
        std::string(
            R"(yesno left "Is {the source} left of {the target}?" answer left(source, target))")}) {
    CAPTURE(statement);
    const auto a = ask(statement, copy);
    CHECK(a->said().find("`toy` looks as `red` does: \"red block\" may be either") !=
          std::string::npos);
    CHECK(asked_of(*a, "among_copies") == nullptr);
    CHECK(asked_of(*a, "red_on_tray") != nullptr);
  }
}

TEST_CASE("what does not fit a task is left out of it, with the reason") {
  using plan::OmissionReason;
  const auto why = [](const std::string& statement, const std::string& more = "") {
    return reason(*ask(statement, more));
  };
  CHECK(why(R"(choice x "{instruction}" answer avoided among objects)") ==
        OmissionReason::kNothingToAvoid);
  CHECK(why(R"(choice x "Which is {phrase of source}?" answer source among objects)") ==
        OmissionReason::kPhraseIsName);
  CHECK(why(R"(choice x "{instruction} {category of source} tray?" answer target among objects)") ==
        OmissionReason::kShowsAnswer);
  CHECK(why(R"(point x "Where is it?" answer pale)") == OmissionReason::kNoMember);
  CHECK(why(kPick + " where has distractors") == OmissionReason::kCondition);
  const std::string away =
      R"(task away like red_on_tray { say "keep {source} from {avoid target}" })";
  const std::string to = R"(choice x "{instruction}" answer target among objects)";
  CHECK(why(to, away) == OmissionReason::kAvoidsIt);
  const std::string lift = R"(task up like red_on_tray { say "lift {source}" })";
  CHECK(why(to, lift) == OmissionReason::kNotTold);
  CHECK(why(R"(choice x "{color of target}" answer target among objects)",
            "task fair like red_on_tray { target pale }") == OmissionReason::kNotKnown);
}

TEST_CASE("a question that is asked nowhere is a warning, but in a library") {
  const auto a = ask(R"(choice x "{instruction}" answer avoided among objects)");
  CHECK_MESSAGE(a->codes() == "P0903", a->said());
  CHECK(a->said().find("nothing to leave alone") != std::string::npos);
}

TEST_CASE("more than one right answer is an error, or left out where that is allowed") {
  const std::string twins = R"(object other like red { name "other red block" }
@allow(shared_name, "test")
task two like red_on_tray { distractors other }
)";
  const std::string point = R"(point where "Point at {the source}." answer source)";
  const auto a = ask(point, twins);
  CHECK_MESSAGE(a->codes() == "P0901", a->said());
  const auto allowed = test::analyze_with_suite(
      twins + "@allow(ambiguous, \"test\")\nquestions q {\n" + point + "\n}\n");
  CHECK_MESSAGE(allowed->codes() == "", allowed->said());
  REQUIRE(allowed->model.left_out.size() == 1);
  CHECK(reason(*allowed) == plan::OmissionReason::kAmbiguous);
  const auto same = ask(kPick, R"(object other like red { mesh "tray"; paint red }
object third like blue { mesh "tray"; color gray; paint gray; name "red block" }
task two like base { source tray; target blue; distractors red, third })");
  CHECK_MESSAGE(same->codes() == "P0902", same->said());
}

TEST_CASE("names that stand for nothing, and doubled names, are said once") {
  CHECK(ask(R"(point x "Point at {the sorce}." answer source)")->codes() == "P0201");
  CHECK(ask(R"(yesno x "Done?" at end answer sucess)")->codes() == "P0201");
  CHECK(ask(R"(number x "How many?" answer count(colour of source))")->codes() == "P0201");
  CHECK(ask(kPick + "\n" + kPick)->codes() == "P0203");
  CHECK(ask(R"(yesno x "Which?" answer left(source, source))")->codes() == "P0203");
  CHECK(ask(R"(choice x "Which one is it?" answer source among objects)")->codes() == "P0904");
  CHECK(ask(R"(yesno x "There?" for o in objects at end answer present(o))")->codes() == "P0904");
  for (
      const char* turned :
      {R"(yesno x "Is {the source} absent?" answer present(source))",
       R"(yesno x "Is {the source} missing in the picture?" answer present(source))",
       R"(yesno x "Is there not {a source}?" answer present(source))",
       R"(yesno x "Is {the source} farther away than {the target}?" answer nearer(source, target))",
       R"(yesno x "Is {the source} behind {the target}?" answer nearer(source, target))",
       R"(yesno x "Told: \"{instruction}\". Has it failed?" at end answer success)",
       R"(choice x "Told: \"{instruction}\". Which must it not touch?" answer source among objects)",
       R"(choice x "Told: \"{instruction}\". Where must it go?" answer source among objects)",
       R"(point x "Point at {the target}." answer source)"}) {
    CAPTURE(turned);
    CHECK(ask(turned)->codes() == "P0904");
  }
  for (const char* straight :
       {R"(yesno x "Is {the source} there or not?" answer present(source))",
        R"(yesno x "Is {the source} behind {the target}?" answer nearer(target, source))",
        R"(yesno x "Told: \"{instruction}\". Has it done so?" at end answer success)",
        R"(choice x "Told: \"{instruction}\". Where must it put it?" answer target among objects)",
        R"(point x "Point to where {the source} is." answer source)"}) {
    CAPTURE(straight);
    CHECK(ask(straight)->codes() == "");
  }
  CHECK(ask(kPick + " pixels 0")->codes() == "P0304");
  CHECK(ask(R"(free x "" answer mentions(source, target))")->codes() == "P0406");
  CHECK(test::analyze_with_suite("questions q { }")->codes() == "P0206");
}

TEST_CASE("a suite says which sets its tasks are asked, and another is asked of none") {
  const std::string sets = "questions p {\n" + kPick + "\n}\nquestions q {\n" + kPick + "\n}\n";
  const auto a = test::analyze_with_suite(
      sets +
      "task more like base { source blue; target tray }\n"
      "suite one trained on lab { tasks { red_on_tray }; seeds 1; questions p }");
  CHECK_MESSAGE(a->codes() == "", a->said());
  REQUIRE(a->model.asked.size() == 1);
  CHECK(a->model.tasks[a->model.asked[0].task].name == "red_on_tray");
  const auto unknown = test::analyze_with_suite(
      sets + "suite one trained on lab { tasks tasks; seeds 1; questions p, r }");
  CHECK_MESSAGE(unknown->codes() == "P0201", unknown->said());
}

TEST_CASE("a text without questions has nothing to ask") {
  CHECK(test::analyze_with_suite("")->model.asked.empty());
  CHECK(test::analyze_with_suite("")->model.left_out.empty());
}

TEST_CASE("a phrase that says where things are is asked for where it is clear in every start") {
  const auto asked = [](const char* red, const char* blue) {
    const auto a = test::analyze_with_suite(
        std::string(
            "relation ahead(a: object) \"first\" = all o in alike - {a}: x(a) < x(o) - 1cm\n"
            "object one like red { phrase first spatial \"first toy\" means category toy and ahead "
            "}\n"
            "layout row { place one at (") +
        red + ", 0cm); place blue at (" + blue +
        ", 0cm); place tray at (0cm, 20cm)\norient by rest; drop 10cm settle 0.5s }\n"
        "task t like base { layout row; source one; target tray; distractors blue; refer source as "
        "first }\n"
        "questions q { choice which \"Which one is the {phrase of source}?\" answer source among "
        "objects }\n"
        "suite s { tasks { t }; seeds 1; questions q }\n");
    return a->model.asked.size();
  };
  CHECK(asked("-20cm", "20cm") == 1);
  CHECK(asked("20cm", "-20cm") == 0);
}
