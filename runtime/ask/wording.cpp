#include "runtime/ask/wording.h"

#include <charconv>

#include "runtime/plan/questions.h"

namespace probe::ask {
namespace {

constexpr std::string_view kBeforeWidth = "\nThe picture is ";
constexpr std::string_view kBeforeHeight = " pixels wide and ";

// The number that stands in `text` behind the last `mark`.
std::optional<int> number_behind(std::string_view text, std::string_view mark) {
  const std::size_t at = text.rfind(mark);
  if (at == text.npos) return std::nullopt;
  const std::string_view rest = text.substr(at + mark.size());
  int number = 0;
  const auto read = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (read.ec != std::errc()) return std::nullopt;
  return number;
}

}  // namespace

std::optional<ToldSize> told_size(std::string_view words) {
  const auto width = number_behind(words, kBeforeWidth);
  const auto height = number_behind(words, kBeforeHeight);
  if (!width || !height) return std::nullopt;
  return ToldSize{*width, *height};
}

std::span<const plan::OptionRecord> options_of(const plan::Plan& plan,
                                               const plan::QuestionRecord& question) {
  return plan::slice_of(plan.options(), question.options);
}

Wording word(const plan::Plan& plan, const plan::QuestionRecord& question, std::uint32_t rotation,
             int width, int height) {
  const auto options = options_of(plan, question);
  const auto count = static_cast<std::uint32_t>(options.size());
  Wording wording;
  wording.text = std::string(plan.text(question.text));
  for (std::uint32_t place = 0; place < count; ++place)
    wording.shown.push_back((place + rotation) % count);
  switch (plan::form_of(plan.families()[question.family])) {
    case plan::QuestionForm::kChoice:
      for (std::size_t place = 0; place < wording.shown.size(); ++place) {
        wording.text += "\n" + letter_of(place) + ". " +
                        std::string(plan.text(options[wording.shown[place]].text));
      }
      wording.text += "\nAnswer with the letter of one option.";
      break;
    case plan::QuestionForm::kYesNo:
      wording.text += "\nAnswer yes or no.";
      break;
    case plan::QuestionForm::kNumber:
      wording.text += "\nAnswer with one whole number.";
      break;
    case plan::QuestionForm::kPoint:
      wording.text += std::string(kBeforeWidth) + std::to_string(width) +
                      std::string(kBeforeHeight) + std::to_string(height) +
                      " high; (0, 0) is its upper left corner.";
      break;
    case plan::QuestionForm::kFree:
      break;
  }
  return wording;
}

}  // namespace probe::ask
