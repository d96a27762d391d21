#include "runtime/policy/reading.h"

namespace probe::policy {

std::vector<std::string> findings_of(const Reading& reading) {
  std::vector<std::string> findings;
  const std::string who = "the policy at " + reading.server;
  if (!reading.failure.empty()) {
    findings.push_back(who +
                       " could not be shown to read pictures and instructions: " + reading.failure);
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
  return findings;
}

}  // namespace probe::policy
