// One start's questions and answers, explained: what was asked in which order, what came, how it
// was read, what is right and how that is known.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/ask/reading/answer_row.h"
#include "runtime/base/json.h"
#include "runtime/base/result.h"

namespace probe::ask {

// Where something of a question was written.
struct Written {
  std::string file;
  int line = 0;  // from 1
  std::string text;
};

struct AnswerWhy {
  std::string question;               // "SET.FAMILY"
  std::string text;                   // of the question, without options
  std::string truth;                  // how the right answer is known: "proved by the text"
  std::optional<Written> asked_at;    // the question's statement
  std::optional<Written> right_at;    // the declaration of the object that is right
  std::vector<AnswerRow> answers;     // by seed, arm, rotation
  std::vector<std::string> left_out;  // why it was not asked of this picture
};

struct StartWhy {
  std::string task;
  int episode = 0;
  std::string model, prompt;
  std::vector<AnswerWhy> questions;  // in the plan's order
};

// Of the answers in `dir`. `family`: "SET.FAMILY", or the family's name; empty: all. Fails (kUsage)
// on a task, start or family that the plan does not have, (kStore) as read_answers does.
Result<StartWhy> why_answers(const std::string& dir, const std::string& task, int episode,
                             std::optional<int> seed, const std::string& family);

// As `vlaprobe why ANSWERS ... --json` prints it.
Json to_json(const StartWhy& why);

}  // namespace probe::ask
