// Any bytes as a model's answer: it is read as one answer that the question has, or as none, and
// always by a rule that has a name; as a restatement it is right or says why not.
// links: probe_ask_reading
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "runtime/ask/reading/mentions.h"
#include "runtime/ask/reading/read_answer.h"

namespace {

using namespace probe;
using ask::Verdict;
using plan::QuestionForm;

void need(bool truth) {
  if (!truth) std::abort();
}

ask::ReadContext context_of(QuestionForm form) {
  return {.form = form,
          .options = {{3, "carrot", {"orange object", "rabbit's favorite vegetable"}},
                      {1, "plate", {"round shaped object"}},
                      {0, "orange juice", {"drink rich in vitamin C"}},
                      {2, "yellow basket", {}}},
          .question = "Is there a carrot on the table?",
          .width = 640,
          .height = 480};
}

void check(QuestionForm form, const ask::Reading& reading) {
  need(!reading.rule.empty());
  const bool read = reading.verdict == Verdict::kRead;
  need(reading.option.has_value() == (read && form == QuestionForm::kChoice));
  need(reading.yes.has_value() == (read && form == QuestionForm::kYesNo));
  need(reading.number.has_value() == (read && form == QuestionForm::kNumber));
  need(reading.point.has_value() == (read && form == QuestionForm::kPoint));
  need(reading.mentioned.empty() || form == QuestionForm::kFree);
  if (reading.option) need(*reading.option < 4);
  if (reading.number) need(*reading.number >= 0);
}

void check_restated(std::string_view raw) {
  const ask::ReadContext context = context_of(QuestionForm::kFree);
  const ask::Restatement restated =
      ask::restate({context.options, 3, 1, "put rabbit's favorite vegetable on the plate"}, raw);
  const bool read = restated.reading.verdict == Verdict::kRead;
  need(restated.right == (read && restated.wrong_by.empty()));
  need(restated.copied >= 0 && restated.copied <= 1);
  need(read || restated.mentions.empty());
  for (const ask::Mention& mention : restated.mentions) need(mention.option < 4);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view raw(reinterpret_cast<const char*>(data), size);
  for (const QuestionForm form : {QuestionForm::kChoice, QuestionForm::kYesNo,
                                  QuestionForm::kNumber, QuestionForm::kPoint, QuestionForm::kFree})
    check(form, ask::read_answer(context_of(form), raw));
  check_restated(raw);
  return 0;
}
