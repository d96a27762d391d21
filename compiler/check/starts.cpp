// Every task's starts, one check after the other; starts.h has their codes. Objects and arms are
// boxes here: collision hulls are not known to the compiler.
#include "compiler/check/starts.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>
#include <vector>

#include "compiler/check/check.h"
#include "compiler/define/fixture.h"
#include "compiler/define/remembered.h"
#include "compiler/define/task.h"
#include "compiler/define/views.h"

namespace probe::sema {

Span TaskStarts::place(std::initializer_list<ObjectId> objects) const {
  if (!like_is_fine || is_within(task.layout_span, task.decl_span))
    return task.place(task.layout_span);
  for (const ObjectId id : objects) {
    if (const auto span = entry_of(task, id)) return task.place(*span);
  }
  return task.span;
}

std::string CountedStarts::text() const {
  return "in " + std::to_string(bad) + " of " + std::to_string(all) +
         (all == 1 ? " start of" : " starts of");
}

std::string CountedStarts::first_words(const std::string& what) const {
  return "first in start " + std::to_string(first) + ": " + what;
}

std::string cause_of(const Span& place, std::initializer_list<std::string_view> names) {
  std::string cause = std::to_string(place.file.value) + ":" + std::to_string(place.begin);
  for (const std::string_view name : names) cause += " " + std::string(name);
  return cause;
}

std::string centimetres(double metres) {
  char text[32];
  // What rounding leaves below nothing has no sign.
  std::snprintf(text, sizeof text, "%.4gcm", std::abs(metres) < 5e-7 ? 0.0 : metres * 100);
  return text;
}

std::string at(const Object& object, const Start::Placed& placed) {
  return object.name + " at (" + centimetres(placed.x) + ", " + centimetres(placed.y) + ")";
}

namespace {

// Whether what it begins with is told by the text alone: what lies in and on fixtures is asked of
// their models.
bool is_plain(const Model& model, const Task& task) {
  return model.scenes[task.scene].fixtures.empty() &&
         std::ranges::none_of(model.layouts[task.layout].places, &Place::is_put);
}

}  // namespace

void check_starts(const Model& model, const AssetRoot& asset_root, Reporter& reporter) {
  // Tasks share lists of starts; what was fine for one in its scene is fine for the next, and what
  // a table of starts has is said of the first task that begins so.
  using Where = std::pair<SceneId, std::vector<double>>;
  std::map<const Start*, std::map<Where, bool>> stands_in;  // whether nothing was said
  // With whether nothing at all was said of them.
  std::map<const Start*, std::map<std::pair<Where, std::vector<CameraId>>, bool>> fine_in;
  std::vector<bool> fine(model.tasks.size(), false);
  Arms arms;
  Lookouts lookouts;
  Travels travels(model, asset_root);
  const bool is_immediate = reporter.depth.is_immediate;
  if (!is_immediate) check_fixture_places(model, travels, reporter);
  Silence silence(model, reporter, Silent::kStarts);
  std::size_t at = 0;
  for (const Task& task : model.tasks) {
    const std::size_t index = at++;
    if (task.starts.empty()) continue;
    if (reporter.is_stopped()) return;
    if (is_plain(model, task) && silence.is_known(task)) {
      fine[index] = true;
      continue;
    }
    const Where where{task.scene, joint_starts_in_all(model, task)};
    std::vector<CameraId> cameras;
    for (const View& view : views_of(model, task)) cameras.push_back(view.camera);
    auto& known = fine_in[task.starts.data()];
    auto& stands = stands_in[task.starts.data()];
    const auto fine_before = known.find({where, cameras});
    if (task.motions.empty() && fine_before != known.end()) {
      fine[index] = true;
      if (!fine_before->second) silence.hold_back();
      continue;
    }
    const About about(reporter, task.decl_span);
    const bool like_is_fine =
        task.like != TaskId::kNone && fine[static_cast<std::size_t>(task.like)];
    const TaskStarts starts{model, reporter, task, model.layouts[task.layout], like_is_fine};
    const std::size_t before = reporter.diagnostics.size();
    const std::size_t errors = reporter.diagnostics.error_count();
    const auto is_settled = [&] {
      return reporter.diagnostics.size() == before ||
             (!starts.layout.given.empty() && reporter.diagnostics.error_count() == errors);
    };
    bool is_reached = true;
    const auto stood = stands.find(where);
    if (task.motions.empty() && stood != stands.end()) {
      if (!stood->second) silence.hold_back();
    } else {
      check_overlap(starts);
      if (!is_immediate) check_travel(starts, travels);
      // What lies beside the table is out of reach and out of view as well.
      is_reached = check_surface(starts, travels) && check_reach(starts, arms);
      if (is_settled()) stands.insert({where, reporter.diagnostics.size() == before});
    }
    if (is_reached) check_frame(starts, lookouts);
    if (!is_immediate) check_motion(starts, travels);
    fine[index] = reporter.diagnostics.size() == before;
    if (is_settled()) known.insert({{where, std::move(cameras)}, fine[index]});
  }
}

}  // namespace probe::sema
