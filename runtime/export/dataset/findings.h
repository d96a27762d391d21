// What the checks of all formats have in common: problems with their places, the loop over the
// demonstrations, and what is held against a trace in the same way everywhere.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/export/dataset/check.h"
#include "runtime/export/dataset/demonstration.h"
#include "runtime/export/dataset/named_runs.h"
#include "runtime/export/dataset/pictures_again.h"

namespace probe::dataset {

class Findings {
 public:
  void problem(std::string text) { report.problems.push_back(std::move(text)); }
  // Of what differs in nothing but its numbers the first place is told, and how many more there
  // are.
  void expect(bool is_so, const std::string& where, const std::string& what);
  // More of the same kind would only fill the screen.
  bool is_full() const;

  CheckReport report;

 private:
  // Of a kind of problem: its first sentence in `report.problems`, where that is, and how many came
  // behind it.
  struct Kind {
    std::string first;
    std::size_t index = 0, more = 0;
  };
  std::map<std::string, Kind> kinds_;
};

// Of each demonstration in each of its wordings, in order, until `episode` fails, which is a
// problem: what follows cannot be read. False then, and where there are too many problems.
bool each_episode(NamedRuns& runs, Findings& findings,
                  const std::function<Status(const NamedDemonstration& named,
                                             const std::string& wording, bool is_first)>& episode);

// What was measured before the action of step `i`, and the joints then.
const vm::StepSample& sample_before(const store::Trace& trace, std::size_t i);
std::span<const double> joints_before(const store::Trace& trace, std::size_t i, std::size_t count);

// Place and gripper as the trace has them; of the rotation, which it does not have, the range.
void expect_state(Findings& findings, std::span<const double> state, const Pose& base,
                  const vm::StepSample& sample, const std::string& at, const std::string& called);

// run::picture_hash of what each step's pictures have to be: what the policy saw, where the dataset
// has all of it as it was (`NamedDemonstration::has_all_pictures`), else what `again` draws. Empty
// where that is not known: `again` is null, or cannot, which is a problem then.
std::vector<Sha256> picture_hashes(Findings& findings, const NamedDemonstration& named,
                                   PicturesAgain* again);
// Whether the pictures of a step, one a camera, are those; `wanted` of picture_hashes().
void expect_pictures(Findings& findings, std::span<const std::span<const std::uint8_t>> rgb,
                     std::span<const Sha256> wanted, std::size_t step, const std::string& at);

// Single numbers of 32 bits, or double ones.
bool equal_singles(std::span<const double> stored, std::span<const double> wanted);

}  // namespace probe::dataset
