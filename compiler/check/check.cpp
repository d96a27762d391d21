#include "compiler/check/check.h"

#include "compiler/define/remembered.h"

namespace probe::sema {

void check_model(const Checked& checked, Reporter& reporter) {
  const Model& model = checked.model;
  if (reporter.depth.remembered != nullptr) reporter.depth.remembered->begin_checks(model);
  check_comparisons(model, reporter);
  check_phrases(model, checked.asset_root, reporter);
  check_spatial_words(model, reporter);
  check_goal_words(model, reporter);
  check_place_words(model, reporter);
  check_mentions(model, reporter);
  check_look_words(model, reporter);
  check_poses(model, reporter);
  check_named(model, reporter);
  if (reporter.is_stopped()) return;
  check_starts(model, checked.asset_root, reporter);
  if (reporter.is_stopped()) return;
  if (!reporter.depth.is_immediate) check_unseen(model, checked.asset_root, reporter);
  if (!reporter.depth.is_immediate) check_buried(model, checked.asset_root, reporter);
  check_repeated(model, reporter);
  if (!reporter.depth.is_immediate) check_wide(model, checked.asset_root, reporter);
  check_horizons(model, reporter);
  check_metrics(model, reporter);
  if (!reporter.depth.is_immediate) check_begun(model, checked.asset_root, reporter);
  check_expectations(model, reporter);
  check_samples(model, reporter);
  check_photos(model, reporter);
  check_tags(model, reporter);
  check_magnitudes(checked.symbols, reporter);
  if (!reporter.depth.is_immediate) check_boxes(checked, reporter);
  check_unused(checked, reporter);
}

}  // namespace probe::sema
