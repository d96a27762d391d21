// What was found as files and words: a line a wording, and what became of all candidates.
#pragma once

#include <map>
#include <string>

#include "compiler/rephrase/rephrase.h"
#include "runtime/base/json.h"
#include "runtime/base/sha256.h"

namespace probe::rephrase {

// What proves the wordings.
struct MadeFrom {
  Sha256 sources;  // sources_hash() of the text
  // By the task's name: plan::starts_hash, in which of its words hold. Empty: of no task known.
  std::map<std::string, Sha256> starts = {};
};

// A line has task, original,
// wording, split ("train", "held_out"), probability, original_probability, template and frame
// (null: words on the spot have no name), source_as and target_as (the phrase; null: the name),
// uses (axes of language that the phrases have), original_sha256 and wording_sha256 (as a run's
// prompt_sha256), made_from_sha256, starts_sha256 (null: not known).
std::string to_json_lines(const sema::Model& model, const Rephrased& all,
                          const MadeFrom& made_from);
// The same columns; lists are joined by spaces.
std::string to_csv(const sema::Model& model, const Rephrased& all, const MadeFrom& made_from);

// Counts by task and in all, with the reasons of refusals.
Json summary(const sema::Model& model, const Rephrased& all, const Options& options);
// For people: `summary` as a table.
std::string summary_text(const Json& summary);

// Of the contents of all files, in the order in which they were read; where they lie does not
// count.
Sha256 sources_hash(const SourceSet& sources);

}  // namespace probe::rephrase
