// What the finished model says that nobody means: one file a family of codes. A check reads the
// model, and the trees only where the words themselves are looked at; it changes neither.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "compiler/model/model.h"
#include "compiler/names/reporter.h"
#include "compiler/names/symbols.h"
#include "runtime/base/asset_root.h"

namespace probe::sema {

// What a check may read.
struct Checked {
  const Model& model;
  const Symbols& symbols;
  const SourceSet& sources;
  const std::vector<const syntax::File*>& files;
  std::span<const FileId> roots;  // named by the user rather than by `use`
  AssetRoot asset_root;
};

// Reports at Task::place; where that is not what was said, a label leads there.
inline Diagnostic& report_of(Reporter& reporter, auto what, const Task& task, const Span& said,
                             std::string message) {
  Diagnostic& diagnostic = reporter.report(what, task.place(said), std::move(message));
  if (!(said.file == task.file)) diagnostic.label(said, "said here");
  return diagnostic;
}

// In: the model that define_model() made. Out: words to the reporter, each thing once. Language
// comes before places because a mistake in either may be why the other is odd; sizes and unused
// names are looked at only when nothing else is wrong.
void check_model(const Checked& checked, Reporter& reporter);

void check_comparisons(const Model& model, Reporter& reporter);  // P0701-P0703
void check_phrases(const Model& model, const AssetRoot& asset_root,
                   Reporter& reporter);                            // P0401-P0407
void check_spatial_words(const Model& model, Reporter& reporter);  // P1202 of phrases
void check_goal_words(const Model& model, Reporter& reporter);     // P1202 of instructions
void check_place_words(const Model& model, Reporter& reporter);    // P1203
void check_look_words(const Model& model, Reporter& reporter);     // P1510
void check_poses(const Model& model, Reporter& reporter);          // P0404 of `pose`
void check_mentions(const Model& model, Reporter& reporter);       // P0404 of words
void check_named(const Model& model, Reporter& reporter);          // P0201 of metrics
void check_starts(const Model& model, const AssetRoot& asset_root,
                  Reporter& reporter);                       // P0501, P0502, P0505, P1302, P1511
void check_unseen(const Model& model, const AssetRoot& asset_root, Reporter&);  // P0505 of parts
void check_buried(const Model& model, const AssetRoot& asset_root, Reporter&);  // P0507
void check_repeated(const Model& model, Reporter& reporter);  // P1512
void check_wide(const Model& model, const AssetRoot& asset_root, Reporter&);   // P1514
void check_horizons(const Model& model, Reporter& reporter);  // P1513
void check_metrics(const Model& model, Reporter& reporter);  // P0206, P0304, P0601, P0604, P0605
void check_begun(const Model& model, const AssetRoot& asset_root, Reporter&);  // P0607
// What of it only fingers or a gripper have, such as "`grip`"; empty where nothing is.
std::string asks_for_fingers(const Model& model, ExprRef expr);
// The read-outs whose metrics are true or false: "`at end`, `once` or `always`".
std::string words_of_truths();
void check_expectations(const Model& model, Reporter& reporter);    // P0504, P0211
void check_samples(const Model& model, Reporter& reporter);         // P0706
void check_photos(const Model& model, Reporter& reporter);          // P0304 of cameras that jitter
void check_tags(const Model& model, Reporter& reporter);            // P0705
void check_magnitudes(const Symbols& symbols, Reporter& reporter);  // P0303
void check_boxes(const Checked& checked, Reporter& reporter);    // P0506
void check_unused(const Checked& checked, Reporter& reporter);  // P0205

}  // namespace probe::sema
