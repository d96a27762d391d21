// Asking a server of the chat interface, which behaves well or badly.
#include "runtime/ask/chat.h"

#include <doctest/doctest.h>

#include <chrono>
#include <cstdlib>
#include <map>

#include "runtime/ask/answers.h"
#include "runtime/ask/ask.h"
#include "runtime/ask/chat_message.h"
#include "runtime/store/database.h"
#include "tests/runtime/ask/asking_plan.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/servers/python_server.h"

namespace probe::ask {
namespace {

using run::TemporaryFolder;
using test::PythonServer;

std::string address_of(const PythonServer& server, const std::string& model,
                       const std::string& options = "") {
  REQUIRE_MESSAGE(!server.port().empty(), "Debian's packages of .ci/packages.txt are installed");
  return "openai://127.0.0.1:" + server.port() + "?model=" + model + "&timeout.wait_s=1" + options;
}

AskOptions asking_at(const std::string& address, const std::string& out) {
  AskOptions options;
  options.model = address;
  options.out = out;
  options.assets = std::string(VLAPROBE_SOURCE_DIR) + "/assets";
  options.choice.questions = {"understanding.source"};
  options.retries = 1;
  return options;
}

std::vector<AnswerRow> answers_in(const std::string& dir) {
  auto rows = read_answers(dir);
  REQUIRE_MESSAGE(rows.ok(), to_text(rows.failure()));
  return *rows;
}

TEST_CASE("an answer that holds the key is kept nowhere; a short key is a word as any") {
  const std::string body =
      R"({"model": "m", "choices": [{"message": {"content": "A, Bearer s3cret-of-the-test"}}]})";
  ChatTerms terms;
  terms.model = "m";
  const auto read_with = [&](const char* key) {
    ::setenv("VLAPROBE_API_KEY", key, 1);
    auto said = read_chat_answer(terms, body, "application/json", 2);
    ::unsetenv("VLAPROBE_API_KEY");
    return said;
  };
  const auto refused = read_with("s3cret-of-the-test");
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().code == Fault::kAnswered);
  CHECK(to_text(refused.failure()).find("s3cret") == std::string::npos);
  CHECK(read_with("A").ok());
  CHECK(read_with("").ok());
}

TEST_CASE("a model that always says A is right in one order of three, and keeps what was sent") {
  const TemporaryFolder folder;
  const PythonServer server("chat_server.py", {"always_a", "logprobs=1"});
  const plan::Plan plan = asking_plan(2);
  AskOptions options = asking_at(address_of(server, "always_a", "&size=224x168"), folder / "a");
  options.choice.arms = {Arm::kPicture, Arm::kBlind};
  options.jobs = 3;
  const auto summary = ask::ask(plan, options);
  REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
  CHECK(summary->total == 2 * 3 * 2);
  CHECK(summary->right == 4);
  CHECK(summary->call.proof.is_blind);
  CHECK(summary->call.proof.is_deaf);
  CHECK(summary->call.proof.has_logprobs);
  REQUIRE(summary->notes.size() >= 2);
  CHECK(summary->notes[0].starts_with("the model gave one answer, bit for bit, to one question"));
  for (const AnswerRow& row : answers_in(folder / "a")) {
    CHECK(row.model == "always_a");
    CHECK(row.raw == "A");
    CHECK(row.right == (row.rotation == 0));
    CHECK(row.image_sha256.size() == (row.arm == Arm::kPicture ? 64 : 0));
    CHECK(row.request_sha256.size() == 64);
    REQUIRE(row.usage.letter_logprobs.size() == 3);
    CHECK(row.usage.letter_logprobs[0] == doctest::Approx(-0.4));
    CHECK(row.usage.fingerprint == "scripted-1");
  }
  // Its server may move: what was asked is the same.
  const PythonServer other("chat_server.py", {"always_a"});
  options.model = address_of(other, "always_a", "&size=224x168");
  const auto again = ask::ask(plan, options);
  REQUIRE_MESSAGE(again.ok(), to_text(again.failure()));
  CHECK(again->done == 0);
  options.model = address_of(other, "always_a", "&size=112x84");
  const auto smaller = ask::ask(plan, options);
  REQUIRE(!smaller.ok());
  CHECK(smaller.failure().message.starts_with("was begun by asking in another way"));
}

TEST_CASE("a server that asks for time gets it, and the answer counts its attempts") {
  const TemporaryFolder folder;
  const PythonServer server("chat_server.py",
                            {"always_a", "fault=busy", "first=2", "on=Which object must"});
  const plan::Plan plan = asking_plan(1);
  AskOptions options = asking_at(address_of(server, "always_a"), folder / "answers");
  options.retries = 0;
  const auto summary = ask::ask(plan, options);
  REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
  CHECK(summary->invalid == 0);
  for (const AnswerRow& row : answers_in(folder / "answers")) CHECK(row.attempts == 3);
}

TEST_CASE("the prior arm shows the picture of another start, and the row says which") {
  const TemporaryFolder folder;
  const PythonServer server("chat_server.py", {"always_a"});
  const plan::Plan plan = asking_plan(3);
  AskOptions options = asking_at(address_of(server, "always_a", "&size=64x48"), folder / "answers");
  options.choice.arms = {Arm::kPicture, Arm::kPrior};
  const auto summary = ask::ask(plan, options);
  REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
  std::map<std::string, std::string> pictures;  // by start
  const auto rows = answers_in(folder / "answers");
  CHECK(rows.size() == 3 * 3 * 2);
  for (const AnswerRow& row : rows) {
    if (row.arm == Arm::kPicture) pictures[row.start_id] = row.image_sha256;
  }
  for (const AnswerRow& row : rows) {
    if (row.arm != Arm::kPrior) continue;
    CHECK(row.shown_start_id != row.start_id);
    CHECK(row.image_sha256 == pictures[row.shown_start_id]);
    CHECK(row.shown_has_answer == true);  // the plan has one task alone
  }
  // What the plan does not bear counts neither way.
  auto database = store::Database::open(folder / "answers" + "/answers.sqlite",
                                        store::Database::Access::kWrite);
  REQUIRE(database.ok());
  REQUIRE(database->execute("update answers set shown_has_answer = 0 where arm = 'prior'").ok());
  for (const AnswerRow& row : answers_in(folder / "answers")) {
    CHECK(row.invalid.has_value() == (row.arm == Arm::kPrior));
    if (row.invalid)
      CHECK(*row.invalid == "store: its `shown_has_answer` does not follow from the plan");
  }
}

TEST_CASE("what cannot be asked at all is told before there is a row") {
  const TemporaryFolder folder;
  const plan::Plan plan = asking_plan(1);
  const auto refusal = [&](const std::string& address) {
    const auto summary = ask::ask(plan, asking_at(address, folder / "answers"));
    REQUIRE(!summary.ok());
    CHECK(!holds_answers(folder / "answers"));
    return summary.failure().message;
  };
  const PythonServer server("chat_server.py", {"always_a", "fault=other_model"});
  CHECK(refusal(address_of(server, "other")) ==
        "answered with HTTP status 404: The model `other` does not exist.");
  CHECK(refusal(address_of(server, "always_a")).starts_with("the answer is of model `other`"));
  CHECK(refusal("openai://127.0.0.1:1?model=m&timeout.wait_s=0").starts_with("connecting: "));
  CHECK(refusal("openai://127.0.0.1:1") ==
        "which of the server's models: `?model=NAME` is missing from the address");
  CHECK(refusal("openai://127.0.0.1:1?model=m&max_tokns=3") ==
        "the address of a model has no option `max_tokns`, did you mean `max_tokens`?");
  CHECK(refusal("openai://127.0.0.1:1?model=m&size=224").starts_with("`size` is written WxH"));
  CHECK(refusal("openai://127.0.0.1:1?model=m&api_key=x").find("VLAPROBE_API_KEY") !=
        std::string::npos);
}

TEST_CASE("a server that sends elsewhere is told where to, and one without TLS that it has none") {
  const TemporaryFolder folder;
  const plan::Plan plan = asking_plan(1);
  const PythonServer moved("chat_server.py", {"always_a", "fault=moved"});
  const auto sent = ask::ask(plan, asking_at(address_of(moved, "always_a"), folder / "answers"));
  REQUIRE(!sent.ok());
  CHECK(sent.failure().message ==
        "answered with HTTP status 307, which sends to "
        "`http://elsewhere:9000/v1/chat/completions`: let the address name that: moved");

  const PythonServer plain("chat_server.py", {"always_a"});
  const std::string address =
      "https://127.0.0.1:" + plain.port() + "?model=always_a&timeout.wait_s=60";
  const auto begun = std::chrono::steady_clock::now();
  const auto refused = ask::ask(plan, asking_at(address, folder / "answers"));
  REQUIRE(!refused.ok());
  CHECK_MESSAGE(refused.failure().message.find("speak TLS") != std::string::npos,
                refused.failure().message);
  CHECK(std::chrono::steady_clock::now() - begun < std::chrono::seconds(50));
  CHECK(!holds_answers(folder / "answers"));
}

TEST_CASE("answers that were asked for in two ways are never mixed, whatever is said") {
  const TemporaryFolder folder;
  const PythonServer server("chat_server.py", {"always_a"});
  const plan::Plan plan = asking_plan(1);
  const std::string small = address_of(server, "always_a", "&size=224x168");
  REQUIRE(ask::ask(plan, asking_at(small, folder / "answers")).ok());
  AskOptions other = asking_at(address_of(server, "always_a", "&size=320x240"), folder / "answers");
  other.if_changed = run::IfChanged::kContinue;
  const auto mixed = ask::ask(plan, other);
  REQUIRE(!mixed.ok());
  CHECK(mixed.failure().message.starts_with("was begun by asking in another way (recorded chat"));
  CHECK(mixed.failure().message.find("--if-changed fork") != std::string::npos);
  CHECK(mixed.failure().message.find("--if-changed continue") == std::string::npos);
  other.if_changed = run::IfChanged::kFork;
  const auto forked = ask::ask(plan, other);
  REQUIRE_MESSAGE(forked.ok(), to_text(forked.failure()));
  CHECK(forked->out == (folder / "answers") + "-2");
}

TEST_CASE("a call gives up after so many lost questions, and the same call goes on later") {
  const TemporaryFolder folder;
  const plan::Plan plan = asking_plan(2);
  {
    const PythonServer server("chat_server.py",
                              {"always_a", "fault=error", "on=Which object must"});
    AskOptions options = asking_at(address_of(server, "always_a"), folder / "answers");
    options.retries = 0;
    options.give_up_after = 3;
    const auto summary = ask::ask(plan, options);
    REQUIRE(!summary.ok());
    CHECK(summary.failure().message.starts_with("the model failed with 3 questions in a row, "));
  }
  const PythonServer server("chat_server.py", {"always_a"});
  const auto summary = ask::ask(plan, asking_at(address_of(server, "always_a"), folder / "answers"));
  REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
  CHECK(summary->done == 6);
  CHECK(answers_in(folder / "answers").size() == 6);
}

TEST_CASE("an address is a base as it is copied, with or without its version, or the whole path") {
  const auto path = [](const std::string& text) {
    const auto choice = choose_chat(text);
    REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
    return choice->server.path;
  };
  CHECK(path("openai://h?model=m") == "/v1/chat/completions");
  CHECK(path("https://h/v1/?model=m") == "/v1/chat/completions");
  CHECK(path("https://h/openai?model=m") == "/openai/v1/chat/completions");
  CHECK(path("http://h/x/chat/completions?model=m") == "/x/chat/completions");
}

TEST_CASE("log-probabilities of a letter are those of all its tokens where it stands") {
  ChatTerms terms;
  terms.model = "m";
  const std::string body =
      R"({"model": "m", "choices": [{"message": {"content": "B"}, "logprobs": {"content": [
        {"token": "B", "top_logprobs": [{"token": "B", "logprob": -1}, {"token": " B", "logprob": -1},
                          {"token": "A", "logprob": -3}, {"token": "The", "logprob": -4}]}]}}]})";
  const auto said = read_chat_answer(terms, body, "application/json", 3);
  REQUIRE(said.ok());
  CHECK(said->has_logprobs);
  REQUIRE(said->letters.size() == 1);
  const auto& letters = said->letters[0].logprobs;
  REQUIRE(letters.size() == 3);
  CHECK(letters[0] == doctest::Approx(-3));
  CHECK(letters[1] == doctest::Approx(-1 + 0.6931471805599453));
  CHECK(!letters[2].has_value());
}

TEST_CASE("content that is no words is a server's failure, and counts below nothing are none") {
  ChatTerms terms;
  terms.model = "m";
  const auto said = [&](const std::string& content) {
    return read_chat_answer(terms,
                            R"({"model": "m", "choices": [{"message": {"content": )" + content +
                                R"(}}], "usage": {"prompt_tokens": -3, "completion_tokens": 1}})",
                            "application/json", 0);
  };
  for (const char* content : {"5", "true", "{\"text\": \"B\"}", "[5]", "[\"B\"]"}) {
    CAPTURE(content);
    const auto failed = said(content);
    REQUIRE(!failed.ok());
    CHECK(failed.failure().code == Fault::kPolicy);
    CHECK(failed.failure().message.starts_with("the answer's `content` is neither text nor null"));
  }
  CHECK(said("null")->raw.empty());
  CHECK(said("\"B\"")->raw == "B");
  CHECK(said(R"([{"type": "text", "text": "B"}, {"type": "refusal"}])")->raw == "B");
  // Parts that are thoughts are kept as such, and answer nothing.
  for (const char* type : {"thinking", "reasoning", "thought"}) {
    CAPTURE(type);
    const auto thought = said(std::string(R"([{"type": ")") + type + R"(", ")" + type +
                              R"(": "A?", "text": "A"}, {"type": "text", "text": "B"}])");
    CHECK(thought->raw == "B");
    CHECK(thought->reasoning == "A");
  }
  CHECK(said(R"([{"type": "thinking", "thinking": "A?"}])")->raw.empty());
  CHECK(said(R"([{"type": "thinking", "thinking": "A?"}])")->reasoning == "A?");
  CHECK(!said("\"B\"")->usage.prompt_tokens.has_value());
  CHECK(said("\"B\"")->usage.completion_tokens == 1);
}

}  // namespace
}  // namespace probe::ask
