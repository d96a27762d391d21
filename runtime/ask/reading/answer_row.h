// What is asked and what came of it: one row an answer. Plain data; knows no servers and no files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/plan/format.h"

namespace probe::ask {

// What a model is given beside the question's words.
enum class Arm : std::uint8_t {
  kPicture,  // the picture of the start, or of the recorded episode
  kBlind,    // none
  kPrior,    // that of another start, in which the right answer may be another one
};
constexpr std::string_view word_of(Arm arm) {
  return arm == Arm::kPicture ? "picture" : arm == Arm::kBlind ? "blind" : "prior";
}

// One question about one start in one order of its options, under one arm.
struct Query {
  std::uint32_t question = 0;  // of the plan's questions
  std::uint32_t episode = 0;   // of the plan's episodes, of the question's task
  std::optional<int> seed;     // of the recorded episode, for questions at its end
  // A choice shows option (i + rotation) % n at letter i; other forms have rotation 0 alone.
  std::uint32_t rotation = 0;
  Arm arm = Arm::kPicture;
  bool operator==(const Query&) const = default;
};

// What a text was read as. Never guessed: two options named are unclear.
enum class Verdict : std::uint8_t {
  kRead,     // as one answer; whether it is right is another matter
  kUnclear,  // it says something, not which
  kRefused,  // the model says that it will not or cannot answer
  kEmpty,    // nothing, or only thoughts
};
constexpr std::string_view word_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kRead:
      return "read";
    case Verdict::kUnclear:
      return "unclear";
    case Verdict::kRefused:
      return "refused";
    case Verdict::kEmpty:
      return "empty";
  }
  return "";
}

// By the question's form one of these is given when the verdict is kRead.
struct Reading {
  Verdict verdict = Verdict::kEmpty;
  std::string rule = {};                     // which row of the table of rules read it
  std::optional<std::uint32_t> option = {};  // choice: of the question's options, not the letter
  std::optional<bool> yes = {};              // yesno
  std::optional<std::int64_t> number = {};   // number
  struct Point {
    double x = 0, y = 0;  // pixels of the picture that was sent, from its upper left corner
    bool operator==(const Point&) const = default;
  };
  std::optional<Point> point = {};  // point
  std::vector<std::uint32_t> mentioned =
      {};  // free: of the question's options, in order of mention
  bool operator==(const Reading&) const = default;
};

// What a server says of an answer beside its text.
struct Usage {
  std::optional<std::int64_t> prompt_tokens = {}, completion_tokens = {};
  std::string model = {};        // as the server calls it
  std::string fingerprint = {};  // system_fingerprint
  std::string finish = {};       // "stop", "length"
  // Natural logarithms of the letters' probabilities where the letter stands that is read, by
  // letter; empty: not offered, or the answer is read from no letter.
  std::vector<std::optional<double>> letter_logprobs = {};
};

// Of the tables that read answers (READING.md): raised whenever one reads some text otherwise, so
// that rows of an older one are told from rows that were changed.
inline constexpr int kReaderVersion = 4;

struct AnswerRow {
  // Which: the first six are the key, exactly one row each.
  std::string question_id, start_id;  // hex
  std::uint32_t rotation = 0;
  Arm arm = Arm::kPicture;
  int episode = 0;  // of the task
  int seed = -1;    // of the recorded episode, -1: asked about the start
  // Names for people and tables.
  std::string set, family, task, model;  // model: as the folder calls it
  // What was asked.
  std::string text;  // all words that were sent
  std::string prompt_sha256, image_sha256, request_sha256;
  std::string expected;  // the right answer in words
  // What came.
  std::string raw;        // the answer's text, as it came
  std::string reasoning;  // what the server gave apart from it
  Reading reading;
  std::optional<bool> right;  // none when invalid
  // free: how much of the instruction's words the answer repeats, 0 .. 1
  std::optional<double> copied;
  Usage usage;
  double latency_s = 0;
  int attempts = 1;
  std::optional<std::string> invalid;  // why it counts neither way
  // Of the prior arm: the start whose picture was shown, hex, and whether what the right answer
  // names is in that picture's scene too; nothing where it names no object.
  std::string shown_start_id = {};
  std::optional<bool> shown_has_answer = {};
  int reader = kReaderVersion;  // which read `raw` when it came
};

}  // namespace probe::ask
