// What models know beside what policies do: answers of `ask`, scored, and set against the episodes
// of the same starts under the same words.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/report/benchmark.h"
#include "runtime/report/contrast.h"

namespace probe::report {

// How well a model answers the questions of a family about the tasks of a category.
struct AccuracyRow {
  int model = 0;
  std::uint32_t family = 0;
  int category = kAbsent;  // kAbsent: all
  const ask::ScoreRow* score = nullptr;
};

// Of the episodes about whose start the model was asked: does it know which object is meant, does
// the policy go for it, does it do the task. `contrast`: knows - goes.
struct KnowsRow {
  int model = 0, policy = 0;
  std::uint32_t family = 0;
  int category = kAbsent;                // kAbsent: all
  std::array<std::int64_t, 8> counts{};  // of episodes, at 4 knows + 2 goes + does
  Contrast contrast;

  std::int64_t episodes() const;
  std::int64_t with(bool knows, bool goes) const;  // whatever it does
};

struct Knowledge {
  std::vector<AccuracyRow> accuracy;
  std::vector<KnowsRow> knows;  // `adjusted` after Holm: sums among themselves, categories of a sum
};

// What each family is called in tables of models: "understanding.source", and with its words where
// a plan before asks other words under that name.
class FamilyNames {
 public:
  explicit FamilyNames(const Benchmark& benchmark);
  const std::string& of(int model, std::uint32_t family) const {
    return names_[static_cast<std::size_t>(model)][family];
  }

 private:
  std::vector<std::vector<std::string>> names_;  // by model, family
};

// The models as policies, families of questions as metrics, and as an episode what was answered in
// all orders of the options about one start: so that tables and comparisons of policies are those
// of models, too. A task stands there once for each family that it is asked.
Benchmark models_as_policies(const Benchmark& benchmark);

// Rows point into `benchmark`.
Knowledge make_knowledge(const Benchmark& benchmark);

// "understanding.source"
std::string question_name(const Benchmark& benchmark, const KnowsRow& row);
// "of the 93 episodes in which pi0 did not go for the right object, paligemma named it in 71"
std::string knows_sentence(const Benchmark& benchmark, const KnowsRow& row);

// For PAGE_DATA.md: `models`, `tables.accuracy`, `tables.knows`.
void add_knowledge(const Benchmark& benchmark, const Knowledge& knowledge, Json& data);

}  // namespace probe::report
