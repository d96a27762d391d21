// The models in this process, and the table.
#include "runtime/ask/models.h"

#include <algorithm>
#include <array>

#include "runtime/ask/chat.h"
#include "runtime/base/hash_number.h"
#include "runtime/base/percent.h"
#include "runtime/base/row_name.h"
#include "runtime/base/spelling.h"
#include "runtime/plan/questions.h"

namespace probe::ask {
namespace {

std::string point_text(double x, double y) {
  return "(" + decimal_text(x, 0) + ", " + decimal_text(y, 0) + ")";
}

std::string sentence(const AskedQuery& asked, std::uint32_t moved, std::uint32_t onto) {
  const auto options = options_of(asked.plan, asked.question);
  const auto name = [&](std::uint32_t option) {
    return std::string(asked.plan.text(options[option].text));
  };
  return "Put the " + name(moved) + " on the " + name(onto) + ".";
}

std::string letter_at(const AskedQuery& asked, std::uint32_t option) {
  const auto place = std::ranges::find(asked.wording.shown, option) - asked.wording.shown.begin();
  return letter_of(static_cast<std::size_t>(place));
}

// Knows the right answer and says it.
std::string truth_says(const AskedQuery& asked) {
  const Truth& truth = asked.truth;
  if (truth.option) return letter_at(asked, *truth.option);
  if (truth.yes) return *truth.yes ? "Yes." : "No.";
  if (truth.number) return std::to_string(*truth.number);
  if (truth.area) return point_text(truth.area->inside.x, truth.area->inside.y);
  return sentence(asked, asked.question.a, asked.question.b);
}

// Every answer as likely as any other, by a hash of the query's key.
std::string random_says(const AskedQuery& asked) {
  std::size_t used = 0;
  const auto below = [&](std::size_t bound) {
    const std::uint64_t value = big_endian_number(asked.draw, used++ % kNumbersOfHash);
    return static_cast<std::uint32_t>(value % std::max<std::size_t>(bound, 1));
  };
  const std::size_t options = asked.wording.shown.size();
  switch (plan::form_of(asked.plan.families()[asked.question.family])) {
    case plan::QuestionForm::kChoice:
      return letter_of(below(options));
    case plan::QuestionForm::kYesNo:
      return below(2) == 0 ? "Yes." : "No.";
    case plan::QuestionForm::kNumber:
      return std::to_string(below(options + 1));
    case plan::QuestionForm::kPoint: {
      const std::uint32_t x = below(static_cast<std::size_t>(asked.width));
      return point_text(x, below(static_cast<std::size_t>(asked.height)));
    }
    case plan::QuestionForm::kFree: {
      const std::uint32_t moved = below(options);
      return sentence(asked, moved, below(options));
    }
  }
  return {};
}

// The same whatever is asked.
std::string first_says(const AskedQuery& asked) {
  switch (plan::form_of(asked.plan.families()[asked.question.family])) {
    case plan::QuestionForm::kChoice:
      return "A";
    case plan::QuestionForm::kYesNo:
      return "Yes.";
    case plan::QuestionForm::kNumber:
      return "1";
    case plan::QuestionForm::kPoint:
      return point_text(asked.width / 2, asked.height / 2);
    case plan::QuestionForm::kFree:
      return "A";  // no habit says a sentence about these objects: never right
  }
  return {};
}

struct OwnEntry {
  std::string_view name;
  std::string (*says)(const AskedQuery&);
  std::string_view meaning;
};
constexpr std::array kOwnModels = {
    OwnEntry{"truth", truth_says, "knows every right answer: what reads answers is checked by it"},
    OwnEntry{"random", random_says, "any answer, each as likely: what luck gets"},
    OwnEntry{"first", first_says, "always A, yes, 1, the middle, no sentence: what a habit gets"},
};

class InProcessModel final : public Model {
 public:
  explicit InProcessModel(const OwnEntry& entry) : entry_(entry) {}
  Result<Said> answer(const AskedQuery& asked) override { return Said{.raw = entry_.says(asked)}; }

 private:
  const OwnEntry& entry_;
};

const OwnEntry* find_own(std::string_view name) {
  const auto found = std::ranges::find(kOwnModels, name, &OwnEntry::name);
  return found == kOwnModels.end() ? nullptr : &*found;
}

Failure nothing_to_accept(std::string_view model) {
  return {Fault::kUsage,
          "`" + std::string(model) +
              "` shows no certificate that could be left unchecked: it is no https://",
          "--insecure"};
}

}  // namespace

Result<ModelTraits> model_traits(std::string_view text, bool accepts_any_certificate) {
  const bool is_own = find_own(text) != nullptr;
  if (is_own && accepts_any_certificate) return nothing_to_accept(text);
  if (is_own)
    return ModelTraits{std::string(text), "in this process: " + std::string(text), {Arm::kPicture}};
  if (is_chat(text)) {
    PROBE_ASSIGN(const ChatChoice choice, choose_chat(text));
    if (accepts_any_certificate && !choice.server.tls.is_on) return nothing_to_accept(text);
    return traits_of(choice);
  }
  std::vector<std::string> names = {"openai"};
  for (const OwnEntry& entry : kOwnModels) names.emplace_back(entry.name);
  return Failure{Fault::kUsage,
                 "unknown model `" + std::string(text) + "`" + did_you_mean(text, names) +
                     "\nthe models are:\n" + model_help(),
                 "--model"};
}

Status check_model_name(const std::string& name, const std::string& model) {
  if (name == model) return {};
  PROBE_TRY(check_row_name(name));
  const bool is_taken = std::ranges::any_of(
      kOwnModels, [&](const OwnEntry& entry) { return reads_alike(entry.name, name); });
  if (!is_taken) return {};
  return name_taken(name, "model", model);
}

std::unique_ptr<Model> make_own_model(std::string_view text) {
  const OwnEntry* entry = find_own(text);
  return entry == nullptr ? nullptr : std::make_unique<InProcessModel>(*entry);
}

std::string model_help() {
  std::string text;
  const auto add = [&](std::string line, std::string_view meaning) {
    line.resize(std::max<std::size_t>(line.size() + 2, 36), ' ');
    text += "  " + line + std::string(meaning) + "\n";
  };
  add("openai://HOST:PORT?model=NAME",
      "a server of the chat interface: vLLM, SGLang, llama.cpp, ollama");
  add("https://HOST/PATH?model=NAME", "the same over TLS, as http:// is it without");
  for (const OwnEntry& entry : kOwnModels) add(std::string(entry.name), entry.meaning);
  return text;
}

}  // namespace probe::ask
