// P0201 for an object or a fixture that a metric names and that is not in the scene of a task.
#include <algorithm>
#include <set>
#include <utility>

#include "compiler/check/check.h"
#include "compiler/define/remembered.h"
#include "compiler/define/task.h"
#include "compiler/define/telling.h"
#include "compiler/model/mentioned.h"

namespace probe::sema {

void check_named(const Model& model, Reporter& reporter) {
  MentionedIn mentioned(model);
  std::set<std::pair<std::uint32_t, std::uint32_t>> said;  // one place is one mistake
  Silence silence(model, reporter, Silent::kNamed, Silence::Says::kOnce);
  for (const Task& task : model.tasks) {
    if (task.abstract || !task.complete || silence.is_known(task)) continue;
    const About about(reporter, task.decl_span);
    const std::vector<ObjectId> objects = task.objects();
    const Mentioned& found = mentioned.metrics(measured_in(task));
    for (const auto& [id, span] : found.objects) {
      if (std::find(objects.begin(), objects.end(), id) != objects.end()) continue;
      if (!said.insert({span.file.value, span.begin}).second) continue;
      const std::string& name = model.objects[id].name;
      report_of(reporter, Situation::kNotInScene, task, span,
                "object `" + name + "` is not in the scene of `" + task.name + "`")
          .label(task.span, "judged by this; its scene has " + objects_text(model, task))
          .help("place it there: `place " + name + " at (..)` in the layout, or `distractors " +
                name + "`");
    }
    if (!found.fixture || model.scenes[task.scene].fixture) continue;
    if (!said.insert({found.fixture->file.value, found.fixture->begin}).second) continue;
    report_of(reporter, Situation::kNotInScene, task, *found.fixture,
              "no fixture is in the scene of `" + task.name + "`")
        .label(task.span, "judged by this");
  }
}

}  // namespace probe::sema
