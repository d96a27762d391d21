#include "runtime/plan/questions.h"

#include <doctest/doctest.h>

#include "runtime/plan/ids.h"
#include "runtime/plan/plan.h"
#include "tests/plan/question_defects.h"

using namespace probe;
using namespace probe::plan;

namespace {

Failure failure_of(const Defect& defect) {
  Writer w = question_writer();
  std::ranges::reverse(w.records.spans);
  w.fill_ids();
  defect.make(w.records, w);
  const Status status = verify(w.lay_out());
  return status.ok() ? Failure{} : status.failure();
}

Sha256 first_id(const std::function<void(Records&, Writer&)>& change = {}) {
  Writer w = question_writer();
  if (change) change(w.records, w);
  return question_id(w.records.tables(), w.records.questions[0]);
}

}  // namespace

TEST_CASE("a plan with a question of each form is one that the verifier takes") {
  Writer w = question_writer();
  const auto bytes = w.finish();
  REQUIRE_MESSAGE(bytes.ok(), to_text(bytes.failure()));
  const auto plan = Plan::from_bytes(*bytes);
  REQUIRE(plan.ok());
  CHECK(plan->families().size() == 7);
  CHECK(plan->questions().size() == 7);
  CHECK(plan->options().size() == 14);
  CHECK(plan->words().size() == 7);
  CHECK(plan->omissions().size() == 2);
  CHECK(plan->text(plan->families()[1].name) == "left");
}

TEST_CASE("each defect of questions is refused where it is") {
  for (const Defect& defect : question_defects()) {
    const Failure failure = failure_of(defect);
    CAPTURE(defect.rule);
    CHECK(failure.where.find(defect.section) != std::string::npos);
    CHECK_MESSAGE(failure.message.find(defect.rule) != std::string::npos, failure.message);
  }
}

TEST_CASE("what is judged is judged at its own moment") {
  const auto refused = [](QuestionTruth truth, QuestionMoment moment) {
    Writer w = question_writer();
    std::ranges::reverse(w.records.spans);
    w.records.questions[5].truth = static_cast<std::uint32_t>(truth);
    w.records.families[5].moment = static_cast<std::uint32_t>(moment);
    w.fill_ids();
    const Status status = verify(w.lay_out());
    return status.ok() ? std::string() : status.failure().message;
  };
  CHECK(refused(QuestionTruth::kRecorded, QuestionMoment::kEnd).empty());
  CHECK(refused(QuestionTruth::kSettled, QuestionMoment::kStart).empty());
  CHECK(refused(QuestionTruth::kSettled, QuestionMoment::kEnd).ends_with("[question-form]"));
  CHECK(refused(QuestionTruth::kRecorded, QuestionMoment::kStart).ends_with("[question-form]"));
}

TEST_CASE("a question's id is what is asked and what is right, not what it is called") {
  const Sha256 id = first_id();
  CHECK(id == first_id([](Records& r, Writer& w) { r.families[0].name = w.text("other"); }));
  CHECK(id == first_id([](Records& r, Writer& w) { r.families[0].set = w.text("other"); }));
  CHECK(id == first_id([](Records& r, Writer&) { r.questions[0].task = 1; }));
  CHECK(id != first_id([](Records& r, Writer& w) { r.questions[0].text = w.text("Other?"); }));
  CHECK(id != first_id([](Records& r, Writer&) { r.questions[0].right = 1; }));
  CHECK(id != first_id([](Records& r, Writer& w) { r.options[2].text = w.text("fork"); }));
  CHECK(id != first_id([](Records& r, Writer& w) { r.words[0] = w.text("red thing"); }));
  CHECK(id != first_id([](Records& r, Writer&) { r.families[0].pixels = 65; }));
}

TEST_CASE("questions leave root and ids of a plan without them as they were") {
  const auto without = Plan::from_bytes(small_plan());
  const auto with = Plan::from_bytes(question_plan());
  REQUIRE(without.ok());
  REQUIRE(with.ok());
  CHECK(without->families().empty());
  for (std::size_t i = 0; i < without->episodes().size(); ++i)
    CHECK(without->episodes()[i].episode_id == with->episodes()[i].episode_id);
  CHECK(without->root() != with->root());
}
