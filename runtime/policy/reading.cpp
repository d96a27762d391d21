#include "runtime/policy/reading.h"

#include <cstdio>

namespace probe::policy {

std::string_view to_word(AtEnd at_end) {
  switch (at_end) {
    case AtEnd::kSame:
      return "same";
    case AtEnd::kOther:
      return "other";
    case AtEnd::kUnclear:
      return "unclear";
    case AtEnd::kDrawn:
      return "drawn";
    case AtEnd::kMixed:
      return "mixed";
    case AtEnd::kNotAsked:
      break;
  }
  return "not asked";
}

bool is_exchanged(AtEnd at_end) {
  return at_end == AtEnd::kOther || at_end == AtEnd::kDrawn || at_end == AtEnd::kMixed;
}

bool are_others(const Reading& a, const Reading& b) {
  if (a.questions_sha256.empty() || a.questions_sha256 != b.questions_sha256) return false;
  if (a.is_steady && b.is_steady) return a.answers_sha256 != b.answers_sha256;
  return (a.is_steady && b.draws) || (a.draws && b.is_steady);
}

std::string batch_remark(const Reading& reading) {
  if (reading.batch == 0) return "";
  const std::string of = "in a batch of " + std::to_string(reading.batch);
  if (reading.batch_difference == 0)
    return of + ", questions had the answers that they have alone, bit for bit";
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", reading.batch_difference);
  return of + ", numbers of the answers were up to " + text +
         " away from those of the same questions alone";
}

std::vector<std::string> findings_of(const Reading& reading) {
  std::vector<std::string> findings;
  const std::string who = "the policy at " + reading.server;
  if (!reading.failure.empty()) {
    findings.push_back(who +
                       " could not be shown to read pictures and instructions: " + reading.failure);
  }
  if (reading.is_unchecked) {
    findings.push_back(who +
                       " was asked with --insecure: its certificate was not checked, so that "
                       "another than it can have answered");
  }
  if (reading.is_deaf) {
    findings.push_back(who +
                       " answers two instructions with one picture bit for bit the same: it does "
                       "not read them, or keeps an older one");
  }
  if (reading.is_blind) {
    findings.push_back(who +
                       " answers one instruction with two pictures bit for bit the same: it does "
                       "not look, or keeps an older one");
  }
  if (reading.at_end == AtEnd::kOther) {
    findings.push_back(who +
                       " answered the questions of the beginning otherwise when the call ended: "
                       "another policy was loaded, and what it may have answered was made invalid, "
                       "to be done again");
  }
  if (reading.at_end == AtEnd::kDrawn) {
    findings.push_back(who +
                       " answered each question of the beginning alike, and later each time "
                       "otherwise: another policy was loaded, and what it may have answered was "
                       "made invalid, to be done again");
  }
  if (reading.at_end == AtEnd::kMixed) {
    findings.push_back(who +
                       " took the questions of a batch for one another when they were asked again: "
                       "what it may have answered so was made invalid; ask without `batch`");
  }
  if (reading.draws) {
    findings.push_back(who + " draws: that it was one policy is not shown");
    const bool both = reading.words_not_shown && reading.picture_not_shown;
    if (reading.words_not_shown || reading.picture_not_shown) {
      findings.push_back(who + " is not shown to read " +
                         (both                      ? "instructions and pictures"
                          : reading.words_not_shown ? "instructions"
                                                    : "pictures") +
                         ": its answers to one question are as far apart as those to others");
    }
  }
  if (reading.at_end == AtEnd::kUnclear) {
    findings.push_back(who +
                       " could not be asked its first questions again when the call ended: whether "
                       "it was one policy to the end is not shown");
  }
  return findings;
}

}  // namespace probe::policy
