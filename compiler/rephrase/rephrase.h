// Rewordings of instructions for training: a model in, the wordings of each task out, in two splits
// that share none. The same text and options give the same result, whatever else is asked for
// beside it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/model/model.h"
#include "compiler/rephrase/leaks.h"
#include "compiler/rephrase/wordings.h"
#include "runtime/base/asset_root.h"

namespace probe::rephrase {

inline constexpr std::uint32_t kMostPerTask = 10'000;

struct Options {
  std::uint64_t seed = 0;
  double held_out = 0.1;          // in [0, 1]: how likely a wording is held out
  std::uint32_t per_task = 1000;  // at most as many wordings of a task, 1 .. kMostPerTask
  // How likely the instruction itself is said in training where there are rewordings; none: as
  // likely as each of them.
  std::optional<double> keep_original = {};
  // For readers who look a rewording up by the instruction alone: only what is proved of every task
  // here that has the instruction, and the same of each.
  bool by_instruction = false;
  AssetRoot asset_root = {};  // of the meshes whose middles relations measure
  bool drop_leaks = false;      // left out and counted; else they are told, and the caller refuses
};

// What INT-ACT's "+rephrase" does: the instruction in one half of all draws, several wordings else,
// all of which are trained on.
inline constexpr std::uint32_t kIntactPerTask = 10;
inline constexpr double kIntactKeepOriginal = 0.5, kIntactHeldOut = 0;

struct Line {
  Wording wording;
  bool is_held_out = false;
  double probability = 0;  // of being said at a draw in training; 0 of what is held out
};

struct TaskWordings {
  sema::TaskId task = sema::TaskId::kNone;
  std::vector<Line> lines;  // in the order of Proved::wordings
  double original_probability = 1;
  std::size_t train = 0, held_out = 0;
  std::uint64_t candidates = 0, same_words = 0, not_drawn = 0, over_cap = 0, leaks = 0;
  std::uint64_t of_some_tasks = 0;  // left out by Options::by_instruction
  Refused refused;
};

struct FoundLeak {
  sema::TaskId task = sema::TaskId::kNone;
  std::string wording;
  Leak leak;
};

struct Rephrased {
  std::vector<TaskWordings> tasks;  // in the order that was asked for
  std::vector<FoundLeak> leaks;     // empty with Options::drop_leaks
  bool by_instruction = false;      // as in Options
};

// `tasks`: concrete ones of `model`, which has no errors and must live as long as the result. A
// wording's split is drawn from the seed and its words, up to how they are compared with
// evaluations and without courtesies, so that no other task has it in another split, not even more
// politely; what is an instruction of any task
// of the model is trained on. Which wordings a task keeps under its cap is drawn from the seed, its
// instruction and the wording.
Rephrased rephrase(const sema::Model& model, std::span<const sema::TaskId> tasks,
                   const std::vector<Evaluation>& not_in, const Options& options);

}  // namespace probe::rephrase
