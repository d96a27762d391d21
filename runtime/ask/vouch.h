// Whether stored rows follow from what they hold: rows are not believed but read again. What an
// answer is read as, whether that is right, what was asked and what is expected are worked out anew
// from its words and the plan; a row that says otherwise is invalid, with the reason. Pure.
//
// Believed are what only the picture shows (that the carrot is further left, which pixels are its),
// the server's own figures, and the words that came.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/ask/reading/answer_row.h"
#include "runtime/ask/reading/read_answer.h"
#include "runtime/ask/truth.h"
#include "runtime/plan/plan.h"

namespace probe::ask {

class Voucher {
 public:
  // Of rows of a folder of that model. The plan must live as long.
  Voucher(const plan::Plan& plan, std::string model);

  // A row that another version of the reader read gets today's reading; `reader` stays, and tells.
  void vouch(AnswerRow& row);

 private:
  // A question in one order of its options, as it is asked and read.
  struct Order {
    std::string text, prompt_sha256;
    std::unique_ptr<AnswerReader> reader;  // of all but free answers
  };
  std::string reason(AnswerRow& row);
  std::string check_shown(const AnswerRow& row, std::uint32_t question) const;
  std::string read_again(AnswerRow& row, std::uint32_t question);
  std::string judge_again(AnswerRow& row, std::uint32_t question, const Reading& today);
  const Order* order_of(const AnswerRow& row, std::uint32_t question);

  const plan::Plan& plan_;
  std::string model_;
  using ById = std::map<std::string, std::vector<std::uint32_t>, std::less<>>;
  ById questions_;  // by id
  ById episodes_;   // that begin so, by the start's id
  std::map<std::pair<std::uint32_t, std::uint32_t>, Order> orders_;  // by question, rotation
};

// Whether it is invalid since it, or what was merged into its folder, did not follow.
bool is_unvouched(const AnswerRow& row);

// What is to be told of a folder's rows, as they come from for_each_answer.
class RowFindings {
 public:
  void add(const AnswerRow& row);
  // How many another version of the reader read, and what cannot be vouched for: a few of the
  // reasons, with their counts.
  std::vector<std::string> sentences() const;
  std::int64_t refused() const { return refused_; }

 private:
  std::int64_t read_anew_ = 0, refused_ = 0;
  std::map<std::string, std::int64_t> reasons_;
};

}  // namespace probe::ask
