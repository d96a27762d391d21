// What a model's text is read as. Pure; knows no right answers. Strict, then lenient, by tables of
// rules: the first rule that applies decides, and its name is kept. Nothing is guessed: what could
// mean two answers is unclear.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/ask/reading/answer_row.h"
#include "runtime/ask/reading/naming.h"
#include "runtime/plan/format.h"

namespace probe::ask {

struct ReadContext {
  plan::QuestionForm form = plan::QuestionForm::kChoice;
  std::vector<ShownOption> options = {};  // in the order in which they were shown
  bool letters = true;                    // a choice: options[0] was shown as A, and so on
  // Its words: an answer "there is a carrot" is held against them, and who repeats them says
  // nothing.
  std::string question = {};
  int width = 0, height = 0;  // of the picture that was sent, pixels; 0: not known
};

// Answers of more bytes, without their thoughts, are not read: they are unclear.
inline constexpr std::size_t kLongestAnswer = std::size_t{1} << 16;

// Never throws; time and memory are linear in the text. Its steps:
// 1. Thoughts are taken out (without_thoughts); what is left blank is empty.
// 2. The part that answers is looked for, in the order of places(): a tag, a box, JSON, an answer
//    line, and else the whole text. In such a part the next is looked for. Two parts that are read
//    as two answers are unclear. Where a place is there and cannot be read, none behind it is
//    tried.
// 3. The part is read by rules() of the question's form.
// Reading::rule is the rule's name, behind that of the place ("box: letter") unless it is the
// whole.
//
// A letter counts only where it stands as one: "A carrot" and "I think" hold none. A point is in
// pixels of the picture: fractions of it (both below 1) and Molmo's percentages (a tag `point` with
// both numbers up to 100) are unclear, since the question asks for pixels; PaliGemma's
// <loc0512><loc0256>, y before x in 1,024 steps of the picture, can mean nothing else and is read.
//
// `finish` is the server's reason why the answer ended. One that was cut off ("length",
// "content_filter") holds an answer only in a place whose end is there: it is unclear, by kCutRule.
Reading read_answer(const ReadContext& context, std::string_view raw, std::string_view finish = {});

inline constexpr std::string_view kCutRule = "cut";
bool is_cut(std::string_view finish);

struct FoundPart;  // read_places.h
struct Place;

// The same for many answers to one question: what its options are called is worked out once.
class AnswerReader {
 public:
  explicit AnswerReader(ReadContext context);
  Reading read(std::string_view raw, std::string_view finish = {}) const;
  const ReadContext& context() const { return context_; }

 private:
  Reading read_part(std::string_view text, int depth) const;
  Reading agreed(const std::vector<FoundPart>& parts, int depth) const;
  bool is_doubtful_around(std::string_view text, const std::vector<FoundPart>& parts,
                          const Place& place, const Reading& reading) const;
  Reading by_rules(std::string_view text) const;

  ReadContext context_;
  NameTable names_;
};

// The tables, for pages and tests.
struct RuleInfo {
  std::string_view name;
  std::string_view says;  // what it takes for what
};
std::vector<RuleInfo> places();
std::vector<RuleInfo> rules(plan::QuestionForm form);

}  // namespace probe::ask
