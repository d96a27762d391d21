// P0505 as a warning: a part of a fixture that a task speaks of, outside the image of every camera
// that does not move, where the task begins.
#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "compiler/check/check.h"
#include "compiler/check/starts.h"
#include "compiler/define/fixture.h"
#include "compiler/define/views.h"

namespace probe::sema {
namespace {

class UnseenChecker {
 public:
  UnseenChecker(const Model& model, const AssetRoot& asset_root, Reporter& reporter)
      : model_(model), reporter_(reporter), travels_(model, asset_root) {}

  void check(const Task& task) {
    if (task.starts.empty()) return;
    std::vector<CameraId> cameras;
    for (const View& view : views_of(model_, task)) cameras.push_back(view.camera);
    for (const auto& [role, id] : task.things()) {
      const auto [at, is_new] = known_.try_emplace(
          {task.scene, cameras, joint_starts_of(model_, task, task.starts.front()), id}, 0.0);
      if (is_new) at->second = outside(task, model_.objects[id]);
      if (at->second >= 1) report(task, role, id, at->second);
    }
  }

 private:
  // px, of the camera that it is the least out of; 0 where it is seen, or where no camera stands
  // still. The first start's cameras and joints tell.
  double outside(const Task& task, const Object& thing) {
    const Scene& scene = model_.scenes[task.scene];
    const TaskStarts starts{model_, reporter_, task, model_.layouts[task.layout]};
    std::vector<scene::Solid> boxes;
    for (const BegunFixture& fixture : begun_fixtures(starts, travels_)) {
      if (&fixture.fixture != &model_.fixtures[thing.of->fixture]) continue;
      for (const PartBox& box : fixture.travel.at(fixture.joints.front())) {
        if (box.part == thing.of->part) boxes.push_back(box.solid);
      }
    }
    Lookout lookout;
    lookout.look(model_, scene, views_of(model_, task), 0);
    return boxes.empty() || lookout.camera() == nullptr ? 0 : lookout.outside(boxes);
  }

  void report(const Task& task, RoleId role, ObjectId id, double out) {
    const About about(reporter_, task.decl_span);
    const auto index = static_cast<std::size_t>(role);
    const Span& said_at = index < task.role_span.size() ? task.role_span[index] : task.span;
    const Camera& camera = model_.cameras[views_of(model_, task).front().camera];
    const std::string& name = model_.objects[id].name;
    Diagnostic& said = reporter_.report(
        Situation::kOutOfFrame, task.place(said_at.is_none() ? task.span : said_at),
        "`" + name + "`, of which `" + task.name + "` speaks, " + Lookout::where(out) + " `" +
            camera.name + "`" +
            (views_of(model_, task).size() > 1 ? ", and no other camera that stands still sees it"
                                               : ""));
    said.severity = Severity::kWarning;
    said.cause = cause_of(model_.scenes[task.scene].span, {camera.name, name});
    said.label(camera.span, "the camera")
        .label(model_.fixtures[model_.objects[id].of->fixture].span, "the fixture")
        .help("move the fixture, or turn the camera: `vlaprobe preview F " + task.name +
              " -o seen.png` shows what it sees");
  }

  const Model& model_;
  Reporter& reporter_;
  Travels travels_;
  std::map<std::tuple<SceneId, std::vector<CameraId>, std::vector<double>, ObjectId>, double> known_;
};

}  // namespace

void check_unseen(const Model& model, const AssetRoot& asset_root, Reporter& reporter) {
  UnseenChecker checker(model, asset_root, reporter);
  for (const Task& task : model.tasks) {
    if (!task.abstract && task.complete) checker.check(task);
  }
}

}  // namespace probe::sema
