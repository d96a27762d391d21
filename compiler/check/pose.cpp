// P0404 for a `pose` of an object that the task does not have: it would turn nothing.
#include <algorithm>
#include <set>
#include <utility>

#include "compiler/check/check.h"
#include "compiler/define/task.h"

namespace probe::sema {

void check_poses(const Model& model, Reporter& reporter) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> said;  // a line of a `derive` is in many tasks
  for (const Task& task : model.tasks) {
    if (task.abstract || !task.complete) continue;
    const std::vector<ObjectId> objects = task.objects();
    for (const PoseOverride& pose : task.poses) {
      // What is copied may have been said of an object that this task has no more.
      if (!is_within(pose.span, task.decl_span)) continue;
      if (std::find(objects.begin(), objects.end(), pose.object) != objects.end()) continue;
      if (!said.insert({pose.span.file.value, pose.span.begin}).second) continue;
      const About about(reporter, task.decl_span);
      const std::string& name = model.objects[pose.object].name;
      reporter
          .report(Situation::kAbsentPosed, pose.span,
                  "`" + name + "` is not in the scene of `" + task.name + "`")
          .point("the scene has " + objects_text(model, task))
          .help("leave the pose out, or add `distractors " + name + "`");
    }
  }
}

}  // namespace probe::sema
