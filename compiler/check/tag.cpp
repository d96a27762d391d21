// P0705: objects of a suite that do not say whether its training set has them.
#include <algorithm>
#include <set>

#include "compiler/check/check.h"

namespace probe::sema {

void check_tags(const Model& model, Reporter& reporter) {
  std::set<ObjectId> reported;
  for (const Suite& suite : model.suites) {
    if (suite.trained_on == DatasetId::kNone) continue;
    for (const TaskId id : suite.members) {
      const Task& task = model.tasks[id];
      if (!task.complete) continue;
      for (const ObjectId object_id : task.objects()) {
        const Object& object = model.objects[object_id];
        // What another data set holds tells nothing of this one.
        const bool is_tagged =
            object.unseen || std::find(object.seen_in.begin(), object.seen_in.end(),
                                       suite.trained_on) != object.seen_in.end();
        if (is_tagged || !reported.insert(object_id).second) continue;
        reporter
            .report(
                Code::P0705, object.span,
                "object `" + object.name + "` does not say whether it was seen in " +
                    (object.seen_in.empty() ? std::string("training")
                                            : "`" + model.datasets[suite.trained_on].name + "`"))
            .help("write `seen in " + model.datasets[suite.trained_on].name + "` or `unseen`");
      }
    }
  }
}

}  // namespace probe::sema
