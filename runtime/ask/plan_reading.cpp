#include "runtime/ask/plan_reading.h"

#include "runtime/plan/questions.h"

namespace probe::ask {
namespace {

ShownOption shown_option(const plan::Plan& plan, const plan::QuestionRecord& question,
                         std::uint32_t index) {
  const plan::OptionRecord& record = plan::slice_of(plan.options(), question.options)[index];
  ShownOption option{index, std::string(plan.text(record.text)), {}};
  for (const plan::StringRef& word : plan::slice_of(plan.words(), record.words))
    option.words.emplace_back(plan.text(word));
  return option;
}

std::optional<std::uint32_t> if_any(std::uint32_t option) {
  if (option == plan::kNone) return std::nullopt;
  return option;
}

}  // namespace

ReadContext read_context(const plan::Plan& plan, const plan::QuestionRecord& question,
                         std::span<const std::uint32_t> shown, int width, int height) {
  ReadContext context{.form = plan::form_of(plan.families()[question.family]),
                      .question = std::string(plan.text(question.text)),
                      .width = width,
                      .height = height};
  for (const std::uint32_t index : shown)
    context.options.push_back(shown_option(plan, question, index));
  return context;
}

Restatement restate(const plan::Plan& plan, const plan::QuestionRecord& question,
                    std::string_view raw, std::string_view finish) {
  std::vector<ShownOption> options;
  for (std::uint32_t index = 0; index < question.options.count; ++index)
    options.push_back(shown_option(plan, question, index));
  return restate({.options = options,
                  .source = if_any(question.a),
                  .target = if_any(question.b),
                  .instruction = plan.text(plan.tasks()[question.task].prompt)},
                 raw, finish);
}

}  // namespace probe::ask
