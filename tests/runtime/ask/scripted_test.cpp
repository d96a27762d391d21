// Whole calls of `ask` at the server of tests/servers/chat_server.py: what its scripted models get
// to the last count, and what each of its faults leaves in a row.
#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "runtime/ask/answers.h"
#include "runtime/ask/ask.h"
#include "runtime/ask/score.h"
#include "runtime/base/json.h"
#include "tests/runtime/ask/asking_plan.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/servers/python_server.h"

namespace probe::ask {
namespace {

using run::TemporaryFolder;
using test::PythonServer;

constexpr std::uint32_t kStarts = 4;
const std::string kPlain = "put carrot on plate";
const std::string kRabbit = "put rabbit's favorite vegetable on the plate";

// source (three options, the first is right), there (no), many (1), restate, and `left`, whose
// right answer the picture tells.
plan::Plan told(const std::string& instruction) {
  return asking_plan(kStarts, [&](plan::Writer& writer) {
    using enum plan::QuestionForm;
    using plan::QuestionTruth;
    writer.records.tasks[0].prompt = writer.text(instruction);
    QuestionWriter q(writer);
    const WrittenOption carrot{"carrot", 0, true}, plate{"plate", 1, true}, towel{"towel"};
    const std::string says = "A robot is told: \"" + instruction + "\". ";
    // An object's words, for each question's options.
    const auto describe = [&](plan::QuestionRecord& question) {
      const std::vector<plan::StringRef> words = {writer.text("rabbit's favorite vegetable")};
      plan::OptionRecord& option = writer.records.options[question.options.first];
      option.words = plan::append<plan::StringRef>(writer.records.words, words);
    };
    q.family("source", kChoice);
    auto& source = q.question(says + "Which object must it pick up?", QuestionTruth::kProved,
                              {carrot, plate, towel});
    source.right = 0;
    describe(source);
    q.family("there", kYesNo);
    q.question("Is there a towel on the table?", QuestionTruth::kProved, {towel}).right = 0;
    q.family("many", kNumber);
    q.question("How many carrots are in the picture?", QuestionTruth::kProved, {carrot}).right = 1;
    q.family("restate", kFree);
    auto& restate = q.question(says + "Say in one short sentence what it has to do.",
                               QuestionTruth::kMentions, {carrot, plate});
    restate.a = 0;
    restate.b = 1;
    describe(restate);
  });
}

AskOptions options_for(const std::string& model, const std::string& out) {
  AskOptions options;
  options.model = model;
  options.out = out;
  options.assets = std::string(VLAPROBE_SOURCE_DIR) + "/assets";
  options.jobs = 4;
  options.retries = 1;
  options.give_up_after = 0;
  return options;
}

std::vector<AnswerRow> asked_rows(const plan::Plan& plan, const AskOptions& options) {
  const auto summary = ask::ask(plan, options);
  REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
  auto rows = read_answers(options.out);
  REQUIRE_MESSAGE(rows.ok(), to_text(rows.failure()));
  return *rows;
}

std::vector<AnswerRow> asked_rows(const plan::Plan& plan, const PythonServer& server,
                                  const std::string& model, const std::string& out,
                                  const std::vector<Arm>& arms = {Arm::kPicture}) {
  REQUIRE(!server.port().empty());
  AskOptions options = options_for("openai://127.0.0.1:" + server.port() + "?model=" + model, out);
  options.choice.arms = arms;
  return asked_rows(plan, options);
}

std::map<std::string, ArmScore> scores_of(const plan::Plan& plan, std::vector<AnswerRow> rows,
                                          Arm arm = Arm::kPicture) {
  Tally tally(plan);
  for (const AnswerRow& row : rows) REQUIRE(tally.add(row).ok());
  std::map<std::string, ArmScore> scores;
  for (const ScoreRow& row : score(plan, tally.asked()))
    scores[std::string(plan.text(plan.families()[row.family].name))] = *row.of(arm);
  return scores;
}

// "2/4 plain 3/4 unclear 1": circular and plain, and what was not read, where any was not.
std::string in_short(const ArmScore& arm) {
  std::ostringstream text;
  text << arm.circular.count.k << "/" << arm.circular.count.n << " plain " << arm.plain.count.k
       << "/" << arm.plain.count.n;
  if (arm.unclear > 0) text << " unclear " << arm.unclear;
  if (arm.refused > 0) text << " refused " << arm.refused;
  if (arm.empty > 0) text << " empty " << arm.empty;
  if (arm.invalid > 0) text << " invalid " << arm.invalid;
  return text.str();
}

// What `truth` says to each question, for the server's side door: the pictures' hashes are those
// that another model was sent.
void write_side_door(const std::string& path, const std::vector<AnswerRow>& sent,
                     const std::vector<AnswerRow>& truth) {
  std::map<std::pair<std::string, std::string>, std::string> says;  // by start and words
  for (const AnswerRow& row : truth) says[{row.start_id, row.text}] = row.raw;
  std::ofstream file(path, std::ios::binary);
  for (const AnswerRow& row : sent) {
    REQUIRE(!row.image_sha256.empty());
    const Json line = {{"image", row.image_sha256},
                       {"text", row.text},
                       {"answer", says.at({row.start_id, row.text})}};
    file << line.dump() << "\n";
  }
}

}  // namespace

TEST_CASE("the scripted models get what they must, to the last count") {
  TemporaryFolder folder;
  const plan::Plan plan = told(kRabbit);
  const PythonServer a("chat_server.py", {"always_a"});
  const auto always = asked_rows(plan, a, "always_a", folder / "a");
  auto scores = scores_of(plan, always);
  CHECK(always.size() == kStarts * (3 + 1 + 1 + 1));
  // The right letter is A at rotation 0 alone, which is the plain one of starts 0 and 3.
  CHECK(in_short(scores["source"]) == "0/4 plain 2/4");
  CHECK(in_short(scores["there"]) == "0/4 plain 0/4 unclear 4");
  CHECK(in_short(scores["many"]) == "0/4 plain 0/4 unclear 4");
  CHECK(in_short(scores["restate"]) == "0/4 plain 0/4");
  CHECK(scores["restate"].copies == 0);
  CHECK(scores["source"].right_letters == std::vector<std::int64_t>{2, 1, 1});
  CHECK(scores["source"].given_letters == std::vector<std::int64_t>{4, 0, 0});

  // The ceiling, and the floor that the counts above must equal.
  const auto truth = asked_rows(plan, options_for("truth", folder / "truth"));
  for (const auto& entry : scores_of(plan, truth)) {
    CAPTURE(entry.first);
    CHECK(in_short(entry.second) == "4/4 plain 4/4");
  }
  scores = scores_of(plan, asked_rows(plan, options_for("first", folder / "first")));
  CHECK(in_short(scores["source"]) == "0/4 plain 2/4");
  CHECK(in_short(scores["there"]) == "0/4 plain 0/4");

  write_side_door(folder / "truth.jsonl", always, truth);
  const PythonServer knows("chat_server.py", {"oracle", "truth=" + (folder / "truth.jsonl")});
  scores = scores_of(plan, asked_rows(plan, knows, "oracle", folder / "oracle"));
  for (const char* family : {"source", "there", "many", "restate"}) {
    CAPTURE(family);
    CHECK(in_short(scores[family]) == "4/4 plain 4/4");
    // Wilson's 4 of 4: the starts lie in four places.
    CHECK(scores[family].circular.interval.low == doctest::Approx(0.5101).epsilon(0.001));
    CHECK(scores[family].circular.interval.high == doctest::Approx(1));
  }
  CHECK(*scores["restate"].copied == doctest::Approx(0.25));
}

TEST_CASE("who copies the instruction is right only where it has the plain names") {
  TemporaryFolder folder;
  const PythonServer server("chat_server.py", {"copycat"});
  const plan::Plan rabbit = told(kRabbit), plain = told(kPlain);
  auto scores = scores_of(rabbit, asked_rows(rabbit, server, "copycat", folder / "rabbit"));
  CHECK(in_short(scores["restate"]) == "0/4 plain 0/4");
  CHECK(scores["restate"].copies == 4);
  CHECK(*scores["restate"].copied == 1);
  // The phrase and the plate: two options.
  CHECK(in_short(scores["source"]) == "0/4 plain 0/4 unclear 12");
  CHECK(in_short(scores["there"]) == "0/4 plain 0/4 unclear 4");
  CHECK(in_short(scores["many"]) == "0/4 plain 0/4 unclear 4");

  const auto rows = asked_rows(plain, server, "copycat", folder / "plain");
  scores = scores_of(plain, rows);
  CHECK(in_short(scores["restate"]) == "4/4 plain 4/4");
  CHECK(scores["restate"].copies == 0);
  CHECK(*scores["restate"].copied == 1);
}

TEST_CASE("who answers by the words alone gets the same with and without the picture") {
  TemporaryFolder folder;
  const plan::Plan plan = told(kRabbit);
  const PythonServer server("chat_server.py", {"words_only"});
  const auto rows = asked_rows(plan, server, "words_only", folder / "words",
                               {Arm::kPicture, Arm::kBlind, Arm::kPrior});
  CHECK(rows.size() == 3 * kStarts * 6);
  std::map<std::string, std::string> said;
  for (const AnswerRow& row : rows) {
    CHECK(row.image_sha256.empty() == (row.arm == Arm::kBlind));
    const std::string key = row.question_id + row.start_id + std::to_string(row.rotation);
    CHECK(said.try_emplace(key, row.raw).first->second == row.raw);
  }
  auto with = scores_of(plan, rows);
  for (const Arm arm : {Arm::kBlind, Arm::kPrior}) {
    auto without = scores_of(plan, rows, arm);
    for (const char* family : {"source", "there", "many", "restate"}) {
      CAPTURE(family);
      CHECK(in_short(without[family]) == in_short(with[family]));
    }
  }
  // A start has no part in the words, so that all starts are answered alike.
  for (const char* family : {"source", "there", "many"}) {
    CAPTURE(family);
    CHECK(with[family].circular.count.k % kStarts == 0);
    CHECK(with[family].unclear == 0);
  }
}

TEST_CASE("letters are scored by their probabilities where the server offers them") {
  TemporaryFolder folder;
  const plan::Plan plan = told(kPlain);
  const PythonServer server("chat_server.py", {"always_a", "logprobs=1"});
  auto scores = scores_of(plan, asked_rows(plan, server, "always_a", folder / "a"));
  REQUIRE(scores["source"].likely_plain);
  CHECK(scores["source"].likely_plain->count.k == 2);
  CHECK(scores["source"].likely_plain->count.n == 4);
  CHECK(scores["source"].likely_circular->count.k == 0);
  CHECK_FALSE(scores["there"].likely_plain);
}

TEST_CASE("each fault of a server is told in the row, and counts neither way or as not right") {
  struct Fault {
    std::string name;
    std::vector<std::string> more;  // of the server
    std::string invalid;            // a part of it; empty: the row is valid
    std::string verdict;
    int attempts = 1;
  };
  const std::vector<Fault> faults = {
      {"error", {}, "HTTP status 500: CUDA out of memory", "", 2},
      {"error", {"first=1"}, "", "read", 2},
      {"busy", {"first=2"}, "", "read", 3},
      {"closes", {}, "closed", "", 2},
      {"cut", {}, "closed", "", 2},
      {"text", {}, "the answer is no JSON object: the model is thinking", "", 2},
      {"shape", {}, "the answer has no `choices`", "", 2},
      {"other_model", {}, "the answer is of model `other`, not of `always_a`", "", 1},
      {"stream", {}, "streams its answer", "", 1},
      {"huge", {}, "more than", "", 1},
      {"null", {}, "", "empty", 1},
      {"thinks", {}, "", "empty", 1},
      {"unclosed", {}, "", "empty", 1},
      {"refusal", {}, "", "refused", 1},
      {"reasoning", {}, "", "read", 1},
      {"think_tags", {}, "", "read", 1},
      {"markup", {}, "", "read", 1},
  };
  const plan::Plan plan = asking_plan(1);
  for (const Fault& fault : faults) {
    CAPTURE(fault.name);
    TemporaryFolder folder;
    std::vector<std::string> words = {"always_a", "fault=" + fault.name, "on=Which object"};
    words.insert(words.end(), fault.more.begin(), fault.more.end());
    const PythonServer server("chat_server.py", words);
    AskOptions options =
        options_for("openai://127.0.0.1:" + server.port() + "?model=always_a", folder / "answers");
    options.choice.questions = {"understanding.source"};
    const auto rows = asked_rows(plan, options);
    REQUIRE(rows.size() == 3);
    for (const AnswerRow& row : rows) {
      CHECK(row.attempts == fault.attempts);
      CHECK(row.invalid.has_value() == !fault.invalid.empty());
      CHECK(row.right.has_value() == fault.invalid.empty());
      const std::string invalid = row.invalid.value_or("");
      CHECK_MESSAGE(invalid.find(fault.invalid) != std::string::npos, invalid);
      if (!row.invalid) CHECK(word_of(row.reading.verdict) == fault.verdict);
    }
    const ArmScore arm = scores_of(plan, rows).at("source");
    if (fault.invalid.empty()) {
      CHECK(arm.circular.count.n == 1);
      CHECK(arm.plain.count.k == (fault.verdict == "read" ? 1 : 0));
    } else {
      CHECK(arm.invalid == 3);
      CHECK(arm.plain.count.n == 0);
    }
    if (fault.name == "reasoning") CHECK(rows[0].reasoning == "A? B? C?");
    if (fault.name == "thinks") CHECK(rows[0].reasoning == "A");
    if (fault.name == "markup") CHECK(rows[0].raw.find("<script>") != std::string::npos);
  }
}

TEST_CASE("a server that is too slow is waited for as long as was said, and no longer") {
  TemporaryFolder folder;
  const plan::Plan plan = asking_plan(1);
  const PythonServer server("chat_server.py", {"always_a", "fault=slow", "on=Which object"});
  AskOptions options =
      options_for("openai://127.0.0.1:" + server.port() + "?model=always_a&timeout.answer_s=1",
                  folder / "answers");
  options.choice.questions = {"understanding.source"};
  options.retries = 0;
  for (const AnswerRow& row : asked_rows(plan, options)) {
    REQUIRE(row.invalid);
    CHECK_MESSAGE(row.invalid->find("no answer") != std::string::npos, *row.invalid);
  }
}

TEST_CASE("a server that takes no pictures is refused before anything is asked") {
  TemporaryFolder folder;
  const plan::Plan plan = asking_plan(1);
  const PythonServer server("chat_server.py", {"always_a", "fault=no_vision"});
  const AskOptions options =
      options_for("openai://127.0.0.1:" + server.port() + "?model=always_a", folder / "answers");
  const auto asked = ask::ask(plan, options);
  REQUIRE_FALSE(asked.ok());
  CHECK(asked.failure().message.find("is no model that sees") != std::string::npos);
  CHECK(asked.failure().message.find("not a multimodal model") != std::string::npos);
}

TEST_CASE("a key is sent from the environment alone and stands in no row") {
  TemporaryFolder folder;
  const plan::Plan plan = asking_plan(1);
  const PythonServer server("chat_server.py", {"always_a", "key=s3cret-of-the-test"});
  const AskOptions options =
      options_for("openai://127.0.0.1:" + server.port() + "?model=always_a", folder / "answers");
  const auto without = ask::ask(plan, options);
  REQUIRE_FALSE(without.ok());
  CHECK(without.failure().message.find("401") != std::string::npos);
  ::setenv("VLAPROBE_API_KEY", "s3cret-of-the-test", 1);
  const auto rows = asked_rows(plan, options);
  ::unsetenv("VLAPROBE_API_KEY");
  CHECK(rows.size() > 3);
  std::ifstream file((folder / "answers") + "/answers.sqlite", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  CHECK(bytes.size() > 1000);
  CHECK(bytes.find("s3cret") == std::string::npos);
}

}  // namespace probe::ask
