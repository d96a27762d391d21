#include "runtime/ask/reading/likely_letters.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/runtime/ask/reading/reading.h"

namespace probe::ask {
namespace {

using Logs = std::vector<std::optional<double>>;

// A table in which each token's likeliest is itself (-0.1), and before letters `other` at -3.
std::string table_of_tokens(const std::vector<std::string>& tokens, const std::string& other) {
  std::string out = "{\"content\": [";
  for (const std::string& token : tokens) {
    const std::string text = Json(token).dump();
    out += (out.back() == '[' ? "" : ", ") + ("{\"token\": " + text) +
           ", \"top_logprobs\": [{\"token\": " + text + ", \"logprob\": -0.1}, {\"token\": \"" +
           other + "\", \"logprob\": -3}]}";
  }
  return out + "]}";
}

Logs read_at(const std::string& table, const std::string& raw, const std::string& finish = "stop") {
  const Json json = Json::parse(table);
  REQUIRE(json.is_object());
  const AnswerReader reader(context_of(plan::QuestionForm::kChoice));
  const auto written = written_letters(&json, raw, 4);
  return at_read_letter(reader, written, raw, finish, reader.read(raw, finish));
}

// -0.1 at the letter that was written, -3 at D.
Logs at(std::size_t place) {
  Logs out(4);
  out[place] = -0.1;
  out[3] = -3.0;
  return out;
}

}  // namespace

TEST_CASE("letters are as likely as where the one stands that is read, wherever that is") {
  struct Case {
    std::vector<std::string> tokens;
    std::size_t place;
  };
  const Case cases[] = {
      {{"B"}, 1},
      {{" B"}, 1},
      {{"\xe2\x96\x81"
        "B"},
       1},
      {{"**", "B", "**"}, 1},
      {{"(B", ")"}, 1},
      {{"(", "B", ")"}, 1},
      {{"The", " answer", " is", " B", "."}, 1},
      {{"\\boxed{", "B", "}"}, 1},
      {{"{\"", "answer", "\":", " \"", "B", "\"}"}, 1},
      {{"<think>", "A", "?", "</think>", "B"}, 1},
      {{"<think>", "B", "?", "</think>", "C"}, 2},
      {{"B", ".", " plate"}, 1},
      {{"{\"", "reason", "\":", "\"", "A", " or", " B", "\",", " \"", "answer", "\":", " \"", "B",
        "\"}"},
       1},
  };
  for (const Case& one : cases) {
    std::string raw;
    for (const std::string& token : one.tokens) raw += token;
    if (raw.starts_with("\xe2\x96\x81") || raw.starts_with(" ")) raw = "B";
    CAPTURE(raw);
    CHECK(read_at(table_of_tokens(one.tokens, "D"), raw) == at(one.place));
  }
  // Thoughts that are given apart have tokens, too.
  CHECK(read_at(table_of_tokens({"A", " or", " B", "\n", "C"}, "D"), "C") == at(2));
  // The first tokens alone are told.
  CHECK(read_at(table_of_tokens({"B"}, "D"), "B. plate") == at(1));
}

TEST_CASE("an answer that is read from no letter, or from one of which nothing is told, has none") {
  CHECK(read_at(table_of_tokens({"The", " carrot"}, "D"), "The carrot").empty());
  CHECK(read_at(table_of_tokens({"A", " carrot"}, "D"), "A carrot").empty());
  CHECK(read_at(table_of_tokens({"The"}, "A"), "The answer is B").empty());
  CHECK(read_at(table_of_tokens({"B", " or", " C"}, "D"), "B or C").empty());
  CHECK(read_at(table_of_tokens({"B"}, "D"), "B", "length").empty());
  CHECK(read_at(table_of_tokens({"B"}, "D"), "C").empty());
}

TEST_CASE("junk in a table of log-probabilities is no log-probability") {
  const std::string good = R"({"token": "B", "logprob": -0.1})";
  const auto table = [](const std::string& list) {
    return R"({"content": [{"token": "B", "top_logprobs": )" + list + "}]}";
  };
  CHECK(read_at(table("[" + good + "]"), "B")[1] == -0.1);
  for (const char* junk :
       {R"({"token": "A", "logprob": null})", R"({"token": "A", "logprob": "-3"})",
        R"({"token": "A", "logprob": 0.5})", R"({"token": "A"})", R"({"logprob": -1})", "5", "null",
        R"({"token": 5, "logprob": -1})", R"({"token": "B", "logprob": -1})"}) {
    CAPTURE(junk);
    CHECK(read_at(table("[" + good + ", " + junk + "]"), "B").empty());
  }
  for (const char* list : {"null", "5", "{}", "[]", "[[]]"}) {
    CAPTURE(list);
    CHECK(read_at(table(list), "B").empty());
  }
  for (const char* logprobs :
       {R"({"content": ["x", 5]})", R"({"content": {"0": 1}})", R"({"content": null})",
        R"({"tokens": ["B"], "token_logprobs": [-0.1]})", "[1, 2]", "null"}) {
    CAPTURE(logprobs);
    const Json json = Json::parse(logprobs);
    CHECK(written_letters(&json, "B", 4).empty());
    CHECK_FALSE(tells_logprobs(&json));
  }
  CHECK(written_letters(nullptr, "B", 4).empty());
  // Letters that were not shown are none.
  CHECK(read_at(table("[" + good + R"(, {"token": "Z", "logprob": -0.01}])"), "B").size() == 4);
}

}  // namespace probe::ask
