#include "runtime/ask/reading/read_doubt.h"

#include <algorithm>

#include "runtime/ask/reading/doubt_words.h"

namespace probe::ask {

std::size_t begin_of_sentence(const Tokens& tokens, std::size_t at) {
  while (at > 0 && !tokens[at - 1].is_end()) --at;
  return at;
}

bool asks_for_presence(const ReadContext& context) {
  const std::vector<std::string> asked = plain_words(context.question);
  for (std::size_t at = 0; at + 1 < asked.size(); ++at) {
    if ((asked[at] == "is" || asked[at] == "are") && asked[at + 1] == "there") return true;
    if (asked[at] == "you" && asked[at + 1] == "see") return true;
  }
  return std::find(asked.begin(), asked.end(), "visible") != asked.end();
}

bool is_doubtful(const ReadContext& context, const AnswerPart& part, const ReadRule& rule,
                 const Reading& reading) {
  if (has_striking_sign(part.text)) return true;
  switch (context.form) {
    case plan::QuestionForm::kChoice:
      return is_choice_doubtful(context, part, rule, reading);
    case plan::QuestionForm::kYesNo:
      return is_yesno_doubtful(context, part, rule, reading);
    case plan::QuestionForm::kNumber:
      return is_number_doubtful(context, part, reading);
    case plan::QuestionForm::kPoint:
      return is_point_doubtful(context, part, reading);
    case plan::QuestionForm::kFree:
      return false;
  }
  return false;
}

}  // namespace probe::ask
