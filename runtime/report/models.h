// What several policies together say: a mixed model, a ranking, comparisons that could have stopped
// early.
#pragma once

#include <string>
#include <vector>

#include "runtime/report/benchmark.h"

namespace probe::report {

struct ModelTerm {
  std::string term, kind;  // kind: "policy", "category", "axis"
  double odds = 1;         // ratio against the reference of its kind
  double low = 0, high = 0, p = 1;
};

struct RandomTerm {
  std::string factor;
  double sd = 0;  // log-odds
};

struct MixedModel {
  int metric = 0;
  std::string formula, note;  // a note without terms says why there is no fit
  std::vector<ModelTerm> terms;
  std::vector<RandomTerm> random;
  std::size_t rows = 0;
};

// Two fits a metric: policy and category, policy and axis as fixed effects; task, object (source)
// and start as random intercepts. Policies that always or never succeed have no finite odds: they
// are left out and named; the other effects have a weak normal prior of 3 log-odds.
std::vector<MixedModel> mixed_models(const Benchmark& benchmark, const std::vector<int>& metrics);

struct RankRow {
  int policy = 0, metric = 0;
  double score = 0, low = 0, high = 0;  // log-strength, sums to 0
};

// Bradley and Terry on the starts that two policies share: the better rate over seeds wins, equal
// ones are half a win each. Its intervals take starts for independent, so they are of these starts.
std::vector<RankRow> ranking(const Benchmark& benchmark, int metric);

// One question of a comparison, looked at after every unit: a start or a place.
struct Looked {
  std::int64_t units = 0, used = 0;  // that both have, and how many were looked at
  std::int64_t a_wins = 0, b_wins = 0;
  double p = 1;  // anytime-valid, at the stop or the end
  bool stopped = false;
};

struct SequentialRow {
  int a = 0, b = 0, metric = 0;
  Looked here;  // on these starts: a start with its seeds is one outcome
  Looked anew;  // for starts never tried: a place with all its tasks and seeds is one outcome
};

// Policies in pairs. An outcome is the sign of a unit's sum, as in the paired tests; starts come
// place by place. Stopped as soon as the anytime-valid p is at most 0.05 and the paired test of the
// units so far agrees.
std::vector<SequentialRow> sequential(const Benchmark& benchmark, int metric);

}  // namespace probe::report
