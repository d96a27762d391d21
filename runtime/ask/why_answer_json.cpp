// One start's answers, explained, as JSON.
#include "runtime/ask/why_answer.h"

namespace probe::ask {
namespace {

Json place_json(const std::optional<Written>& written) {
  if (!written) return nullptr;
  return {{"file", written->file}, {"line", written->line}, {"text", written->text}};
}

Json answer_json(const AnswerRow& row) {
  Json json = {{"seed", row.seed == -1 ? Json() : Json(row.seed)},
               {"arm", word_of(row.arm)},
               {"rotation", row.rotation},
               {"text", row.text},
               {"raw", row.raw},
               {"read_as", word_of(row.reading.verdict)},
               {"rule", row.reading.rule},
               {"reader", row.reader},
               {"expected", row.expected},
               {"right", row.right ? Json(*row.right) : Json()},
               {"image_sha256", row.image_sha256}};
  json["invalid"] = row.invalid ? Json(*row.invalid) : Json();
  return json;
}

}  // namespace

Json to_json(const StartWhy& why) {
  Json json = {{"task", why.task},
               {"episode", why.episode},
               {"model", why.model},
               {"instruction", why.prompt},
               {"questions", Json::array()}};
  for (const AnswerWhy& question : why.questions) {
    Json one = {{"question", question.question},
                {"text", question.text},
                {"truth", question.truth},
                {"asked_at", place_json(question.asked_at)},
                {"right_at", place_json(question.right_at)},
                {"left_out", question.left_out},
                {"answers", Json::array()}};
    for (const AnswerRow& row : question.answers) one["answers"].push_back(answer_json(row));
    json["questions"].push_back(std::move(one));
  }
  return json;
}

}  // namespace probe::ask
