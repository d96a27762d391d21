// Proof of reading: what the first questions of a run showed of a policy server. Plain data, stored
// with each call of `run`; knows no protocol.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace probe::policy {

enum class AtEnd : std::uint8_t {
  kNotAsked,  // of a policy that draws, or a call that did not come to its end
  kSame,
  kOther,    // another policy answers
  kUnclear,  // nothing was answered
  kDrawn,    // answered otherwise than at first, and each time otherwise: it drew nothing then
  kMixed,    // takes the questions of a batch for one another, and did not at first
};

struct Reading {
  std::string server = {};   // HOST:PORT
  int answers = 0;           // that came; 0: nothing was asked, or nothing was answered
  std::string failure = {};  // why it ended early; empty where it did not
  // Answers equal bit for bit: of two instructions with one picture, of one instruction with two
  // pictures.
  bool is_deaf = false, is_blind = false;
  // Over the three answers, hex: two servers with equal ones can be one model. Empty where not all
  // came.
  std::string answers_sha256 = {};
  // Over what was asked, hex: answers to other questions say nothing of one another.
  std::string questions_sha256 = {};
  // The first question, asked again, had the same answer bit for bit: nothing is drawn, so that
  // other answers are another policy's.
  bool is_steady = false;
  // It had another answer: the policy draws, and none of its answers shows that it is the same one.
  bool draws = false;
  // Of one that draws: answers to other words, or to another picture, were no farther apart than
  // those to one question.
  bool words_not_shown = false, picture_not_shown = false;
  // What the questions showed when they were asked once more at the end of the call.
  AtEnd at_end = AtEnd::kNotAsked;
  // Questions that were asked once more in one message; 0: the run asks no batches. How far the
  // numbers of its answers were from those of the questions alone.
  int batch = 0;
  double batch_difference = 0;
  // Fields that the profile leaves open, with the value that the answers show.
  std::vector<std::pair<std::string, std::string>> measured = {};
  bool is_unchecked = false;  // TLS without a look at the certificate: it may be anybody's server
  bool operator==(const Reading&) const = default;
};

// "same", "other", "unclear", "drawn", "mixed", "not asked".
std::string_view to_word(AtEnd at_end);
// Whether what was answered between the first questions and these is not to be believed.
bool is_exchanged(AtEnd at_end);

// Whether two policies were read: asked the same and answering otherwise, where not both draw.
bool are_others(const Reading& a, const Reading& b);

// What a batch showed; empty where none was asked.
std::string batch_remark(const Reading& reading);

// Sentences on what is not as it should be; none where the policy reads.
std::vector<std::string> findings_of(const Reading& reading);

}  // namespace probe::policy
